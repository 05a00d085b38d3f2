"""Flight to a place: sent, watched, sent again when nothing moves, arrived when telemetry says so."""

from __future__ import annotations

import contextlib

from hardware.autopilot.commander import CommandRefused, Manoeuvre
from hardware.autopilot.helm import Helm
from hardware.autopilot.messages import CHANGE_SPEED, command_long, reposition
from hardware.autopilot.patience import Deadline
from hardware.ports import VehicleError
from hardware.readings import GeoPoint

ARRIVED_M, SETTLED_M_S, SETTLED_FOR_S = 2.0, 1.0, 1.0
STUCK_S = 10.0
ATTEMPTS = 3


async def fly_to(helm: Helm, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
    """Returns once arrived and settled. Raises VehicleError when it does not arrive."""
    monitor = helm.monitor
    manoeuvre = helm.begin("Flight")
    distance, climb = helm.distance(place, altitude_amsl_m)
    deadline = Deadline(monitor.clock, 30.0 + 3.0 * distance / speed_m_s + climb / 0.5)
    for attempt in range(1, ATTEMPTS + 1):
        await _send(helm, manoeuvre, place, altitude_amsl_m, speed_m_s)
        if await _arrive(helm, manoeuvre, place, altitude_amsl_m, deadline):
            return
        distance, climb = helm.distance(place, altitude_amsl_m)
        if deadline.passed:
            break
        if attempt < ATTEMPTS:
            monitor.announce(
                f"no progress for {STUCK_S:.0f} s with {distance:.0f} m to go, "
                f"place sent again ({attempt + 1} of {ATTEMPTS})"
            )
    raise VehicleError(
        f"The vehicle did not arrive: still {distance:.1f} m and {climb:.1f} m of height from the place."
    )


async def _send(helm: Helm, manoeuvre: Manoeuvre, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
    dialect = helm.monitor.dialect
    there = reposition(place, altitude_amsl_m, speed_m_s, None)
    await helm.steer(manoeuvre, there, "the next place")
    helm.spot = (place, altitude_amsl_m)
    if not dialect.reposition_sets_speed:
        speed = command_long(CHANGE_SPEED, 1.0, speed_m_s, -1.0, 0.0, 0.0, 0.0, 0.0)
        with contextlib.suppress(CommandRefused):  # then it flies at the autopilot's own speed
            await helm.order(manoeuvre, speed, dialect.reposition_modes, "the speed")


async def _arrive(
    helm: Helm, manoeuvre: Manoeuvre, place: GeoPoint, altitude_amsl_m: float, deadline: Deadline
) -> bool:
    """True when arrived and settled; False when no progress was seen for STUCK_S, or the deadline passed.

    Both are measured in the time of the positions seen, so that a silent link is no lack of progress.
    """
    snapshot = helm.monitor.snapshot
    nearest, progress_at = sum(helm.distance(place, altitude_amsl_m)), snapshot.position_at_s or 0.0
    settled_since: float | None = None
    while not deadline.passed:
        helm.go_on(manoeuvre)
        distance, climb = helm.distance(place, altitude_amsl_m)
        speed, seen_at = snapshot.speed_m_s, snapshot.position_at_s or 0.0
        inside = distance < ARRIVED_M and climb < ARRIVED_M
        if inside and speed is not None and speed < SETTLED_M_S:
            settled_since = seen_at if settled_since is None else settled_since
            if seen_at - settled_since >= SETTLED_FOR_S:
                return True
        else:
            settled_since = None
        if inside or distance + climb < nearest - 1.0:
            nearest, progress_at = min(nearest, distance + climb), seen_at
        if seen_at - progress_at > STUCK_S:
            return False
        await helm.monitor.news.wait()
    return False
