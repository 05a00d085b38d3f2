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
from sqlalchemy import text

from backend.events import (
    AreaChanged,
    BearingExcluded,
    BearingMeasured,
    BeliefUpdated,
    CraftSource,
    MissionDrafted,
    MissionEnded,
    MissionStarted,
    PhaseChanged,
    SweepStarted,
)
from backend.ports import TrackPoint
from backend.reasons.search import Localized
from backend.reasons.work import FileTooHeavy
from backend.search.localization import localization
from backend.spec import EmitterSpec, MissionSpec, Polygon, SearchArea
from backend.store.engine import make_engine
from backend.store.handed_over import made_of
from backend.wire.belief_frame import encode_belief
from backend.workers import Workers, WorkStopped
from hardware.frame import LocalFrame
from hardware.readings import Place, Sweep

HOME = Place(lat=50.6, lon=7.2)
FRAME = LocalFrame(HOME)
EMITTER = FRAME.to_geo(30.0, 120.0)


def corner(x: float, y: float) -> tuple[float, float]:
    point = FRAME.to_geo(x, y)
    return point.lon, point.lat


SPEC = MissionSpec(
    name="Owl <7> & \x07 friends",
    area=Polygon(coordinates=[[corner(-150, 0), corner(150, 0), corner(150, 200), corner(-150, 200), corner(-150, 0)]]),
    emitters=[EmitterSpec(), EmitterSpec(emitter_id="tag", frequency_hz=150e6, label="tag 7")],
)
"""Its name is one of before drafts were held to the rule of labels."""
DRAFT = SPEC.model_copy(update={"name": "Owl <7> & friends"}).model_dump(mode="json")
TASK, TAG_TASK = localization(SPEC, HOME), localization(SPEC, HOME, "tag")


def bearing(number: int, x: float, y: float, error_deg: float = 0.0) -> BearingMeasured:
    here = FRAME.to_geo(x, y)
    true = math.degrees(math.atan2(30.0 - x, 120.0 - y))
    return BearingMeasured(
        emitter_id="emitter-1",
        source=CraftSource(craft_id="craft-1"),
        bearing_id=f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=here,
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
OF_TAG = bearing(4, 0, 0).model_copy(update={"emitter_id": "tag"})


@pytest.fixture
async def flown(services) -> str:
    started = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
    events = [MissionDrafted(spec=SPEC), started]
    for number, fact in enumerate(BEARINGS, start=1):
        events += [
            SweepStarted(craft_id="craft-1", place_number=number, attempt=1),
            fact,
            TASK.belief_fact(BEARINGS[:number])[0],
        ]
    excluded = BearingExcluded(emitter_id="emitter-1", bearing_id="b2", by="operator", reason="mirror")
    events += [OF_TAG, TAG_TASK.belief_fact([OF_TAG])[0], excluded, TASK.belief_fact(COUNTED)[0]]
    events += [PhaseChanged(craft_id="craft-1", before="measuring", after="returning", reason=Localized())]
    events += [MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0)]
    events += [PhaseChanged(craft_id="craft-1", before="returning", after="ground", reason=Localized())]
    services.hub.events(await services.journal.append("flown", events))
    points = [TrackPoint(1.7e9 + n, 50.6 + n * 1e-5, 7.2, 140.0, 40.0, 0.0, 80.0, "AUTO") for n in range(4)]
    await services.journal.save_track("flown", "craft-1", points)
    power = np.array([-80.0, math.nan, -70.0])
    sweep = Sweep(np.array([10.0, 10.5, 11.0]), np.array([0.0, 15.0, 30.0]), power, 868e6, Place(50.6, 7.2), 140.0)
    await services.journal.save_sweep("flown", "s1", "craft-1", "emitter-1", 1, 1, sweep)
    return "/api/missions/flown"


async def test_the_mission_tells_how_it_ended_and_what_is_known_of_each_emitter(client, flown):
    mission = (await client.get(flown)).json()
    assert (mission["phase"], mission["outcome"]) == ("done", "localized")
    assert mission["outcome_reason"] == {"code": "localized"}
    assert (mission["bearings"], mission["editable"], mission["flying"]) == (3, False, False)
    first, tag = mission["found"]
    assert [(e["emitter_id"], e["bearings"], e["localized"]) for e in (first, tag)] == [
        ("emitter-1", 2, TASK.belief_fact(COUNTED)[0].localized),
        ("tag", 1, False),
    ]
    assert tag["not_yet"]
    estimate = first["estimate"]
    east, north = FRAME.to_enu(Place(estimate["lat"], estimate["lon"]))
    assert math.hypot(east - 30, north - 120) < 3 * estimate["expected_rmse_m"]


