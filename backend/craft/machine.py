"""The craft machine: transition(craft, search, input, at) -> effects. No await, no clock, no input or output.

Every input is answered in every state. The rules that hold throughout (design, section 4): hold and abort act at once
in every phase of flight; in hold and manual nothing moves until an operator resumes, orders the return or aborts (or,
in hold, the console-lost timer runs out); a pilot's takeover silences everything.
"""

from __future__ import annotations

from typing import assert_never

from backend.craft import low_battery, orders
from backend.craft.devices import clock_seen, losses_seen
from backend.craft.effects import CancelTimer, CancelWork, CraftEffect, StartTimer
from backend.craft.hanging import nets_looked_at
from backend.craft.inputs import (
    Abandoned,
    Arrived,
    AuthorityHeard,
    AutopilotReturns,
    BatteryLow,
    BatteryReported,
    Broke,
    CarriedOut,
    ChargeLow,
    ClockAgrees,
    ClockOdd,
    CraftInput,
    CraftOrdered,
    FailsafeEnded,
    HomeReached,
    InTheAir,
    Landed,
    Leaving,
    LinkDown,
    LinkUp,
    NetsNotTaken,
    NetsUp,
    NothingToPlan,
    PlaceNotTaken,
    Planned,
    ReceiverKeepsUp,
    ReceiverLoses,
    Restarted,
    Said,
    SaidNoMore,
    SearchChanged,
    SweepTaken,
    TimerExpired,
    WorkFailed,
    WorkVetoed,
)
from backend.craft.low_battery import LANDING_PATIENCE_S
from backend.craft.state import AUTOMATIC, HOMEWARD, ORDERED_BEFORE, CraftState, most_repeated_first
from backend.craft.step import (
    CraftStep,
    alert,
    arrived,
    bring_down,
    carried_out,
    clear_alerts,
    clear_failsafe,
    clear_said,
    come_down,
    doubt_place,
    go_home,
    go_on,
    hold,
    insist,
    measure,
    not_done,
    refuse_flight,
    start_console_timers,
    tell_said,
    try_rung,
)
from backend.craft.who_flies import authority_heard, restarted, tell_failsafe
from backend.events import (
    BearingMeasured,
    HoldOrdered,
    LinkLost,
    LinkRestored,
    PlaceReached,
    PlaceRefused,
    ReturnOrdered,
    SweepRejected,
    TookOff,
)
from backend.reasons import (
    AutopilotFliesHome,
    NotLocalized,
    NoUsableBearing,
    Reason,
    ReceiverTrouble,
    flight,
)
from backend.reasons.refused import Refused
from backend.reasons.search import Localized
from backend.search.effects import Refuse
from backend.search.state import SearchState

MOST_REFUSED = 3
"""This number of places in a row that the autopilot will not fly to is no accident."""


def transition(
    craft: CraftState, search: SearchState, given: CraftInput, at_s: float
) -> tuple[CraftState, tuple[CraftEffect, ...]]:
    """The state after `given`, and what is to be done about it, in order. `at_s`: UTC epoch seconds of the input.

    The new state is the fold of the recorded facts onto the old one.
    """
    step = CraftStep(craft, search, at_s)
    try:
        _take(step, given)
    except Refused as refused:
        step.do(Refuse(refused.reason))
    return step.craft, tuple(step.effects)


def _take(step: CraftStep, given: CraftInput) -> None:
    craft = step.craft
    match given:
        case CraftOrdered():
            orders.carry_out(step, given)
        case SearchChanged():
            _search_changed(step)
        case InTheAir() | Planned() | NothingToPlan() | Arrived() | SweepTaken():
            _finished(step, given)
        case CarriedOut(way=way):
            carried_out(step, way)
        case WorkFailed():
            _failed(step, given)
        case PlaceNotTaken():
            _place_not_taken(step, given)
        case Said(reason=reason):
            if craft.engaged:
                tell_said(step, reason)
        case SaidNoMore(text=text):
            clear_said(step, text)
        case ClockOdd() | ClockAgrees():
            clock_seen(step, given)
        case ReceiverLoses() | ReceiverKeepsUp():
            losses_seen(step, given)
        case WorkVetoed(vetoes=vetoes, on_ground=on_ground):
            if craft.phase in AUTOMATIC:
                refuse_flight(step, vetoes, on_ground)
        case Broke(because=because):
            if craft.engaged and not craft.taken_over:
                alert(step, "failure", "warning", because)
                if craft.phase in AUTOMATIC:
                    hold(step, because)
        case NetsUp() | NetsNotTaken():
            nets_looked_at(step, given)
        case AuthorityHeard(authority=authority):
            authority_heard(step, authority)
        case FailsafeEnded(mode=mode):
            if craft.phase in ("hold", *HOMEWARD) and not craft.taken_over:
                alert(step, "vehicle", "caution", flight.FailsafeStopped(mode))
        case LinkDown():
            _link_down(step, given)
        case LinkUp():
            _link_up(step, given)
        case BatteryLow() | BatteryReported() | HomeReached() | Landed():
            _vehicle(step, given)
        case ChargeLow(because=because):
            if craft.engaged:
                alert(step, "battery", "warning", because)
        case AutopilotReturns(because=because):
            if craft.phase in HOMEWARD and not craft.taken_over:
                alert(step, "safety", "caution", AutopilotFliesHome(because))
                carried_out(step, "return")
        case TimerExpired():
            _timer(step, given)
        case Restarted() if craft.comes_down_as_ordered and given.on_ground:
            come_down(step, craft.return_reason or flight.Proceeds("way_home"))
        case Restarted():
            restarted(step, given)
        case Leaving(homeward=homeward):
            needs_us = craft.phase in AUTOMATIC or (craft.phase == "returning" and not homeward)
            if craft.engaged and needs_us and not craft.taken_over and craft.authority.who != "failsafe":
                reason = flight.ServerEnds()
                step.record(HoldOrdered(craft_id=craft.craft_id, by=None, reason=reason))
                hold(step, reason)
        case Abandoned(because=because):
            if craft.engaged:
                come_down(step, because, "failed")
        case _:
            assert_never(given)


