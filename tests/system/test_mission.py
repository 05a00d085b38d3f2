"""A whole mission over real sockets, judged by what the websocket said."""

from __future__ import annotations

import math

import pytest
from console import Console, console

from backend.cli.running import RunningServer
from backend.simulation.emitters import Signal
from hardware.frame import LocalFrame
from hardware.readings import Place

pytestmark = pytest.mark.system


@pytest.mark.parametrize("flavour", ["px4", "ardupilot"])
async def test_a_mission_is_flown_to_a_localized_emitter(server: RunningServer, operator: Console) -> None:
    await operator.start()
    async with console(server.url) as second:
        second.mission_id = operator.mission_id
        await operator.until_event("flight_started")
        await second.watch()
        ended = await operator.until_event("mission_ended", wall_s=120)
        await second.until_event("mission_ended")
        await operator.until_phase("ground")
        await second.until_phase("ground")
        assert [e["seq"] for e in operator.events] == list(range(1, len(operator.events) + 1))
        assert second.events == operator.events

    assert ended["outcome"] == "localized", operator.story()
    assert operator.phases[:3] == ["taking_off", "planning", "flying"]
    assert operator.phases[-3:] == ["returning", "landing", "ground"]

    last = operator.of("belief_updated")[-1]["event"]
    assert server.receiver is not None
    truth = server.receiver.truth[Signal(868.3e6)]
    error = math.hypot(*LocalFrame(truth).to_enu(Place(last["estimate"]["lat"], last["estimate"]["lon"])))
    assert error < 4 * last["estimate"]["expected_rmse_m"]
    assert len({(b["event"]["place"]["lat"], b["event"]["place"]["lon"]) for b in operator.of("bearing_measured")}) >= 2

    assert operator.messages["hello"][0]["time_factor"] == 12.0
    assert any(t["in_air"] and t["who"] == "ours" for t in operator.messages["telemetry"])
    said = [(s["phase"], [craft["phase"] for craft in s["crafts"]]) for s in operator.messages["status"]]
    assert ("measuring", ["measuring"]) in said
    assert max(p["turned_deg"] for p in operator.messages["sweep_progress"]) > 180
    assert len(operator.frames) >= 2

    stored = (await operator.client.get(f"/api/missions/{operator.mission_id}/events")).json()["events"]
    assert stored == operator.events
    track = (await operator.client.get(f"/api/missions/{operator.mission_id}/track")).json()["points"]
    assert max(p["altitude_relative_m"] for p in track) == pytest.approx(40, abs=3)


async def test_hold_override_and_abort_are_obeyed_in_flight(operator: Console) -> None:
    await operator.start()
    await operator.until_event("flight_started")
    assert (await operator.order("hold"))["accepted"]
    await operator.until_phase("hold")
    chosen = operator.of("plan_chosen")[-1]["event"]
    place = chosen["candidates"][0]
    override = await operator.order("override", place={"lat": place["lat"], "lon": place["lon"]})
    assert override["accepted"], override["reason"]
    away = await operator.order("override", place={"lat": place["lat"] + 0.05, "lon": place["lon"]})
    assert not away["accepted"]
    assert away["reason"]["code"] in ("outside_fence", "too_far_from_home")
    assert (await operator.order("resume"))["accepted"]
    reached = await operator.until_event("place_reached")
    assert reached["distance_m"] < 3
    assert operator.of("plan_chosen")[-1]["event"]["source"] == "operator"
    assert (await operator.order("abort"))["accepted"]
    assert (await operator.until_event("mission_ended"))["outcome"] == "aborted"
    await operator.until(lambda: operator.messages["telemetry"][-1]["mode"] == "LAND")
    await operator.until(lambda: operator.messages["telemetry"][-1]["in_air"] is False, wall_s=60)


async def test_bad_input_is_answered_with_what_is_wrong(server: RunningServer, operator: Console) -> None:
    spec = (await operator.client.get("/api/defaults")).json()["spec"]
    corners = spec["area"]["coordinates"][0]
    crossed = [corners[0], corners[2], corners[1], corners[3], corners[0]]
    answer = await operator.client.post(
        "/api/missions", json=spec | {"area": spec["area"] | {"coordinates": [crossed]}}
    )
    assert answer.status_code == 422
    assert answer.json()["reason"] == {"what": "area", "fault": "crosses_itself", "code": "outline_unusable"}
    unknown = await operator.client.get("/api/missions/nobody")
    assert (unknown.status_code, unknown.json()["reason"]["code"]) == (404, "no_mission")
