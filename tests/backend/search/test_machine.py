"""The search machine in every stage against every input, and a search that no craft flies for."""

from __future__ import annotations

from typing import get_args

import pytest
from facts import (
    AREA,
    CHECK,
    FAILED_CHECK,
    IMPORT,
    NO_ANSWER,
    NOT_YET,
    OTHER_AREA,
    PERSON,
    SECOND,
    SPEC,
    START,
    TWO_SPEC,
    VETO,
    WAITING_SPEC,
    bearing,
    belief,
)
from search_walk import STARTED, SearchWalk, facts_of, muting, refusal

from backend import commands
from backend.events import (
    AlertRaised,
    MissionEnded,
    RecordingImported,
)
from backend.reasons import NoLongerLocalized, NotLocalized, Reason, flight, refusals
from backend.reasons.search import BeliefBroke, HeadingsAskew, Localized, LocalizedAgainst
from backend.search.effects import SearchEffect, SearchElsewhere, UpdateBelief
from backend.search.inputs import (
    BearingsArrived,
    BeliefFailed,
    BeliefReady,
    Edited,
    NotStored,
    PreflightDone,
    SearchInput,
    SearchOrdered,
    SearchOver,
)
from backend.search.machine import transition
from backend.search.state import SearchState, Stage, evolve
from backend.spec import FIRST_EMITTER
from planner.reasons import BearingsNotInBelief, NoBearingYet

STAGES: tuple[Stage, ...] = get_args(Stage)


def every_input(state: SearchState) -> list[SearchInput]:
    known = state.measured[0].bearing_id if state.measured else "unknown"
    ids = state.emitters[FIRST_EMITTER].bearing_ids
    orders: tuple[commands.ForSearch, ...] = (
        commands.ChangeArea(search=OTHER_AREA),
        commands.ExcludeBearing(bearing_id=known),
        commands.ExcludeBearing(bearing_id="unknown"),
        commands.IncludeBearing(bearing_id=known),
        commands.IncludeBearing(bearing_id="unknown"),
        *(muting(name, muted) for name in (PERSON.name, "unheard of") for muted in (True, False)),
        *(commands.SetPriorities(priorities=order) for order in ({}, {FIRST_EMITTER: 1}, {"nobody": 1})),
        commands.AcknowledgeAlert(alert_id="storage-1"),
    )
    return [
        Edited(SPEC, "anna"),
        Edited(WAITING_SPEC, "anna"),
        PreflightDone((CHECK,)),
        PreflightDone((FAILED_CHECK,)),
        BearingsArrived((bearing(1, source=PERSON, bearing_id=f"p{len(state.measured)}"),)),
        BearingsArrived((bearing(1, emitter_id="nobody", source=PERSON),)),
        BeliefReady(ids, belief(len(ids))),
        BeliefReady(ids, belief(len(ids), localized=True)),
        BeliefReady(("stale",), belief(1)),
        BeliefReady((), belief(0, emitter_id="nobody")),
        BeliefFailed(ids, FIRST_EMITTER),
        BeliefFailed(("stale",), FIRST_EMITTER),
        BeliefFailed((), "nobody"),
        *(SearchOrdered("anna", order) for order in orders),
        *(SearchOrdered("anna", order, objections=(VETO,)) for order in orders),
        *(SearchOrdered("anna", order, held=False) for order in orders),
        NotStored("a number is missing"),
        SearchOver(NO_ANSWER),
        SearchOver(NO_ANSWER, "aborted"),
        SearchOver(NO_ANSWER, "failed"),
    ]


