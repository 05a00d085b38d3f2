"""The mission machine when bearings come, from its craft or from elsewhere, about one emitter or about several."""

from __future__ import annotations

import pytest
from facts import (
    IMPORT,
    PERSON,
    SECOND,
    SPEC,
    TWO_SPEC,
    WAITING_SPEC,
    bearing,
    in_sector,
    plan,
    rejected,
    silent,
)
from walks import Walk, commanded, of_craft, refusal, sent

from backend import commands
from backend.craft import effects, inputs
from backend.events import SilenceFact
from backend.mission.machine import transition
from backend.mission.state import MissionState, fold
from backend.reasons import refusals
from backend.search.effects import Record, UpdateBelief
from backend.search.inputs import BearingsArrived
from backend.spec import FIRST_EMITTER
from hardware.reasons.sweep import UnlikeAntenna

UNLIKE = UnlikeAntenna(0.5, 0.7)


@pytest.mark.parametrize("source", [PERSON, IMPORT])
def test_a_bearing_from_elsewhere_changes_the_belief_and_leaves_the_craft_its_place(source: object) -> None:
    for phase in ("flying", "measuring", "waiting"):
        walk = Walk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)
        if phase == "measuring":
            walk.arrive()
        chosen = walk.craft.chosen
        assert chosen is not None
        asked = walk.give(BearingsArrived((bearing(9, source=source, bearing_id="p"),)))  # type: ignore[arg-type]
        assert [effect for effect in asked if not isinstance(effect, Record)] == [UpdateBelief(FIRST_EMITTER)]
        assert not walk.search.beliefs_current
        assert (walk.craft.phase, walk.craft.chosen) == (phase, chosen)
        assert sent(walk.believe()) == []
        assert (walk.craft.phase, walk.craft.chosen) == (phase, chosen)
        assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ("p",)


def test_a_search_without_a_craft_folds_what_people_and_imports_bring() -> None:
    walk = Walk()
    walk.give(BearingsArrived((bearing(1, source=PERSON),)))
    walk.give(BearingsArrived((bearing(2, source=IMPORT),)))
    walk.believe(localized=True)
    assert walk.search.localized
    assert (walk.state.engaged, walk.state.phase) == ((), "draft")
    assert all(isinstance(effect, Record | UpdateBelief) for effect in walk.asked)
    walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert not walk.search.localized
    assert fold(walk.recorded) == walk.state
    none = MissionState(search=walk.search, crafts={})
    after, asked = transition(none, BearingsArrived((bearing(3, source=PERSON),)), 2_000.0)
    assert UpdateBelief(FIRST_EMITTER) in asked
    assert len(after.search.measured) == 3
    after, asked = transition(after, commanded(commands.Hold(), "c"), 2_001.0)
    assert isinstance(refusal(asked), refusals.NoSuchCraft)


def test_one_craft_finds_two_emitters_with_the_same_turns_and_comes_home_when_both_are_localized() -> None:
    walk = Walk(TWO_SPEC).to("flying").arrive()
    asked = walk.to_craft(inputs.SweepTaken((bearing(1, bearing_id="a1"), bearing(1, SECOND, bearing_id="b1"))))
    assert {effect for effect in asked if isinstance(effect, UpdateBelief)} == {
        UpdateBelief(FIRST_EMITTER),
        UpdateBelief(SECOND),
    }
    assert of_craft(walk.believe(True, FIRST_EMITTER)) == []
    assert walk.craft.phase == "planning"
    assert of_craft(walk.believe(False, SECOND)) == [effects.PlanNext(2, ())]
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((rejected(1, 2), bearing(2, SECOND, bearing_id="b2"))))
    assert [bearing_.bearing_id for bearing_ in walk.search.measured] == ["a1", "b1", "b2"]
    assert sent(walk.believe(True, SECOND)) == [effects.ReturnHome()]
    walk.to_craft(inputs.Landed())
    assert walk.search.outcome == "localized"
    assert fold(walk.recorded) == walk.state


