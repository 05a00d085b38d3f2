"""What a flown mission left: read back, rebuilt and exported. The exports are read with other people's eyes."""

from __future__ import annotations

import csv
import io
import json
import math
from xml.etree import ElementTree

import numpy as np
import pytest
from shapely.geometry import shape

from backend.events import (
    AreaChanged,
    BearingExcluded,
    BearingMeasured,
    MissionDrafted,
    MissionEnded,
    MissionStarted,
    PhaseChanged,
    SweepStarted,
)
from backend.mission.localization import localization
from backend.mission.ports import TrackPoint
from backend.spec import MissionSpec, Place, Polygon, SearchArea
from backend.wire.belief_frame import encode_belief
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint, Sweep

HOME = Place(lat=50.6, lon=7.2)
FRAME = LocalFrame(GeoPoint(HOME.lat, HOME.lon))
EMITTER = FRAME.to_geo(30.0, 120.0)


def corner(x: float, y: float) -> tuple[float, float]:
    point = FRAME.to_geo(x, y)
    return point.lon_deg, point.lat_deg


SPEC = MissionSpec(
    name="Owl <7> & \x07 friends",
    area=Polygon(coordinates=[[corner(-150, 0), corner(150, 0), corner(150, 200), corner(-150, 200), corner(-150, 0)]]),
)
TASK = localization(SPEC, HOME, 100.0)


def bearing(number: int, x: float, y: float, error_deg: float = 0.0) -> BearingMeasured:
    here = FRAME.to_geo(x, y)
    true = math.degrees(math.atan2(30.0 - x, 120.0 - y))
    return BearingMeasured(
        bearing_id=f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=Place(lat=here.lat_deg, lon=here.lon_deg),
        altitude_amsl_m=140.0,
        bearing_deg=(true + error_deg) % 360,
        sigma_deg=7.0,
        quality=0.9,
        peaks=[],
        snr_db=20.0,
        drift_m=0.2,
        binned_db=[0.0] * 180,
        fitted_db=[0.0] * 180,
    )


BEARINGS = [bearing(1, 0, 0), bearing(2, 150, 60, 90.0), bearing(3, 140, 150)]
COUNTED = [BEARINGS[0], BEARINGS[2]]


@pytest.fixture
async def flown(services) -> str:
    started = MissionStarted(by="operator", home=HOME, home_amsl_m=100.0, software="0")
    events = [MissionDrafted(spec=SPEC), started]
    for number, fact in enumerate(BEARINGS, start=1):
        events += [SweepStarted(place_number=number, attempt=1), fact, TASK.belief_fact(BEARINGS[:number])[0]]
    events += [BearingExcluded(bearing_id="b2", by="operator", reason="mirror"), TASK.belief_fact(COUNTED)[0]]
    events += [PhaseChanged(before="measuring", after="done", reason="localized")]
    events += [MissionEnded(outcome="localized", reason="within 10 m", mission_time_s=200.0)]
    services.hub.events(await services.journal.append("flown", events))
    points = [TrackPoint(1.7e9 + n, 50.6 + n * 1e-5, 7.2, 140.0, 40.0, 0.0, 80.0, "AUTO") for n in range(4)]
    await services.journal.save_track("flown", points)
    power = np.array([-80.0, math.nan, -70.0])
    sweep = Sweep(np.array([10.0, 10.5, 11.0]), np.array([0.0, 15.0, 30.0]), power, 868e6, GeoPoint(50.6, 7.2), 140.0)
    await services.journal.save_sweep("flown", "s1", 1, 1, sweep)
    return "/api/missions/flown"


async def test_the_mission_tells_how_it_ended(client, flown):
    mission = (await client.get(flown)).json()
    assert (mission["phase"], mission["outcome"], mission["outcome_reason"]) == ("done", "localized", "within 10 m")
    assert (mission["bearings"], mission["editable"]) == (2, False)
    estimate = mission["estimate"]
    east, north = FRAME.to_enu(GeoPoint(estimate["lat"], estimate["lon"]))
    assert math.hypot(east - 30, north - 120) < 3 * estimate["expected_rmse_m"]


async def test_events_come_in_pages(client, flown):
    seqs, after, more = [], 0, True
    while more:
        page = (await client.get(f"{flown}/events", params={"after": after, "limit": 4})).json()
        seqs += [record["seq"] for record in page["events"]]
        after, more = seqs[-1], page["more"]
    assert seqs == list(range(1, page["last_seq"] + 1))


@pytest.mark.parametrize("counted", [[], BEARINGS[:1], COUNTED, BEARINGS])
async def test_a_past_belief_is_rebuilt_as_it_was(client, flown, counted):
    """After two bearings: the later of the two beliefs, without the excluded bearing."""
    _, belief = TASK.belief_fact(counted)
    for lite in (False, True):
        reply = await client.get(f"{flown}/beliefs/{len(counted)}", params={"lite": lite})
        corners = TASK.corners_lon_lat(belief)
        assert reply.content == encode_belief("flown", len(counted), belief.density, corners, lite=lite)


