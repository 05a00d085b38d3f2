"""One measurement on doubles: what is unknown about a sweep makes it a rejected one, never a made-up bearing."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator
from dataclasses import replace
from itertools import pairwise

import pytest
from equipment import SECOND_HZ, TWO_EMITTERS, spec
from refusals import refusing
from stage import Stage

from backend.craft.listening import Listening, channels_of
from backend.craft.measuring import Measured, measure
from backend.events import FIRST_CRAFT, BearingMeasured, CraftSource, SweepRejected
from backend.reasons.search import SweepIncomplete
from backend.spec import EmitterSpec, MissionSpec
from hardware.ports import ReceiverError, VehicleError
from hardware.readings import BearingReading, PowerSample
from hardware.reasons.receiver import NothingHeardInTurn
from hardware.reasons.sweep import NoPulseHeard, PulsesNotGiven
from hardware.reasons.vehicle import PositionLost
from hardware.reasons.vehicle_news import ClockRateOdd


async def measured(stage: Stage, mission: MissionSpec | None = None) -> tuple[Measured, ...]:
    mission = mission or spec()
    listening = Listening(stage.receiver, stage.clock, channels_of(mission), 5.0)
    listening.start()
    try:
        return await measure(stage.craft(), mission, "m", listening, 1, 1, [e.emitter_id for e in mission.emitters])
    finally:
        await listening.stop()


async def test_a_sweep_becomes_a_bearing_of_the_craft_that_took_it() -> None:
    (found,) = await measured(Stage())
    assert isinstance(found.fact, BearingMeasured)
    assert found.fact.source == CraftSource(craft_id=FIRST_CRAFT)
    assert found.fact.measurement_time_s is not None
    assert found.sweep is not None


async def test_a_clock_that_becomes_odd_during_the_turn_rejects_its_sweep() -> None:
    stage = Stage()
    turn = stage.vehicle.turn

    async def turning(rate_deg_s: float, by_deg: float = 360.0) -> None:
        await turn(rate_deg_s, by_deg)
        stage.vehicle.state = replace(stage.vehicle.state, odd_clock_rate=0.9)

    stage.vehicle.turn = turning  # type: ignore[method-assign]
    (found,) = await measured(stage)
    assert isinstance(found.fact, SweepRejected)
    assert found.fact.reason == ClockRateOdd(0.9)
    assert found.sweep is not None, "what was heard is kept"


async def test_one_turn_becomes_one_result_for_each_emitter() -> None:
    stage = Stage(target=(0.0, 60.0), others={SECOND_HZ: (60.0, 0.0)})
    found = await measured(stage, spec(TWO_EMITTERS))
    assert stage.vehicle.names == ["turn"]
    assert [m.fact.emitter_id for m in found] == [emitter.emitter_id for emitter in TWO_EMITTERS]
    assert len({m.sweep_id for m in found}) == 2
    bearings = [m.fact.bearing_deg for m in found if isinstance(m.fact, BearingMeasured)]
    assert bearings == pytest.approx([0.0, 90.0], abs=1e-6)
    assert {emitter_id for emitter_id, _ in stage.publisher.progress} <= {e.emitter_id for e in TWO_EMITTERS}


async def test_an_emitter_that_was_not_heard_rejects_its_own_sweep_only() -> None:
    stage = Stage()
    tag = EmitterSpec(emitter_id="tag", frequency_hz=150e6, kind="pulsed", pulse_width_s=0.02, pulse_period_s=0.5)

    async def carrier_only() -> AsyncIterator[PowerSample]:
        while True:
            await stage.clock.sleep(0.2)
            yield PowerSample(stage.clock.now(), EmitterSpec().frequency_hz, -60.0)
            yield PowerSample(stage.clock.now(), tag.frequency_hz, -90.0, detected=False)

    stage.receiver.samples = carrier_only  # type: ignore[method-assign]
    carrier, unheard = await measured(stage, spec((EmitterSpec(), tag)))
    assert isinstance(carrier.fact, BearingMeasured)
    assert isinstance(unheard.fact, SweepRejected)
    assert unheard.fact.reason == NoPulseHeard()
    assert unheard.fact.silence is not None
    assert sum(unheard.fact.silence.chances) > 0.0
    assert max(unheard.fact.silence.gain_db) == 0.0
    assert unheard.sweep is None


async def test_a_height_or_a_bearing_that_is_not_known_rejects_the_sweep_and_says_which() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, altitude_amsl_m=None)
    blind = stage.finder.estimate

    def without_sigma(sweep: object, pattern: object) -> BearingReading:
        return replace(blind(sweep, pattern), sigma_deg=math.nan)  # type: ignore[arg-type]

    stage.finder.estimate = without_sigma  # type: ignore[method-assign]
    (found,) = await measured(stage)
    assert isinstance(found.fact, SweepRejected)
    assert found.fact.reason == SweepIncomplete(("sigma", "altitude"))
    assert found.sweep is not None


async def test_a_receiver_that_delivers_nothing_is_an_error_and_no_rejected_sweep() -> None:
    stage = Stage()
    stage.receiver.mute = True
    with refusing(NothingHeardInTurn, ReceiverError):
        await measured(stage)
    assert stage.vehicle.names == ["turn"]


async def test_without_any_position_there_is_an_error_and_no_made_up_place() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, position=None)
    with refusing(PositionLost, VehicleError):
        await measured(stage)
    assert stage.vehicle.names == ["turn"]


async def test_a_narrow_receiver_goes_round_once_for_each_group_that_is_wanted() -> None:
    stage = Stage(target=(0.0, 60.0), others={SECOND_HZ: (60.0, 0.0)})
    mission = spec(TWO_EMITTERS)
    mission = mission.model_copy(update={"sensor": mission.sensor.model_copy(update={"receiver_band_hz": 25e3})})
    found = await measured(stage, mission)
    assert stage.vehicle.names == ["turn", "turn"]
    bearings = {m.fact.emitter_id: m.fact.bearing_deg for m in found if isinstance(m.fact, BearingMeasured)}
    assert list(bearings.values()) == pytest.approx([0.0, 90.0], abs=1e-6)
    assert stage.receiver.frequencies_hz == [max(emitter.frequency_hz for emitter in TWO_EMITTERS)]

    listening = Listening(stage.receiver, stage.clock, channels_of(mission), 5.0)
    listening.start()
    wanted = TWO_EMITTERS[0].emitter_id
    (only,) = await measure(stage.craft(), mission, "m", listening, 2, 1, [wanted])
    await listening.stop()
    assert only.fact.emitter_id == wanted
    assert stage.vehicle.names == ["turn"] * 3


async def test_tags_at_one_frequency_have_sweeps_of_their_own_pulses() -> None:
    stage = Stage()
    tags = [
        EmitterSpec(
            emitter_id=f"tag-{k}", frequency_hz=150e6, kind="pulsed", pulse_width_s=0.02, pulse_period_s=period_s
        )
        for k, period_s in enumerate((0.5, 0.4))
    ]

    async def both() -> AsyncIterator[PowerSample]:
        began_s = stage.clock.now()
        strangers = [began_s + 0.031 + 0.917 * k for k in range(1000)]
        due = sorted([began_s + 0.1 + 0.5 * k for k in range(2000)] + [began_s + 0.23 + 0.4 * k for k in range(2500)])
        due = sorted([*due, *strangers[::7]])
        for at_s in due:
            while stage.clock.now() < at_s:
                await stage.clock.sleep(0.1)
            yield PowerSample(at_s, 150e6, -60.0)

    stage.receiver.samples = both  # type: ignore[method-assign]
    mission = spec(tags)
    mission = mission.model_copy(update={"sensor": mission.sensor.model_copy(update={"pulses_per_heading": 1})})
    found = await measured(stage, mission)
    heard = {m.fact.emitter_id: m.sweep for m in found}
    for emitter_id, period_s in (("tag-0", 0.5), ("tag-1", 0.4)):
        sweep = heard[emitter_id]
        assert sweep is not None, [m.fact for m in found]
        gaps = [b - a for a, b in pairwise(sweep.at_s)]
        assert all(gap / period_s == pytest.approx(round(gap / period_s), abs=0.02) for gap in gaps)
    remarks = [remark for m in found if isinstance(m.fact, BearingMeasured) for remark in m.fact.remarks]
    assert any(isinstance(remark, PulsesNotGiven) for remark in remarks), "a stranger's are counted"
