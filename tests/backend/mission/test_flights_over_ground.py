"""Missions over hills on doubles: how high each way is flown, what is kept for a restart, what is refused."""

from __future__ import annotations

from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import replace
from unittest.mock import AsyncMock

import numpy as np
import pytest
from equipment import FRAME, HOME
from flights import flying, order
from numpy.typing import NDArray
from relief import Shelf, hill, level, terrain
from stage import Stage

from backend import commands
from backend.craft import checklist
from backend.events import FlightStarted, MissionStarted, PlanChosen
from backend.reasons import safety
from backend.reasons.terrain import GroundNotKept
from backend.terrain import Terrain
from hardware.readings import ReturnAltitude

HILL = hill(0.0, 50.0, 35.0, 25.0)
"""In the middle of the field."""
CLEARANCE_M = 20.0


def ridge(east: NDArray[np.float64], north: NDArray[np.float64]) -> NDArray[np.float64]:
    """From one end of the field to the other, beyond the fence."""
    return 160.0 - 60.0 * (1.0 - np.exp(-(((north - 50.0) / 20.0) ** 2))) + 0.0 * east


@pytest.fixture
async def over() -> AsyncIterator[Callable[[Terrain | None], Awaitable[tuple[Stage, Shelf]]]]:
    made: list[Stage] = []

    async def on_stage(found: Terrain | None) -> tuple[Stage, Shelf]:
        stage, shelf = Stage(), Shelf(found)
        stage.grounds = shelf
        stage.vehicle.returns_at = ReturnAltitude("RTL_RETURN_ALT", 100.0)  # over every hill here
        stage.room = stage.new_room()
        made.append(stage)
        await stage.room.start_up()
        return stage, shelf

    yield on_stage
    for stage in made:
        await stage.room.shut_down()


async def test_every_way_of_a_mission_is_flown_level_and_clear_of_the_hill(over) -> None:
    stage, shelf = await over(terrain(HILL, spacing_m=10.0))
    mission_id = await flying(stage, "measuring")
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    await stage.until(mission_id, "mission_ended")
    ground = next(iter(shelf.stored.values()))
    assert stage.vehicle.flown
    before, amsl_before = HOME, 140.0
    for place, amsl in stage.vehicle.flown:
        (x0, y0), (x1, y1) = FRAME.to_enu(before), FRAME.to_enu(place)
        moved = np.hypot(x1 - x0, y1 - y0) > 1.0
        assert not moved or abs(amsl - amsl_before) <= 1.0
        along = np.array(FRAME.to_lon_lat(np.column_stack((np.linspace(x0, x1, 200), np.linspace(y0, y1, 200)))))
        assert amsl - ground.at(along[:, 1], along[:, 0]).max() >= CLEARANCE_M or not moved
        before, amsl_before = place, amsl
    for plan, start in zip(
        stage.journal.of_kind(mission_id, PlanChosen), stage.journal.of_kind(mission_id, FlightStarted), strict=False
    ):
        assert plan.altitude_amsl_m == start.altitude_amsl_m


async def test_an_override_behind_the_hill_is_flown_over_it_after_a_climb_on_the_spot(over) -> None:
    stage, _ = await over(terrain(hill(0.0, 50.0, 60.0, 20.0), spacing_m=10.0))
    mission_id = await flying(stage, "waiting", automatic=False)
    behind = FRAME.to_geo(0.0, 98.0)
    assert (await order(stage, mission_id, commands.Override(place=behind))).accepted
    await order(stage, mission_id, commands.Accept())
    await stage.until(mission_id, "place_reached")
    (climb, high), (there, same) = stage.vehicle.flown[-2:]
    assert FRAME.to_enu(climb) == pytest.approx((0.0, 0.0), abs=0.1)
    assert FRAME.to_enu(there) == pytest.approx((0.0, 98.0), abs=0.1)
    assert high == same == pytest.approx(160.0 + CLEARANCE_M + 3.0, abs=1.0)
    assert stage.journal.of_kind(mission_id, PlanChosen)[-1].altitude_amsl_m == high
    await order(stage, mission_id, commands.Abort())
    await stage.until_true(lambda: "land" in stage.vehicle.names)
    assert stage.vehicle.flown[-1][1] == high


