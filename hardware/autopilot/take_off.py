"""Take-off: mode, arming and take-off are tried together, because an autopilot disarms while one waits between them."""

from __future__ import annotations

from hardware.autopilot.commander import CommandRefused, Manoeuvre
from hardware.autopilot.helm import Helm
from hardware.autopilot.messages import arm
from hardware.autopilot.patience import Deadline
from hardware.ports import VehicleError

LEAVE_GROUND_S = 60.0


async def take_off(helm: Helm, altitude_relative_m: float) -> None:
    """Returns once the vehicle hovers there. Raises VehicleError with the last trouble when it does not."""
    monitor = helm.monitor
    snapshot, dialect = monitor.snapshot, monitor.dialect
    amsl = helm.here()[1]
    target_amsl = amsl + altitude_relative_m - (snapshot.altitude_relative_m or 0.0)
    manoeuvre = helm.begin("Take-off")
    try:
        await _leave_ground(helm, manoeuvre, altitude_relative_m, target_amsl)
    finally:
        if snapshot.disarmed:
            monitor.latch.stand_down()
    slack = max(1.0, 0.03 * altitude_relative_m)

    def climbed() -> bool:
        up, velocity = snapshot.altitude_relative_m, snapshot.velocity_ned
        level = velocity is not None and abs(velocity[2]) < 0.5
        settled = snapshot.custom_mode in dialect.settled_modes
        return up is not None and up > altitude_relative_m - slack and level and settled

    if not await helm.until(manoeuvre, Deadline(monitor.clock, 30.0 + altitude_relative_m / 0.5), climbed):
        up = snapshot.altitude_relative_m or 0.0
        raise VehicleError(f"The vehicle climbed to {up:.1f} m only, not {altitude_relative_m:.1f} m.")
    helm.spot = (helm.here()[0], target_amsl)


async def _leave_ground(helm: Helm, manoeuvre: Manoeuvre, relative_m: float, amsl_m: float) -> None:
    monitor = helm.monitor
    snapshot, dialect, clock = monitor.snapshot, monitor.dialect, monitor.clock

    def rising() -> bool:
        up = snapshot.altitude_relative_m
        return bool(snapshot.armed) and up is not None and up > min(1.0, 0.5 * relative_m)

    deadline, trouble = Deadline(clock, LEAVE_GROUND_S, 5.0), "nothing tried"
    while not deadline.passed:
        try:
            await helm.select(manoeuvre, dialect.before_take_off)
            if not snapshot.armed:
                await helm.order(manoeuvre, arm(), dialect.take_off_modes, "arming")
                snapshot.arming_at_s = clock.now()
            take_off = dialect.take_off(relative_m, amsl_m)
            await helm.order(manoeuvre, take_off, dialect.take_off_modes, "take-off")
            if await helm.until(manoeuvre, Deadline(clock, 10.0, 2.0), rising):
                return
            trouble = "take-off was acknowledged but the vehicle stayed on the ground"
        except CommandRefused as refusal:
            trouble = str(refusal)
        monitor.announce(f"take-off tried again: {trouble}")
        await helm.until(manoeuvre, Deadline(clock, 2.0, 0.2), lambda: False)
    raise VehicleError(f"No take-off within {LEAVE_GROUND_S:.0f} s: {trouble}")
