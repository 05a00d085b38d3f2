"""The craft machine's answers to an operator's orders. Pure; see machine.py for how a step is built."""

from __future__ import annotations

import math
from typing import assert_never

from backend.commands import (
    Abort,
    Accept,
    Hold,
    KeepHolding,
    Land,
    Override,
    Resume,
    Return,
    SetAutomatic,
    Start,
    Veto,
)
from backend.craft.effects import CancelTimer, CancelWork, HoldVehicle, LeaveSearch, TakeControl
from backend.craft.inputs import CraftOrdered
from backend.craft.low_battery import keep_holding
from backend.craft.state import AUTOMATIC, HOMEWARD, CraftState, failsafe_has
from backend.craft.step import (
    CraftStep,
    cancel_timers,
    clear_alerts,
    clear_failsafe,
    go_on,
    insist,
    record_vetoes,
    take_off_again,
)
from backend.events import (
    AbortOrdered,
    AuthorityChanged,
    AutomaticChanged,
    HoldOrdered,
    LandOrdered,
    MissionStarted,
    PlanChosen,
    PlanVetoed,
    PreflightChecked,
    ResumeOrdered,
    ReturnOrdered,
)
from backend.reasons import PreflightFailed, Reason, refusals
from backend.reasons.flight import Ordered
from backend.reasons.refused import Refused
from backend.reasons.safety import NoLink, PilotControls
from backend.search.state import SearchState
from backend.spec import Place
from hardware.authority import OperatorTookControl, authority_after
from hardware.frame import LocalFrame
from planner.policy.actions import SAME_PLACE_M


def carry_out(step: CraftStep, given: CraftOrdered) -> None:
    """Raises Refused, after the facts that led to it were recorded."""
    command = given.command
    match command:
        case Start():
            _start(step, given)
        case Hold():
            _hold(step, given)
        case Resume():
            _resume(step, given)
        case Return():
            _return(step, given)
        case Land():
            _land(step, given)
        case Abort():
            _abort(step, given)
        case KeepHolding():
            keep_holding(step, given.by)
        case Override():
            _override(step, given, command)
        case Accept():
            if step.craft.phase != "waiting":
                raise Refused(refusals.NoProposedPlace())
            go_on(step, Ordered("accept", given.by), accepted=True)
        case Veto():
            _veto(step, given)
        case SetAutomatic(automatic=automatic):
            _set_automatic(step, given, automatic)
        case _:
            assert_never(command)


def _start(step: CraftStep, given: CraftOrdered) -> None:
    search, facts = step.search, given.start
    if search.stage == "ended":
        raise Refused(refusals.MissionOver())
    if search.deleted:
        raise Refused(refusals.WasDeleted())
    if step.craft.engaged:
        raise Refused(refusals.AlreadyStarted())
    if facts is None:
        raise Refused(refusals.VehicleUnknown())
    failed = [check for check in facts.checks if check.blocking and not check.ok]
    step.record(PreflightChecked(passed=not failed, checks=list(facts.checks)))
    if failed:
        raise Refused(PreflightFailed(failed[0].name, failed[0].reason))
    _refuse_objections(step, given)
    if facts.home is None or facts.home_amsl_m is None:
        raise Refused(refusals.NoHome())
    step.record(
        MissionStarted(
            craft_id=step.craft.craft_id,
            by=given.by,
            home=facts.home,
            home_amsl_m=facts.home_amsl_m,
            software=facts.software,
            antenna=facts.antenna,
            ground=facts.ground,
            learned=facts.learned,
        )
    )
    _take_control(step, given.by)
    go_on(step, Ordered("start", given.by))


def _hold(step: CraftStep, given: CraftOrdered) -> None:
    """On an ended search, too: a vehicle of ours in the air is never out of reach."""
    _refuse_out_of_reach(step)
    step.do(CancelWork())
    _take_from_failsafe(step, given.by)
    step.record(HoldOrdered(craft_id=step.craft.craft_id, by=given.by, reason=None))
    insist(step, "hold")
    step.go("hold", Ordered("hold", given.by))


def _resume(step: CraftStep, given: CraftOrdered) -> None:
    craft, search = step.craft, step.search
    refused = resume_refusal(craft, search)
    if refused is not None:
        raise Refused(refused)
    _refuse_objections(step, given)
    step.record(ResumeOrdered(craft_id=craft.craft_id, by=given.by))
    _take_control(step, given.by)
    clear_alerts(step, "pilot", "failure", "safety", "vehicle", "ground", "order", "clock")
    step.do(CancelTimer("console_hold"))
    step.do(CancelTimer("console_return"))
    step.do(CancelTimer("order"))
    reason = Ordered("resume", given.by)
    if search.stage == "ended" or craft.nets_wait:  # control is taken back from a pilot, and that is all
        insist(step, "hold")
        step.go("hold", reason)
    elif given.on_ground and not search.found:
        take_off_again(step, reason)
    else:
        go_on(step, reason)


def _return(step: CraftStep, given: CraftOrdered) -> None:
    _refuse_out_of_reach(step)
    ladder = step.craft.ladder
    lands_at_home = ladder is None or ladder.way != "land"
    if step.craft.phase == "landing" and lands_at_home:
        raise Refused(refusals.LandingAlready())
    step.do(CancelWork())
    _take_from_failsafe(step, given.by)
    step.record(ReturnOrdered(craft_id=step.craft.craft_id, by=given.by, reason=None))
    step.go("returning", Ordered("return", given.by))
    insist(step, "return")


