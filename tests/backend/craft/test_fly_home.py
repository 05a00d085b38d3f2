"""How a return is flown: by our way points around a zone; by the autopilot's own return only when ours cannot be."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Any

import pytest
from craft_walk import CraftWalk
from equipment import FRAME, HOME, spec
from shapely import LineString, Point, box
from stage import Stage

from backend.craft import effects, inputs
from backend.craft.runner import CraftRunner
from backend.events import AlertRaised
from backend.reasons import AutopilotFliesHome
from backend.reasons.safety import AltitudeOutside, NoPosition, NoWayHome
from backend.search.task import search_task
from backend.spec import MissionSpec, Polygon
from hardware.ports import VehicleError
from hardware.readings import Place
from hardware.reasons.vehicle import NotArrived

WALL = box(-60.0, 30.0, 60.0, 50.0)
"""Between the place measured at and home."""
AWAY = FRAME.to_geo(0.0, 80.0)


def polygon(shape: object) -> Polygon:
    ring = [FRAME.to_geo(x, y) for x, y in shape.exterior.coords]  # type: ignore[attr-defined]
    return Polygon(coordinates=[[(p.lon, p.lat) for p in ring]])


def behind(*walls: object, **flight: Any) -> MissionSpec:
    return spec(no_fly=[polygon(wall) for wall in walls], **flight)


class Returning:
    """A craft on its way home. `way`: where it was ordered to, m ENU and AMSL."""

    def __init__(self, mission: MissionSpec, at: Place = AWAY) -> None:
        self.stage = Stage()
        self.vehicle = self.stage.vehicle
        self.vehicle.state = replace(
            self.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0, altitude_amsl_m=140.0, position=at
        )
        self.walk = CraftWalk(mission).to("returning")
        self.given: list[inputs.CraftInput] = []
        self.way: list[tuple[float, float, float]] = []
        self.fails_at = -1
        goto = self.vehicle.goto

        async def noted(place: Place, altitude_amsl_m: float, speed_m_s: float) -> None:
            if len(self.way) == self.fails_at:
                raise VehicleError(NotArrived(20.0, 0.0))
            self.way.append((*FRAME.to_enu(place), altitude_amsl_m))
            await goto(place, altitude_amsl_m, speed_m_s)

        self.vehicle.goto = noted  # type: ignore[method-assign]
        self.runner = CraftRunner(
            "m",
            self.stage.craft(),
            search_task(mission, HOME, 100.0),
            lambda: self.walk.craft,
            lambda: self.walk.search,
            self._give,
            lambda points: None,
            lambda found, place_number, attempt: None,
        )

    def _give(self, given: inputs.CraftInput) -> None:
        self.given.append(given)
        self.walk.give(given)

    async def flown(self, until: str) -> None:
        self.runner.carry_out(effects.ReturnHome())
        await self.stage.until_true(lambda: self.vehicle.names[-1:] == [until], 10.0)
        await self.stage.clock.sleep(3.0)

    async def close(self) -> None:
        await self.runner.close()


@pytest.fixture
async def returning() -> AsyncIterator[list[Returning]]:
    made: list[Returning] = []
    yield made
    for one in made:
        await one.close()


def start(returning: list[Returning], mission: MissionSpec, at: Place = AWAY) -> Returning:
    returning.append(Returning(mission, at))
    return returning[-1]


async def test_a_return_leads_around_a_zone_at_the_missions_altitude_and_lands_at_home(
    returning: list[Returning],
) -> None:
    craft = start(returning, behind(WALL))
    await craft.flown("land")
    path = LineString([FRAME.to_enu(AWAY), *[(east, north) for east, north, _ in craft.way]])
    assert path.intersection(WALL).length == 0.0
    assert Point(path.coords[-1]).distance(Point(0, 0)) < 0.1
    assert [amsl for *_, amsl in craft.way] == pytest.approx([140.0] * len(craft.way))
    assert set(craft.vehicle.names) == {"goto", "land"}
    assert craft.given == [inputs.CarriedOut("return")]


async def test_a_vehicle_that_is_low_climbs_before_it_goes_anywhere(returning: list[Returning]) -> None:
    craft = start(returning, spec())
    craft.vehicle.state = replace(craft.vehicle.state, altitude_relative_m=8.0, altitude_amsl_m=108.0)
    await craft.flown("land")
    assert [math.hypot(east, north) for east, north, _ in craft.way] == [pytest.approx(80, abs=0.1), pytest.approx(0)]


async def test_above_home_it_only_lands(returning: list[Returning]) -> None:
    craft = start(returning, spec(), HOME)
    await craft.flown("land")
    assert craft.vehicle.names == ["land"]


@pytest.mark.parametrize(("height", "flown"), [(40.0, ["goto", "land"]), (5.0, ["land"])])
async def test_beside_home_it_goes_there_unless_it_is_too_low_to_go_anywhere(
    returning: list[Returning], height: float, flown: list[str]
) -> None:
    craft = start(returning, spec(), FRAME.to_geo(4.0, 3.0))
    craft.vehicle.state = replace(craft.vehicle.state, altitude_relative_m=height, altitude_amsl_m=100.0 + height)
    await craft.flown("land")
    assert craft.vehicle.names == flown


async def told(craft: Returning) -> object:
    await craft.flown("return_home")
    await craft.stage.until_true(lambda: bool(craft.given))
    (given,) = craft.given
    assert isinstance(given, inputs.AutopilotReturns)
    alert = craft.walk.of_kind(AlertRaised)[-1]
    assert alert.reason == AutopilotFliesHome(given.because)
    return given.because


async def test_without_a_way_the_autopilot_returns_and_it_is_told(returning: list[Returning]) -> None:
    craft = start(returning, behind(box(-200.0, 30.0, 200.0, 50.0)))
    assert isinstance(await told(craft), NoWayHome)


async def test_without_a_position_the_autopilot_returns_and_it_is_told(returning: list[Returning]) -> None:
    craft = start(returning, spec())
    craft.vehicle.state = replace(craft.vehicle.state, position=None)
    assert await told(craft) == NoPosition()


async def test_a_leg_that_is_not_flown_is_left_to_the_autopilot(returning: list[Returning]) -> None:
    craft = start(returning, behind(WALL))
    craft.fails_at = 1
    assert await told(craft) == NotArrived(20.0, 0.0)
    assert craft.vehicle.names == ["goto", "return_home"]


async def test_an_altitude_outside_the_band_is_not_flown_home_at(returning: list[Returning]) -> None:
    craft = start(returning, spec(altitude_relative_m=130.0))
    assert isinstance(await told(craft), AltitudeOutside)


async def test_a_pilot_ends_the_return_between_two_legs(returning: list[Returning]) -> None:
    craft = start(returning, behind(WALL))
    goto = craft.vehicle.goto

    async def taken_over(place: Place, altitude_amsl_m: float, speed_m_s: float) -> None:
        await goto(place, altitude_amsl_m, speed_m_s)
        craft.vehicle.pilot_takes_over()

    craft.vehicle.goto = taken_over  # type: ignore[method-assign]
    craft.runner.carry_out(effects.ReturnHome())
    await craft.stage.until_true(lambda: craft.walk.craft.phase == "manual" or craft.vehicle.names == ["goto"], 10.0)
    await craft.stage.clock.sleep(20.0)
    assert craft.vehicle.names == ["goto"]


async def test_a_hold_stops_it_and_another_return_goes_on_from_there(returning: list[Returning]) -> None:
    craft = start(returning, behind(WALL))
    craft.vehicle.stuck = True
    craft.runner.carry_out(effects.ReturnHome())
    await craft.stage.until_true(lambda: craft.vehicle.names == ["goto"], 10.0)
    craft.runner.carry_out(effects.CancelWork())
    craft.runner.carry_out(effects.HoldVehicle())
    await craft.stage.until_true(lambda: craft.vehicle.names == ["goto", "hold"], 10.0)
    craft.vehicle.stuck = False
    craft.vehicle.state = replace(craft.vehicle.state, position=FRAME.to_geo(70.0, 52.0))
    craft.way.clear()
    await craft.flown("land")
    assert len(craft.way) < 3
