"""A craft that turns as far as it needs, on doubles: what the vehicle is asked for, and what is recorded of it."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest
from equipment import spec
from stage import Stage

from backend.craft.listening import Listening, channels_of
from backend.craft.measuring import Measured, measure
from backend.events import BearingMeasured, SweepRejected
from backend.reasons.turning import (
    MaximumAtEdge,
    MaximumSeen,
    NothingFoundYet,
    SectorExpected,
    WholeCircleSeen,
    WholeTurn,
)
from backend.search.sector import TurnPlan, planned_turn, whole_turn
from backend.spec import MissionSpec, SensorSpec
from hardware.ports import VehicleError


def expected(middle_deg: float, sd_deg: float = 5.0) -> np.ndarray:
    off = (np.arange(360) - middle_deg + 180.0) % 360.0 - 180.0
    mass = np.exp(-0.5 * (off / sd_deg) ** 2)
    return mass / mass.sum()


def flown() -> MissionSpec:
    return spec().model_copy(update={"sensor": SensorSpec(sector_turns=True)})


async def measured(stage: Stage, plan: TurnPlan | None, attempt: int = 1) -> Measured:
    listening = Listening(stage.receiver, stage.clock, channels_of(flown()), 5.0)
    listening.start()
    try:
        (found,) = await measure(stage.craft(), flown(), "m", listening, 1, attempt, ["emitter-1"], plan)
        return found
    finally:
        await listening.stop()


async def test_it_swings_the_short_way_to_the_beginning_and_turns_through_the_sector_only() -> None:
    stage = Stage(target=(0.0, 60.0))
    plan = planned_turn(expected(0.0))
    found = await measured(stage, plan)
    assert stage.vehicle.turned_by == pytest.approx([-100.0, 200.0], abs=2.0)
    assert isinstance(found.fact, BearingMeasured)
    assert found.sweep is not None
    assert found.sweep.partial
    turn = found.fact.turn
    assert turn is not None
    assert (turn.planned_deg, turn.turned_deg) == pytest.approx((200.0, 200.0), abs=1.0)
    assert turn.begin_deg == pytest.approx(260.0, abs=2.0)
    assert isinstance(turn.planned_because, SectorExpected)
    assert turn.went_on_because == []
    assert isinstance(turn.stopped_because, MaximumSeen)
    assert any(sector is not None and sector.goal_deg == 200.0 for sector in stage.publisher.sectors)


async def test_a_nose_that_points_there_already_does_not_swing() -> None:
    stage = Stage(target=(0.0, 60.0))
    await measured(stage, planned_turn(expected(100.0)))
    assert stage.vehicle.turned_by[0] > 0.0


async def test_an_emitter_at_the_end_of_the_sector_is_turned_to() -> None:
    stage = Stage(target=(0.0, 60.0))
    found = await measured(stage, planned_turn(expected(290.0)))
    assert isinstance(found.fact, BearingMeasured)
    assert found.fact.turn is not None
    assert found.fact.bearing_deg == pytest.approx(0.0, abs=1e-6)
    (first, *_) = found.fact.turn.went_on_because
    assert isinstance(first, MaximumAtEdge)
    assert first.edge == "end"
    assert found.fact.turn.turned_deg > 200.0


async def test_an_emitter_behind_takes_the_whole_circle_and_is_found() -> None:
    stage = Stage(target=(0.0, 60.0))
    found = await measured(stage, planned_turn(expected(180.0)))
    assert isinstance(found.fact, BearingMeasured)
    assert found.fact.turn is not None
    assert found.fact.bearing_deg == pytest.approx(0.0, abs=1e-6)
    assert isinstance(found.fact.turn.stopped_because, WholeCircleSeen)
    assert found.fact.turn.turned_deg > 350.0


async def test_a_whole_turn_says_why_and_is_no_partial_sweep() -> None:
    stage = Stage()
    found = await measured(stage, whole_turn("first"))
    assert stage.vehicle.turned_by == [360.0]
    assert isinstance(found.fact, BearingMeasured)
    assert found.sweep is not None
    assert not found.sweep.partial
    assert found.fact.turn is not None
    assert found.fact.turn.planned_because == WholeTurn("first")


async def test_without_a_plan_nothing_is_recorded_of_the_turn() -> None:
    stage = Stage()
    found = await measured(stage, None)
    assert stage.vehicle.turned_by == [360.0]
    assert isinstance(found.fact, BearingMeasured)
    assert found.fact.turn is None
    assert set(stage.publisher.sectors) <= {None}


async def test_a_sweep_that_never_gives_a_bearing_ends_with_the_circle() -> None:
    stage = Stage(target=(0.0, 60.0))
    stage.finder.rejected = 99
    found = await measured(stage, planned_turn(expected(0.0)))
    assert isinstance(found.fact, SweepRejected)
    assert found.fact.turn is not None
    assert {type(why) for why in found.fact.turn.went_on_because} == {NothingFoundYet}
    assert found.fact.turn.turned_deg > 350.0


async def test_a_hold_amid_the_sector_stops_the_yaw() -> None:
    stage = Stage(target=(0.0, 60.0))
    stage.vehicle.stuck = True
    work = asyncio.create_task(measured(stage, planned_turn(expected(0.0))))
    await stage.until_true(lambda: "turn" in stage.vehicle.names, 10.0)
    work.cancel()
    with pytest.raises(asyncio.CancelledError):
        await work
    await stage.vehicle.hold()
    await asyncio.sleep(0.05)
    assert stage.vehicle.names == ["turn", "hold"]


async def test_a_takeover_amid_the_sector_ends_it() -> None:
    stage = Stage(target=(0.0, 60.0))
    turned = stage.vehicle.turn

    async def taken_over(rate_deg_s: float, by_deg: float = 360.0) -> None:
        await turned(rate_deg_s, by_deg)
        stage.vehicle.pilot_takes_over()

    stage.vehicle.turn = taken_over  # type: ignore[method-assign]
    with pytest.raises(VehicleError):
        await measured(stage, planned_turn(expected(0.0)))
    assert stage.vehicle.names == ["turn"]
