"""What a craft does by itself: from the start to the ground, from place to place, and what it makes of bearings."""

from __future__ import annotations

import pytest
from craft_walk import CraftWalk, craft_in, moves, refusal, sent
from facts import (
    BATTERY_VETO,
    HOME,
    IMPORT,
    LINK_LOST,
    NO_PLACE,
    NOT_YET,
    OURS,
    PERSON,
    SECOND,
    SPEC,
    TWO_SPEC,
    bearing,
    belief,
    plan,
    rejected,
)

from backend import commands
from backend.craft import effects, inputs
from backend.events import AlertRaised, BearingSource, MissionEnded
from backend.reasons import NotLocalized, PlacesUsedUp, refusals
from backend.reasons.flight import Landed, PlaceUnsure
from backend.spec import FIRST_EMITTER


def test_a_craft_measures_from_place_to_place_until_the_search_is_localized_and_comes_home() -> None:
    walk = CraftWalk()
    walk.order(commands.Start())
    assert walk.craft.phase == "taking_off"
    walk.give(inputs.AuthorityHeard(OURS))
    assert moves(walk.give(inputs.InTheAir(HOME, 40.0))) == []
    for number in (1, 2):
        assert walk.believe()[-1] == effects.PlanNext(number, ())
        assert walk.give(inputs.Planned(plan(number)))[-1] == effects.FlyTo(number, plan(number).place)
        assert walk.give(inputs.Arrived(HOME, 0.3, 9.0))[-1] == effects.Measure(number, 1)
        walk.give(inputs.SweepTaken((bearing(number),)))
        assert walk.craft.phase == "planning"
    assert walk.believe(localized=True)[-1] == effects.ReturnHome()
    walk.give(inputs.HomeReached())
    assert walk.craft.phase == "landing"
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.craft.engaged, walk.search.outcome) == ("ground", False, "localized")


def test_a_rejected_sweep_is_taken_again_and_then_another_place_is_chosen() -> None:
    walk = CraftWalk().to("measuring")
    assert walk.craft.chosen is not None
    place = walk.craft.chosen.place
    assert walk.give(inputs.SweepTaken((rejected(1),)))[-1] == effects.Measure(1, 2)
    assert walk.give(inputs.SweepTaken((rejected(2),)))[-1] == effects.PlanNext(2, (place,))
    assert walk.craft.phase == "planning"


def test_a_craft_whose_mission_ran_out_of_places_goes_home_honestly() -> None:
    walk = CraftWalk().to("planning")
    most = SPEC.localization.maximum_bearings
    for number in range(1, most + 1):
        walk.believe()
        walk.give(inputs.Planned(plan(number)))
        walk.give(inputs.Arrived(HOME, 0.3, 9.0))
        walk.give(inputs.SweepTaken((bearing(number),)))
    walk.believe()
    assert walk.craft.phase == "returning"
    walk.give(inputs.Landed())
    (ended,) = walk.of_kind(MissionEnded)
    assert ended.outcome == "not_localized"
    reason = NotLocalized(PlacesUsedUp(most), (NOT_YET,))
    assert walk.craft.return_reason == reason


def test_nothing_left_to_plan_goes_home() -> None:
    walk = CraftWalk().to("planning")
    walk.believe()
    assert moves(walk.give(inputs.NothingToPlan(NO_PLACE))) == [effects.ReturnHome()]
    assert walk.craft.return_reason == NotLocalized(NO_PLACE, (NOT_YET,))


def test_a_vehicle_that_landed_by_itself_waits_on_the_ground_and_takes_off_again_on_resume() -> None:
    for phase in ("hold", "flying"):
        walk = craft_in(phase)  # type: ignore[arg-type]
        assert not moves(walk.give(inputs.Landed()))
        assert walk.craft.phase == "hold"
        assert walk.topics == ["ground"]
        assert walk.give(inputs.Landed()) == ()
        chosen = walk.craft.chosen
        assert chosen is not None
        asked = walk.order(commands.Resume(), on_ground=True)
        assert moves(asked) == [effects.TakeOff(SPEC.flight.altitude_relative_m, again=True, chosen=chosen.place)]
        assert walk.craft.phase == "taking_off"
        assert not walk.topics
        walk.give(inputs.InTheAir(HOME, 40.0))
        assert walk.craft.phase == "flying"


