"""The machine's answers to an operator's commands. Pure; see machine.py for how a step is built."""

from __future__ import annotations

from typing import assert_never

from backend.commands import (
    Abort,
    Accept,
    AcknowledgeAlert,
    ChangeArea,
    ExcludeBearing,
    Hold,
    Override,
    Resume,
    Return,
    SetAutomatic,
    Start,
    Veto,
)
from backend.events import (
    AbortOrdered,
    AlertAcknowledged,
    AreaChanged,
    AutomaticChanged,
    BearingExcluded,
    CommandAccepted,
    CommandRefused,
    ControlReleased,
    HoldOrdered,
    MissionStarted,
    PlanChosen,
    PlanVetoed,
    PreflightChecked,
    ResumeOrdered,
    ReturnOrdered,
    SafetyVetoed,
)
from backend.mission.effects import (
    CancelTimer,
    CancelWork,
    HoldVehicle,
    ReleasePilotLatch,
    Reply,
    ReturnHome,
    SearchElsewhere,
    UpdateBelief,
)
from backend.mission.inputs import Commanded
from backend.mission.state import AUTOMATIC, GROUND, HOMEWARD, TERMINAL
from backend.mission.step import Step, clear_alerts, end, forget_failsafe, go_on, take_off

NOT_STARTED = ("the mission has not started", "start it first")
ENDED = ("the mission has ended", "draft a new one")
PILOT = ("the pilot has control: nothing is sent to the vehicle", "resume when the pilot has given control back")


class Refused(Exception):
    """Why a command is not carried out, and what to do about it."""

    def __init__(self, reason: str, remedy: str) -> None:
        super().__init__(reason)
        self.remedy = remedy


def answer(step: Step, given: Commanded) -> None:
    """Carry out or refuse one command. A command id that was answered before gets the same answer and does nothing."""
    before = step.state.answered.get(given.command_id)
    if before is not None:
        step.do(Reply(given.command_id, before.accepted, before.reason, before.remedy))
        return
    try:
        _carry_out(step, given)
    except Refused as refused:
        step.record(
            CommandRefused(
                command_id=given.command_id,
                command=given.command.kind,
                by=given.by,
                reason=str(refused),
                remedy=refused.remedy,
            )
        )
        step.do(Reply(given.command_id, False, str(refused), refused.remedy))
    else:
        step.record(CommandAccepted(command_id=given.command_id, command=given.command.kind, by=given.by))
        step.do(Reply(given.command_id, True, "", ""))


def _carry_out(step: Step, given: Commanded) -> None:
    command, by = given.command, given.by
    match command:
        case Start():
            _start(step, given)
        case Hold():
            _hold(step, given)
        case Resume():
            _resume(step, given)
        case Return():
            _return(step, given)
        case Abort():
            _abort(step, given)
        case Override():
            _override(step, given, command)
        case ChangeArea():
            _change_area(step, given, command)
        case Accept():
            _accept(step)
        case Veto():
            _veto(step, by)
        case SetAutomatic(automatic=automatic):
            _set_automatic(step, automatic, by)
        case ExcludeBearing():
            _exclude(step, command, by)
        case AcknowledgeAlert(alert_id=alert_id):
            if alert_id not in step.state.open_alerts:
                raise Refused("there is no such open alert", "it may have cleared by itself")
            step.record(AlertAcknowledged(alert_id=alert_id, by=by))
        case _:
            assert_never(command)


def _start(step: Step, given: Commanded) -> None:
    state, facts = step.state, given.start
    if state.phase not in GROUND:
        raise Refused("the mission has started already", "draft a new one to fly again")
    if facts is None:
        raise Refused("nothing is known of the vehicle", "connect the vehicle and ask again")
    failed = [c for c in facts.checks if c.blocking and not c.ok]
    step.record(PreflightChecked(passed=not failed, checks=list(facts.checks)))
    if failed:
        raise Refused(f"preflight: {failed[0].name}: {failed[0].detail}", failed[0].remedy)
    _refuse_objections(step, given)
    if facts.home is None or facts.home_amsl_m is None:
        raise Refused("the vehicle has no home position", "wait for a GPS fix")
    started = MissionStarted(
        by=given.by,
        home=facts.home,
        home_amsl_m=facts.home_amsl_m,
        software=facts.software,
        antenna=facts.antenna,
    )
    step.record(started)
    step.do(ReleasePilotLatch())
    go_on(step, f"started by {given.by}")


def _hold(step: Step, given: Commanded) -> None:
    state, by = step.state, given.by
    if state.phase in GROUND:
        raise Refused(*NOT_STARTED)
    if state.pilot_has_control:
        raise Refused(*PILOT)
    _refuse_when_down(step, given)
    step.do(CancelWork())
    _take_from_failsafe(step, given)
    step.do(HoldVehicle())
    step.record(HoldOrdered(by=by, reason="ordered"))
    if state.phase not in TERMINAL:
        step.go("hold", f"held by {by}")


def _resume(step: Step, given: Commanded) -> None:
    state, by = step.state, given.by
    if state.phase in GROUND:
        raise Refused(*NOT_STARTED)
    if state.phase in TERMINAL:
        raise Refused(*ENDED)
    if state.phase not in ("hold", "manual"):
        raise Refused("the mission is not held", "")
    if "vehicle" in state.links_down:
        raise Refused("the link to the vehicle is lost", "wait until the vehicle answers again")
    _refuse_objections(step, given)
    step.record(ResumeOrdered(by=by))
    if state.pilot_has_control:
        step.record(ControlReleased(by=by))
    step.do(ReleasePilotLatch())
    clear_alerts(step, "pilot", "failure", "safety", "vehicle", "ground")
    step.do(CancelTimer("console_hold"))
    step.do(CancelTimer("console_return"))
    if given.on_ground and not state.localized:
        take_off(step, f"resumed by {by}")
    else:
        go_on(step, f"resumed by {by}")


