"""Missions of the vehicle adapter on a simulated autopilot, held against where the vehicle truly was at each step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from equipment import FRAME
from relief import hill, terrain
from shapely import Point, Polygon, box
from simulated_mission import HOME_FRAME, Flight, flight
from stepped_loop import run_stepped

from backend import spec as wire
from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.firmware import Conditions, Firmware
from hardware.sim.autopilot.px4 import Px4

OVER_HOME_M = 6.0


def area(zone: Polygon) -> wire.Polygon:
    ring = [FRAME.to_geo(x, y) for x, y in zone.exterior.coords]
    return wire.Polygon(coordinates=[[(p.lon, p.lat) for p in ring]])


WALL = box(-60.0, 30.0, 60.0, 50.0)
BESIDE_NORTH_M = 53.0
CLEARANCE_M = 20.0
GROUND = terrain(hill(0.0, 50.0, 60.0, 20.0), spacing_m=10.0)
"""Between home and the far side of the field."""


async def returned(flavour: type[Firmware], east: float, north: float) -> list[tuple[float, float, float]]:
    firmware = flavour(Conditions(HOME_FRAME))  # pyright: ignore[reportCallIssue]
    async with flight(firmware) as one:
        await one.start(no_fly=[area(WALL)])
        await one.fly_to(east, north)
        await one.come_home()
    return one.track


@pytest.mark.parametrize(("flavour", "north"), [(ArduCopter, 90.0), (Px4, BESIDE_NORTH_M)])
def test_no_moment_of_a_return_is_inside_a_no_fly_area(flavour: type[Firmware], north: float) -> None:
    """Where it begins beside the area too."""
    track = run_stepped(returned(flavour, 0.0, north))
    assert max(at[1] for at in track) > WALL.bounds[3]
    assert [at for at in track if WALL.contains(Point(at[:2]))] == []
    assert math.hypot(*track[-1][:2]) < 3.0


async def over_the_hill() -> Flight:
    firmware = Px4(Conditions(HOME_FRAME))
    firmware.parameters.set("RTL_RETURN_ALT", 100.0)  # its own return has to clear the hill
    async with flight(firmware, GROUND) as one:
        await one.start()
        await one.fly_to(0.0, 98.0)
        await one.come_home()
    return one


def test_at_every_moment_of_the_way_there_and_home_the_hill_is_cleared() -> None:
    one = run_stepped(over_the_hill())
    east, north, up = np.array(one.track).T
    lon, lat = np.array(FRAME.to_lon_lat(np.column_stack((east, north)))).T
    clear_m = HOME_FRAME.amsl_m + up - GROUND.at(lat, lon)
    away = np.hypot(east, north) > OVER_HOME_M
    assert north[away].max() > 95.0
    assert clear_m[away].min() >= CLEARANCE_M, clear_m[away].min()
    assert max(one.sent_amsl_m) == pytest.approx(160.0 + CLEARANCE_M + 3.0, abs=1.0)
    assert min(one.sent_amsl_m) >= HOME_FRAME.amsl_m + 40.0 - 0.5
    assert math.hypot(*one.track[-1][:2]) < 3.0
