"""Take-off: mode, arming and take-off are tried together, because an autopilot disarms while one waits between them."""

from __future__ import annotations

from dataclasses import replace

from hardware.authority import FlightEnded
from hardware.autopilot.commander import CommandDenied, Manoeuvre, OutOfMode
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.messages import arm
from hardware.deadline import Deadline
from hardware.ports import VehicleError
from hardware.reasons.vehicle import AutopilotRefused, ClimbTooLow, NoTakeOff, TakeOffIgnored
from hardware.reasons.vehicle_news import TriedAgain

LEAVE_GROUND_S = 60.0
MOST_SAID = 3


async def take_off(guidance: Guidance, altitude_relative_m: float) -> None:
    """Returns once the vehicle hovers there. Raises VehicleError with the last trouble when it does not."""
    monitor = guidance.monitor
    snapshot, dialect = monitor.snapshot, monitor.dialect
    amsl = guidance.here()[1]
    target_amsl = amsl + altitude_relative_m - (snapshot.altitude_relative_m or 0.0)
    manoeuvre = guidance.begin("take_off")
    try:
        await _leave_ground(guidance, manoeuvre, altitude_relative_m, target_amsl)
    finally:
        if snapshot.disarmed:
            monitor.control.see(FlightEnded())
    slack = max(1.0, 0.03 * altitude_relative_m)

    def climbed() -> bool:
        up, velocity = snapshot.altitude_relative_m, snapshot.velocity_ned
        level = velocity is not None and abs(velocity[2]) < 0.5
        settled = snapshot.custom_mode in dialect.settled_modes
        return up is not None and up > altitude_relative_m - slack and level and settled

    if not await guidance.until(manoeuvre, Deadline(monitor.clock, 30.0 + altitude_relative_m / 0.5), climbed):
        up = snapshot.altitude_relative_m or 0.0
        raise VehicleError(ClimbTooLow(up, altitude_relative_m))
    guidance.spot = (guidance.here()[0], target_amsl)


async def _leave_ground(guidance: Guidance, manoeuvre: Manoeuvre, relative_m: float, amsl_m: float) -> None:
    monitor = guidance.monitor
    snapshot, dialect, clock = monitor.snapshot, monitor.dialect, monitor.clock

    stood_m = snapshot.altitude_relative_m or 0.0

    def rising() -> bool:
        up = snapshot.altitude_relative_m
        return bool(snapshot.armed) and up is not None and up - stood_m > min(1.0, 0.5 * (relative_m - stood_m))

    deadline, attempt = Deadline(clock, LEAVE_GROUND_S, 5.0), 1
    trouble: AutopilotRefused | TakeOffIgnored = TakeOffIgnored()
    while not deadline.passed:
        began_s = clock.now()
        try:
            if snapshot.custom_mode not in dialect.before_take_off.modes:
                await guidance.select(manoeuvre, dialect.before_take_off)
            if not snapshot.armed:
                await guidance.send(manoeuvre, arm(), dialect.take_off_modes, "arming")
                snapshot.arming_at_s = clock.now()
            take_off = dialect.take_off(relative_m, amsl_m)
            await guidance.send(manoeuvre, take_off, dialect.take_off_modes, "take_off")
            if await guidance.until(manoeuvre, Deadline(clock, 10.0, 2.0), rising):
                return
            trouble = TakeOffIgnored()
        except OutOfMode:
            trouble = TakeOffIgnored()
        except CommandDenied as denied:
            trouble = denied.refusal
        attempt += 1
        if await guidance.until(manoeuvre, Deadline(clock, 2.0, 0.2), rising):
            return  # in the air an autopilot refuses the order whose answer was lost before
        if isinstance(trouble, AutopilotRefused):  # why comes as a text, a moment after the answer
            trouble = replace(trouble, said=" / ".join(monitor.said_since(began_s)[-MOST_SAID:]))
        monitor.announce(TriedAgain(trouble, attempt))
    raise VehicleError(NoTakeOff(LEAVE_GROUND_S, trouble))