def test_a_search_that_waits_on_the_ground_does_not_end_because_nobody_watches() -> None:
    """Whoever changes the battery there may close the console meanwhile."""
    walk = craft_in("hold")
    walk.give(inputs.Landed())
    walk.give(inputs.LinkDown("console", LINK_LOST))
    assert not sent(walk.give(inputs.TimerExpired("console_return")))
    assert (walk.craft.phase, walk.craft.engaged) == ("hold", True)
    walk.order(commands.Resume(), on_ground=True)
    walk.give(inputs.InTheAir(HOME, 40.0))
    walk.give(inputs.TimerExpired("console_return"))
    assert walk.craft.phase == "returning"


def test_what_the_battery_forbids_on_the_ground_waits_there_and_the_search_goes_on() -> None:
    walk = craft_in("hold")
    walk.give(inputs.Landed())
    walk.order(commands.Resume(), on_ground=True)
    chosen = walk.craft.chosen
    asked = walk.give(inputs.WorkVetoed((BATTERY_VETO,), on_ground=True))
    assert not sent(asked)
    assert (walk.craft.phase, walk.craft.engaged, walk.search.outcome) == ("hold", True, None)
    assert walk.craft.chosen == chosen
    assert (walk.topics, walk.last_alert.reason) == (["safety"], BATTERY_VETO)
    walk.order(commands.Resume(), on_ground=True)
    assert not walk.topics
    assert walk.craft.phase == "taking_off"


def test_a_vehicle_that_landed_in_hold_when_all_is_localized_is_done() -> None:
    walk = CraftWalk().to("measuring")
    walk.give(inputs.SweepTaken((bearing(1),)))
    walk.order(commands.Hold())
    walk.believe(localized=True)
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.search.outcome) == ("ground", "localized")
    assert walk.craft.phase_reason == Landed("localized")


def test_a_place_that_jumped_is_an_alert_until_a_bearing_comes_from_a_sure_one() -> None:
    walk = CraftWalk().to("measuring")
    walk.give(inputs.SweepTaken((bearing(1).model_copy(update={"drift_m": 30.0}),)))
    (raised,) = walk.of_kind(AlertRaised)
    assert (raised.topic, raised.level, raised.reason) == ("place", "caution", PlaceUnsure(1, 30.0))
    walk.believe()
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    assert walk.topics == ["place"]
    walk.give(inputs.SweepTaken((bearing(2),)))
    assert not walk.topics


def test_the_result_of_work_counts_only_in_the_phase_that_asked_for_it() -> None:
    results = {
        "taking_off": inputs.InTheAir(HOME, 40.0),
        "planning": inputs.Planned(plan(7)),
        "flying": inputs.Arrived(HOME, 0.3, 9.0),
        "measuring": inputs.SweepTaken((bearing(7),)),
    }
    for asker, result in results.items():
        for phase in ("hold", "manual", "returning", "landing", *(other for other in results if other != asker)):
            assert craft_in(phase).give(result) == (), (phase, asker)  # type: ignore[arg-type]


@pytest.mark.parametrize("source", [PERSON, IMPORT])
@pytest.mark.parametrize("phase", ["flying", "measuring", "waiting"])
def test_a_bearing_from_elsewhere_leaves_the_craft_its_chosen_place(phase: str, source: BearingSource) -> None:
    walk = craft_in(phase)  # type: ignore[arg-type]
    chosen, attempt = walk.craft.chosen, walk.craft.attempt
    assert chosen is not None
    assert walk.learn(bearing(9, source=source)) == ()
    assert (walk.craft.phase, walk.craft.chosen, walk.craft.attempt) == (phase, chosen, attempt)
    assert walk.believe() == ()
    assert (walk.craft.phase, walk.craft.chosen) == (phase, chosen)
    if phase == "flying":
        assert walk.give(inputs.Arrived(chosen.place, 0.3, 9.0))[-1] == effects.Measure(1, 1)