async def test_events_come_in_pages(client, flown):
    seqs, page = [], {"last_seq": 0, "more": True}
    while page["more"]:
        after = seqs[-1] if seqs else 0
        page = (await client.get(f"{flown}/events", params={"after": after, "limit": 4})).json()
        seqs += [record["seq"] for record in page["events"]]
    assert seqs == list(range(1, page["last_seq"] + 1))


async def test_a_past_belief_is_rebuilt_as_it_was(client, services, flown):
    """At every event: the belief of the last BeliefUpdated until then, with that event's number."""
    told: list[BearingMeasured] = []
    counted: list[BearingMeasured] = []
    seq = 0
    for record in await services.journal.read("flown"):
        match record.event:
            case BearingMeasured(emitter_id="emitter-1") as measured:
                told.append(measured)
            case BearingExcluded():
                told = COUNTED
            case BeliefUpdated(emitter_id="emitter-1"):
                seq, counted = record.seq, list(told)
            case _:
                pass
        if seq == 0:
            continue
        _, belief = TASK.belief_fact(counted)
        for lite in (False, True):
            reply = await client.get(f"{flown}/beliefs", params={"seq": record.seq, "lite": lite})
            corners = TASK.corners_lon_lat(belief)
            frame = encode_belief("flown", "emitter-1", seq, len(counted), belief.density, corners, lite=lite)
            assert reply.content == frame


async def test_a_long_mission_is_worked_on_in_a_process_of_its_own_and_comes_out_alike(
    client, services, flown, monkeypatch
):
    asked = (f"{flown}/beliefs", f"{flown}/export/geojson", f"{flown}/export/json")
    before = [(await client.get(address)).content for address in asked]
    ran: list[str] = []
    monkeypatch.setattr("backend.api.heavy.LONG_FACTS", 1)
    monkeypatch.setattr(Workers, "run", counting(Workers.run, ran))
    assert [(await client.get(address)).content for address in asked] == before
    assert ran == ["belief_frame", "geojson", "journal_json"]
    supposed = await client.post(f"{flown}/what-if", json={"bearings": 2, "sigma_deg": 9.0})
    monkeypatch.setattr("backend.api.heavy.LONG_FACTS", 10_000)
    here = await client.post(f"{flown}/what-if", json={"bearings": 2, "sigma_deg": 9.0})
    assert ran[-1] == "what_if"
    assert without_times(supposed.json()) == without_times(here.json())
    await services.desk.close()


@pytest.mark.parametrize("long_facts", [1, 10_000], ids=["in a process of its own", "here"])
async def test_a_file_of_a_mission_with_a_damaged_fact_says_so(
    client, services, settings, flown, monkeypatch, long_facts
):
    monkeypatch.setattr("backend.api.heavy.LONG_FACTS", long_facts)
    engine = make_engine(settings.async_database_url, 60.0)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(text("UPDATE events SET body = '{}' WHERE mission_id = 'flown' AND seq = 3"))
    await engine.dispose()
    services.journal._written.pop("flown", None)
    reply = await client.get(f"{flown}/export/geojson")
    assert (reply.status_code, reply.json()["reason"]["code"]) == (500, "mission_damaged")
    await services.desk.close()


def without_times(answer):
    """plan_ms is measured."""
    return {**answer, "plan": answer["plan"] and {**answer["plan"], "plan_ms": 0}}


def counting(run, ran):
    async def counted(self, work, *args, **kwargs):
        ran.append((args[1] if work is made_of else work).__name__)
        return await run(self, work, *args, **kwargs)

    return counted


async def test_a_mission_that_is_too_heavy_is_refused_with_its_limit(client, services, flown, monkeypatch):
    monkeypatch.setattr("backend.api.heavy.LONG_FACTS", 1)

    async def stopped(*_):
        raise WorkStopped(FileTooHeavy("time", 120.0, 2**31))

    monkeypatch.setattr(Workers, "run", stopped)
    reply = await client.get(f"{flown}/export/geojson")
    assert (reply.status_code, reply.json()["reason"]["code"]) == (503, "mission_too_heavy")
    assert reply.json()["reason"]["limit"] == "time"