async def test_a_belief_from_before_a_bearing_was_left_out_or_the_area_changed_is_rebuilt_too(client, services, flown):
    _, earlier = TASK.belief_fact(BEARINGS[:2])
    recorded = await services.journal.read("flown")
    excluded = next(r.seq for r in recorded if r.event.kind == "bearing_excluded")
    reply = await client.get(f"{flown}/beliefs/2", params={"seq": excluded})
    assert reply.content == encode_belief("flown", 2, earlier.density, TASK.corners_lon_lat(earlier), lite=False)

    west = Polygon(coordinates=[[corner(-150, 0), corner(50, 0), corner(50, 200), corner(-150, 200), corner(-150, 0)]])
    task = localization(SPEC.model_copy(update={"area": west}), HOME, 100.0)
    fact, later = task.belief_fact(COUNTED)
    search = SearchArea(area=west, prior=SPEC.prior, fence=None, fence_margin_m=60.0, no_fly=[])
    changed = AreaChanged(search=search, by="operator")
    await services.journal.append("flown", [changed, fact])
    frames = [(await client.get(f"{flown}/beliefs/2", params=q)).content for q in ({"seq": recorded[-1].seq}, {})]
    _, before = TASK.belief_fact(COUNTED)
    assert frames == [
        encode_belief("flown", 2, before.density, TASK.corners_lon_lat(before), lite=False),
        encode_belief("flown", 2, later.density, task.corners_lon_lat(later), lite=False),
    ]


async def test_there_is_no_belief_beyond_the_last_bearing(client, flown):
    assert (await client.get(f"{flown}/beliefs/4")).status_code == 404


async def test_a_draft_shows_its_prior(client):
    spec = SPEC.model_dump(mode="json")
    mission_id = (await client.post("/api/missions", json=spec)).json()["mission_id"]
    assert (await client.get(f"/api/missions/{mission_id}/beliefs/0")).status_code == 200
    assert (await client.get(f"/api/missions/{mission_id}/beliefs/1")).status_code == 404


async def test_a_raw_sweep_is_told_sample_by_sample(client, flown):
    sweep = (await client.get(f"{flown}/sweeps/s1")).json()
    assert (sweep["at_s"], sweep["heading_deg"]) == ([0.0, 0.5, 1.0], [0.0, 15.0, 30.0])
    assert sweep["power_db"] == [-80.0, None, -70.0]
    assert (await client.get(f"{flown}/sweeps/s9")).status_code == 404


async def test_the_track_is_told_point_by_point(client, flown):
    points = (await client.get(f"{flown}/track")).json()["points"]
    assert [point["lat"] for point in points] == pytest.approx([50.6, 50.60001, 50.60002, 50.60003])


async def test_the_bearing_file_has_the_columns_of_uavrt(client, flown):
    reply = await client.get(f"{flown}/export/csv")
    rows = list(csv.reader(io.StringIO(reply.text)))
    assert [row[1] for row in rows] == ["s1", "s3"]
    for row, fact in zip(rows, COUNTED, strict=True):
        assert len(row) == 10
        numbers = [float(row[column]) for column in (2, 3, 4, 5, 6, 7)]
        wanted = [fact.bearing_deg, fact.quality, fact.place.lat, fact.place.lon, 40.0, 140.0]
        np.testing.assert_allclose(numbers, wanted, atol=1e-6)
        assert float(row[8]) <= float(row[9])


async def test_geojson_shows_where_and_what(client, flown):
    collection = (await client.get(f"{flown}/export/geojson")).json()
    found: dict[str, list] = {}
    for feature in collection["features"]:
        assert shape(feature["geometry"]).is_valid
        found.setdefault(feature["properties"]["what"], []).append(feature)
    assert {what: len(features) for what, features in found.items()} == {
        "area": 1,
        "track": 1,
        "place": 3,
        "bearing": 3,
        "estimate": 1,
        "c95": 1,
    }
    assert [f["properties"]["excluded"] for f in found["bearing"]] == [False, True, False]
    for feature, fact in zip(found["bearing"], BEARINGS, strict=True):
        (lon0, lat0), (lon1, lat1) = feature["geometry"]["coordinates"]
        east, north = LocalFrame(GeoPoint(lat0, lon0)).to_enu(GeoPoint(lat1, lon1))
        turned = (math.degrees(math.atan2(east, north)) - fact.bearing_deg + 180) % 360 - 180
        assert abs(turned) < 0.01


async def test_kml_is_xml_with_the_same_placemarks(client, flown):
    root = ElementTree.fromstring((await client.get(f"{flown}/export/kml")).text)
    names = [element.text for element in root.iter("{http://www.opengis.net/kml/2.2}name")]
    assert names[0] == "Owl <7> &  friends"
    assert {"flown path", "bearing 3", "estimate", "95 % region"} <= set(names)


async def test_the_json_file_is_the_whole_journal(client, flown, services):
    reply = await client.get(f"{flown}/export/json")
    assert "attachment" in reply.headers["content-disposition"]
    recorded = await services.journal.read("flown")
    assert json.loads(reply.text)["events"] == [record.model_dump(mode="json") for record in recorded]


async def test_every_format_takes_a_mission_that_never_flew(client):
    mission_id = (await client.post("/api/missions", json=SPEC.model_dump(mode="json"))).json()["mission_id"]
    for name in ("geojson", "kml", "csv", "json"):
        assert (await client.get(f"/api/missions/{mission_id}/export/{name}")).status_code == 200
    assert (await client.get(f"/api/missions/{mission_id}/export/exe")).status_code == 422
