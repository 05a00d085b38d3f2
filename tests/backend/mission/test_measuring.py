"""One measurement on doubles: what cannot be told of a sweep makes it a rejected one, never a made-up bearing."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from doubles import PATTERN, Stage, spec

from backend.events import BearingMeasured, SweepRejected
from backend.mission.equipment import Equipment
from backend.mission.listening import Listening
from backend.mission.measuring import Measured, measure
from hardware.ports import VehicleError
from hardware.readings import BearingReading


async def measured(stage: Stage) -> Measured:
    equipment = Equipment(
        vehicle=stage.vehicle,
        receiver=stage.receiver,
        finder=stage.finder,
        pattern=PATTERN,
        journal=stage.journal,
        publisher=stage.publisher,
        clock=stage.clock,
        software="test",
    )
    listening = Listening(stage.receiver, stage.clock, 868.3e6, 5.0)
    listening.start()
    try:
        return await measure(equipment, spec(), "m", listening, 1, 1)
    finally:
        await listening.stop()


async def test_a_sweep_becomes_a_bearing() -> None:
    found = await measured(Stage())
    assert isinstance(found.fact, BearingMeasured)
    assert found.sweep is not None


async def test_a_height_or_a_bearing_that_is_not_known_rejects_the_sweep_and_says_which() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, altitude_amsl_m=None)
    blind = stage.finder.estimate

    def without_sigma(sweep: object, pattern: object) -> BearingReading:
        return replace(blind(sweep, pattern), sigma_deg=math.nan)  # type: ignore[arg-type]

    stage.finder.estimate = without_sigma  # type: ignore[method-assign]
    found = await measured(stage)
    assert isinstance(found.fact, SweepRejected)
    assert found.fact.reason == "the sigma and the altitude of this sweep cannot be told"
    assert found.sweep is not None


async def test_without_any_position_there_is_an_error_and_no_made_up_place() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, position=None)
    with pytest.raises(VehicleError, match="lost its position"):
        await measured(stage)
