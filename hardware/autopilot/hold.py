"""Hold: one order after the other until the vehicle brakes, then wait until it hovers.

PX4 holds at a place that it reckons ahead while it still flies. It comes to rest metres beside that place and then
creeps there, so a second order to stay follows as soon as it is slow. While it brakes it turns its nose to that place,
at up to 70 degrees a second, from a swing all the way round, so the nose is ordered to stay where it is. The order to
stay takes that back, and over it PX4 is carried metres on: the nose is ordered once more.
"""

from __future__ import annotations

from collections.abc import Callable

from hardware.autopilot.commander import CommandDenied, Manoeuvre, ManoeuvreSuperseded, OutOfMode
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.hover import Hover
from hardware.autopilot.messages import Outgoing, yaw_alone
from hardware.deadline import Deadline
from hardware.ports import NotInControl, VehicleError
from hardware.reasons.vehicle import AutopilotRefused, DoesNotHold, HoldIgnored
from hardware.reasons.vehicle_news import StillMoving, TriedAgain

BRAKES_S, BRAKES_WALL_S = 3.0, 1.5
"""This long after a hold was ordered, the vehicle must be in a hold mode and slower."""
SLOWER, NEVER_FAST_M_S = 0.6, 2.0
"""Slower: than this share of the highest speed since the order; what was never faster than NEVER_FAST_M_S need not."""
TAKEN_S = 0.2
"""An order to hold that has arrived is surely taken after this. One of the nose alone that is taken together with it
would put the place that was flown to before in its stead; PX4 looks for orders twenty times a second."""
STAYS_M_S = 0.5
"""A vehicle this slow stops within some ten centimetres."""
HOVERS_S, HOVERS_WALL_S = 20.0, 2.0
"""A vehicle that holds and in all this time does not come to rest is in a strong wind: that is news, not an error."""


async def hold(guidance: Guidance) -> None:
    """Returns once the vehicle hovers. Raises VehicleError when it obeys no order to hold."""
    monitor, dialect = guidance.monitor, guidance.monitor.dialect
    manoeuvre = guidance.begin("hold")
    if monitor.snapshot.disarmed:
        return
    trouble: AutopilotRefused | HoldIgnored = HoldIgnored()
    for number, outgoing in enumerate(dialect.hold, 1):
        if not (outgoing.changes_mode or monitor.snapshot.custom_mode in dialect.hold_modes):
            continue
        try:
            if await _holds(guidance, manoeuvre, outgoing):
                return
            trouble = HoldIgnored()
        except OutOfMode:  # what it did before has just shown its mode: the next order changes it
            trouble = HoldIgnored()
        except CommandDenied as denied:
            trouble = denied.refusal
        if number < len(dialect.hold):
            monitor.announce(TriedAgain(trouble, number + 1))
    raise VehicleError(DoesNotHold(trouble))


async def _holds(guidance: Guidance, manoeuvre: Manoeuvre, outgoing: Outgoing) -> bool:
    """True when it came to rest, or at least obeys; False when it does not."""
    monitor, dialect, snapshot = guidance.monitor, guidance.monitor.dialect, guidance.monitor.snapshot
    snapshot.fastest_m_s = snapshot.speed_m_s or 0.0
    await guidance.send(manoeuvre, outgoing, dialect.hold_modes, "hold")
    brakes = Deadline(monitor.clock, BRAKES_S, BRAKES_WALL_S)
    rests = Deadline(monitor.clock, HOVERS_S, HOVERS_WALL_S)
    turns_nose = snapshot.fastest_m_s > NEVER_FAST_M_S and dialect.hold_turns_nose
    if turns_nose:
        await _keep_nose(guidance, manoeuvre)
    hover, hovers = Hover(), False

    def obeys() -> bool:
        slower = (snapshot.speed_m_s or 0.0) <= max(NEVER_FAST_M_S, SLOWER * snapshot.fastest_m_s)
        return slower and snapshot.custom_mode in dialect.hold_modes

    def nearly_rests() -> bool:
        return obeys() and snapshot.speed_m_s is not None and snapshot.speed_m_s < STAYS_M_S

    def decided() -> bool:
        nonlocal hovers
        if snapshot.position is not None and snapshot.position_at_s is not None:
            in_mode = snapshot.custom_mode in dialect.hold_modes
            hovers = hover.see(snapshot.position, snapshot.speed_m_s, snapshot.position_at_s, in_mode)
        return hovers or (brakes.passed and not obeys())

    stay = dialect.stay
    if stay is not None:
        await guidance.until(manoeuvre, rests, lambda: decided() or nearly_rests())
        if nearly_rests():
            await _said(guidance, manoeuvre, lambda: stay)
            if turns_nose:
                await _keep_nose(guidance, manoeuvre)
    if await guidance.until(manoeuvre, rests, decided):
        return hovers
    monitor.announce(StillMoving(snapshot.speed_m_s or 0.0))
    return True


async def _keep_nose(guidance: Guidance, manoeuvre: Manoeuvre) -> None:
    """The nose stays where it is while the vehicle brakes: sent again, where it is by then."""
    snapshot, modes = guidance.monitor.snapshot, guidance.monitor.dialect.hold_modes
    await guidance.until(manoeuvre, Deadline(guidance.monitor.clock, TAKEN_S), lambda: False)
    if snapshot.heading_deg is not None and snapshot.custom_mode in modes:
        await _said(guidance, manoeuvre, lambda: yaw_alone(snapshot.heading_deg or 0.0))


async def _said(guidance: Guidance, manoeuvre: Manoeuvre, outgoing: Callable[[], Outgoing]) -> None:
    """Sent to a vehicle that holds. Refused or unanswered, it holds all the same, only less quietly."""
    monitor = guidance.monitor
    try:
        await monitor.commander.send(manoeuvre, outgoing(), monitor.dialect.hold_modes, "hold", again=outgoing)
    except (NotInControl, ManoeuvreSuperseded):
        raise
    except VehicleError:
        return
