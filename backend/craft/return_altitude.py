"""Does the autopilot's own return stay below the mission's ceiling? It acts when the link is lost or ours cannot be."""

from __future__ import annotations

from backend.events import CheckFact
from backend.reasons.checks import ReturnAltitudeChecked, ReturnAltitudeUnread
from backend.spec import FlightSpec
from hardware.ports import HardwareError, Vehicle


async def return_altitude_check(flight: FlightSpec, vehicle: Vehicle) -> CheckFact | None:
    """A line of the checklist; None while no vehicle is heard. There is no floor: it never sinks to its altitude."""
    try:
        found = await vehicle.return_altitude()
    except HardwareError:
        return None
    ceiling = flight.maximum_altitude_relative_m
    if found.altitude_relative_m is None:
        unread = ReturnAltitudeUnread(found.parameter, ceiling)
        return CheckFact(name="failsafe", ok=False, reason=unread, blocking=False)
    reason = ReturnAltitudeChecked(found.parameter, found.altitude_relative_m, ceiling)
    return CheckFact(name="failsafe", ok=found.altitude_relative_m <= ceiling, reason=reason, blocking=True)