def test_after_a_silent_place_the_next_is_planned_with_what_the_silence_tells() -> None:
    walk = Walk().to("measuring")
    asked = walk.to_craft(inputs.SweepTaken((silent(),)))
    assert UpdateBelief(FIRST_EMITTER) in asked
    assert walk.craft.phase == "planning", "to hear nothing there once more would tell hardly anything"
    (planned,) = of_craft(walk.believe())
    assert isinstance(planned, effects.PlanNext)
    assert planned.avoid == (walk.craft.avoid[-1],)
    assert fold(walk.recorded) == walk.state


def test_a_belief_does_not_disturb_the_turn_that_is_taken_again() -> None:
    """A sector in which nothing was heard leaves the rest of the circle, and the turn made again is whole."""
    walk = Walk().to("measuring")
    asked = walk.to_craft(inputs.SweepTaken((in_sector(silent()),)))
    assert UpdateBelief(FIRST_EMITTER) in asked
    assert walk.craft.phase == "measuring"
    assert sent(walk.believe()) == []


def test_a_whole_turn_whose_receiver_lived_for_a_part_of_it_is_taken_again() -> None:
    """Of a tag: it was taken for silence all round, and the place was left with most of the circle unheard."""
    walk = Walk().to("measuring")
    told = SilenceFact(chances=[1.0] * 3 + [0.0] * 13, gain_db=[0.0] * 36)
    walk.to_craft(inputs.SweepTaken((silent().model_copy(update={"silence": told}),)))
    assert walk.craft.phase == "measuring"
    assert fold(walk.recorded) == walk.state


def test_before_there_is_a_bearing_a_place_that_may_lie_above_the_emitter_is_left_at_once() -> None:
    """Where a sweep is unlike the antenna; any later one is taken again."""
    walk = Walk().to("measuring")
    here = walk.craft.chosen
    assert here is not None
    walk.to_craft(inputs.SweepTaken((rejected(1).model_copy(update={"reason": UNLIKE}),)))
    assert (walk.craft.phase, walk.craft.avoid) == ("planning", (here.place,))
    assert walk.craft.chosen is None
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((bearing(2),)))
    walk.believe()
    walk.to_craft(inputs.Planned(plan(3)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((rejected(1, 3).model_copy(update={"reason": UNLIKE}),)))
    assert walk.craft.phase == "measuring", "what is known by now keeps places away from it"
    assert fold(walk.recorded) == walk.state


def test_turns_that_were_broken_off_are_not_counted_as_turns_in_vain() -> None:
    walk = Walk().to("measuring")
    for _ in range(SPEC.sensor.maximum_retakes + 1):
        walk.command(commands.Hold())
        walk.command(commands.Resume())
        walk.arrive()
    begun = walk.craft.attempt
    assert begun == SPEC.sensor.maximum_retakes + 2
    for retake in range(SPEC.sensor.maximum_retakes):
        walk.to_craft(inputs.SweepTaken((rejected(begun + retake),)))
        assert walk.craft.phase == "measuring", f"{retake} of {SPEC.sensor.maximum_retakes} turns were taken again"
    walk.to_craft(inputs.SweepTaken((rejected(begun + SPEC.sensor.maximum_retakes),)))
    assert walk.craft.phase == "planning"
    assert fold(walk.recorded) == walk.state


def test_a_turn_that_heard_no_emitter_of_two_is_one_turn_in_vain() -> None:
    walk = Walk(TWO_SPEC).to("flying").arrive()
    for attempt in range(1, SPEC.sensor.maximum_retakes + 1):
        walk.to_craft(inputs.SweepTaken((rejected(attempt), rejected(attempt, emitter_id=SECOND))))
        assert walk.craft.phase == "measuring"
    last = SPEC.sensor.maximum_retakes + 1
    walk.to_craft(inputs.SweepTaken((rejected(last), rejected(last, emitter_id=SECOND))))
    assert walk.craft.phase == "planning"


@pytest.mark.parametrize(("bad", "unheard"), [(FIRST_EMITTER, SECOND), (SECOND, FIRST_EMITTER)])
def test_a_silent_emitter_takes_no_turn_from_another_whose_sweep_was_bad(bad: str, unheard: str) -> None:
    walk = Walk(TWO_SPEC).to("flying").arrive()
    for attempt in range(1, SPEC.sensor.maximum_retakes + 1):
        turn = (rejected(attempt, emitter_id=bad), silent(attempt, emitter_id=unheard))
        walk.to_craft(inputs.SweepTaken(tuple(sorted(turn, key=lambda result: result.emitter_id))))
        assert walk.craft.phase == "measuring", bad
        assert walk.craft.avoid == ()
    last = SPEC.sensor.maximum_retakes + 1
    walk.to_craft(inputs.SweepTaken((rejected(last, emitter_id=bad), silent(last, emitter_id=unheard))))
    assert walk.craft.phase == "planning"
    assert fold(walk.recorded) == walk.state


def test_a_bad_sweep_of_an_emitter_that_is_found_keeps_no_craft_where_the_sought_one_is_silent() -> None:
    walk = Walk(TWO_SPEC).to("flying").arrive()
    walk.to_craft(inputs.SweepTaken((bearing(1, bearing_id="a1"), bearing(1, SECOND, bearing_id="b1"))))
    walk.believe(True, FIRST_EMITTER)
    walk.believe(False, SECOND)
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((rejected(1, 2), silent(1, 2, SECOND))))
    assert walk.craft.phase == "planning"
    assert len(walk.craft.avoid) > 0
    assert fold(walk.recorded) == walk.state


