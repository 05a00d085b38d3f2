"""Take-off: mode, arming and take-off are tried together, because an autopilot disarms while one waits between them."""

from __future__ import annotations

import math
from dataclasses import replace

from hardware.authority import FlightEnded
from hardware.autopilot.commander import CommandDenied, CommandLost, Manoeuvre, OutOfMode
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.messages import arm
from hardware.deadline import Deadline
from hardware.ports import VehicleError
from hardware.reasons.vehicle import AutopilotRefused, ClimbTooLow, CommandUnanswered, NoTakeOff, TakeOffIgnored
from hardware.reasons.vehicle_news import TriedAgain

LEAVE_GROUND_S = 60.0
MOST_SAID = 3
HOME_SET_S = 0.25
RISES_M, RISES_S, RISES_WALL_S = 0.5, 10.0, 2.0
"""A climb that gains less in this time has ended: a pilot who selects PX4's own HOLD stops it, and that is our mode."""
JUMPS_M, LASTS_S = 2.0, 4.0
"""A height that stays lower by more for this long in a climb has jumped: what was gained counts from there. A noisy one
comes back before; so does a climb of less than 0.5 m/s, which is taken for one that ended then."""


async def take_off(guidance: Guidance, altitude_relative_m: float) -> None:
    """Returns once the vehicle hovers there. Raises VehicleError with the last trouble when it does not."""
    monitor = guidance.monitor
    snapshot, dialect = monitor.snapshot, monitor.dialect
    manoeuvre = guidance.begin("take_off")
    try:
        await _leave_ground(guidance, manoeuvre, altitude_relative_m)
    finally:
        if snapshot.disarmed:
            monitor.control.see(FlightEnded())
    slack = max(1.0, 0.03 * altitude_relative_m)

    def climbed() -> bool:
        up, velocity = snapshot.altitude_relative_m, snapshot.velocity_ned
        level = velocity is not None and abs(velocity[2]) < 0.5
        settled = snapshot.custom_mode in dialect.settled_modes
        return up is not None and up > altitude_relative_m - slack and level and settled

    highest_m, rises = -math.inf, Deadline(monitor.clock, RISES_S, RISES_WALL_S)
    fell_at_s, highest_since_m = math.inf, -math.inf

    def ended() -> bool:
        nonlocal highest_m, rises, fell_at_s, highest_since_m
        up, now_s = snapshot.altitude_relative_m or 0.0, monitor.clock.now()
        if up > min(highest_m + RISES_M, altitude_relative_m - slack) or not monitor.connected:
            highest_m, rises = up, Deadline(monitor.clock, RISES_S, RISES_WALL_S)
        if up > highest_m - JUMPS_M:
            fell_at_s, highest_since_m = math.inf, -math.inf
        else:
            fell_at_s, highest_since_m = min(fell_at_s, now_s), max(highest_since_m, up)
        if now_s - fell_at_s > LASTS_S:
            highest_m, fell_at_s, highest_since_m = highest_since_m, math.inf, -math.inf
        return climbed() or snapshot.disarmed or rises.passed

    await guidance.until(manoeuvre, Deadline(monitor.clock, 30.0 + altitude_relative_m / 0.5), ended)
    if not climbed():
        raise VehicleError(ClimbTooLow(snapshot.altitude_relative_m or 0.0, altitude_relative_m))
    guidance.spot = (guidance.here()[0], _amsl_of(guidance, altitude_relative_m))


async def _arm(guidance: Guidance, manoeuvre: Manoeuvre) -> None:
    """From the order on it may be armed: what stops a take-off must reach it though its answer has not come yet."""
    snapshot, clock = guidance.monitor.snapshot, guidance.monitor.clock
    before_s, snapshot.arming_at_s = snapshot.arming_at_s, math.inf
    try:
        await guidance.send(manoeuvre, arm(), guidance.monitor.dialect.take_off_modes, "arming")
    except (CommandDenied, OutOfMode) as not_done:
        if not (isinstance(not_done, OutOfMode) and not_done.sent):
            snapshot.arming_at_s = before_s
        raise
    finally:
        snapshot.arming_at_s = min(snapshot.arming_at_s, clock.now())


async def _hear_home(guidance: Guidance, manoeuvre: Manoeuvre) -> None:
    """Arming has set home, and a moment later heights are above that."""
    snapshot = guidance.monitor.snapshot
    armed_at_s = snapshot.position_at_s or 0.0

    def heard() -> bool:
        return (snapshot.position_at_s or 0.0) > armed_at_s + HOME_SET_S

    await guidance.until(manoeuvre, Deadline(guidance.monitor.clock, 1.0, 0.5), heard)


def _amsl_of(guidance: Guidance, relative_m: float) -> float:
    """As home is now: arming sets it to where the vehicle stands."""
    return guidance.here()[1] + relative_m - (guidance.monitor.snapshot.altitude_relative_m or 0.0)


async def _leave_ground(guidance: Guidance, manoeuvre: Manoeuvre, relative_m: float) -> None:
    monitor = guidance.monitor
    snapshot, dialect, clock = monitor.snapshot, monitor.dialect, monitor.clock

    stood_amsl_m = guidance.here()[1]

    def rising() -> bool:
        enough = min(1.0, 0.5 * (_amsl_of(guidance, relative_m) - stood_amsl_m))
        return bool(snapshot.armed) and guidance.here()[1] - stood_amsl_m > enough

    deadline, attempt = Deadline(clock, LEAVE_GROUND_S, 5.0), 1
    trouble: AutopilotRefused | CommandUnanswered | TakeOffIgnored = TakeOffIgnored()
    while not deadline.passed:
        began_s = clock.now()
        try:
            modes = dialect.before_take_off.modes if snapshot.disarmed else dialect.take_off_modes
            if snapshot.custom_mode not in modes:
                await guidance.select(manoeuvre, dialect.before_take_off)
            if not snapshot.armed:
                await _arm(guidance, manoeuvre)
                await _hear_home(guidance, manoeuvre)
                stood_amsl_m = guidance.here()[1]
            take_off = dialect.take_off(relative_m, _amsl_of(guidance, relative_m))
            await guidance.send(manoeuvre, take_off, dialect.take_off_modes, "take_off")
            if await guidance.until(manoeuvre, Deadline(clock, 10.0, 2.0), rising):
                return
            trouble = TakeOffIgnored()
        except OutOfMode:
            trouble = TakeOffIgnored()
        except CommandDenied as denied:
            trouble = denied.refusal
        except CommandLost as lost:
            trouble = lost.unanswered
        attempt += 1
        if await guidance.until(manoeuvre, Deadline(clock, 2.0, 0.2), rising):
            return  # the order whose answer was lost was carried out; in the air an autopilot refuses it
        if isinstance(trouble, AutopilotRefused):  # why comes as a text, a moment after the answer
            trouble = replace(trouble, said=" / ".join(monitor.said_since(began_s)[-MOST_SAID:]))
        monitor.announce(TriedAgain(trouble, attempt))
    raise VehicleError(NoTakeOff(LEAVE_GROUND_S, trouble))