@pytest.mark.parametrize("phase", ["flying", "measuring", "waiting"])
def test_a_bearing_from_elsewhere_that_settles_the_search_brings_the_craft_home(phase: str) -> None:
    walk = craft_in(phase)  # type: ignore[arg-type]
    walk.learn(bearing(9, source=PERSON))
    assert moves(walk.believe(localized=True)) == [effects.ReturnHome()]
    assert walk.craft.phase == "returning"


def test_a_craft_that_waits_for_the_belief_plans_with_what_arrived_meanwhile() -> None:
    walk = CraftWalk().to("measuring")
    walk.give(inputs.SweepTaken((bearing(1),)))
    assert not any(isinstance(e, effects.PlanNext) for e in walk.learn(bearing(2, source=IMPORT)))
    assert walk.believe()[-1] == effects.PlanNext(3, ())


def test_a_held_craft_is_not_moved_by_what_the_search_learns() -> None:
    for phase in ("hold", "manual", "returning", "landing"):
        walk = craft_in(phase)  # type: ignore[arg-type]
        assert sent(walk.learn(bearing(9, source=PERSON))) == []
        assert sent(walk.believe(localized=True)) == []
        assert walk.craft.phase == phase


def two_emitters() -> CraftWalk:
    return CraftWalk(TWO_SPEC).to("measuring")


def test_one_turn_gives_results_for_two_emitters_and_the_craft_flies_on_until_both_are_localized() -> None:
    walk = two_emitters()
    both = (bearing(1, bearing_id="a1"), bearing(1, SECOND, bearing_id="b1"))
    walk.give(inputs.SweepTaken(both))
    assert walk.search.measured == both
    walk.learn(belief(1, localized=True))
    assert walk.craft.phase == "planning"
    assert walk.learn(belief(1, False, SECOND))[-1] == effects.PlanNext(2, ())
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    walk.give(inputs.SweepTaken((bearing(2, bearing_id="a2"), bearing(2, SECOND, bearing_id="b2"))))
    assert moves(walk.believe(localized=True)) == [effects.ReturnHome()]


def test_a_turn_that_heard_one_of_two_emitters_is_done_with_its_place_and_keeps_away_from_it() -> None:
    """Else a tag that cannot be heard there would be sought from the same place again and again."""
    walk = two_emitters()
    walk.give(inputs.SweepTaken((bearing(1, bearing_id="a1"), rejected(1, 1, SECOND))))
    assert walk.craft.phase == "planning"
    assert walk.believe()[-1] == effects.PlanNext(2, (HOME,))


def test_a_turn_that_heard_neither_is_taken_again() -> None:
    walk = two_emitters()
    assert walk.give(inputs.SweepTaken((rejected(1), rejected(1, 1, SECOND))))[-1] == effects.Measure(1, 2)
    last = walk.give(inputs.SweepTaken((rejected(2), rejected(2, 1, SECOND))))[-1]
    assert isinstance(last, effects.PlanNext)
    assert plan(1).place in last.avoid


def test_a_turn_that_heard_only_what_is_localized_already_counts_for_it_and_keeps_away_from_there() -> None:
    walk = two_emitters()
    walk.give(inputs.SweepTaken((bearing(1, bearing_id="a1"), bearing(1, SECOND, bearing_id="b1"))))
    walk.learn(belief(1, localized=True), belief(1, False, SECOND))
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    walk.give(inputs.SweepTaken((bearing(2, bearing_id="a2"), rejected(1, 2, SECOND))))
    assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ("a1", "a2")
    walk.fold(belief(2, localized=True))
    assert walk.learn(belief(1, False, SECOND))[-1] == effects.PlanNext(3, (HOME,))


def test_a_craft_that_flies_is_not_started_again() -> None:
    walk = CraftWalk().to("flying")
    assert refusal(walk.order(commands.Start())) == refusals.AlreadyStarted()
    assert walk.craft.phase == "flying"
