"""The order of importance, its changes in flight, and for how long the others wait for what comes first."""

from __future__ import annotations

import pytest
from facts import PERSON, SECOND, TWO_SPEC, bearing, belief, plan, rejected, silent
from pydantic import ValidationError
from search_walk import SearchWalk, facts_of, refusal

from backend import commands
from backend.events import Event, PrioritiesChanged, ServerRestarted
from backend.reasons import refusals
from backend.reasons.search import FirstForLong, UnclearForLong, UnheardForLong
from backend.search.importance import FIRST_PLACES, LAST, UNCLEAR_PLACES, UNHEARD_PLACES, come_first
from backend.spec import FIRST_EMITTER, MissionSpec

SECOND_FIRST = TWO_SPEC.in_order({SECOND: 1})


def open_search(spec: MissionSpec = SECOND_FIRST) -> SearchWalk:
    return SearchWalk(spec).to("open")


def sought(walk: SearchWalk) -> list[str]:
    return [emitter.emitter_id for emitter in walk.state.sought]


def set_order(walk: SearchWalk, **priorities: int) -> tuple[object, ...]:
    names = {"first": FIRST_EMITTER, "second": SECOND}
    return walk.order(commands.SetPriorities(priorities={names.get(n, n): p for n, p in priorities.items()}))


def chosen_for(number: int, *first: str) -> Event:
    return plan(number).model_copy(update={"first": list(first)})


def reasons(walk: SearchWalk) -> dict[str, object]:
    return {one.emitter_id: one.reason for one in walk.state.set_back}


def test_without_priorities_all_are_alike_and_stand_in_the_specifications_order() -> None:
    walk = open_search(TWO_SPEC)
    assert sought(walk) == [FIRST_EMITTER, SECOND]
    assert {walk.state.rank(name) for name in sought(walk)} == {LAST}
    assert come_first({FIRST_EMITTER: 3, SECOND: 3}) == come_first({}) == []


def test_a_specification_of_before_has_no_order() -> None:
    stored = TWO_SPEC.model_dump(mode="json")
    for emitter in stored["emitters"]:
        del emitter["priority"]
    assert MissionSpec.model_validate(stored) == TWO_SPEC
    assert TWO_SPEC.priorities == {}


def test_the_more_important_is_sought_first_and_once_it_is_found_the_next() -> None:
    walk = open_search()
    assert sought(walk) == [SECOND, FIRST_EMITTER]
    assert come_first({name: walk.state.rank(name) for name in sought(walk)}) == [SECOND]
    walk.arrive(bearing(1, SECOND, source=PERSON))
    walk.believe(localized=True, emitter_id=SECOND)
    assert sought(walk) == [FIRST_EMITTER]


def test_the_order_changes_in_flight_as_a_fact_and_by_a_second_change_it_is_undone() -> None:
    walk = open_search()
    assert facts_of(set_order(walk, first=1)) == [PrioritiesChanged(priorities={FIRST_EMITTER: 1}, by="anna")]  # type: ignore[arg-type]
    assert sought(walk) == [FIRST_EMITTER, SECOND]
    walk.fold(ServerRestarted())
    assert (walk.state.mission.priorities, sought(walk)) == ({FIRST_EMITTER: 1}, [FIRST_EMITTER, SECOND])
    set_order(walk, second=1)
    assert walk.state.mission == SECOND_FIRST
    set_order(walk)
    assert walk.state.mission == TWO_SPEC


def test_the_order_is_refused_before_the_start_after_the_end_and_for_an_emitter_that_is_not_sought() -> None:
    before = SearchWalk(TWO_SPEC)
    assert refusal(set_order(before, first=1)) == refusals.NotStarted()  # type: ignore[arg-type]
    over = SearchWalk(TWO_SPEC).to("ended")
    assert refusal(set_order(over, first=1)) == refusals.MissionOver()  # type: ignore[arg-type]
    walk = open_search()
    asked = walk.order(commands.SetPriorities(priorities={"nobody": 1, SECOND: 2}))
    assert refusal(asked) == refusals.NoSuchEmitter("nobody")
    assert walk.state.mission == SECOND_FIRST