def check_rules(before: SearchState, given: SearchInput, after: SearchState, asked: tuple[SearchEffect, ...]) -> None:
    folded = before
    for fact in facts_of(asked):
        folded = evolve(folded, fact, 2_000.0)
    assert folded == after, "the new state is the fold of the recorded facts"
    command = given.command if isinstance(given, SearchOrdered) else None
    if before.stage == "ended":
        assert (after.stage, after.outcome, after.outcome_reason) == ("ended", before.outcome, before.outcome_reason)
    if after.stage == "ended" and before.stage != "ended":
        assert isinstance(given, SearchOver)
        assert before.stage == "open"
    if after.spec != before.spec:
        edited = isinstance(given, Edited) and before.stage in ("draft", "ready")
        changed = isinstance(command, commands.ChangeArea) and before.stage == "open"
        ordered = isinstance(command, commands.SetPriorities) and before.stage == "open"
        assert edited or changed or ordered
        assert not ordered or after.mission.in_order(before.mission.priorities) == before.mission
        assert not changed or (given.held and not given.objections)  # type: ignore[union-attr]
    if refusal(asked) is not None:
        assert after == before, "what is refused leaves no trace in the search"
    for emitter in after.emitters.values():
        if emitter.localized:
            assert emitter.belief is not None
            assert emitter.belief.bearings == len(emitter.bearing_ids)
    if after.started_at_s != before.started_at_s:
        raise AssertionError("only a craft's start opens a search")


@pytest.mark.parametrize("stage", STAGES)
def test_every_input_is_answered_in_every_stage(stage: Stage) -> None:
    start = SearchWalk().to(stage).state
    for given in every_input(start):
        after, asked = transition(start, given, 2_000.0)
        check_rules(start, given, after, asked)
        for again in every_input(after):
            twice, more = transition(after, again, 2_000.0)
            check_rules(after, again, twice, more)
            for third in every_input(twice):
                check_rules(twice, third, *transition(twice, third, 2_000.0))


def test_editing_takes_readiness_back_until_the_start() -> None:
    walk = SearchWalk().to("ready")
    walk.give(Edited(WAITING_SPEC, "anna"))
    assert (walk.state.stage, walk.state.spec) == ("draft", WAITING_SPEC)
    started = SearchWalk().to("open")
    assert started.give(Edited(WAITING_SPEC, "anna")) == ()
    assert started.state.spec == SPEC


def test_a_preflight_says_whether_the_mission_is_ready() -> None:
    walk = SearchWalk()
    walk.give(PreflightDone((FAILED_CHECK, CHECK)))
    assert walk.state.stage == "draft"
    walk.give(PreflightDone((FAILED_CHECK.model_copy(update={"blocking": False}), CHECK)))
    assert walk.state.stage == "ready"


@pytest.mark.parametrize("source", [PERSON, IMPORT])
def test_a_search_without_a_craft_is_made_of_bearings_from_elsewhere(source: object) -> None:
    walk = SearchWalk()
    for number in (1, 2):
        asked = walk.arrive(bearing(number, source=source))  # type: ignore[arg-type]
        assert asked[-1] == UpdateBelief(FIRST_EMITTER)
        assert not walk.state.localized
        walk.believe(localized=number == 2)
    emitter = walk.state.emitters[FIRST_EMITTER]
    assert (emitter.bearing_ids, emitter.localized, walk.state.localized) == (("b1", "b2"), True, True)
    assert walk.state.stage == "draft"
    assert walk.state.home is None
    walk.order(commands.ExcludeBearing(bearing_id="b2"))
    assert (emitter.bearing_ids, walk.state.localized) == (("b1", "b2"), False)
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ("b1",)
    walk.believe()
    assert walk.state.not_yet == (NOT_YET,)


def test_bearings_that_no_belief_contains_are_not_said_to_be_none() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1))
    assert walk.state.not_yet == (BearingsNotInBelief(1),)
    walk.fold(belief(0).model_copy(update={"not_yet": [NoBearingYet()]}))
    walk.arrive(bearing(2))
    assert walk.state.not_yet == (BearingsNotInBelief(2),)
    walk.order(commands.ExcludeBearing(bearing_id="b1"))
    assert walk.state.not_yet == (BearingsNotInBelief(1),)
    walk.order(commands.ExcludeBearing(bearing_id="b2"))
    assert walk.state.not_yet == (NoBearingYet(),)
    walk.fold(belief(2))
    walk.arrive(bearing(3))
    assert walk.state.not_yet == (NOT_YET,), "what a belief of some bearings said stands until the next"


