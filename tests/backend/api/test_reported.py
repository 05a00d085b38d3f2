"""Bearings from anyone by POST: counted once, in the belief, taken back; each refusal says what is wrong."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import httpx
import pytest
from fastapi import FastAPI

from backend.api.suggestion import suggested_mission
from backend.commands import ExcludeBearing
from backend.mission.reports import Reports
from backend.search.inputs import SearchOrdered
from backend.spec import EmitterSpec
from hardware.frame import LocalFrame
from hardware.readings import Place

HOME = Place(50.6, 7.2)
NOW = datetime.fromtimestamp(1_700_000_000.0, UTC)
FRAME = LocalFrame(HOME)


def report(number: int, east: float, north: float, bearing_deg: float, **more: object) -> dict:
    place = FRAME.to_geo(east, north)
    told = {"bearing_id": f"phone-{number:04d}", "by": "Ada", "bearing_deg": bearing_deg}
    return {**told, "place": {"lat": place.lat, "lon": place.lon}, **more}


async def drafted(client: httpx.AsyncClient, **changes: object) -> str:
    spec = suggested_mission(HOME).model_copy(update=changes)
    return (await client.post("/api/missions", json=spec.model_dump(mode="json"))).json()["mission_id"]


async def events(client: httpx.AsyncClient, mission: str, kind: str) -> list[dict]:
    told = (await client.get(f"/api/missions/{mission}/events")).json()["events"]
    return [recorded["event"] for recorded in told if recorded["event"]["kind"] == kind]


async def test_two_people_localize_without_a_craft_and_one_takes_a_bearing_back(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    address = f"/api/missions/{mission}/bearings"
    first = await client.post(address, json=report(1, -100.0, 50.0, 63.4, sigma_deg=4.0, snr_db=12.0))
    assert first.status_code == 201, first.text
    assert first.json() | {"seq": 0} == {
        "bearing_id": "phone-0001", "emitter_id": "emitter-1", "by": "Ada", "already": False, "seq": 0,
    }  # fmt: skip
    await client.post(address, json=report(2, 100.0, 50.0, 296.6, by="Ben", sigma_deg=4.0))
    measured = await events(client, mission, "bearing_measured")
    assert [one["source"]["name"] for one in measured] == ["Ada", "Ben"]
    assert measured[0]["snr_db"] == 12.0
    beliefs = await events(client, mission, "belief_updated")
    assert [one["bearings"] for one in beliefs] == [1, 2]
    estimate = beliefs[-1]["estimate"]
    east, north = FRAME.to_enu(Place(estimate["lat"], estimate["lon"]))
    assert (east, north) == pytest.approx((0.0, 100.0), abs=15.0)

    assert (await client.delete(f"{address}/phone-0002")).status_code == 204
    assert (await client.delete(f"{address}/phone-0002")).status_code == 204
    assert len(await events(client, mission, "bearing_excluded")) == 1
    assert (await events(client, mission, "belief_updated"))[-1]["bearings"] == 1


async def test_what_was_taken_back_counts_again_and_the_belief_is_the_one_of_before(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    address = f"/api/missions/{mission}/bearings"
    for number, (east, bearing) in enumerate([(-100.0, 63.4), (100.0, 296.6)]):
        await client.post(address, json=report(number, east, 50.0, bearing))
    before = (await events(client, mission, "belief_updated"))[-1]
    await client.delete(f"{address}/phone-0000")
    for _ in range(2):
        assert (await client.post(f"{address}/phone-0000/restore")).status_code == 204
    assert len(await events(client, mission, "bearing_included")) == 1
    assert (await events(client, mission, "belief_updated"))[-1] == before
    assert (await client.post(f"{address}/phone-0009/restore")).status_code == 422


async def test_a_reporter_mutes_themselves_and_nobody_else_and_the_console_has_the_last_word(
    client: httpx.AsyncClient,
) -> None:
    mission = await drafted(client)
    address = f"/api/missions/{mission}"
    for name in ("Ada", "Ben"):
        await client.post(f"{address}/bearings", json=report(ord(name[0]), -100.0, 50.0, 63.4, by=name))
    for muted in (True, True, False):
        reply = await client.put(f"{address}/reporter", json={"by": "Ada", "muted": muted})
        assert reply.status_code == 204, reply.text
    counts = [one["bearings"] for one in await events(client, mission, "belief_updated")]
    assert counts == [1, 2, 1, 2]
    order = {"kind": "mute_source", "of": "person", "name": "Ben", "muted": True}
    request = {"command_id": "0f3c1a52-8ba1-4f0e-9d2c-5b7c0e1d2a11", "command": order}
    assert (await client.post(f"{address}/commands", json=request)).json()["accepted"]
    assert (await events(client, mission, "belief_updated"))[-1]["bearings"] == 1
    refused = await client.put(f"{address}/reporter", json={"by": "Ben", "muted": False})
    assert (refused.status_code, "left_out_by_another" in refused.text) == (422, True)
    unheard = await client.put(f"{address}/reporter", json={"by": "Eve", "muted": True})
    assert "no_such_source" in unheard.text


async def test_what_somebody_else_left_out_is_not_restored_by_its_reporter(
    app: FastAPI, client: httpx.AsyncClient
) -> None:
    mission = await drafted(client)
    await client.post(f"/api/missions/{mission}/bearings", json=report(1, -100.0, 50.0, 63.4))
    reports: Reports = app.state.services.missions.reports
    await reports.flights.give(mission, SearchOrdered("Anna", ExcludeBearing(bearing_id="phone-0001")))
    refused = await client.post(f"/api/missions/{mission}/bearings/phone-0001/restore")
    assert (refused.status_code, "left_out_by_another" in refused.text) == (422, True)
    assert await events(client, mission, "bearing_included") == []


async def test_the_same_bearing_sent_again_counts_once(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    address = f"/api/missions/{mission}/bearings"
    first, again = [await client.post(address, json=report(1, 0.0, -20.0, 10.0)) for _ in range(2)]
    assert (first.status_code, again.status_code) == (201, 200)
    assert again.json() == first.json() | {"already": True}
    assert len(await events(client, mission, "bearing_measured")) == 1


async def test_one_kept_while_offline_comes_late_and_says_so(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    taken = (NOW - timedelta(minutes=20)).isoformat()
    await client.post(f"/api/missions/{mission}/bearings", json=report(1, 0.0, -20.0, 10.0, taken_at_utc=taken))
    (measured,) = await events(client, mission, "bearing_measured")
    assert [remark["code"] for remark in measured["remarks"]] == ["taken_earlier"]


@pytest.mark.parametrize("ahead_s", [-7200.0, 7200.0])
async def test_a_machine_whose_clock_was_set_meanwhile_takes_what_phones_report(
    app: FastAPI, client: httpx.AsyncClient, ahead_s: float
) -> None:
    """The mission's clock stays where it was; when a bearing was taken is counted from now."""
    mission = await drafted(client)
    wall = NOW + timedelta(seconds=ahead_s)
    app.state.services = replace(app.state.services, wall=wall.timestamp)
    address, taken = f"/api/missions/{mission}/bearings", (wall - timedelta(minutes=20)).isoformat()
    late = await client.post(address, json=report(1, 0.0, -20.0, 10.0, taken_at_utc=taken))
    now = await client.post(address, json=report(2, 0.0, -20.0, 10.0, taken_at_utc=wall.isoformat()))
    assert (late.status_code, now.status_code) == (201, 201), late.text + now.text
    measured = await events(client, mission, "bearing_measured")
    assert [one["taken_at_s"] for one in measured] == pytest.approx([NOW.timestamp() - 1200.0, NOW.timestamp()])
    assert [[remark["code"] for remark in one["remarks"]] for one in measured] == [["taken_earlier"], []]