@pytest.mark.parametrize("wrong", [0, -1, 33, 1.5, None, "first", 10**30])
def test_a_priority_is_a_whole_number_from_one_to_the_most_emitters(wrong: object) -> None:
    with pytest.raises(ValidationError):
        commands.SetPriorities.model_validate({"priorities": {SECOND: wrong}})
    with pytest.raises(ValidationError):
        commands.SetPriorities(priorities={f"emitter-{number}": 1 for number in range(33)})


def test_one_that_is_not_heard_stands_back_until_it_is_heard() -> None:
    walk = open_search()
    for place in range(1, UNHEARD_PLACES + 1):
        assert sought(walk)[0] == SECOND
        walk.fold(chosen_for(place, SECOND), bearing(place, bearing_id=f"a{place}"))
        walk.fold(*(silent(attempt, place, SECOND) for attempt in (1, 2)))
    assert reasons(walk) == {SECOND: UnheardForLong(UNHEARD_PLACES)}
    assert {walk.state.rank(name) for name in sought(walk)} == {LAST}
    walk.fold(bearing(4, SECOND, bearing_id="b4"))
    assert (reasons(walk), sought(walk)) == ({}, [SECOND, FIRST_EMITTER])


def test_a_turn_that_was_taken_again_at_one_place_is_one_place() -> None:
    walk = open_search()
    walk.fold(*(rejected(attempt, 1, SECOND) for attempt in range(1, UNHEARD_PLACES + 2)))
    assert reasons(walk) == {}


def test_one_whose_bearings_disagree_stands_back_until_they_agree() -> None:
    walk = open_search()
    unclear = belief(2, emitter_id=SECOND).model_copy(update={"consistent": False})
    walk.fold(*[unclear] * (UNCLEAR_PLACES + 1))
    assert reasons(walk) == {}, "what others' bearings tell of the compass is no turn"
    for place in range(1, UNCLEAR_PLACES + 1):
        assert reasons(walk) == {}
        walk.fold(bearing(place, SECOND, bearing_id=f"b{place}"), unclear)
    assert reasons(walk) == {SECOND: UnclearForLong(UNCLEAR_PLACES)}
    walk.fold(belief(3, emitter_id=SECOND))
    assert reasons(walk) == {}


def test_one_that_takes_too_long_stands_back_until_the_order_is_set_again() -> None:
    walk = open_search()
    for place in range(1, FIRST_PLACES + 1):
        assert reasons(walk) == {}
        walk.fold(chosen_for(place, SECOND), bearing(place, SECOND, bearing_id=f"b{place}"))
    assert reasons(walk) == {SECOND: FirstForLong(FIRST_PLACES)}
    walk.fold(ServerRestarted())
    assert reasons(walk) == {SECOND: FirstForLong(FIRST_PLACES)}
    set_order(walk, second=1)
    assert (reasons(walk), sought(walk)) == ({}, [SECOND, FIRST_EMITTER])


def test_places_that_were_chosen_for_another_use_up_no_patience() -> None:
    walk = open_search(TWO_SPEC.in_order({FIRST_EMITTER: 1, SECOND: 2}))
    for place in range(1, FIRST_PLACES + 1):
        walk.fold(chosen_for(place, FIRST_EMITTER), bearing(place, SECOND, bearing_id=f"b{place}"))
        walk.fold(bearing(place, bearing_id=f"a{place}"))
    assert reasons(walk) == {FIRST_EMITTER: FirstForLong(FIRST_PLACES)}
    assert sought(walk) == [SECOND, FIRST_EMITTER]


def test_a_persons_bearing_is_no_turn_of_a_craft() -> None:
    walk = open_search()
    walk.fold(chosen_for(1, SECOND))
    for number in range(FIRST_PLACES + 1):
        walk.arrive(bearing(number, SECOND, source=PERSON, bearing_id=f"p{number}"))
    assert reasons(walk) == {}
