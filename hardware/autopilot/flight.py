"""Flight to a place: sent, watched, sent again when nothing moves, arrived when telemetry says so."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass

from hardware.autopilot.commander import CommandDenied, Manoeuvre
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.hover import Hover
from hardware.autopilot.messages import CHANGE_SPEED, command_long, reposition
from hardware.autopilot.nose import LegNose
from hardware.deadline import Deadline
from hardware.ports import PlaceRefused, VehicleError
from hardware.readings import Place
from hardware.reasons.vehicle import NoProgress, NotArrived, PlaceNotTaken
from hardware.reasons.vehicle_news import TriedAgain
from hardware.yaw_swings import Swinging

ARRIVED_M = 2.0
STUCK_S = 10.0
ATTEMPTS = 3


@dataclass(frozen=True, slots=True)
class Flight:
    """Where to, as `Vehicle.goto` is asked."""

    place: Place
    altitude_amsl_m: float
    speed_m_s: float
    heading_deg: float | None = None
    swinging: Swinging | None = None

    @property
    def facing_deg(self) -> float | None:
        """Where the nose is sent with the place itself: nowhere while swings are to come."""
        swings = None if self.swinging is None else self.swinging.swings
        return self.heading_deg if swings is None or swings.stage == "over" else None


async def fly_to(guidance: Guidance, flight: Flight) -> None:
    """Returns once arrived and settled, wherever the nose points by then. Raises PlaceRefused when the autopilot says
    that it will not fly there, VehicleError when it does not arrive."""
    try:
        await _fly_to(guidance, flight)
    finally:
        if flight.swinging is not None:
            flight.swinging.stop("not_ours")


async def _fly_to(guidance: Guidance, flight: Flight) -> None:
    monitor = guidance.monitor
    manoeuvre = guidance.begin("flight")
    distance, climb = guidance.distance(flight.place, flight.altitude_amsl_m)
    deadline = Deadline(monitor.clock, 30.0 + 3.0 * distance / flight.speed_m_s + climb / 0.5)
    ordered_at_s = monitor.clock.now()
    nose = None if flight.swinging is None else LegNose(guidance, manoeuvre, flight.swinging, guidance.here()[0])
    for attempt in range(1, ATTEMPTS + 1):
        await _send(guidance, manoeuvre, flight)
        if await _arrive(guidance, manoeuvre, flight, nose, deadline, ordered_at_s):
            return
        distance, climb = guidance.distance(flight.place, flight.altitude_amsl_m)
        if deadline.passed:
            break
        if attempt < ATTEMPTS:
            monitor.announce(TriedAgain(NoProgress(STUCK_S, distance), attempt + 1))
    raise VehicleError(NotArrived(distance, climb))


async def _send(guidance: Guidance, manoeuvre: Manoeuvre, flight: Flight) -> None:
    dialect = guidance.monitor.dialect
    await guidance.enter_steering(manoeuvre)
    there = reposition(flight.place, flight.altitude_amsl_m, flight.speed_m_s, flight.facing_deg)
    try:
        await guidance.steer(manoeuvre, there, "place")
    except CommandDenied as denied:
        if denied.refusal.result == "failed":  # ArduCopter's answer to a place beyond its fence
            raise PlaceRefused(PlaceNotTaken(denied.refusal.said)) from denied
        raise
    guidance.spot = (flight.place, flight.altitude_amsl_m)
    if not dialect.reposition_sets_speed:
        speed = command_long(CHANGE_SPEED, 1.0, flight.speed_m_s, -1.0, 0.0, 0.0, 0.0, 0.0)
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
    flight: Flight,
    nose: LegNose | None,
    deadline: Deadline,
    ordered_at_s: float,
) -> bool:
    """True when arrived and settled; False when no progress was seen for STUCK_S, or the deadline passed.

    Both are measured in the time of the positions seen, so that a silent link is no lack of progress.
    """
    snapshot, place, altitude_amsl_m = guidance.monitor.snapshot, flight.place, flight.altitude_amsl_m
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
        if nose is not None:
            await nose.steer(place, altitude_amsl_m, flight.speed_m_s)
        await guidance.monitor.wakeup.wait()
    return False
