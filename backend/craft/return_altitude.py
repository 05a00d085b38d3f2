"""Does the autopilot's own return stay below the mission's ceiling and above the ground? It acts when the link is lost
or ours cannot be."""

from __future__ import annotations

import math

import numpy as np
from shapely import contains_xy, get_coordinates
from shapely.geometry.base import BaseGeometry

from backend.events import CheckFact
from backend.reasons.checks import ReturnAltitudeChecked, ReturnAltitudeUnread, ReturnClimbs, ReturnMeetsGround
from backend.search.ground import LATERAL_TOLERANCE_M, Points, sample_m
from backend.search.task import SearchTask
from backend.spec import FlightSpec
from hardware.ports import HardwareError, Vehicle

PLACES_ACROSS, MOST_ON_EDGE = 20, 1000
"""Where a return may begin: places of a grid inside the fence, and at most this many on its edge."""
MOST_POINTS = 400
"""Of one way home: a longer one is looked at less finely."""


async def return_altitude_check(
    flight: FlightSpec, vehicle: Vehicle, least_m: float | None, over_terrain: bool
) -> CheckFact | None:
    """A line of the checklist; None while no vehicle is heard. least_m: see least_return_altitude_m. over_terrain: the
    mission follows it, and may be as high as its ceiling then.

    The band has no floor here: the autopilot's own return never sinks to its altitude.
    """
    try:
        found = await vehicle.return_altitude()
    except HardwareError:
        return None
    ceiling, parameter, altitude = flight.maximum_altitude_relative_m, found.parameter, found.altitude_relative_m
    if altitude is None or found.climb_m is None:
        unread = ReturnAltitudeUnread(parameter if altitude is None else found.climb_parameter or parameter, ceiling)
        return CheckFact(name="failsafe", ok=False, reason=unread, blocking=True)
    if least_m is not None and altitude < least_m:
        reason = ReturnMeetsGround(parameter, altitude, math.ceil(least_m))
        return CheckFact(name="failsafe", ok=False, reason=reason, blocking=True)
    highest = ceiling if over_terrain else flight.altitude_relative_m
    if found.climb_parameter is not None and found.climb_m > 0.0 and highest + found.climb_m > ceiling:
        climbs = ReturnClimbs(found.climb_parameter, found.climb_m, highest, ceiling)
        return CheckFact(name="failsafe", ok=False, reason=climbs, blocking=True)
    reason = ReturnAltitudeChecked(parameter, altitude, ceiling)
    return CheckFact(name="failsafe", ok=altitude <= ceiling, reason=reason, blocking=True)


def least_return_altitude_m(task: SearchTask) -> float | None:
    """How high above home the autopilot's own return must climb to keep clear of the ground on its straight way home,
    from anywhere in the fence; None: it is clear at the altitude that the craft flies there. What the terrain does not
    know counts for nothing: the checklist has a line of its own for that.
    """
    ground, flight = task.ground, task.mission.flight
    places = _places(task.fence)
    if ground.terrain is None or not len(places):
        return None
    reach_m = float(np.hypot(*places.T).max())
    share = np.linspace(0.0, 1.0, min(math.ceil(reach_m / sample_m(ground.terrain)) + 1, MOST_POINTS))
    ways = places[:, None, :] * share[None, :, None]  # (n, k, 2), from home outwards
    lowest, highest = ground.bounds_at(ways.reshape(-1, 2))
    highest = np.where(np.isinf(highest), -np.inf, highest).reshape(ways.shape[:2])
    lowest = np.where(np.isinf(lowest), np.inf, lowest).reshape(ways.shape[:2])
    wanted = ground.home_amsl_m + flight.altitude_relative_m
    below = np.minimum(wanted, lowest[:, -1] + flight.maximum_above_ground_m)
    flown = np.maximum(below, highest[:, -1] + flight.minimum_clearance_m)
    clear = highest.max(axis=1) + flight.minimum_clearance_m
    short = clear > flown
    return float(clear[short].max()) - ground.home_amsl_m if short.any() else None


def _places(fence: BaseGeometry) -> Points:
    """(n, 2) m ENU: on the edge of an area, so close that no way home lies further beside another than a vehicle flies
    off its way, and on a grid inside."""
    if fence.is_empty:
        return np.empty((0, 2))
    west, south, east, north = fence.bounds
    x, y = np.meshgrid(np.linspace(west, east, PLACES_ACROSS), np.linspace(south, north, PLACES_ACROSS))
    grid = np.column_stack((x.ravel(), y.ravel()))
    edge = fence.segmentize(max(LATERAL_TOLERANCE_M, fence.length / MOST_ON_EDGE))
    return np.concatenate((np.asarray(get_coordinates(edge)), grid[contains_xy(fence, grid[:, 0], grid[:, 1])]))