async def test_the_belief_about_another_emitter_is_asked_for_by_its_name(client, services, flown):
    (seq,) = [
        r.seq
        for r in await services.journal.read("flown")
        if isinstance(r.event, BeliefUpdated) and r.event.emitter_id == "tag"
    ]
    _, belief = TAG_TASK.belief_fact([OF_TAG])
    reply = await client.get(f"{flown}/beliefs", params={"emitter": "tag"})
    assert reply.content == encode_belief(
        "flown", "tag", seq, 1, belief.density, TAG_TASK.corners_lon_lat(belief), lite=False
    )
    unknown = await client.get(f"{flown}/beliefs", params={"emitter": "fox"})
    assert (unknown.status_code, unknown.json()["reason"]["what"]) == (404, "belief_about")


async def test_a_belief_from_before_the_area_changed_is_rebuilt_too(client, services, flown):
    recorded = await services.journal.read("flown")
    flown_seq = max(r.seq for r in recorded if r.event.kind == "belief_updated")
    west = Polygon(coordinates=[[corner(-150, 0), corner(50, 0), corner(50, 200), corner(-150, 200), corner(-150, 0)]])
    task = localization(SPEC.model_copy(update={"area": west}), HOME)
    fact, later = task.belief_fact(COUNTED)
    search = SearchArea(area=west, priors={}, fence=None, fence_margin_m=60.0, no_fly=[])
    _, new = await services.journal.append("flown", [AreaChanged(search=search, by="operator"), fact])
    frames = [(await client.get(f"{flown}/beliefs", params=q)).content for q in ({"seq": recorded[-1].seq}, {})]
    _, before = TASK.belief_fact(COUNTED)
    assert frames == [
        encode_belief("flown", "emitter-1", flown_seq, 2, before.density, TASK.corners_lon_lat(before), lite=False),
        encode_belief("flown", "emitter-1", new.seq, 2, later.density, task.corners_lon_lat(later), lite=False),
    ]


async def test_before_the_first_bearing_there_is_the_prior(client, flown):
    _, prior = TASK.belief_fact([])
    reply = await client.get(f"{flown}/beliefs", params={"seq": 4})
    assert reply.content == encode_belief(
        "flown", "emitter-1", 0, 0, prior.density, TASK.corners_lon_lat(prior), lite=False
    )


async def test_a_draft_shows_its_prior(client):
    mission_id = (await client.post("/api/missions", json=DRAFT)).json()["mission_id"]
    reply = await client.get(f"/api/missions/{mission_id}/beliefs")
    assert reply.status_code == 200
    assert b'"seq":0' in reply.content


async def test_a_raw_sweep_is_told_sample_by_sample(client, flown):
    sweep = (await client.get(f"{flown}/sweeps/s1")).json()
    assert (sweep["at_s"], sweep["heading_deg"]) == ([0.0, 0.5, 1.0], [0.0, 15.0, 30.0])
    assert sweep["power_db"] == [-80.0, None, -70.0]
    assert (await client.get(f"{flown}/sweeps/s9")).status_code == 404


async def test_the_track_is_told_point_by_point(client, flown):
    track = (await client.get(f"{flown}/track")).json()
    assert track["craft_id"] == "craft-1"
    assert [point["lat"] for point in track["points"]] == pytest.approx([50.6, 50.60001, 50.60002, 50.60003])
    assert (await client.get(f"{flown}/track", params={"craft": "craft-2"})).json()["points"] == []


async def test_the_bearing_file_has_the_columns_of_uavrt(client, flown):
    reply = await client.get(f"{flown}/export/csv")
    rows = list(csv.reader(io.StringIO(reply.text)))
    assert [(row[0], row[1]) for row in rows] == [("1", "s1"), ("1", "s3"), ("2", "s4")]
    for row, fact in zip(rows, [*COUNTED, OF_TAG], strict=True):
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
        "place": 4,
        "bearing": 4,
        "estimate": 2,
        "c95": 2,
    }
    assert [f["properties"]["excluded"] for f in found["bearing"]] == [False, True, False, False]
    assert [f["properties"]["emitter"] for f in found["estimate"]] == [e.label for e in SPEC.emitters]
    for feature, fact in zip(found["bearing"], [*BEARINGS, OF_TAG], strict=True):
        (lon0, lat0), (lon1, lat1) = feature["geometry"]["coordinates"]
        east, north = LocalFrame(Place(lat0, lon0)).to_enu(Place(lat1, lon1))
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
    mission_id = (await client.post("/api/missions", json=DRAFT)).json()["mission_id"]
    for name in ("geojson", "kml", "csv", "json"):
        assert (await client.get(f"/api/missions/{mission_id}/export/{name}")).status_code == 200
    assert (await client.get(f"/api/missions/{mission_id}/export/exe")).status_code == 422
