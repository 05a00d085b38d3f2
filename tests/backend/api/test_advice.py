"""A search without a craft: bearings by hand, advice where to listen next, and its end when it is localized."""

from __future__ import annotations

import math

import httpx
import pytest

from backend.api.suggestion import suggested_mission
from backend.spec import EmitterSpec, Polygon
from hardware.frame import LocalFrame
from hardware.readings import Place

HOME = Place(50.6, 7.2)
FRAME = LocalFrame(HOME)


SQUARE = ((-100.0, 0.0), (100.0, 0.0), (100.0, 200.0), (-100.0, 200.0), (-100.0, 0.0))


def lon_lat(east: float, north: float) -> tuple[float, float]:
    found = FRAME.to_geo(east, north)
    return found.lon, found.lat


def place(east: float, north: float) -> dict:
    found = FRAME.to_geo(east, north)
    return {"lat": found.lat, "lon": found.lon}


async def drafted(client: httpx.AsyncClient, **changes: object) -> str:
    spec = suggested_mission(HOME).model_copy(update=changes)
    return (await client.post("/api/missions", json=spec.model_dump(mode="json"))).json()["mission_id"]


async def hear(client: httpx.AsyncClient, mission: str, number: int, at: tuple[float, float]) -> None:
    bearing = math.degrees(math.atan2(40.0 - at[0], 120.0 - at[1])) % 360.0
    said = {"bearing_id": f"phone-{number:04d}", "by": "Ada", "bearing_deg": bearing, "sigma_deg": 5.0}
    answer = await client.post(f"/api/missions/{mission}/bearings", json=said | {"place": place(*at)})
    assert answer.status_code == 201, answer.text


async def stated_m(client: httpx.AsyncClient, mission: str) -> float:
    """As the page shows it: what the last belief's fact says."""
    asked = await client.get(f"/api/missions/{mission}/events", params={"limit": 5000})
    said = [one["event"] for one in asked.json()["events"] if one["event"]["kind"] == "belief_updated"]
    return said[-1]["estimate"]["expected_rmse_m"]


async def test_following_the_advice_localizes_without_any_craft(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    here = (-150.0, -20.0)
    errors = []
    for number in range(12):
        asked = await client.post(f"/api/missions/{mission}/advice", json={"place": place(*here)})
        assert asked.status_code == 200, asked.text
        told = asked.json()
        if told["localized"]:
            break
        assert told["bearings"] == number
        assert told["error_then_m"] < told["error_now_m"]
        if number:
            assert told["error_now_m"] == pytest.approx(await stated_m(client, mission)), "the page states another"
        errors.append(told["error_now_m"])
        to = FRAME.to_enu(Place(told["place"]["lat"], told["place"]["lon"]))
        assert told["away_m"] == pytest.approx(math.dist(here, to), abs=1.0)
        assert told["move_s"] == pytest.approx(told["away_m"] / 1.3, rel=0.01)
        here = to
        await hear(client, mission, number, here)
    else:
        pytest.fail(f"not localized after 12 bearings: {errors}")
    assert told["place"] is None
    assert errors[-1] < errors[0]


async def test_a_car_is_sent_further_than_a_walker_thinks_worth_it(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    await hear(client, mission, 1, (-100.0, -30.0))
    on_foot, by_car = [
        (await client.post(f"/api/missions/{mission}/advice", json={"place": place(-100, -30), "speed_m_s": v})).json()
        for v in (1.3, 9.0)
    ]
    assert by_car["expected_time_s"] < on_foot["expected_time_s"]
    assert by_car["away_m"] >= 0.8 * on_foot["away_m"]


async def test_who_hops_is_sent_inside_the_fence_and_told_up_turn_and_down(client: httpx.AsyncClient) -> None:
    """By car from 180 m outside; a place where the craft may not leave the ground is no place, though it would bring
    as much, and a craft's climbs make each bearing dearer than a hand's."""
    ring = [lon_lat(e, n) for e, n in ((-110, -10), (110, -10), (110, 210), (-110, 210), (-110, -10))]
    suggested = suggested_mission(HOME)
    area = Polygon(coordinates=[[lon_lat(e, n) for e, n in SQUARE]])
    flight = suggested.flight.model_copy(update={"fence": Polygon(coordinates=[ring]), "altitude_relative_m": 60.0})
    mission = await drafted(client, area=area, flight=flight)
    here, asked = (-290.0, 100.0), {"speed_m_s": 9.0, "hops": True}
    for number in range(3):
        reply = await client.post(f"/api/missions/{mission}/advice", json={"place": place(*here), **asked})
        assert reply.status_code == 200, reply.text
        told = reply.json()
        east, north = FRAME.to_enu(Place(told["place"]["lat"], told["place"]["lon"]))
        assert (abs(east) <= 110.0, -10.0 <= north <= 210.0) == (True, True), (east, north)
        assert told["hop"] == {"altitude_m": 60.0, "up_s": 24.0, "turn_s": 16.0, "down_s": 40.0}
        here = (east, north)
        await hear(client, mission, number, here)
    by_hand = await client.post(f"/api/missions/{mission}/advice", json={"place": place(*here)})
    assert by_hand.json()["hop"] is None


async def test_what_cannot_be_advised_is_refused(client: httpx.AsyncClient) -> None:
    mission = await drafted(client, emitters=[EmitterSpec()])
    far = await client.post(f"/api/missions/{mission}/advice", json={"place": {"lat": 10, "lon": 7}})
    assert (far.status_code, far.json()["errors"][0]["reason"]["code"]) == (422, "asked_from_too_far")
    nobody = await client.post(f"/api/missions/{mission}/advice", json={"place": place(0, 0), "emitter_id": "other"})
    assert nobody.status_code == 422
    assert (await client.post("/api/missions/none/advice", json={"place": place(0, 0)})).status_code == 404
    slow = await client.post(f"/api/missions/{mission}/advice", json={"place": place(0, 0), "speed_m_s": 0})
    assert slow.status_code == 422


async def test_a_kraken_joins_by_post_and_only_at_the_frequency_looked_for(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    at = FRAME.to_geo(-100.0, 50.0)
    line = "1700000000000,63,80,-31,{hz},UCA,412,roof,{lat},{lon},0,0,GPS"
    address = f"/api/missions/{mission}/bearings/kraken"

    def said(hz: int) -> str:
        return line.format(hz=hz, lat=at.lat, lon=at.lon)

    answer = await client.post(address, content=said(868_300_000))
    assert answer.status_code == 201, answer.text
    assert answer.json()["by"] == "roof"
    assert (await client.post(address, content=said(868_300_000))).status_code == 200
    elsewhere = await client.post(address, content=said(433_900_000))
    assert elsewhere.json()["errors"][0]["reason"]["code"] == "heard_elsewhere"
    assert (await client.post(address, content="hello")).json()["errors"][0]["reason"]["code"] == "kraken_unreadable"