def test_the_facts_of_an_import_are_kept_in_order_and_its_bearings_counted() -> None:
    walk = SearchWalk().to("open")
    imported = RecordingImported(
        emitter_id=FIRST_EMITTER,
        recording_id="turn",
        filename="turn.csv",
        by="anna",
        recorded_at_utc=None,
        sweep_ids=["s1", "s2"],
        remarks=[],
    )
    facts = (imported, bearing(1, source=IMPORT), bearing(2, source=IMPORT))
    asked = walk.arrive(*facts)
    assert facts_of(asked) == list(facts)
    assert [effect for effect in asked if isinstance(effect, UpdateBelief)] == [UpdateBelief(FIRST_EMITTER)]


def test_a_bearing_of_an_emitter_that_is_not_looked_for_is_refused_whole() -> None:
    walk = SearchWalk()
    asked = walk.arrive(bearing(1, source=PERSON), bearing(2, emitter_id="other", source=PERSON))
    assert refusal(asked) == refusals.NoSuchEmitter("other")
    assert walk.state.measured == ()


def test_each_emitter_has_its_own_bearings_belief_and_verdict() -> None:
    walk = SearchWalk(TWO_SPEC).to("open")
    walk.arrive(bearing(1, source=PERSON, bearing_id="a"))
    walk.believe(localized=True)
    assert not walk.state.localized
    assert [emitter.emitter_id for emitter in walk.state.wanted] == [SECOND]
    walk.arrive(bearing(1, SECOND, PERSON, bearing_id="b"))
    assert walk.state.emitters[FIRST_EMITTER].belief_current, "a bearing of one emitter is none of the other"
    walk.believe(True, SECOND)
    assert walk.state.localized
    assert walk.state.localized_at_s == walk.at_s
    walk.order(commands.ExcludeBearing(bearing_id="a"))
    assert [emitter.emitter_id for emitter in walk.state.wanted] == [FIRST_EMITTER]


def test_a_stale_belief_is_not_recorded() -> None:
    walk = SearchWalk().to("open")
    ready = BeliefReady((), belief(0, localized=True))
    walk.arrive(bearing(1, source=PERSON))
    assert walk.give(ready) == ()
    walk.believe()
    assert walk.believe() == (), "nor one that says what is known already"


def test_an_emitter_that_is_no_longer_looked_for_takes_its_bearings_with_it() -> None:
    walk = SearchWalk(TWO_SPEC)
    walk.arrive(bearing(1, source=PERSON), bearing(1, SECOND, PERSON, bearing_id="b"))
    walk.give(Edited(SPEC, "anna"))
    assert list(walk.state.emitters) == [FIRST_EMITTER]
    assert [b.bearing_id for b in walk.state.measured] == ["b1"]


def test_the_start_makes_what_was_believed_before_it_stale() -> None:
    """The bearings are folded again in the frame of the home."""
    walk = SearchWalk()
    walk.arrive(bearing(1, source=PERSON))
    walk.believe()
    assert walk.state.beliefs_current
    walk.fold(STARTED)
    assert not walk.state.beliefs_current
    assert walk.state.home == START.home


CHANGE = commands.ChangeArea(search=OTHER_AREA)


@pytest.mark.parametrize(
    ("stage", "reason"),
    [("draft", refusals.NotStarted()), ("ready", refusals.NotStarted()), ("ended", refusals.MissionOver())],
)
def test_the_area_changes_while_the_search_is_open_only(stage: Stage, reason: object) -> None:
    walk = SearchWalk().to(stage)
    assert refusal(walk.order(CHANGE)) == reason
    assert walk.state.spec == SPEC


def test_the_area_changes_in_hold_only_and_the_bearings_count_on() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    walk.believe(localized=True)
    assert refusal(walk.order(CHANGE, held=False)) == refusals.AreaOnlyInHold()
    assert refusal(walk.order(CHANGE, objections=(VETO,))) == VETO
    assert walk.state.mission.area == AREA
    asked = walk.order(CHANGE)
    assert asked[-2:] == (SearchElsewhere(), UpdateBelief(FIRST_EMITTER))
    assert walk.state.spec == SPEC.searching(OTHER_AREA)
    assert walk.state.emitters[FIRST_EMITTER].bearing_ids == ("b1",)
    assert (walk.state.localized, walk.state.localized_at_s) == (False, None)


