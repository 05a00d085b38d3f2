"""What the autopilot says and refuses, in the machine: readable alerts, and places that are not tried again."""

from __future__ import annotations

import math

import pytest
from craft_inputs import NOT_TAKEN, SAID
from craft_walk import PHASES, CraftWalk, craft_in, moves, refusal
from facts import OTHER_AREA, plan

from backend import commands
from backend.craft import effects, inputs
from backend.craft.machine import MOST_REFUSED
from backend.craft.step import MOST_SAID
from backend.events import AlertRaised, AreaChanged, Phase, PlaceRefused
from backend.reasons.refusals import PlaceRefusedBefore
from backend.spec import Place
from hardware.frame import LocalFrame
from hardware.reasons.vehicle_news import AutopilotRepeats, AutopilotSaid
from planner.policy.actions import SAME_PLACE_M


def standing(walk: CraftWalk) -> list[str]:
    return [getattr(raised.reason, "text", "") for raised in walk.craft.open_alerts if raised.topic == "autopilot"]


@pytest.mark.parametrize("phase", [phase for phase in PHASES if phase != "ground"])
def test_in_every_phase_the_words_are_an_alert_and_change_nothing_else(phase: Phase) -> None:
    walk = craft_in(phase)
    before = walk.craft.phase
    asked = walk.give(inputs.Said(SAID[0]))
    assert (walk.last_alert.topic, walk.last_alert.level) == ("autopilot", "warning")
    assert moves(asked) == []
    assert walk.craft.phase == before
    walk.give(inputs.Said(AutopilotSaid("warning", "High wind")))
    assert walk.last_alert.level == "caution"
    assert len(standing(walk)) == 2


def test_a_text_that_repeats_takes_the_place_of_itself_and_goes_when_it_is_over() -> None:
    walk = craft_in("flying")
    walk.give(inputs.Said(AutopilotSaid("error", "a")))
    walk.give(inputs.Said(AutopilotSaid("error", "b")))
    walk.give(inputs.Said(AutopilotRepeats("error", "a", 4)))
    assert standing(walk) == ["b", "a"]
    walk.give(inputs.SaidNoMore("a"))
    assert standing(walk) == ["b"]


def test_only_so_many_texts_stand_side_by_side() -> None:
    walk = craft_in("flying")
    for number in range(3 * MOST_SAID):
        walk.give(inputs.Said(AutopilotSaid("critical", f"text {number}")))
    assert standing(walk) == [f"text {number}" for number in range(2 * MOST_SAID, 3 * MOST_SAID)]
    assert len(walk.of_kind(AlertRaised)) >= 3 * MOST_SAID  # each is a fact


def test_on_the_ground_nothing_is_recorded() -> None:
    walk = CraftWalk()
    assert walk.give(inputs.Said(SAID[0])) == ()


def test_a_refused_place_is_a_fact_and_another_is_planned_without_it() -> None:
    walk = craft_in("flying")
    assert walk.craft.chosen is not None
    place = walk.craft.chosen.place
    asked = walk.give(inputs.PlaceNotTaken(place, NOT_TAKEN))
    assert [fact.place for fact in walk.of_kind(PlaceRefused)] == [place]
    (planned,) = [effect for effect in asked if isinstance(effect, effects.PlanNext)]
    assert place in planned.avoid
    assert walk.craft.phase == "planning"
    assert refusal(walk.order(commands.Override(place=place))) == PlaceRefusedBefore(0.0, SAME_PLACE_M)


@pytest.mark.parametrize("bearing_deg", range(0, 360, 45))
def test_a_place_beside_a_refused_one_is_refused_and_one_further_off_is_flown_to(bearing_deg: int) -> None:
    walk = craft_in("flying")
    assert walk.craft.chosen is not None
    refused = walk.craft.chosen.place
    walk.give(inputs.PlaceNotTaken(refused, NOT_TAKEN))
    towards = math.radians(bearing_deg)

    def beside(away_m: float) -> Place:
        return LocalFrame(refused).to_geo(away_m * math.sin(towards), away_m * math.cos(towards))

    near = refusal(walk.order(commands.Override(place=beside(SAME_PLACE_M - 0.1))))
    assert isinstance(near, PlaceRefusedBefore)
    assert near.near_m == pytest.approx(SAME_PLACE_M - 0.1, abs=1e-3)
    assert refusal(walk.order(commands.Override(place=beside(SAME_PLACE_M + 0.1)))) is None


def test_every_refused_place_counts_until_the_search_area_changes() -> None:
    walk = craft_in("flying")
    first, second = Place(50.0, 7.001), Place(50.0, 7.002)
    walk.give(inputs.PlaceNotTaken(first, NOT_TAKEN))
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.PlaceNotTaken(second, NOT_TAKEN))
    for place in (first, second):
        assert isinstance(refusal(walk.order(commands.Override(place=place))), PlaceRefusedBefore)
    walk.order(commands.Hold())
    walk.fold(AreaChanged(search=OTHER_AREA, by="anna"))
    walk.give(inputs.NetsUp())
    assert refusal(walk.order(commands.Override(place=first))) is None


def test_when_place_after_place_is_refused_the_craft_holds() -> None:
    walk = craft_in("flying")
    for number in range(1, MOST_REFUSED + 1):
        assert walk.craft.phase == "flying"
        walk.give(inputs.PlaceNotTaken(Place(50.0, 7.0 + number / 1_000), NOT_TAKEN))
        if number < MOST_REFUSED:
            walk.give(inputs.Planned(plan(number + 1)))
    assert walk.craft.phase == "hold"
    assert len(walk.craft.refused) == MOST_REFUSED


def test_a_refusal_that_comes_after_something_else_was_ordered_counts_for_nothing() -> None:
    for phase in PHASES:
        if phase != "flying":
            assert craft_in(phase).give(inputs.PlaceNotTaken(Place(50.0, 7.0), NOT_TAKEN)) == ()
