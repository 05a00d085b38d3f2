"""Two tags at one frequency, told apart by their rhythm, and two emitters that a narrow receiver hears one after
another: each mission flown to its end over real sockets."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from console import console

from backend.cli.demo import TAG_SENSOR
from backend.cli.running import RunningServer, running_server
from backend.settings import Settings
from backend.simulation.emitters import Signal
from backend.spec import EmitterSpec
from hardware.frame import LocalFrame
from hardware.readings import Place

pytestmark = [pytest.mark.system, pytest.mark.long, pytest.mark.timeout(420)]

PERIODS_S = (1.3, 1.05)
BAND_HZ = 25_000.0
TAGS = [
    EmitterSpec(emitter_id=f"tag-{k}", frequency_hz=150.1e6, kind="pulsed", label=f"tag {k}", pulse_period_s=period_s)
    for k, period_s in enumerate(PERIODS_S)
]
BEACONS = [EmitterSpec(emitter_id=f"beacon-{k}", frequency_hz=hz) for k, hz in enumerate((868.3e6, 121.5e6))]


@pytest.fixture
def band_hz() -> float | None:
    return None


@pytest.fixture
async def server(tmp_path: Path, band_hz: float | None) -> AsyncIterator[RunningServer]:
    settings = Settings(
        port=0,
        data_dir=tmp_path,
        simulated_flies_on=False,
        time_factor=5.0,
        seed=3,
        emitters=tuple(f"150.1/{period_s}" for period_s in PERIODS_S),
        simulated_band_hz=band_hz,
    )
    async with running_server(settings) as running:
        yield running


async def localized(server: RunningServer, emitters: list[EmitterSpec], sensor: dict) -> list[dict]:
    """The facts of a mission that found all of them, each near its truth."""
    async with console(server.url) as operator:
        spec = [emitter.model_dump(mode="json") for emitter in emitters]
        await operator.draft(planner={"seed": 3}, emitters=spec, sensor=sensor)
        await operator.ready()
        await operator.watch()
        await operator.start()
        ended = await operator.until_event("mission_ended", wall_s=360)
        assert ended["outcome"] == "localized", operator.story()
        mission = (await operator.client.get(f"/api/missions/{operator.mission_id}")).json()
        assert server.receiver is not None
        for emitter, found in zip(emitters, mission["found"], strict=True):
            period_s = emitter.pulse_period_s if emitter.kind == "pulsed" else None
            truth, estimate = server.receiver.truth[Signal(emitter.frequency_hz, period_s)], found["estimate"]
            off_m = math.hypot(*LocalFrame(truth).to_enu(Place(estimate["lat"], estimate["lon"])))
            assert off_m < 4 * estimate["expected_rmse_m"], found["emitter_id"]
        return [frame["event"] for kind in ("bearing_measured", "sweep_rejected") for frame in operator.of(kind)]


async def test_two_tags_at_one_frequency_are_both_found(server: RunningServer) -> None:
    facts = await localized(server, TAGS, TAG_SENSOR)
    assert {fact["emitter_id"] for fact in facts} == {"tag-0", "tag-1"}


@pytest.mark.parametrize("band_hz", [BAND_HZ])
async def test_a_narrow_receiver_hears_one_after_another_and_what_is_found_is_left_out(server: RunningServer) -> None:
    facts = await localized(server, BEACONS, {"receiver_band_hz": BAND_HZ})
    assert {fact["emitter_id"] for fact in facts} == {"beacon-0", "beacon-1"}
    times = [fact["measurement_time_s"] for fact in facts if fact["kind"] == "bearing_measured"]
    assert min(times[:2]) > 24.0, "two rounds of twelve seconds"
