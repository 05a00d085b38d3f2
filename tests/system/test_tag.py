"""A pulsed tag, flown over real sockets: slow sweeps of single pulses find it, at its own frequency and place."""

from __future__ import annotations

import math

import httpx
import pytest
from console import console

from backend.cli.demo import TAG, TAG_SENSOR
from backend.cli.running import RunningServer
from backend.simulation.emitters import EMITTERS, Signal, emitter_places
from hardware.frame import LocalFrame
from hardware.readings import Place

pytestmark = pytest.mark.system


async def test_a_wildlife_tag_is_found_by_its_pulses(server: RunningServer) -> None:
    async with console(server.url) as operator:
        await operator.draft(planner={"seed": 3}, emitters=[TAG.model_dump(mode="json")], sensor=TAG_SENSOR)
        await operator.ready()
        await operator.watch()
        await operator.start()
        await operator.until_event("mission_ended", wall_s=180)
        mission = (await operator.client.get(f"/api/missions/{operator.mission_id}")).json()
        assert mission["outcome"] == "localized"
        assert server.receiver is not None
        home = Place(mission["home"]["lat"], mission["home"]["lon"])
        truth = server.receiver.truth[Signal(150e6, 1.3)]
        (found,) = [emitter["estimate"] for emitter in mission["found"]]
        estimate = Place(found["lat"], found["lon"])
        assert math.hypot(*LocalFrame(truth).to_enu(estimate)) < 4 * found["expected_rmse_m"]
        assert math.hypot(*LocalFrame(truth).to_enu(emitter_places(3, home, EMITTERS)[Signal(150e6, 1.3)])) < 1.0
        bearing = operator.of("bearing_measured")[0]["event"]
        sweep = await _sweep(operator.client, operator.mission_id, bearing["sweep_id"])
        seconds = sweep["at_s"][-1]
        assert seconds >= 16 * 2 * 1.3 * 0.9
        assert len(sweep["power_db"]) == pytest.approx(seconds / 1.3, abs=6)


async def _sweep(client: httpx.AsyncClient, mission_id: str, sweep_id: str) -> dict:
    return (await client.get(f"/api/missions/{mission_id}/sweeps/{sweep_id}")).json()
