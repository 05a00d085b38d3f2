"""Two emitters at two frequencies, found by one craft in one flight: each sweep listens to both."""

from __future__ import annotations

import math

import pytest
from console import console
from shapely import Point
from shapely.geometry import shape

from backend.cli.running import RunningServer
from backend.simulation.emitters import EMITTERS, Signal
from backend.spec import EmitterSpec
from hardware.frame import LocalFrame
from hardware.readings import Place

pytestmark = pytest.mark.system

BEACON, OTHER = EMITTERS[0], EMITTERS[2]
LOOKED_FOR = [
    EmitterSpec(emitter_id="beacon", frequency_hz=BEACON.frequency_hz, label="beacon"),
    EmitterSpec(emitter_id="rescue", frequency_hz=OTHER.frequency_hz, label="rescue beacon"),
]
CLOSE_M = 10.0
"""A truth this far outside its C95 is still close: one region in twenty misses it."""


def distance_to_c95_m(estimate: dict, truth: Place) -> float:
    """0 inside."""
    frame = LocalFrame(truth)
    ring = [frame.to_enu(Place(lat, lon)) for lon, lat in estimate["c95"]["coordinates"][0]]
    region = shape({"type": "Polygon", "coordinates": [ring]})
    return region.distance(Point(0.0, 0.0))


@pytest.mark.timeout(300)
async def test_one_craft_localizes_two_emitters(server: RunningServer) -> None:
    async with console(server.url) as operator:
        emitters = [emitter.model_dump(mode="json") for emitter in LOOKED_FOR]
        await operator.draft(planner={"seed": 3}, emitters=emitters)
        await operator.ready()
        await operator.watch()
        await operator.start()
        ended = await operator.until_event("mission_ended", wall_s=240)
        assert ended["outcome"] == "localized", operator.story()
        mission = (await operator.client.get(f"/api/missions/{operator.mission_id}")).json()
        assert mission["localized"]
        assert server.receiver is not None
        truths = {e.emitter_id: server.receiver.truth[Signal(e.frequency_hz)] for e in LOOKED_FOR}
        assert [found["emitter_id"] for found in mission["found"]] == list(truths)
        for found in mission["found"]:
            estimate, truth = found["estimate"], truths[found["emitter_id"]]
            assert found["localized"]
            off_m = math.hypot(*LocalFrame(truth).to_enu(Place(estimate["lat"], estimate["lon"])))
            assert off_m < 4 * estimate["expected_rmse_m"], found["emitter_id"]
            assert distance_to_c95_m(estimate, truth) < CLOSE_M, found["emitter_id"]

        bearings = [e["event"] for e in operator.of("bearing_measured")]
        assert {b["emitter_id"] for b in bearings} == set(truths)
        assert {b["source"]["craft_id"] for b in bearings} == {"craft-1"}
        places = {name: {b["place_number"] for b in bearings if b["emitter_id"] == name} for name in truths}
        assert places["beacon"] & places["rescue"], "one turn is heard for both"
        plans = [e["event"] for e in operator.of("plan_chosen")]
        assert plans[0]["emitter_id"] is None, "the first place is chosen for both"
        assert {plan["emitter_id"] for plan in plans} <= {None, *truths}
        frames = [frame for frame in operator.frames if b'"emitter_id":"rescue"' in frame]
        assert frames, "each emitter's belief is shown"

        lines = (await operator.client.get(f"/api/missions/{operator.mission_id}/export/csv")).text.splitlines()
        assert {line.split(",")[0] for line in lines} == {"1", "2"}
