"""Ways and barriers over HTTP, and the advice that keeps to them."""

from __future__ import annotations

import json
import math
from datetime import UTC, datetime, timedelta

import httpx
import pytest
from shapely import LineString, Point, box

from backend.api.suggestion import suggested_mission
from backend.spec import Polygon
from backend.store.engine import engine_for_once
from backend.store.retention import bury, forget_gone
from backend.store.ways_files import WaysFiles
from hardware.frame import LocalFrame
from hardware.readings import Place

HOME = Place(50.6, 7.2)
FRAME = LocalFrame(HOME)
SQUARE = ((-100.0, 0.0), (100.0, 0.0), (100.0, 200.0), (-100.0, 200.0), (-100.0, 0.0))
RIVER = ((-9000.0, -60.0), (9000.0, -60.0), (9000.0, -50.0), (-9000.0, -50.0), (-9000.0, -60.0))
BRIDGE = ((150.0, -80.0), (150.0, -30.0))
ROAD = ((-180.0, -100.0), (150.0, -100.0), (150.0, 230.0))
HERE = (-80.0, -95.0)


def lon_lat(*points: tuple[float, float]) -> list[tuple[float, float]]:
    return [(one.lon, one.lat) for one in (FRAME.to_geo(east, north) for east, north in points)]


def feature(kind: str, of: str, *points: tuple[float, float]) -> dict[str, object]:
    found = lon_lat(*points)
    geometry = {"type": of, "coordinates": [found] if of == "Polygon" else found}
    return {"type": "Feature", "properties": {"kind": kind}, "geometry": geometry}


def file_of(*features: dict[str, object]) -> bytes:
    return json.dumps({"type": "FeatureCollection", "features": features}).encode()


@pytest.fixture
async def mission(client: httpx.AsyncClient) -> str:
    spec = suggested_mission(HOME).model_copy(update={"area": Polygon(coordinates=[lon_lat(*SQUARE)])})
    return (await client.post("/api/missions", json=spec.model_dump(mode="json"))).json()["mission_id"]


async def uploaded(client: httpx.AsyncClient, mission: str, *features: dict[str, object]) -> httpx.Response:
    return await client.post(
        f"/api/missions/{mission}/ways", params={"filename": "w.geojson"}, content=file_of(*features)
    )


async def asked(client: httpx.AsyncClient, mission: str, **more: object) -> httpx.Response:
    at = FRAME.to_geo(*HERE)
    body = {"place": {"lat": at.lat, "lon": at.lon}} | more
    return await client.post(f"/api/missions/{mission}/advice", json=body, timeout=60)


def way_of(told: dict) -> LineString:
    return LineString([FRAME.to_enu(Place(lat, lon)) for lon, lat in told["way"]])


async def test_uploaded_shown_replaced_and_forgotten(client: httpx.AsyncClient, mission: str) -> None:
    address = f"/api/missions/{mission}/ways"
    assert (await client.get(address)).json()["features"] == []
    answer = await uploaded(client, mission, feature("road", "LineString", *ROAD))
    assert answer.status_code == 201, answer.text
    told = answer.json()
    assert (told["name"], told["barriers"], told["features"]) == ("w", 0, [])
    assert told["roads_m"] == pytest.approx(660.0, rel=0.01)
    await uploaded(client, mission, feature("barrier", "Polygon", *RIVER))
    (water,) = (await client.get(address)).json()["features"]
    assert water["properties"] == {"kind": "barrier"}
    assert (await client.delete(address)).status_code == 204
    assert (await client.get(address)).json()["features"] == []


async def test_on_foot_over_the_bridge_and_without_it_no_way_leads_there(
    client: httpx.AsyncClient, mission: str
) -> None:
    straight = (await asked(client, mission)).json()
    assert (straight["along"], straight["unreached"], len(straight["way"])) == ("straight", 0, 2)
    river = feature("barrier", "Polygon", *RIVER)
    await uploaded(client, mission, river, feature("path", "LineString", *BRIDGE))
    told = (await asked(client, mission)).json()
    assert told["along"] == "around"
    assert told["unreached"] == 0
    way = way_of(told)
    assert told["way_m"] == pytest.approx(way.length, rel=0.01)
    assert told["move_s"] == pytest.approx(told["way_m"] / 1.3, rel=0.01)
    crossed = way.intersection(box(-9000, -60, 9000, -50))
    assert crossed.is_empty or crossed.bounds[0] == pytest.approx(150.0, abs=2.0)

    await uploaded(client, mission, river)
    told = (await asked(client, mission)).json()
    assert told["unreached"] > told["places"] / 2
    assert FRAME.to_enu(Place(**told["place"]))[1] < -50.0
    pen = [(HERE[0] + 20 * math.cos(a), HERE[1] + 20 * math.sin(a)) for a in (0.1, 1.5, 3, 4.5, 0.1)]
    await uploaded(client, mission, feature("barrier", "Polygon", *pen))
    refused = await asked(client, mission)
    assert refused.status_code == 422
    assert refused.json()["errors"][0]["reason"]["code"] == "no_way_leads_there"