@pytest.mark.parametrize(
    ("changes", "status", "field"),
    [
        ({"bearing_deg": 361.0}, 422, "bearing_deg"),
        ({"bearing_deg": None}, 422, "bearing_deg"),
        ({"sigma_deg": 0.0}, 422, "sigma_deg"),
        ({"bearing_id": "x"}, 422, "bearing_id"),
        ({"bearing_id": "../../etc/passwd"}, 422, "bearing_id"),
        ({"place": {"lat": 91.0, "lon": 0.0}}, 422, "place.lat"),
        ({"place": {"lat": 40.0, "lon": 0.0}}, 422, "place"),
        ({"emitter_id": "another"}, 422, "emitter_id"),
        ({"taken_at_utc": "2001-01-01T00:00:00Z"}, 422, "taken_at_utc"),
        ({"by": "x\n200 OK"}, 422, "by"),
        ({"by": "Ada\u202expj"}, 422, "by"),
    ],
)
async def test_what_is_wrong_is_refused_by_its_field(
    client: httpx.AsyncClient, changes: dict, status: int, field: str
) -> None:
    mission = await drafted(client)
    answer = await client.post(f"/api/missions/{mission}/bearings", json=report(1, 0.0, -20.0, 10.0) | changes)
    assert answer.status_code == status, answer.text
    assert any(error["field"].endswith(field) for error in answer.json()["errors"]), answer.text
    assert await events(client, mission, "bearing_measured") == []


async def test_of_several_emitters_it_says_which(client: httpx.AsyncClient) -> None:
    emitters = [EmitterSpec(emitter_id=name, frequency_hz=150e6 + k * 1e5) for k, name in enumerate(("a", "b"))]
    mission = await drafted(client, emitters=emitters)
    address = f"/api/missions/{mission}/bearings"
    assert (await client.post(address, json=report(1, 0.0, -20.0, 10.0))).json()["errors"][0]["field"] == "emitter_id"
    assert (await client.post(address, json=report(1, 0.0, -20.0, 10.0, emitter_id="b"))).json()["emitter_id"] == "b"


async def test_no_mission_and_no_such_bearing(client: httpx.AsyncClient) -> None:
    mission = await drafted(client)
    assert (await client.post("/api/missions/nowhere/bearings", json=report(1, 0.0, 0.0, 1.0))).status_code == 404
    answer = await client.delete(f"/api/missions/{mission}/bearings/phone-0009")
    assert (answer.status_code, answer.json()["errors"][0]["reason"]["code"]) == (422, "no_such_bearing")