def _search_changed(step: CraftStep) -> None:
    """A bearing from elsewhere changes what is believed, not where the craft is on its way to."""
    phase = step.craft.phase
    if phase == "planning" or (phase == "waiting" and step.craft.chosen is None):
        go_on(step, flight.Proceeds("belief"))
    elif phase in ("flying", "measuring", "waiting") and step.search.done:
        go_home(step, Localized())


def _finished(step: CraftStep, given: InTheAir | Planned | NothingToPlan | Arrived | SweepTaken) -> None:
    """The result of work counts only in the phase that asked for it."""
    craft = step.craft
    match given:
        case InTheAir() if craft.phase == "taking_off":
            step.record(
                TookOff(craft_id=craft.craft_id, place=given.place, altitude_relative_m=given.altitude_relative_m)
            )
            go_on(step, flight.Proceeds("climb"))
        case Planned(choice=choice, vetoes=vetoes) if craft.phase == "planning":
            if vetoes:
                refuse_flight(step, vetoes)
            else:
                step.record(choice.model_copy(update={"place_number": step.search.place_number + 1}))
                go_on(step, flight.Proceeds("plan"))
        case NothingToPlan(because=because) if craft.phase == "planning":
            go_home(step, NotLocalized(because, step.search.not_yet))
        case Arrived() if craft.phase == "flying":
            step.record(
                PlaceReached(
                    craft_id=craft.craft_id,
                    place_number=craft.place_number,
                    place=given.place,
                    distance_m=given.distance_m,
                    flight_time_s=given.flight_time_s,
                )
            )
            for leg in given.heard:
                step.record(leg)
            arrived(step)
        case SweepTaken(results=results) if craft.phase == "measuring":
            _swept(step, results)
        case _:
            return


def _swept(step: CraftStep, results: tuple[BearingMeasured | SweepRejected, ...]) -> None:
    """A place is done when an emitter was heard there, or when it was tried often enough for all that are sought."""
    bearings = [result for result in results if isinstance(result, BearingMeasured)]
    rejected = most_repeated_first(step.craft, step.search, results)
    for result in (*bearings, *rejected):
        step.record(result)
    for bearing in bearings[:1]:
        doubt_place(step, bearing)
    because: Reason = rejected[0].reason if rejected else flight.Proceeds("bearing")
    if bearings:
        go_on(step, flight.Proceeds("bearing"))
    elif step.craft.chosen is None:
        go_on(step, NoUsableBearing(because, again=False))
    else:
        measure(step, NoUsableBearing(because, again=True))


def _place_not_taken(step: CraftStep, given: PlaceNotTaken) -> None:
    """Another place is chosen; when the autopilot takes none, somebody has to look."""
    craft = step.craft
    if craft.phase != "flying":
        return
    step.record(
        PlaceRefused(craft_id=craft.craft_id, place_number=craft.place_number, place=given.place, reason=given.because)
    )
    alert(step, "place", "caution", given.because)
    if step.craft.refused_in_a_row >= MOST_REFUSED:
        hold(step, given.because)
    else:
        go_on(step, given.because)


def _failed(step: CraftStep, given: WorkFailed) -> None:
    craft, phase = step.craft, step.craft.phase
    if not craft.engaged or craft.taken_over:
        return
    ladder = craft.ladder
    if ladder is not None and ladder.stage != "waits" and ladder.way == given.step:  # a way home may fail on its way
        not_done(step, ladder, given.because)
        return
    alert(step, "failure", "warning", given.because)
    if phase == "taking_off" and given.step == "take_off" and given.in_air is False:
        step.do(CancelWork())
        come_down(step, given.because, "failed")
    elif phase in AUTOMATIC:
        hold(step, given.because)


