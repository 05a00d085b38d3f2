"""The mission machine: transition(state, input, at) -> (state, effects). No await, no clock, no input or output.

Every input is answered in every state. The rules that hold throughout (design, section 4): hold and abort act at once
in every phase of flight; in hold and manual nothing moves until an operator resumes, orders the return or aborts (or,
in hold, the console-lost timer runs out); a pilot's takeover silences everything; ended missions stay ended.
"""

from __future__ import annotations

from typing import assert_never

from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    ControlTaken,
    HoldOrdered,
    LinkLost,
    LinkRestored,
    MissionEdited,
    PlaceReached,
    PreflightChecked,
    ReturnOrdered,
    ServerRestarted,
    TookOff,
)
from backend.mission import operator
from backend.mission.effects import (
    CancelTimer,
    CancelWork,
    Effect,
    HoldVehicle,
    Land,
    ReturnHome,
    StartTimer,
    UpdateBelief,
)
from backend.mission.inputs import (
    Arrived,
    BatteryLow,
    BatteryReported,
    BeliefReady,
    Commanded,
    Edited,
    FailsafeActs,
    FailsafeStopped,
    HomeReached,
    Input,
    Interrupted,
    InTheAir,
    Landed,
    Link,
    LinkDown,
    LinkUp,
    NothingToPlan,
    NotStored,
    PilotTookOver,
    Planned,
    PreflightDone,
    Restarted,
    SweepRefused,
    SweepTaken,
    TimerExpired,
    WorkFailed,
    WorkVetoed,
)
from backend.mission.state import AUTOMATIC, GROUND, HOMEWARD, TERMINAL, MissionState
from backend.mission.step import (
    LOCALIZED,
    Step,
    alert,
    clear_alerts,
    end,
    finish,
    forget_failsafe,
    go_home,
    go_on,
    hold,
    measure,
    refuse_flight,
    why_not_yet,
)

LANDING_PATIENCE_S = 120.0
UNSURE_PLACE_M = 5.0
"""A vehicle that hovers stays within this; what it reports beyond is told."""


def transition(state: MissionState, given: Input, at_s: float) -> tuple[MissionState, tuple[Effect, ...]]:
    """The state after `given`, and what is to be done about it, in order. `at_s`: UTC epoch seconds of the input.

    The new state is the fold of the recorded facts onto the old one.
    """
    step = Step(state, at_s)
    match given:
        case Commanded():
            operator.answer(step, given)
        case Edited(spec=spec):
            if state.phase in GROUND:
                step.record(MissionEdited(spec=spec))
                step.go("draft", "edited")
        case PreflightDone():
            _preflight(step, given)
        case InTheAir() | Planned() | NothingToPlan() | Arrived() | SweepTaken() | SweepRefused():
            _finished(step, given)
        case BeliefReady():
            _belief(step, given)
        case WorkFailed():
            _failed(step, given)
        case WorkVetoed(vetoes=vetoes):
            if state.phase in AUTOMATIC:
                refuse_flight(step, vetoes)
        case PilotTookOver():
            _pilot(step, given)
        case FailsafeActs(mode=mode):
            if state.phase in AUTOMATIC | {"hold"} and not state.pilot_has_control:
                step.do(CancelWork())
                _failsafe_flies(step, f"it went into {mode} because it had not heard from here")
                step.go("hold", "the autopilot is bringing the vehicle home")
        case FailsafeStopped(mode=mode):
            if state.phase == "hold" and not state.pilot_has_control:
                text = f"the autopilot's own way home ended in {mode}, perhaps by an earlier order"
                alert(step, "vehicle", "caution", text, "look at the vehicle, then hold or resume")
        case LinkDown():
            _link_down(step, given)
        case LinkUp():
            _link_up(step, given)
        case BatteryLow() | BatteryReported() | HomeReached() | Landed():
            _vehicle(step, given)
        case TimerExpired():
            _timer(step, given)
        case NotStored(detail=detail):
            if state.phase not in GROUND:
                text = f"not everything of this mission can be stored: {detail}"
                alert(step, "storage", "warning", text, "it is kept beside the journal's spool; the flight goes on")
        case Interrupted(detail=detail):
            if state.phase not in GROUND and state.phase not in TERMINAL:
                clear_alerts(step, *(alert_id.rsplit("-", 1)[0] for alert_id in state.open_alerts))
                end(step, "failed", "failed", f"interrupted: {detail}{why_not_yet(state)}")
        case Restarted():
            _restarted(step, given)
        case _:
            assert_never(given)
    return step.state, tuple(step.effects)


def _preflight(step: Step, given: PreflightDone) -> None:
    passed = all(check.ok or not check.blocking for check in given.checks)
    if step.state.phase in TERMINAL:
        return
    step.record(PreflightChecked(passed=passed, checks=list(given.checks)))
    if step.state.phase in GROUND:
        step.go("ready" if passed else "draft", "preflight passed" if passed else "preflight failed")


