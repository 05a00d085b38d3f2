"""How a return is flown: by way points of ours around what may not be flown over, then down at home.

The autopilot knows neither our no-fly areas nor our altitude band nor the ground: its own return flies straight. It is
ordered only when ours cannot be flown, from an altitude that keeps clear of the ground, and the operator sees which it
is. Each leg is held against the vetoes again right before it is sent; a pilot who takes over, or the autopilot's
failsafe, ends it.
"""

from __future__ import annotations

import asyncio
import logging
import math

from backend.craft import inputs
from backend.craft.recent_telemetry import recent
from backend.craft.safety import ground_return_vetoes, return_vetoes
from backend.craft.under_way import UnderWay
from backend.craft.way_home import ABOVE_HOME_M, Point2, way_home
from backend.craft.work import CLIMB_FIRST_M, LEVEL_M, Work
from backend.reasons import Reason, safety
from hardware.ports import HardwareError, NotInControl, VehicleUnreachable
from hardware.readings import Place

log = logging.getLogger("crossfix.craft")

AT_HOME_M = 2.0


async def fly_home(work: Work, under_way: UnderWay) -> inputs.AutopilotReturns | None:
    """Returns once the landing at home, or the autopilot's own return, has begun; the latter with its reason.
    under_way: learns of each leg.

    Raises NotInControl when somebody else flies, HardwareError when the autopilot does not return either.
    """
    vehicle = work.equipment.vehicle
    if vehicle.telemetry().in_air is False:
        await vehicle.return_home()
        return None
    try:
        because = await _our_way(work, under_way)
    except (NotInControl, VehicleUnreachable):
        raise
    except HardwareError as error:
        because = error.reason
    if because is None:
        if vehicle.telemetry().in_air is not False:
            await vehicle.land()
        return None
    log.warning("%s: the autopilot returns by itself: %s", work.equipment.craft_id, because)
    await _level_off(work)
    await vehicle.return_home()
    return inputs.AutopilotReturns(because)


async def _level_off(work: Work) -> None:
    """Over known ground, as high as the straight way needs. One that fails holds no return up."""
    try:
        await work.level_off_for_home()
    except (NotInControl, VehicleUnreachable):
        raise
    except HardwareError as error:
        log.warning("%s: no climb before the return: %s", work.equipment.craft_id, error)


async def _our_way(work: Work, under_way: UnderWay) -> Reason | None:
    """Fly it. Why it cannot be flown (any further), None once the vehicle is above its home."""
    now = await recent(work.situation)
    position = now.telemetry.position
    if position is None:
        return safety.NoPosition()
    at = work.task.frame.to_enu(position)
    amsl = now.telemetry.altitude_amsl_m
    if math.hypot(*at) < ABOVE_HOME_M:
        return await _over_home(work, under_way, at, amsl)
    way = await asyncio.to_thread(way_home, work.limits.problem, at)
    if way is None:
        return safety.NoWayHome(math.hypot(*at))
    altitude = await asyncio.to_thread(work.task.level_altitude, [at, *way])
    against = await asyncio.to_thread(ground_return_vetoes, work.limits, [at, *way], altitude)
    if against:
        return against[0]
    off_m = CLIMB_FIRST_M if work.task.ground.terrain is None else LEVEL_M
    if amsl is not None and abs(altitude - amsl) > off_m:
        because = await _leg(work, under_way, position, way, altitude)
        if because is not None:
            return because
    for index, point in enumerate(way):
        last = index == len(way) - 1
        to = work.task.home if last else work.task.frame.to_geo(*point)
        because = await _leg(work, under_way, to, way[index:], altitude)
        if because is not None:
            return because
    return None


async def _over_home(work: Work, under_way: UnderWay, at: Point2, amsl: float | None) -> Reason | None:
    """The last metres, as high as it is; a vehicle that is lower than the band lands where it is."""
    low = work.limits.home_amsl_m + work.limits.minimum_altitude_relative_m
    if math.hypot(*at) < AT_HOME_M or amsl is None or amsl < low:
        return None
    return await _leg(work, under_way, work.task.home, ((0.0, 0.0),), amsl)


async def _leg(work: Work, under_way: UnderWay, to: Place, way: tuple[Point2, ...], altitude: float) -> Reason | None:
    """One leg at an altitude (m AMSL), and what safety has against it or against the rest of the way."""
    vetoes = return_vetoes(work.limits, await recent(work.situation), way, altitude)
    if vetoes:
        return vetoes[0]
    under_way.begin(to)
    try:
        await work.equipment.vehicle.goto(to, altitude, work.task.mission.flight.speed_m_s)
    finally:
        under_way.end()
    return None