async def test_before_the_return_the_vehicle_climbs_as_the_way_home_needs(over) -> None:
    """A pilot may have left it low behind the hill."""
    stage, _ = await over(terrain(hill(0.0, 50.0, 60.0, 20.0), spacing_m=10.0))
    mission_id = await flying(stage, "waiting", automatic=False)
    low = replace(
        stage.vehicle.state, position=FRAME.to_geo(0.0, 99.0), altitude_amsl_m=110.0, altitude_relative_m=10.0
    )
    stage.vehicle.state = low
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_true(lambda: "land" in stage.vehicle.names)
    assert stage.vehicle.names[-3:] == ["goto", "goto", "land"]
    (climb, high), (home, same) = stage.vehicle.flown[-2:]
    assert FRAME.to_enu(climb) == pytest.approx((0.0, 99.0), abs=0.1)
    assert FRAME.to_enu(home) == pytest.approx((0.0, 0.0), abs=0.1)
    assert high == same == pytest.approx(160.0 + CLEARANCE_M + 3.0, abs=1.0)


async def test_the_autopilots_own_return_begins_as_high_as_the_straight_way_needs(over, monkeypatch) -> None:
    """It is what is left where our way cannot be flown: here the ground asks for more than the band allows. No start is
    accepted so; a parameter that another station changes in flight is not looked at again."""
    stage, _ = await over(terrain(ridge, spacing_m=10.0))
    monkeypatch.setattr(checklist, "return_altitude_check", AsyncMock(return_value=None))
    mission_id = await flying(stage, "waiting", automatic=False, maximum_altitude_relative_m=60.0)
    stage.vehicle.state = replace(
        stage.vehicle.state, position=FRAME.to_geo(0.0, 99.0), altitude_amsl_m=110.0, altitude_relative_m=10.0
    )
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_true(lambda: "return_home" in stage.vehicle.names)
    assert stage.vehicle.names[-2:] == ["goto", "return_home"]
    place, amsl = stage.vehicle.flown[-1]
    assert FRAME.to_enu(place) == pytest.approx((0.0, 99.0), abs=0.1)
    assert amsl == pytest.approx(160.0 + CLEARANCE_M + 3.0, abs=1.0)


async def test_the_ground_is_kept_before_the_start_and_used_again_after_a_restart(over) -> None:
    stage, shelf = await over(terrain(HILL, spacing_m=10.0))
    mission_id = await flying(stage, "waiting", automatic=False)
    (started,) = stage.journal.of_kind(mission_id, MissionStarted)
    assert started.ground is not None
    assert list(shelf.stored) == [started.ground.digest]
    shelf.found = terrain(level(), name="other")
    await stage.restart()
    used = stage.active.task.ground.terrain
    assert used is not None
    assert used.digest == started.ground.digest


async def test_when_the_ground_is_lost_over_a_restart_no_place_is_flown_to_but_home_is_in_reach(over) -> None:
    stage, shelf = await over(terrain(HILL, spacing_m=10.0))
    mission_id = await flying(stage, "waiting", automatic=False)
    shelf.stored.clear()
    await stage.restart()
    await stage.until_phase(mission_id, "hold")
    reply = await order(stage, mission_id, commands.Override(place=FRAME.to_geo(20.0, 30.0)))
    assert isinstance(reply.reason, safety.GroundUnknown)
    stage.vehicle.state = replace(stage.vehicle.state, position=FRAME.to_geo(20.0, 30.0))
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_true(lambda: "return_home" in stage.vehicle.names)


async def test_a_start_whose_ground_cannot_be_stored_is_refused(over) -> None:
    stage, shelf = await over(terrain(HILL))
    shelf.full = True
    with pytest.raises(AssertionError) as refused:
        await flying(stage)
    assert "GroundNotKept" in str(refused.value)
    assert stage.vehicle.names == []
    assert GroundNotKept("No space left on device").detail in str(refused.value)


async def test_without_terrain_a_mission_flies_as_its_altitude_says_and_the_start_says_flat(over) -> None:
    stage, _ = await over(None)
    mission_id = await flying(stage, "measuring", altitude_relative_m=15.0)
    (started,) = stage.journal.of_kind(mission_id, MissionStarted)
    assert started.ground is None
    assert {amsl for _, amsl in stage.vehicle.flown} == {115.0}
    await order(stage, mission_id, commands.Abort())