def test_an_offset_common_to_all_bearings_is_an_alert_until_there_is_none() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    askew = HeadingsAskew(12.4, 1.6)
    doubted = belief(1).model_copy(update={"not_yet": [NOT_YET, askew], "heading_offset_deg": 12.4})
    walk.give(BeliefReady(("b1",), doubted))
    (raised,) = [fact for fact in walk.recorded if isinstance(fact, AlertRaised)]
    assert (raised.topic, raised.level, raised.reason, raised.craft_id) == ("heading", "caution", askew, None)
    walk.arrive(bearing(2, source=PERSON))
    assert walk.state.open_alerts
    walk.believe()
    assert not walk.state.open_alerts


def test_what_can_never_be_stored_is_an_alert_of_an_open_search() -> None:
    for stage in STAGES:
        walk = SearchWalk().to(stage)
        walk.give(NotStored("a number is missing"))
        expected = [flight.NotStored("a number is missing")] if stage == "open" else []
        assert [alert.reason for alert in walk.state.open_alerts] == expected


def test_a_belief_that_cannot_be_computed_is_an_alert_until_there_is_one() -> None:
    for stage in STAGES:
        walk = SearchWalk().to(stage)
        walk.arrive(bearing(1, source=PERSON))
        walk.give(BeliefFailed(("stale",), FIRST_EMITTER))
        assert walk.state.open_alerts == ()
        walk.give(BeliefFailed(walk.state.behind(FIRST_EMITTER), FIRST_EMITTER))
        expected = [("failure", BeliefBroke(FIRST_EMITTER))] if stage == "open" else []
        assert [(alert.topic, alert.reason) for alert in walk.state.open_alerts] == expected
        walk.believe()
        assert walk.state.open_alerts == ()


def ended(walk: SearchWalk) -> MissionEnded:
    (found,) = [fact for fact in walk.recorded if isinstance(fact, MissionEnded)]
    return found


@pytest.mark.parametrize("because", [NO_ANSWER, NotLocalized(NO_ANSWER, (NOT_YET,))])
def test_the_end_says_honestly_and_once_what_came_of_it(because: Reason) -> None:
    """A craft that goes home since it found nothing says so with the same words."""
    unheard = SearchWalk().to("open")
    unheard.believe()
    unheard.give(SearchOver(because))
    assert (ended(unheard).outcome, ended(unheard).reason) == ("not_localized", NotLocalized(NO_ANSWER, (NOT_YET,)))


def test_the_time_of_a_mission_is_until_it_was_localized() -> None:
    found = SearchWalk().to("open")
    found.arrive(bearing(1, source=PERSON))
    found.believe(localized=True)
    at_s = found.at_s
    found.at_s += 60.0
    found.give(SearchOver(Localized()))
    assert (ended(found).outcome, ended(found).reason) == ("localized", Localized())
    assert ended(found).mission_time_s == at_s - (found.state.started_at_s or 0.0)


def test_the_end_of_a_claim_against_a_bearing_says_so() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    against = belief(1, localized=True).model_copy(update={"contradicting": ["b1"]})
    walk.give(BeliefReady(("b1",), against))
    walk.give(SearchOver(Localized()))
    assert ended(walk).reason == LocalizedAgainst(1, 1)


def test_a_search_whose_bearing_was_excluded_on_the_way_home_does_not_say_that_it_is_localized() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    walk.believe(localized=True)
    walk.order(commands.ExcludeBearing(bearing_id="b1"))
    walk.believe()
    walk.give(SearchOver(Localized()))
    assert (ended(walk).outcome, ended(walk).reason) == ("not_localized", NoLongerLocalized((NOT_YET,)))


def test_a_search_that_ended_still_takes_in_bearings_and_says_nothing_new_about_its_end() -> None:
    walk = SearchWalk().to("ended")
    walk.arrive(bearing(1, source=IMPORT))
    walk.believe(localized=True)
    assert walk.state.localized
    assert walk.give(SearchOver(Localized())) == ()
    assert walk.state.outcome == "aborted"


def test_place_numbers_count_on_over_all_sources() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(7, source=IMPORT))
    walk.arrive(bearing(3, source=PERSON))
    assert walk.state.place_number == 7
