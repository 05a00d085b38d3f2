"""What holds in every state that the craft machine can reach, whatever input it is given."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest
from craft_inputs import CLOCK_ODD
from craft_sweep import Step, reachable, stepped, steps
from craft_walk import PHASES, VEHICLE, moves, ordered, sent
from facts import HOME, in_sector, rejected, silent

from backend import commands
from backend.craft import effects, inputs
from backend.craft.ladder import Ladder
from backend.craft.low_battery import COUNTDOWN_S
from backend.craft.orders import resume_refusal
from backend.craft.state import AUTOMATIC, HOMEWARD, pilot_has
from backend.craft.who_flies import kept_of
from backend.events import OrderDone, OrderNotDone
from backend.reasons.flight import OrderName
from backend.search.effects import Record
from hardware.reasons.receiver import SamplesLost
from hardware.reasons.sweep import UnlikeAntenna

# A million steps, made once, and without the tracer that would make them five times as slow.
pytestmark = [pytest.mark.no_cover, pytest.mark.timeout(900)]


def test_the_sweep_reaches_every_phase_with_whoever_may_fly_then_before_and_after_the_end() -> None:
    seen = {(craft.phase, craft.authority.who, search.stage) for craft, search in reachable() if craft.engaged}
    assert {phase for phase, _, _ in seen} == set(PHASES) - {"ground"}
    assert {who for phase, who, _ in seen if phase == "manual"} >= {"pilot", "nobody"}
    assert {who for phase, who, _ in seen if phase == "hold"} >= {"ours", "failsafe", "nobody"}
    assert {phase for phase, _, stage in seen if stage == "ended"} >= {"hold", "manual", "returning", "landing"}
    assert {craft.phase for craft, _ in reachable() if not craft.engaged} == {"ground"}


def test_a_pilot_who_flies_an_engaged_craft_flies_it_by_hand() -> None:
    for craft, _ in reachable():
        if craft.engaged and craft.authority.who == "pilot":
            assert craft.phase == "manual"
        if craft.phase in AUTOMATIC:
            assert craft.authority.who != "failsafe"


def test_nothing_is_sent_while_somebody_else_flies_until_an_operator_takes_control() -> None:
    for step in steps():
        restarted = isinstance(step.given, inputs.Restarted)
        flies = step.after if restarted else step.craft
        if flies.taken_over or flies.authority.who == "failsafe":
            first = next((k for k, effect in enumerate(step.asked) if isinstance(effect, VEHICLE)), None)
            if first is not None:
                assert step.carried_out, step.about
                assert effects.TakeControl() in step.asked[:first], step.about
        if isinstance(step.given, inputs.AuthorityHeard | inputs.FailsafeEnded):
            assert not sent(step.asked), step.about


def test_the_end_of_a_failsafe_changes_nothing_but_what_is_said() -> None:
    for step in steps(inputs.FailsafeEnded):
        assert {type(effect) for effect in step.asked} <= {Record}, step.about
        assert (step.after.phase, step.after.authority) == (step.craft.phase, step.craft.authority), step.about
        said = step.craft.phase in ("hold", *HOMEWARD) and not step.craft.taken_over
        assert (step.after != step.craft) == said, step.about


def test_control_is_taken_by_an_operators_deed_alone_and_from_a_pilot_by_resuming_alone() -> None:
    for step in steps():
        if effects.TakeControl() not in step.asked:
            continue
        assert step.carried_out, step.about
        if step.craft.engaged and step.craft.taken_over:
            assert isinstance(step.command, commands.Resume), step.about
        assert not step.after.taken_over, step.about


def test_hold_and_return_work_on_every_engaged_craft_unless_a_pilot_flies() -> None:
    for step in steps(inputs.CraftOrdered):
        if not step.craft.engaged or step.craft.taken_over:
            continue
        match step.command:
            case commands.Hold():
                assert effects.HoldVehicle() in step.asked, step.about
                assert step.asked[0] == effects.CancelWork(), step.about
                assert step.after.phase == "hold", step.about
            case commands.Return() if step.craft.phase != "landing":
                assert moves(step.asked) == [effects.ReturnHome()], step.about
                assert step.after.phase == "returning", step.about
            case commands.Land():
                assert moves(step.asked) == [effects.Land()], step.about
                assert step.asked[0] == effects.CancelWork(), step.about
                assert step.after.phase == "landing", step.about
            case commands.Abort() if step.search.stage == "open":
                assert sent(step.asked) == [effects.HoldVehicle()], step.about
                assert step.asked[0] == effects.CancelWork(), step.about
                assert step.after.phase == "returning", step.about
                assert not step.after.searching, step.about
            case _:
                pass


def test_a_held_craft_moves_only_when_an_operator_says_so_or_nobody_is_left_to() -> None:
    for step in steps():
        if step.craft.phase in ("hold", "manual") and moves(step.asked):
            ordered = isinstance(step.command, commands.Resume | commands.Return | commands.Land | commands.Abort)
            timer = step.given == inputs.TimerExpired("console_return")
            ladder = step.craft.ladder
            refused = ladder is not None and ladder.stage == "waits" and step.given == inputs.TimerExpired("order")
            counted = step.given == inputs.TimerExpired("battery_return") and step.craft.counting_down
            lower = isinstance(step.given, inputs.BatteryLow) and step.given.stage != "return"
            assert ordered or timer or refused or counted or lower, step.about


def under_way(step: Step) -> Ladder | None:
    """The order that is being carried out, unless somebody else flies."""
    ladder = step.craft.ladder
    return ladder if step.craft.engaged and ladder is not None and ladder.stage != "done" else None


def test_an_order_that_is_not_done_is_told_and_tried_again_or_waits_for_the_link() -> None:
    seen = 0
    for step in steps(inputs.WorkFailed):
        ladder = under_way(step)
        if ladder is None or ladder.stage != "tried":
            continue
        if isinstance(step.given, inputs.WorkFailed) and step.given.step == ladder.way:
            seen += 1
            assert step.after.ladder is not None, step.about
            assert step.after.ladder.stage == "waits", step.about
            assert any(isinstance(e, Record) and isinstance(e.event, OrderNotDone) for e in step.asked), step.about
            assert [a.topic for a in step.after.open_alerts].count("order") == 1, step.about
            again = [e for e in step.asked if isinstance(e, effects.StartTimer) and e.name == "order"]
            assert bool(again) == ("vehicle" not in step.craft.links_down), step.about
            assert not sent(step.asked), step.about
    assert seen > 100


def test_a_rung_that_waits_is_commanded_when_its_time_has_come_and_at_no_other() -> None:
    command = {"hold": effects.HoldVehicle(), "return": effects.ReturnHome(), "land": effects.Land()}
    for step in steps(inputs.TimerExpired):
        if step.given != inputs.TimerExpired("order"):
            continue
        ladder = under_way(step)
        expected = [command[ladder.way]] if ladder is not None and ladder.stage == "waits" else []
        assert sent(step.asked) == expected, step.about


def test_an_order_counts_as_done_only_once_the_vehicle_shows_it() -> None:
    for step in steps():
        for effect in step.asked:
            if isinstance(effect, Record) and isinstance(effect.event, OrderDone):
                assert under_way(step) is not None, step.about
                shown = inputs.CarriedOut(effect.event.way)
                returns = isinstance(step.given, inputs.AutopilotReturns) and effect.event.way == "return"
                assert returns or step.given == shown, step.about
                assert [a.topic for a in step.after.open_alerts].count("order") <= 1


def test_a_newer_order_takes_the_place_of_the_one_under_way() -> None:
    kinds: dict[type[commands.CraftCommand], OrderName] = {
        commands.Hold: "hold", commands.Return: "return", commands.Land: "land", commands.Abort: "abort",
    }  # fmt: skip
    for step in steps(inputs.CraftOrdered):
        order = kinds.get(type(step.command)) if step.carried_out and step.command is not None else None
        if order is not None and not step.craft.taken_over:
            assert step.after.ladder == Ladder(order), step.about
            assert effects.CancelTimer("order") in step.asked, step.about


def test_whoever_takes_the_vehicle_ends_every_order_and_all_work_of_ours() -> None:
    for step in steps():
        heard = step.given.authority if isinstance(step.given, inputs.AuthorityHeard) else None
        taken = heard if heard is not None and (pilot_has(heard) or heard.who == "failsafe") else None
        if taken is not None and step.craft.engaged and kept_of(taken) != kept_of(step.craft.authority):
            assert step.after.ladder is None, step.about
            assert effects.CancelTimer("order") in step.asked, step.about
            assert step.craft.phase not in AUTOMATIC or effects.CancelWork() in step.asked, step.about
        if step.after.taken_over or step.after.authority.who == "failsafe":
            assert step.after.ladder is None, step.about


def test_a_countdown_runs_in_hold_only_and_is_stopped_once() -> None:
    for step in steps():
        started = effects.StartTimer("battery_return", COUNTDOWN_S) in step.asked
        assert started == (step.after.counting_down and not step.craft.counting_down), step.about
        if step.after.counting_down:
            assert step.after.phase == "hold", step.about
            assert not step.after.taken_over, step.about
        if started:
            assert not step.craft.countdown_stopped, step.about
        if isinstance(step.command, commands.KeepHolding):
            assert step.carried_out == step.craft.counting_down, step.about
            assert not moves(step.asked), step.about
            assert not step.after.counting_down, step.about


def test_the_lower_the_battery_the_less_is_asked() -> None:
    for step in steps(inputs.BatteryLow):
        if not isinstance(step.given, inputs.BatteryLow) or not step.craft.engaged:
            continue
        ours = not (step.craft.taken_over or step.craft.authority.who == "failsafe")
        if not ours or step.craft.phase in ("manual", "landing"):
            assert not sent(step.asked), step.about
        elif step.given.stage == "land":
            assert moves(step.asked) == [effects.Land()], step.about
            assert step.after.phase == "landing", step.about
        elif step.craft.phase in AUTOMATIC or (step.craft.phase == "hold" and step.given.stage == "last"):
            assert moves(step.asked) == [effects.ReturnHome()], step.about
        else:
            assert not sent(step.asked), step.about


def test_no_sweep_is_begun_while_the_autopilots_headings_cannot_be_dated() -> None:
    began, held = 0, 0
    for craft, search in reachable():
        if craft.phase not in ("flying", "measuring"):
            continue
        odd = stepped(craft, search, inputs.ClockOdd(CLOCK_ODD))
        assert [raised.topic for raised in odd.after.open_alerts].count("clock") == 1, odd.about
        assert odd.after.phase == ("hold" if craft.phase == "measuring" else craft.phase), odd.about
        for given in (inputs.Arrived(HOME, 0.4, 12.0), inputs.SweepTaken((rejected(1, craft.place_number),))):
            began += effects.Measure in map(type, stepped(craft, search, given).asked)
            step = stepped(odd.after, odd.search, given)
            assert effects.Measure not in map(type, step.asked), step.about
            held += step.after.phase == "hold"
        over = stepped(odd.after, odd.search, inputs.ClockAgrees())
        assert "clock" not in [raised.topic for raised in over.after.open_alerts], over.about
        assert sent(over.asked) == [], over.about
    assert min(began, held) > 10


def test_what_a_receiver_loses_is_said_while_it_lasts_and_changes_nothing_else() -> None:
    for step in steps(inputs.ReceiverLoses, inputs.ReceiverKeepsUp):
        assert {type(effect) for effect in step.asked} <= {Record}, step.about
        assert replace(step.after, open_alerts=(), alerts_raised=0) == replace(
            step.craft, open_alerts=(), alerts_raised=0
        ), step.about
        if "receiver" in step.craft.links_down or not step.craft.engaged:
            assert step.after == step.craft, step.about
        else:
            said = [raised.reason for raised in step.after.open_alerts if raised.topic == "receiver"]
            loses = isinstance(step.given, inputs.ReceiverLoses)
            assert said == ([SamplesLost(12.0)] if loses else []), step.about


def test_what_safety_forbids_on_the_ground_sends_nothing_and_ends_no_search() -> None:
    seen = 0
    for step in steps(inputs.WorkVetoed):
        refused = isinstance(step.given, inputs.WorkVetoed) and step.given.on_ground
        if refused and step.craft.phase == "taking_off":
            seen += 1
            assert {type(effect) for effect in step.asked} == {Record}, step.about
            assert (step.after.phase, step.after.engaged) == ("hold", True), step.about
            assert step.after.chosen == step.craft.chosen, step.about
            assert [raised.topic for raised in step.after.open_alerts].count("safety") == 1, step.about
            again = stepped(step.after, step.search, ordered(commands.Resume(), on_ground=True))
            assert again.carried_out == (resume_refusal(step.after, step.search) is None), again.about
            if again.carried_out and not step.search.found:
                assert again.after.phase == "taking_off", again.about
                assert "safety" not in [raised.topic for raised in again.after.open_alerts], again.about
    assert seen > 5


def test_a_place_is_left_at_once_for_a_first_sweep_unlike_the_antenna_and_for_silence_all_round() -> None:
    """Whether another turn is made there, in every state that measures, each turn and each way to be rejected."""
    seen = 0
    for craft, search in reachable():
        if craft.phase != "measuring" or craft.chosen is None:
            continue
        number = craft.place_number
        for has_bearing, kind in product((False, True), ("unlike", "no direction", "silent", "silent in a sector")):
            attempts = frozenset(range(1, 4))
            for attempt in attempts:
                vain = frozenset(one for one in attempts if one < attempt)
                before = (("b9", HOME),)
                left_out = frozenset[str]() if has_bearing else frozenset({"b9"})
                turns = replace(craft, taken=before, left_out=left_out, attempt=attempt, in_vain=vain)
                swept = {
                    "unlike": rejected(attempt, number).model_copy(update={"reason": UnlikeAntenna(0.5, 0.7)}),
                    "no direction": rejected(attempt, number),
                    "silent": silent(attempt, number),
                    "silent in a sector": in_sector(silent(attempt, number)),
                }[kind]
                step = stepped(turns, search, inputs.SweepTaken((swept,)))
                at_once = kind == "silent" or (kind == "unlike" and not has_bearing)
                left = at_once or attempt > craft.maximum_retakes
                assert (step.after.chosen is None) == left, step.about
                assert (effects.Measure in map(type, step.asked)) == (not left), step.about
                assert (swept.place in step.after.avoid) == left or swept.place in craft.avoid, step.about
                seen += left
    assert seen > 10


def test_nothing_moves_a_craft_that_is_not_engaged_but_its_start() -> None:
    for step in steps():
        if not step.craft.engaged and sent(step.asked):
            assert isinstance(step.command, commands.Start), step.about


def test_after_the_search_is_over_a_craft_only_holds_or_comes_home() -> None:
    for step in steps():
        if step.search.stage == "ended":
            assert all(isinstance(move, effects.ReturnHome | effects.Land) for move in moves(step.asked)), step.about
            assert step.after.phase not in AUTOMATIC, step.about


def test_what_is_objected_to_is_not_done() -> None:
    for step in steps(inputs.CraftOrdered):
        objected = isinstance(step.given, inputs.CraftOrdered) and step.given.objections
        if objected and isinstance(step.command, commands.Start | commands.Resume | commands.Override):
            assert not step.carried_out, step.about
            assert not sent(step.asked), step.about
            assert (step.after.phase, step.after.authority) == (step.craft.phase, step.craft.authority), step.about


def test_a_refused_order_sends_nothing_and_leaves_the_phase() -> None:
    for step in steps(inputs.CraftOrdered):
        if step.command is not None and not step.carried_out:
            assert not any(isinstance(e, (*VEHICLE, effects.CancelWork, effects.TakeControl)) for e in step.asked)
            assert step.after.phase == step.craft.phase, step.about


def test_a_pilot_who_takes_over_silences_everything_at_once() -> None:
    for step in steps(inputs.AuthorityHeard):
        heard = step.given.authority if isinstance(step.given, inputs.AuthorityHeard) else None
        if heard is not None and pilot_has(heard) and step.craft.engaged and not step.craft.taken_over:
            assert step.asked[0] == effects.CancelWork(), step.about
            assert step.after.phase == "manual", step.about
            assert not sent(step.asked), step.about


def test_what_is_asked_of_a_craft_on_its_way_home_never_sends_it_out_again() -> None:
    for step in steps():
        if step.craft.phase in HOMEWARD and step.command is None:
            assert step.after.phase not in AUTOMATIC, step.about
