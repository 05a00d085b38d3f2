"""The mission machine over its search and its craft: the usual way, its answers, and a restart."""

from __future__ import annotations

from facts import (
    HOME,
    NOT_YET,
    OURS,
    PERSON,
    SECOND,
    TWO_SPEC,
    bearing,
    plan,
)
from walks import Walk, answer, belief_ready, commanded, of_craft, refusal, sent

from backend import commands
from backend.craft import effects, inputs
from backend.events import CommandRefused, MissionEnded, MissionStarted
from backend.mission.inputs import ServerCameBack
from backend.mission.state import fold
from backend.reasons import refusals
from backend.search.effects import UpdateBelief
from backend.search.inputs import BearingsArrived, NotStored
from backend.spec import FIRST_EMITTER


def test_a_localized_mission_goes_from_draft_to_done() -> None:
    walk = Walk()
    walk.command(commands.Start())
    assert walk.state.phase == "taking_off"
    assert UpdateBelief(FIRST_EMITTER) in walk.asked
    walk.to_craft(inputs.AuthorityHeard(OURS))
    walk.to_craft(inputs.InTheAir(HOME, 40.0))
    for number in (1, 2):
        assert of_craft(walk.give(belief_ready(walk.search)))[-1] == effects.PlanNext(number, ())
        assert of_craft(walk.to_craft(inputs.Planned(plan(number))))[-1] == effects.FlyTo(number, plan(number).place)
        assert of_craft(walk.to_craft(inputs.Arrived(HOME, 0.3, 9.0)))[-1] == effects.Measure(number, 1)
        assert UpdateBelief(FIRST_EMITTER) in walk.to_craft(inputs.SweepTaken((bearing(number),)))
    localized_at = walk.at_s + 1
    assert of_craft(walk.give(belief_ready(walk.search, localized=True)))[-1] == effects.ReturnHome()
    walk.to_craft(inputs.HomeReached())
    assert walk.state.phase == "landing"
    walk.to_craft(inputs.Landed())
    assert (walk.state.phase, walk.search.outcome, walk.state.engaged) == ("done", "localized", ())
    (ended,) = walk.of_kind(MissionEnded)
    started = next(r for r in walk.recorded if isinstance(r.event, MissionStarted)).at_utc.timestamp()
    assert ended.mission_time_s == localized_at - started


def test_a_repeated_command_gets_the_first_answer_and_does_nothing() -> None:
    walk = Walk().to("flying")
    first = walk.give(commanded(commands.Hold(), "same"))
    recorded = len(walk.recorded)
    assert walk.give(commanded(commands.Hold(), "same")) == (answer(first),)
    refused = walk.give(commanded(commands.Accept(), "no"))
    assert refusal(refused) == refusals.NoProposedPlace()
    assert walk.give(commanded(commands.Accept(), "no")) == (answer(refused),)
    assert len(walk.recorded) == recorded + 1
    assert fold(walk.recorded).answered == walk.state.answered


def test_every_refusal_is_a_fact() -> None:
    walk = Walk()
    walk.command(commands.Hold())
    (refused,) = walk.of_kind(CommandRefused)
    assert (refused.reason, refused.by, refused.command) == (refusals.NotStarted(), "anna", "hold")


def test_only_an_open_alert_is_acknowledged_whoever_raised_it() -> None:
    walk = Walk().to("measuring")
    walk.give(NotStored("a number is missing"))
    walk.to_craft(inputs.LinkDown("receiver", NOT_YET))
    for alert in (*walk.search.open_alerts, *walk.craft.open_alerts):
        assert refusal(walk.command(commands.AcknowledgeAlert(alert_id=alert.alert_id))) is None
    assert refusal(walk.command(commands.AcknowledgeAlert(alert_id="battery-9"))) == refusals.NoSuchAlert()


def test_a_restart_brings_the_same_search_back_with_its_beliefs_to_be_folded_again() -> None:
    walk = Walk(TWO_SPEC).to("flying")
    asked = walk.give(ServerCameBack())
    assert [effect for effect in asked if isinstance(effect, UpdateBelief)] == [
        UpdateBelief(FIRST_EMITTER),
        UpdateBelief(SECOND),
    ]
    assert sent(walk.to_craft(inputs.Restarted(OURS))) == [effects.HoldVehicle()]
    walk.believe()
    assert walk.craft.phase == "hold"
    assert sent(walk.command(commands.Resume())) != []
    assert Walk().give(ServerCameBack()) == (), "a draft was not in the air"


def landing_with_what_was_found() -> Walk:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.believe(localized=True)
    walk.to_craft(inputs.HomeReached())
    assert walk.state.phase == "landing"
    return walk


def test_what_was_found_before_a_restart_stays_found_when_the_vehicle_stands_there_already() -> None:
    """A search ends with the belief of its bearings, whether or not they are folded again by then."""
    walk = landing_with_what_was_found()
    localized_at, started_at = walk.search.localized_at_s, walk.search.started_at_s
    assert localized_at is not None
    assert started_at is not None
    for _ in range(2):
        walk.give(ServerCameBack())
    assert not walk.search.localized
    walk.to_craft(inputs.Restarted(OURS, on_ground=True))
    (ended,) = walk.of_kind(MissionEnded)
    assert (ended.outcome, ended.mission_time_s) == ("localized", localized_at - started_at)
    assert fold(walk.recorded) == walk.state


def test_a_bearing_that_comes_after_a_restart_takes_back_what_was_found() -> None:
    walk = landing_with_what_was_found()
    walk.give(ServerCameBack())
    walk.give(BearingsArrived((bearing(2, source=PERSON, bearing_id="p"),)))
    walk.to_craft(inputs.Restarted(OURS, on_ground=True))
    assert walk.search.outcome == "not_localized"


def test_after_an_abort_and_a_restart_the_craft_is_held_and_brought_home() -> None:
    walk = Walk().to("aborted")
    walk.state = fold(walk.recorded)
    walk.give(ServerCameBack())
    walk.to_craft(inputs.Restarted(OURS))
    assert (walk.state.phase, walk.craft.phase) == ("aborted", "hold")
    assert sent(walk.command(commands.Hold())) == [effects.HoldVehicle()]
    assert refusal(walk.command(commands.Resume())) == refusals.MissionOver()
    assert sent(walk.command(commands.Return())) == [effects.ReturnHome()]
    walk.to_craft(inputs.Landed())
    assert walk.state.engaged == ()
