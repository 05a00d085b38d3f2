"""Flight to a place: sent, watched, sent again when nothing moves, arrived when telemetry says so."""

from __future__ import annotations

import contextlib

from hardware.autopilot.commander import CommandDenied, Manoeuvre
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.hover import Hover
from hardware.autopilot.messages import CHANGE_SPEED, command_long, reposition
from hardware.deadline import Deadline
from hardware.ports import PlaceRefused, VehicleError
from hardware.readings import Place
from hardware.reasons.vehicle import NoProgress, NotArrived, PlaceNotTaken
from hardware.reasons.vehicle_news import TriedAgain

ARRIVED_M = 2.0
STUCK_S = 10.0
ATTEMPTS = 3


async def fly_to(
    guidance: Guidance, place: Place, altitude_amsl_m: float, speed_m_s: float, heading_deg: float | None = None
) -> None:
    """Returns once arrived and settled, wherever the nose points by then. Raises PlaceRefused when the autopilot says
    that it will not fly there, VehicleError when it does not arrive."""
    monitor = guidance.monitor
    manoeuvre = guidance.begin("flight")
    distance, climb = guidance.distance(place, altitude_amsl_m)
    deadline = Deadline(monitor.clock, 30.0 + 3.0 * distance / speed_m_s + climb / 0.5)
    ordered_at_s = monitor.clock.now()
    for attempt in range(1, ATTEMPTS + 1):
        await _send(guidance, manoeuvre, place, altitude_amsl_m, speed_m_s, heading_deg)
        if await _arrive(guidance, manoeuvre, place, altitude_amsl_m, deadline, ordered_at_s):
            return
        distance, climb = guidance.distance(place, altitude_amsl_m)
        if deadline.passed:
            break
        if attempt < ATTEMPTS:
            monitor.announce(TriedAgain(NoProgress(STUCK_S, distance), attempt + 1))
    raise VehicleError(NotArrived(distance, climb))


async def _send(
    guidance: Guidance,
    manoeuvre: Manoeuvre,
    place: Place,
    altitude_amsl_m: float,
    speed_m_s: float,
    heading_deg: float | None,
) -> None:
    dialect = guidance.monitor.dialect
    await guidance.enter_steering(manoeuvre)
    there = reposition(place, altitude_amsl_m, speed_m_s, heading_deg)
    try:
        await guidance.steer(manoeuvre, there, "place")
    except CommandDenied as denied:
        if denied.refusal.result == "failed":  # ArduCopter's answer to a place beyond its fence
            raise PlaceRefused(PlaceNotTaken(denied.refusal.said)) from denied
        raise
    guidance.spot = (place, altitude_amsl_m)
    if not dialect.reposition_sets_speed:
        speed = command_long(CHANGE_SPEED, 1.0, speed_m_s, -1.0, 0.0, 0.0, 0.0, 0.0)
        with contextlib.suppress(CommandDenied):  # then it flies at the autopilot's own speed
            await guidance.steer(manoeuvre, speed, "speed")


def _check_taken(guidance: Guidance, ordered_at_s: float) -> None:
    """PX4 acknowledges a place before it looks at it, and refuses by a text alone."""
    beginnings = guidance.monitor.dialect.place_refused_texts
    for text in guidance.monitor.said_since(ordered_at_s):
        if text.startswith(beginnings):
            raise PlaceRefused(PlaceNotTaken(text))


async def _arrive(
    guidance: Guidance,
    manoeuvre: Manoeuvre,
    place: Place,
    altitude_amsl_m: float,
    deadline: Deadline,
    ordered_at_s: float,
) -> bool:
    """True when arrived and settled; False when no progress was seen for STUCK_S, or the deadline passed.

    Both are measured in the time of the positions seen, so that a silent link is no lack of progress.
    """
    snapshot = guidance.monitor.snapshot
    nearest, progress_at = sum(guidance.distance(place, altitude_amsl_m)), snapshot.position_at_s or 0.0
    hover = Hover()
    while not deadline.passed:
        guidance.go_on(manoeuvre)
        _check_taken(guidance, ordered_at_s)
        distance, climb = guidance.distance(place, altitude_amsl_m)
        seen_at = snapshot.position_at_s or 0.0
        inside = distance < ARRIVED_M and climb < ARRIVED_M
        if hover.see(guidance.here()[0], snapshot.speed_m_s, seen_at, inside):
            return True
        if inside or distance + climb < nearest - 1.0:
            nearest, progress_at = min(nearest, distance + climb), seen_at
        if seen_at - progress_at > STUCK_S:
            return False
        await guidance.monitor.wakeup.wait()
    return False