def _land(step: CraftStep, given: CraftOrdered) -> None:
    _refuse_out_of_reach(step)
    step.do(CancelWork())
    _take_from_failsafe(step, given.by)
    step.record(LandOrdered(craft_id=step.craft.craft_id, by=given.by, reason=None))
    step.go("landing", Ordered("land", given.by))
    insist(step, "land")


def _abort(step: CraftStep, given: CraftOrdered) -> None:
    """The search is over at once; the craft comes home, held first. So does one that was held after the end."""
    _refuse_not_started(step)
    ended = step.search.stage == "ended"
    if ended and step.craft.phase != "hold":
        raise Refused(refusals.MissionOver())
    reason = Ordered("abort", given.by)
    step.do(CancelWork())
    _take_from_failsafe(step, given.by)
    step.record(AbortOrdered(craft_id=step.craft.craft_id, by=given.by))
    cancel_timers(step)
    if not step.craft.taken_over:
        step.go("returning", reason)
        insist(step, "abort")
    if not ended:
        step.do(LeaveSearch(reason, "aborted"))


def _override(step: CraftStep, given: CraftOrdered, command: Override) -> None:
    craft = step.craft
    _refuse_not_started(step)
    if step.search.stage == "ended":
        raise Refused(refusals.MissionOver())
    if craft.taken_over:
        raise Refused(PilotControls())
    if craft.phase in HOMEWARD:
        raise Refused(refusals.OnTheWayHome())
    if craft.nets_wait:
        raise Refused(refusals.NetsChanging())
    _refuse_place_refused_before(craft, command.place)
    _refuse_objections(step, given)
    # a second climb from the ground, like the first, ends before anything flies elsewhere
    in_the_way = craft.phase in AUTOMATIC and craft.phase != "taking_off"
    if in_the_way:
        step.do(CancelWork())
    told = given.foretold
    number = step.search.place_number + 1 if craft.chosen is None or craft.attempt > 0 else craft.place_number
    step.record(
        PlanChosen(
            craft_id=craft.craft_id,
            place_number=max(number, 1),
            place=command.place,
            source="operator",
            reason=Ordered("override", given.by),
            expected_time_s=None if told is None else told.mean_s,
            time_90_s=None if told is None else told.p90_s,
            candidates=[],
            rollouts=0 if told is None else told.rollouts,
            plan_ms=0.0,
            by=given.by,
            altitude_amsl_m=given.altitude_amsl_m,
        )
    )
    if in_the_way:
        go_on(step, Ordered("override", given.by))


def _refuse_place_refused_before(craft: CraftState, place: Place) -> None:
    """As the planner keeps away from it: a metre beside it the autopilot would only refuse again."""
    near_m = min((math.hypot(*LocalFrame(place).to_enu(refused)) for refused in craft.refused), default=math.inf)
    if near_m < SAME_PLACE_M:
        raise Refused(refusals.PlaceRefusedBefore(near_m, SAME_PLACE_M))


def _veto(step: CraftStep, given: CraftOrdered) -> None:
    craft = step.craft
    if craft.chosen is None or craft.phase not in ("waiting", "flying", "hold"):
        raise Refused(refusals.NoProposedPlace())
    if craft.phase == "flying":
        step.do(CancelWork())
        step.do(HoldVehicle())
    step.record(PlanVetoed(craft_id=craft.craft_id, place=craft.chosen.place, by=given.by))
    if craft.phase != "hold":
        go_on(step, Ordered("veto", given.by))


def _set_automatic(step: CraftStep, given: CraftOrdered, automatic: bool) -> None:
    if step.search.stage == "ended":
        raise Refused(refusals.MissionOver())
    step.record(AutomaticChanged(craft_id=step.craft.craft_id, automatic=automatic, by=given.by))
    if step.craft.phase == "waiting" and automatic:
        go_on(step, Ordered("automatic", given.by))


def _take_from_failsafe(step: CraftStep, by: str) -> None:
    """An explicit deed, as resuming is; a pilot's own control is never taken by it."""
    if failsafe_has(step.craft.authority):
        _take_control(step, by)
        clear_failsafe(step)


def _take_control(step: CraftStep, by: str) -> None:
    """A fact at once: an order that comes before the vehicle has answered must not meet the pilot of before."""
    before = step.craft.authority
    after = authority_after(before, OperatorTookControl())
    if after != before:
        step.record(AuthorityChanged(craft_id=step.craft.craft_id, authority=after, by=by))
    step.do(TakeControl())


def resume_refusal(craft: CraftState, search: SearchState) -> Reason | None:
    """Why resuming is refused whatever safety says, None when it is not. From a pilot who has given back it takes
    control, without which nothing else can be ordered: nets that wait are no reason against that."""
    if not craft.engaged:
        return _not_started(search)
    if search.stage == "ended" and craft.phase != "manual":
        return refusals.MissionOver()
    if craft.phase not in ("hold", "manual"):
        return refusals.NotHeld()
    if "vehicle" in craft.links_down:
        return NoLink()
    return refusals.NetsChanging() if craft.nets_wait and craft.phase == "hold" and search.stage != "ended" else None


def _not_started(search: SearchState) -> Reason:
    return refusals.NotStarted() if search.stage in ("draft", "ready") else refusals.MissionOver()


def _refuse_not_started(step: CraftStep) -> None:
    if not step.craft.engaged:
        raise Refused(_not_started(step.search))


def _refuse_out_of_reach(step: CraftStep) -> None:
    _refuse_not_started(step)
    if step.craft.taken_over:
        raise Refused(PilotControls())


def _refuse_objections(step: CraftStep, given: CraftOrdered) -> None:
    record_vetoes(step, given.objections)
    for reason in given.objections:
        raise Refused(reason)