def _link_down(step: CraftStep, given: LinkDown) -> None:
    craft = step.craft
    if not craft.engaged or given.link in craft.links_down:
        return
    step.record(LinkLost(craft_id=craft.craft_id, link=given.link, reason=given.because))
    match given.link:
        case "vehicle":
            alert(step, "vehicle", "warning", given.because)
            if craft.phase in AUTOMATIC:
                step.do(CancelWork())
                step.go("hold", given.because)
        case "receiver":
            reason = ReceiverTrouble(given.because)
            alert(step, "receiver", "caution", reason)
            if craft.phase == "measuring":
                hold(step, reason)
        case "payload":
            alert(step, "payload", "caution", given.because)
        case "gps":
            alert(step, "gps", "warning", given.because)
            if craft.phase in AUTOMATIC:
                hold(step, given.because)
        case "console":
            start_console_timers(step)
        case _:
            assert_never(given.link)


def _link_up(step: CraftStep, given: LinkUp) -> None:
    craft = step.craft
    if not craft.engaged or given.link not in craft.links_down:
        return
    step.record(LinkRestored(craft_id=craft.craft_id, link=given.link, outage_s=given.outage_s))
    clear_alerts(step, given.link)
    if given.link == "console":
        step.do(CancelTimer("console_hold"))
        step.do(CancelTimer("console_return"))
    elif given.link == "vehicle" and not craft.taken_over:
        _heard_again(step)


def _heard_again(step: CraftStep) -> None:
    """What was ordered last is ordered again: the vehicle may not have heard it."""
    phase = step.craft.phase
    if step.comes_by_itself and phase in HOMEWARD | {"hold"}:
        tell_failsafe(step, "link_lost")
    if phase in HOMEWARD:
        clear_alerts(step, "failure")
        bring_down(step, "land" if phase == "landing" else "return")
    elif phase == "hold" and not step.comes_by_itself:
        insist(step, "hold")


def _vehicle(step: CraftStep, given: BatteryLow | BatteryReported | HomeReached | Landed) -> None:
    phase = step.craft.phase
    match given:
        case BatteryLow():
            low_battery.low(step, given)
        case BatteryReported():
            low_battery.suffices(step)
        case HomeReached() if phase == "returning":
            step.go("landing", flight.Proceeds("way_home"))
            step.do(StartTimer("landing", LANDING_PATIENCE_S))
        case Landed() if phase in HOMEWARD:
            come_down(step, step.craft.return_reason or flight.Proceeds("way_home"))
        case Landed() if phase == "manual":
            come_down(step, flight.Landed("manual"))
        case Landed() if phase == "hold" or (phase in AUTOMATIC and phase != "taking_off"):
            _on_the_ground(step)
        case _:
            return


def _on_the_ground(step: CraftStep) -> None:
    """Not by our order, but by a failsafe, say, or as ordered before a restart. What was found is kept."""
    if step.craft.comes_down_as_ordered:
        come_down(step, ORDERED_BEFORE)
        return
    if step.search.found or step.search.stage == "ended":
        step.do(CancelWork())
        come_down(step, flight.Landed("localized" if step.search.found else "hold"))
        return
    reason = flight.Landed("hold")
    if step.craft.phase in AUTOMATIC:
        reason = flight.Landed("automatic")
        step.do(CancelWork())
        step.go("hold", reason)
    clear_failsafe(step)
    if not step.on_ground:
        step.do(CancelTimer("order"))
        clear_alerts(step, "order")
        alert(step, "ground", "warning", reason)


def _timer(step: CraftStep, given: TimerExpired) -> None:
    phase, craft_id = step.craft.phase, step.craft.craft_id
    match given.name:
        case "console_hold" if phase in AUTOMATIC:
            reason = flight.NoConsole("hold")
            step.record(HoldOrdered(craft_id=craft_id, by=None, reason=reason))
            alert(step, "console", "warning", reason)
            hold(step, reason)
        case "console_return" if phase in AUTOMATIC or (phase == "hold" and not step.on_ground):
            reason = flight.NoConsole("return")
            step.record(ReturnOrdered(craft_id=craft_id, by=None, reason=reason))
            go_home(step, reason)
        case "landing" if phase == "landing":
            bring_down(step, "land")
        case "order" if step.craft.ladder is not None and step.craft.ladder.stage == "waits":
            step.do(CancelWork())
            try_rung(step, step.craft.ladder)
        case "battery_return":
            low_battery.counted_down(step)
        case _:
            return