def _return(step: Step, given: Commanded) -> None:
    state, by = step.state, given.by
    if state.phase in GROUND:
        raise Refused(*NOT_STARTED)
    if state.pilot_has_control:
        raise Refused(*PILOT)
    if state.phase in TERMINAL:
        _refuse_when_down(step, given)
        step.do(ReturnHome())
        step.record(ReturnOrdered(by=by, reason="ordered after the mission's end"))
        return
    if state.phase == "landing":
        raise Refused("the vehicle is landing at home already", "hold stops the landing")
    step.do(CancelWork())
    _take_from_failsafe(step, given)
    step.record(ReturnOrdered(by=by, reason="ordered"))
    step.go("returning", f"return ordered by {by}")
    step.do(ReturnHome())


def _abort(step: Step, given: Commanded) -> None:
    state, by = step.state, given.by
    if state.phase in GROUND:
        raise Refused(*NOT_STARTED)
    if state.phase in TERMINAL:
        raise Refused(*ENDED)
    step.do(CancelWork())
    _take_from_failsafe(step, given)
    if not state.pilot_has_control:
        step.do(ReturnHome(hold_first=True))
    step.record(AbortOrdered(by=by, reason="ordered"))
    end(step, "aborted", "aborted", f"aborted by {by}")


def _override(step: Step, given: Commanded, command: Override) -> None:
    state = step.state
    if state.phase in GROUND:
        raise Refused(*NOT_STARTED)
    if state.phase in TERMINAL:
        raise Refused(*ENDED)
    if state.pilot_has_control:
        raise Refused(*PILOT)
    if state.phase in HOMEWARD:
        raise Refused("the vehicle is on its way home", "hold and resume first, to go on searching")
    _refuse_objections(step, given)
    if state.phase in AUTOMATIC and state.took_off:
        step.do(CancelWork())
    number = state.place_number + (1 if state.chosen is None or state.attempt > 0 else 0)
    step.record(
        PlanChosen(
            place_number=max(number, 1),
            place=command.place,
            source="operator",
            reason=f"chosen by {given.by}",
            expected_time_s=None,
            time_90_s=None,
            candidates=[],
            rollouts=0,
            plan_ms=0.0,
            by=given.by,
        )
    )
    if state.phase in AUTOMATIC and state.took_off:
        go_on(step, f"place chosen by {given.by}")


def _change_area(step: Step, given: Commanded, command: ChangeArea) -> None:
    state = step.state
    if state.phase in GROUND:
        raise Refused(NOT_STARTED[0], "edit the draft")
    if state.phase in TERMINAL:
        raise Refused(*ENDED)
    if state.pilot_has_control:
        raise Refused(*PILOT)
    if state.phase != "hold":
        raise Refused("the search area is changed in hold only", "hold, then change it")
    _refuse_objections(step, given)
    step.record(AreaChanged(search=command.search, by=given.by))
    step.do(SearchElsewhere())
    step.do(UpdateBelief())


def _accept(step: Step) -> None:
    if step.state.phase != "waiting":
        raise Refused("no place is waiting to be accepted", "")
    go_on(step, "place accepted", accepted=True)


def _veto(step: Step, by: str) -> None:
    state = step.state
    if state.chosen is None or state.phase not in ("waiting", "flying", "hold"):
        raise Refused("there is no proposed place to refuse", "")
    if state.phase == "flying":
        step.do(CancelWork())
        step.do(HoldVehicle())
    step.record(PlanVetoed(place=state.chosen.place, by=by))
    if state.phase != "hold":
        go_on(step, f"place refused by {by}")


def _set_automatic(step: Step, automatic: bool, by: str) -> None:
    if step.state.phase in TERMINAL:
        raise Refused(*ENDED)
    step.record(AutomaticChanged(automatic=automatic, by=by))
    if step.state.phase == "waiting" and automatic:
        go_on(step, "automatic acceptance armed")


def _exclude(step: Step, command: ExcludeBearing, by: str) -> None:
    state = step.state
    if command.bearing_id not in {b.bearing_id for b in state.measured}:
        raise Refused("this mission has no such bearing", "reload the page")
    if command.bearing_id in state.excluded:
        raise Refused("the bearing is excluded already", "")
    if state.phase in TERMINAL:
        raise Refused(*ENDED)
    step.record(BearingExcluded(bearing_id=command.bearing_id, by=by, reason=command.reason))
    if state.phase in ("planning", "waiting"):
        step.do(CancelWork())
        go_on(step, f"bearing excluded by {by}")
    else:
        step.do(UpdateBelief())


def _take_from_failsafe(step: Step, given: Commanded) -> None:
    """An explicit deed, as resuming is; a pilot's own control is never released by it."""
    if given.failsafe_flies and not step.state.pilot_has_control:
        step.do(ReleasePilotLatch())
        forget_failsafe(step)


def _refuse_when_down(step: Step, given: Commanded) -> None:
    """After its end a mission still answers hold and return while an aborted vehicle flies home."""
    if step.state.phase in TERMINAL and (step.state.phase != "aborted" or given.objections):
        raise Refused(*ENDED)


def _refuse_objections(step: Step, given: Commanded) -> None:
    for veto in given.objections:
        step.record(SafetyVetoed(rule=veto.rule, detail=veto.detail, remedy=veto.remedy))
    if given.objections:
        raise Refused(given.objections[0].detail, given.objections[0].remedy)