def _finished(step: Step, given: InTheAir | Planned | NothingToPlan | Arrived | SweepTaken | SweepRefused) -> None:
    """A step's result counts only in the phase that asked for it."""
    state = step.state
    match given:
        case InTheAir() if state.phase == "taking_off":
            step.record(TookOff(place=given.place, altitude_relative_m=given.altitude_relative_m))
            go_on(step, "at altitude")
        case Planned(choice=choice, vetoes=vetoes) if state.phase == "planning":
            if vetoes:
                refuse_flight(step, vetoes)
            else:
                step.record(choice)
                go_on(step, f"to place {choice.place_number}")
        case NothingToPlan(reason=reason) if state.phase == "planning":
            go_home(step, f"not localized: {reason}{why_not_yet(state)}")
        case Arrived() if state.phase == "flying":
            step.record(
                PlaceReached(
                    place_number=state.place_number,
                    place=given.place,
                    distance_m=given.distance_m,
                    flight_time_s=given.flight_time_s,
                )
            )
            measure(step, "place reached")
        case SweepTaken(bearing=bearing) if state.phase == "measuring":
            step.record(bearing)
            _doubt_place(step, bearing)
            go_on(step, "bearing taken")
        case SweepRefused(sweep=sweep) if state.phase == "measuring":
            step.record(sweep)
            if step.state.chosen is None:
                go_on(step, f"no usable bearing here: {sweep.reason}")
            else:
                measure(step, f"taken again: {sweep.reason}")
        case _:
            return


def _doubt_place(step: Step, bearing: BearingMeasured) -> None:
    if bearing.drift_m > UNSURE_PLACE_M:
        text = f"the place of bearing {bearing.place_number} is unsure by {bearing.drift_m:.0f} m; it counts for less"
        alert(step, "place", "caution", text, "its reported position jumped, or wind moved it: look at GPS and wind")
    else:
        clear_alerts(step, "place")


def _doubt_heading(step: Step, belief: BeliefUpdated) -> None:
    offset_deg, std_error_deg = belief.heading_offset_deg, belief.heading_offset_std_error_deg
    if offset_deg is not None and std_error_deg is not None:
        text = (
            f"the bearings of this flight disagree by a common offset of about {offset_deg:+.0f} "
            f"± {std_error_deg:.0f} degrees: the place found may be wrong"
        )
        alert(step, "heading", "caution", text, "check compass and antenna mounting; one wrong place looks alike")
    else:
        clear_alerts(step, "heading")


def _belief(step: Step, given: BeliefReady) -> None:
    state = step.state
    if given.bearing_ids != state.bearing_ids or state.belief_current:
        return
    fact: BeliefUpdated = given.fact
    step.record(fact)
    _doubt_heading(step, fact)
    if state.phase == "planning":
        go_on(step, "belief updated")
    elif fact.localized and state.phase in ("flying", "measuring"):
        go_home(step, LOCALIZED)


def _failed(step: Step, given: WorkFailed) -> None:
    phase, way_home = step.state.phase, given.step in ("return", "land")
    if phase in GROUND or step.state.pilot_has_control:
        return
    unheard = "vehicle" in step.state.links_down and (way_home or given.step == "hold")
    remedy = "it is ordered again when the vehicle is heard" if unheard else given.remedy
    alert(step, "failure", "warning", given.detail, remedy)
    if phase == "taking_off" and given.step == "take_off" and given.in_air is False:
        step.do(CancelWork())
        end(step, "failed", "failed", given.detail)
    elif phase in AUTOMATIC or (phase in HOMEWARD and way_home and not unheard):
        hold(step, given.detail)


def _pilot(step: Step, given: PilotTookOver) -> None:
    state = step.state
    if state.phase in GROUND or state.pilot_has_control:
        return
    step.do(CancelWork())
    for name in ("console_hold", "console_return", "landing"):
        step.do(CancelTimer(name))
    step.record(ControlTaken(mode=given.mode, detail=given.detail))
    if state.phase not in TERMINAL:
        forget_failsafe(step)
        if given.perhaps_failsafe:
            text = f"the pilot or the autopilot's own failsafe has control: {given.detail}"
        else:
            text = f"the pilot has control: {given.detail}"
        alert(step, "pilot", "caution", text, "resume when he has given it back")
        step.go("manual", given.detail)


def _concerned(state: MissionState, link: Link) -> bool:
    """An aborted mission's vehicle still flies home."""
    return state.phase not in GROUND | TERMINAL or (state.phase == "aborted" and link == "vehicle")


def _link_down(step: Step, given: LinkDown) -> None:
    state = step.state
    if not _concerned(state, given.link) or given.link in state.links_down:
        return
    step.record(LinkLost(link=given.link, detail=given.detail))
    match given.link:
        case "vehicle":
            text = f"vehicle link lost: {given.detail}"
            alert(step, "vehicle", "warning", text, "its failsafe acts; restore the link")
            if state.phase in AUTOMATIC:
                step.do(CancelWork())
                step.go("hold", "vehicle link lost")
        case "receiver":
            alert(step, "receiver", "caution", f"receiver: {given.detail}", "check the receiver, then resume")
            if state.phase == "measuring":
                hold(step, f"receiver: {given.detail}")
        case "payload":
            alert(step, "payload", "caution", f"payload link lost: {given.detail}", "check the companion's link")
        case "console":
            step.do(StartTimer("console_hold", state.mission.timers.console_lost_hold_s))
            step.do(StartTimer("console_return", state.mission.timers.console_lost_return_s))
        case _:
            assert_never(given.link)