async def test_a_car_listens_beside_the_road_and_takes_as_long_as_the_road_is(
    client: httpx.AsyncClient, mission: str
) -> None:
    await uploaded(client, mission, feature("road", "LineString", *ROAD), feature("barrier", "Polygon", *RIVER))
    told = (await asked(client, mission, speed_m_s=9, on_roads=True)).json()
    assert told["along"] == "roads"
    at = Point(FRAME.to_enu(Place(**told["place"])))
    assert LineString(ROAD).distance(at) < 1.0
    assert told["way_m"] >= LineString(ROAD).project(at) - LineString(ROAD).project(Point(HERE)) - 30.0
    elsewhere = FRAME.to_geo(-80.0, 190.0)
    refused = await client.post(
        f"/api/missions/{mission}/advice",
        json={"place": {"lat": elsewhere.lat, "lon": elsewhere.lon}, "speed_m_s": 9, "on_roads": True},
    )
    assert refused.json()["errors"][0]["reason"]["code"] == "no_road_near"
    on_foot = (await asked(client, mission)).json()
    assert on_foot["along"] == "around"


async def test_who_hops_drives_to_where_the_craft_may_leave_the_ground(client: httpx.AsyncClient, mission: str) -> None:
    road = feature("road", "LineString", (-180.0, -95.0), (0.0, -95.0), (0.0, 150.0))
    await uploaded(client, mission, road)
    told = (await asked(client, mission, speed_m_s=9, on_roads=True, hops=True)).json()
    assert told["along"] == "roads"
    assert told["hop"] is not None
    east, north = FRAME.to_enu(Place(**told["place"]))
    assert east == pytest.approx(0.0, abs=1.0)
    assert -60.0 <= north <= 150.0


async def test_hostile_files_are_refused_and_what_was_there_stays(client: httpx.AsyncClient, mission: str) -> None:
    address = f"/api/missions/{mission}/ways"
    await uploaded(client, mission, feature("road", "LineString", *ROAD))
    empty = await client.post(address, content=b"")
    assert (empty.status_code, empty.json()["reason"]["code"]) == (422, "not_readable_as")
    huge = await client.post(address, content=b"{" * 50_000_000)
    assert (huge.status_code, huge.json()["reason"]["code"]) == (413, "body_too_large")
    far = b'{"type": "LineString", "coordinates": [[100, 0], [101, 0]]}'
    other = b'{"type": "Feature", "properties": {"kind": "road"}, "geometry": %s}' % far
    found = await client.post(address, content=other)
    assert (found.status_code, found.json()["reason"]["code"]) == (422, "ways_too_far")
    unmarked = await client.post(address, content=far)
    assert (unmarked.status_code, unmarked.json()["reason"]["code"]) == (422, "no_ways_in_file")
    assert (await client.get(address)).json()["roads_m"] > 0
    nowhere = await client.post("/api/missions/none/ways", content=file_of(feature("road", "LineString", *ROAD)))
    assert nowhere.status_code == 404


async def test_ways_stay_with_a_deleted_mission_and_go_when_it_is_buried(client, mission, settings) -> None:
    assert (await uploaded(client, mission, feature("path", "LineString", *ROAD))).status_code == 201
    ways = WaysFiles.of_settings(settings)
    (ways.directory / "stranger.json").write_bytes(ways.path(mission).read_bytes())
    engine = engine_for_once(settings.async_database_url, 60.0)
    late = datetime.now(UTC) + timedelta(days=400)
    try:
        assert await forget_gone(engine, ways) == ["stranger"]
        assert (await client.delete(f"/api/missions/{mission}")).status_code == 204
        assert await forget_gone(engine, ways) == [], "it can be restored, with its ways"
        assert await bury(engine, 30.0, late) == 1
        assert await forget_gone(engine, ways) == [mission]
    finally:
        await engine.dispose()
    assert list(ways.directory.iterdir()) == []


async def test_where_the_search_has_moved_far_away_nothing_is_known_of_the_ground(client, mission) -> None:
    await uploaded(client, mission, feature("barrier", "Polygon", *RIVER))
    assert (await asked(client, mission)).json()["along"] == "around"
    spec = (await client.get(f"/api/missions/{mission}")).json()["spec"]
    spec["area"]["coordinates"] = [[[lon + 1.0, lat] for lon, lat in lon_lat(*SQUARE)]]
    assert (await client.put(f"/api/missions/{mission}/spec", json=spec)).status_code == 200
    at = FRAME.to_geo(*HERE)
    body = {"place": {"lat": at.lat, "lon": at.lon + 1.0}}
    told = (await client.post(f"/api/missions/{mission}/advice", json=body, timeout=60)).json()
    assert told["along"] == "straight"
