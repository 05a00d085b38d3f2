"""What counts: bearings, silences and sources that are left out, muted, and counted again."""

from __future__ import annotations

from facts import (
    IMPORT,
    PERSON,
    SECOND,
    TWO_SPEC,
    bearing,
    belief,
    rejected,
    silent,
)
from search_walk import SearchWalk, facts_of, muting, refusal

from backend import commands
from backend.events import (
    BearingExcluded,
    BearingIncluded,
    PersonSource,
)
from backend.reasons import refusals
from backend.search.effects import UpdateBelief
from backend.search.inputs import (
    BeliefReady,
)
from backend.spec import FIRST_EMITTER


def test_a_bearing_is_excluded_once_and_only_where_it_is_known() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    assert walk.order(commands.ExcludeBearing(bearing_id="b1"))[-1] == UpdateBelief(FIRST_EMITTER)
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ()
    assert next(fact for fact in walk.recorded if isinstance(fact, BearingExcluded)).emitter_id == FIRST_EMITTER
    again, other = (walk.order(commands.ExcludeBearing(bearing_id=name)) for name in ("b1", "b9"))
    assert (refusal(again), refusal(other)) == (refusals.BearingExcludedAlready(), refusals.NoSuchBearing())


def test_a_turn_that_heard_nothing_outruns_the_belief_and_can_be_left_out_like_a_bearing() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    walk.believe(localized=True)
    walk.fold(rejected(1, 2))
    assert walk.state.localized, "a turn that was refused for another reason tells nothing"
    walk.fold(silent(1, 3))
    emitter = walk.state.emitters[FIRST_EMITTER]
    assert (emitter.bearing_ids, emitter.localized, len(emitter.bearings)) == (("b1", "r3-1"), False, 1)
    assert not facts_of(walk.give(BeliefReady(("b1",), belief(1)))), "a belief without it is no longer current"
    walk.believe(localized=True)
    assert walk.order(commands.ExcludeBearing(bearing_id="r3-1"))[-1] == UpdateBelief(FIRST_EMITTER)
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ("b1",)
    (left_out,) = [fact for fact in walk.recorded if isinstance(fact, BearingExcluded)]
    assert not left_out.heard
    again = walk.order(commands.ExcludeBearing(bearing_id="r3-1"))
    assert refusal(again) == refusals.BearingExcludedAlready()
    assert refusal(walk.order(commands.ExcludeBearing(bearing_id="r2-1"))) == refusals.NoSuchBearing()
    assert walk.order(commands.IncludeBearing(bearing_id="r3-1"))[-1] == UpdateBelief(FIRST_EMITTER)
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ("b1", "r3-1")
    (back,) = [fact for fact in walk.recorded if isinstance(fact, BearingIncluded)]
    assert not back.heard


def test_a_bearing_counts_again_in_its_old_place_and_the_belief_is_the_same() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON), bearing(2, source=PERSON))
    before = walk.state.emitters[FIRST_EMITTER].bearings
    walk.order(commands.ExcludeBearing(bearing_id="b1"))
    walk.believe(localized=True)
    assert walk.order(commands.IncludeBearing(bearing_id="b1"))[-1] == UpdateBelief(FIRST_EMITTER)
    emitter = walk.state.emitters[FIRST_EMITTER]
    assert (emitter.bearings, emitter.claim, emitter.belief_current) == (before, None, False)
    again, other = (walk.order(commands.IncludeBearing(bearing_id=name)) for name in ("b1", "b9"))
    assert (refusal(again), refusal(other)) == (refusals.BearingCountsAlready(), refusals.NoSuchBearing())


def test_a_muted_person_counts_for_nothing_until_unmuted_and_what_was_left_out_stays_so() -> None:
    walk = SearchWalk().to("open")
    ben = PersonSource(name="Ben")
    walk.arrive(bearing(1, source=PERSON), bearing(2, source=ben), bearing(3, source=PERSON))
    walk.order(commands.ExcludeBearing(bearing_id="b3"))
    walk.believe(localized=True)
    assert walk.order(muting(PERSON.name, True))[-1] == UpdateBelief(FIRST_EMITTER)
    walk.arrive(bearing(4, source=PERSON))
    emitter = walk.state.emitters[FIRST_EMITTER]
    assert (emitter.bearing_ids, emitter.claim) == (("b2",), None)
    assert refusal(walk.order(muting(PERSON.name, True))) == refusals.MutedAlready(True)
    walk.order(muting(PERSON.name, False))
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ("b1", "b2", "b4")
    assert refusal(walk.order(muting(PERSON.name, False))) == refusals.MutedAlready(False)


def test_a_source_that_told_nothing_is_not_muted_nor_a_recording_that_is_named_as_a_person() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON), bearing(2, source=IMPORT))
    for unknown in (muting("Eve", True), muting(IMPORT.recording_id, True)):
        assert refusal(walk.order(unknown)) == refusals.NoSuchSource()
    walk.order(commands.MuteSource(of="import", name=IMPORT.recording_id, muted=True))
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ("b1",)


def test_muting_leaves_the_emitters_alone_that_the_source_told_nothing_of() -> None:
    walk = SearchWalk(TWO_SPEC).to("open")
    walk.arrive(bearing(1, source=PERSON), bearing(2, emitter_id=SECOND, source=PersonSource(name="Ben")))
    walk.believe(localized=True)
    walk.believe(localized=True, emitter_id=SECOND)
    walk.order(muting(PERSON.name, True))
    assert [walk.state.emitters[name].localized for name in (FIRST_EMITTER, SECOND)] == [False, True]