def test_a_muted_person_sends_a_craft_on_its_way_home_back_to_no_search_and_the_end_says_so() -> None:
    walk = Walk().to("flying")
    walk.give(BearingsArrived((bearing(1, source=PERSON, bearing_id="p"),)))
    walk.believe(localized=True)
    assert walk.craft.phase == "returning"
    asked = walk.command(commands.MuteSource(of="person", name=PERSON.name, muted=True))
    assert sent(asked) == []
    assert UpdateBelief(FIRST_EMITTER) in asked
    walk.to_craft(inputs.Landed())
    assert walk.search.outcome == "not_localized"
    assert fold(walk.recorded) == walk.state


@pytest.mark.parametrize("phase", ["waiting", "flying", "hold"])
def test_muting_and_unmuting_moves_no_craft(phase: str) -> None:
    walk = Walk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)
    walk.give(BearingsArrived((bearing(1, source=PERSON, bearing_id="p"),)))
    walk.believe()
    for muted in (True, False):
        assert sent(walk.command(commands.MuteSource(of="person", name=PERSON.name, muted=muted))) == []
        assert walk.search.emitters[FIRST_EMITTER].bearing_ids == (() if muted else ("p",))
        assert sent(walk.believe()) == []
    assert fold(walk.recorded) == walk.state


def test_where_the_only_bearing_is_left_out_the_craft_does_not_turn_again() -> None:
    """Without a bearing the next turn is planned where it hovers: if that was wrong, right above the emitter."""
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.command(commands.Hold())
    walk.believe()
    walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert not walk.craft.has_bearing
    walk.believe()
    walk.command(commands.Resume())
    planned = [effect for effect in of_craft(tuple(walk.asked)) if isinstance(effect, effects.PlanNext)][-1]
    assert planned.avoid == (bearing(1).place,)
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((rejected(1, 2).model_copy(update={"reason": UNLIKE}),)))
    assert walk.craft.phase == "planning", "as before the first bearing, it is not repeated"
    walk.command(commands.IncludeBearing(bearing_id="b1"))
    assert walk.craft.has_bearing
    assert fold(walk.recorded) == walk.state


def test_a_place_is_not_avoided_while_another_bearing_counts() -> None:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.believe()
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((bearing(2),)))
    walk.believe()
    walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert walk.craft.has_bearing
    assert walk.craft.avoid == ()


def test_an_excluded_bearing_is_taken_out_of_the_belief_without_moving_the_vehicle() -> None:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.command(commands.Hold())
    walk.believe()
    asked = walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert UpdateBelief(FIRST_EMITTER) in asked
    assert sent(asked) == []
    assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ()
