"""A battery that runs low belongs to somebody: automatic flight returns at once, a held craft after a countdown.

Who holds it may stop the countdown once a flight. Lower still it returns without asking, and when it would not get home
any more it lands where it is. While a pilot flies an alert says so, and nothing is sent.
"""

from __future__ import annotations

from backend.craft.effects import CancelTimer, CancelWork, StartTimer
from backend.craft.inputs import BatteryLow
from backend.craft.state import AUTOMATIC, HOMEWARD
from backend.craft.step import CraftStep, alert, bring_down, clear_alerts, go_home
from backend.events import BatteryCountdownStarted, BatteryCountdownStopped, LandOrdered, ReturnOrdered
from backend.reasons import Reason
from backend.reasons.refusals import NoCountdown
from backend.reasons.refused import Refused

COUNTDOWN_S = 30.0
LANDING_PATIENCE_S = 120.0
"""A landing that takes longer is ordered again."""


def low(step: CraftStep, given: BatteryLow) -> None:
    """What becomes of a craft whose battery is this low."""
    craft, because = step.craft, given.because
    coming = craft.phase in HOMEWARD
    if craft.phase in ("ground", "landing") or (coming and given.stage != "land"):
        return
    alert(step, "battery", "warning", because)
    if craft.taken_over or craft.phase == "manual" or step.comes_by_itself:
        return
    if given.stage == "land":
        _land_here(step, because)
    elif craft.phase in AUTOMATIC or given.stage == "last":
        _return(step, because)
    elif not (craft.counting_down or craft.countdown_stopped):
        step.record(BatteryCountdownStarted(craft_id=craft.craft_id, seconds=COUNTDOWN_S, reason=because))
        step.do(StartTimer("battery_return", COUNTDOWN_S))


def suffices(step: CraftStep) -> None:
    """The battery was heard to suffice again."""
    clear_alerts(step, "battery")
    if step.craft.counting_down:
        _stop(step, None)


def counted_down(step: CraftStep) -> None:
    """Nobody stopped it. One that was, or whose hold is over, no longer counts; a failsafe brings it home by itself."""
    craft = step.craft
    raised = [raised.reason for raised in craft.open_alerts if raised.topic == "battery"]
    if not craft.counting_down:
        return
    if step.comes_by_itself or not raised:
        _stop(step, None)
    else:
        _return(step, raised[0])


def keep_holding(step: CraftStep, by: str) -> None:
    """Raises Refused when nothing counts down."""
    if not step.craft.counting_down:
        raise Refused(NoCountdown())
    _stop(step, by)


def _stop(step: CraftStep, by: str | None) -> None:
    step.record(BatteryCountdownStopped(craft_id=step.craft.craft_id, by=by))
    step.do(CancelTimer("battery_return"))


def _return(step: CraftStep, because: Reason) -> None:
    step.record(ReturnOrdered(craft_id=step.craft.craft_id, by=None, reason=because))
    go_home(step, because)


def _land_here(step: CraftStep, because: Reason) -> None:
    step.do(CancelWork())
    step.record(LandOrdered(craft_id=step.craft.craft_id, by=None, reason=because))
    step.go("landing", because)
    step.do(StartTimer("landing", LANDING_PATIENCE_S))
    bring_down(step, "land")