def _link_up(step: Step, given: LinkUp) -> None:
    state = step.state
    if not _concerned(state, given.link) or given.link not in state.links_down:
        return
    step.record(LinkRestored(link=given.link, outage_s=given.outage_s))
    clear_alerts(step, given.link)
    if given.link == "console":
        step.do(CancelTimer("console_hold"))
        step.do(CancelTimer("console_return"))
    elif given.link == "vehicle" and not state.pilot_has_control:
        _heard_again(step, given.going_home)


def _heard_again(step: Step, going_home: bool) -> None:
    """What was ordered last is ordered again: the vehicle may not have heard it."""
    state = step.state
    if state.phase in HOMEWARD or (state.phase == "aborted" and state.homebound):
        clear_alerts(step, "failure")
        step.do(Land() if state.phase == "landing" else ReturnHome())
    elif state.phase == "hold" and going_home:
        _failsafe_flies(step, "its failsafe acted while the link was lost")
    elif state.phase in ("hold", "aborted") and not going_home:
        step.do(HoldVehicle())


def _vehicle(step: Step, given: BatteryLow | BatteryReported | HomeReached | Landed) -> None:
    phase = step.state.phase
    match given:
        case BatteryLow(detail=detail) if phase in AUTOMATIC or phase in ("hold", "manual"):
            alert(step, "battery", "warning", detail, "return home now")
            if phase in AUTOMATIC:
                step.record(ReturnOrdered(by="mission", reason=detail))
                go_home(step, detail)
        case BatteryReported():
            clear_alerts(step, "battery")
        case HomeReached() if phase == "returning":
            step.go("landing", "above home")
            step.do(StartTimer("landing", LANDING_PATIENCE_S))
        case Landed() if phase in HOMEWARD:
            finish(step, step.state.return_reason)
        case Landed() if phase == "manual":
            finish(step, "the vehicle landed while the pilot or its own failsafe had control")
        case Landed() if phase == "hold" or (phase in AUTOMATIC and phase != "taking_off"):
            _on_the_ground(step)
        case _:
            return


def _on_the_ground(step: Step) -> None:
    """The mission did not bring it down (a failsafe did, or a return from before a restart). What it found is kept."""
    if step.state.localized:
        step.do(CancelWork())
        finish(step, "the vehicle landed")
        return
    text = "the vehicle landed while the mission was held"
    if step.state.phase in AUTOMATIC:
        text = "the vehicle landed without being told to"
        step.do(CancelWork())
        step.go("hold", text)
    if not any(alert_id.startswith("ground-") for alert_id in step.state.open_alerts):
        forget_failsafe(step)
        alert(step, "ground", "warning", text, "resume to take off again, abort to end the mission")


def _timer(step: Step, given: TimerExpired) -> None:
    phase = step.state.phase
    match given.name:
        case "console_hold" if phase in AUTOMATIC:
            step.record(HoldOrdered(by="mission", reason="no console is connected"))
            alert(step, "console", "warning", "no console is connected", "connect a console and resume")
            hold(step, "no console is connected")
        case "console_return" if phase in AUTOMATIC or phase == "hold":
            step.record(ReturnOrdered(by="mission", reason="no console came back"))
            go_home(step, "no console came back")
        case "landing" if phase == "landing":
            step.do(Land())
        case _:
            return


def _restarted(step: Step, given: Restarted) -> None:
    """Rule 4: back in hold with the same belief; a vehicle that a pilot flies is not touched."""
    state = step.state
    if state.phase in GROUND or state.phase in TERMINAL:
        return
    step.record(ServerRestarted(detail=given.detail))
    clear_alerts(step, "vehicle", "receiver", "console", "payload")
    if state.pilot_has_control:
        step.do(UpdateBelief())
        return
    if given.pilot:
        step.record(ControlTaken(mode="unknown", detail="the pilot had control when the server came back"))
        step.go("manual", "the pilot had control when the server came back")
    elif given.going_home:
        if state.phase in HOMEWARD:
            _failsafe_flies(step, "the return was ordered before the server was away")
        else:
            _failsafe_flies(step, "its failsafe acted while the server was away")
        step.go("hold", "the server restarted; the autopilot is bringing the vehicle home")
    else:
        step.do(HoldVehicle())
        step.go("hold", "the server restarted")
    step.do(UpdateBelief())


def _failsafe_flies(step: Step, why: str) -> None:
    remedy = "resume to go on searching, or let it land"
    alert(step, "vehicle", "caution", f"the autopilot is on its own way home: {why}", remedy)
