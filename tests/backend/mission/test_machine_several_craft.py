"""The mission machine with two craft for one search."""

from __future__ import annotations

import pytest
from facts import (
    GIVEN_BACK,
    HOME,
    OTHER_AREA,
    PERSON,
    START,
    bearing,
)
from walks import Walk, of_craft, refusal, sent

from backend import commands
from backend.craft import effects, inputs
from backend.events import FIRST_CRAFT, MissionEnded, MissionStarted
from backend.mission.state import fold
from backend.reasons import refusals
from backend.reasons.flight import Ordered, Proceeds
from backend.search.inputs import BearingsArrived

OTHER_CRAFT = "craft-2"


def two_craft() -> Walk:
    """Both in the air for one search, the first on its way to a place."""
    walk = Walk().start(FIRST_CRAFT)
    walk.start(OTHER_CRAFT)
    return walk.fly(FIRST_CRAFT)


def phases(walk: Walk) -> dict[str, str]:
    return {craft.craft_id: craft.phase for craft in walk.state.crafts.values()}


def test_two_craft_of_one_search_keep_their_own_phase_place_and_authority() -> None:
    walk = two_craft()
    assert phases(walk) == {FIRST_CRAFT: "flying", OTHER_CRAFT: "planning"}
    walk.fly(OTHER_CRAFT)
    first, other = (walk.state.crafts[name] for name in (FIRST_CRAFT, OTHER_CRAFT))
    assert (first.place_number, other.place_number, walk.search.place_number) == (1, 2, 2)
    assert first.chosen != other.chosen
    walk.arrive(FIRST_CRAFT)
    walk.to_craft(inputs.AuthorityHeard(GIVEN_BACK), OTHER_CRAFT)
    assert phases(walk) == {FIRST_CRAFT: "measuring", OTHER_CRAFT: "manual"}
    assert [walk.state.crafts[name].taken_over for name in (FIRST_CRAFT, OTHER_CRAFT)] == [False, True]
    assert walk.of_kind(MissionStarted)[1].craft_id == OTHER_CRAFT
    assert walk.search.home == START.home
    assert fold(walk.recorded) == walk.state


def test_what_one_craft_measures_the_other_takes_into_its_plans() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    walk.arrive(FIRST_CRAFT)
    chosen = walk.state.crafts[OTHER_CRAFT].chosen
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    assert walk.state.crafts[OTHER_CRAFT].chosen == chosen, "it keeps its place"
    asked = walk.believe()
    assert of_craft(asked, FIRST_CRAFT) == [effects.PlanNext(3, ())]
    assert of_craft(asked, OTHER_CRAFT) == []
    walk.give(BearingsArrived((bearing(9, source=PERSON, bearing_id="p"),)))
    asked = walk.believe(localized=True)
    for name in (FIRST_CRAFT, OTHER_CRAFT):
        assert sent(asked, name) == [effects.ReturnHome()]


def test_the_search_ends_when_the_last_craft_is_down() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    for name in (FIRST_CRAFT, OTHER_CRAFT):
        assert sent(walk.command(commands.Return(craft_id=name)), name) == [effects.ReturnHome()]
        walk.to_craft(inputs.HomeReached(), name)
        assert walk.search.stage == "open"
        walk.to_craft(inputs.Landed(), name)
    assert (walk.state.phase, walk.search.outcome, walk.state.engaged) == ("done", "not_localized", ())
    assert len(walk.of_kind(MissionEnded)) == 1


def test_an_abort_of_one_craft_leaves_the_other_searching_and_of_both_ends_the_search() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    asked = walk.command(commands.Abort(craft_id=FIRST_CRAFT))
    assert sent(asked, FIRST_CRAFT) == [effects.HoldVehicle()]
    assert sent(asked, OTHER_CRAFT) == []
    assert walk.search.stage == "open"
    assert phases(walk) == {FIRST_CRAFT: "returning", OTHER_CRAFT: "flying"}
    walk.to_craft(inputs.Landed(), FIRST_CRAFT)
    assert walk.search.stage == "open"
    walk.command(commands.Abort(craft_id=OTHER_CRAFT))
    assert walk.search.outcome == "aborted"
    assert [craft.craft_id for craft in walk.state.engaged] == [OTHER_CRAFT]


@pytest.mark.parametrize(
    ("command", "wanted"),
    [
        (commands.Hold(), effects.HoldVehicle()),
        (commands.Return(), effects.ReturnHome()),
        (commands.Land(), effects.Land()),
        (commands.Abort(), effects.HoldVehicle()),
    ],
)
def test_hold_return_and_abort_without_a_name_are_for_every_craft(command: commands.ForCraft, wanted: object) -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    asked = walk.command(command)
    assert refusal(asked) is None
    for name in (FIRST_CRAFT, OTHER_CRAFT):
        assert sent(asked, name) == [wanted]
    if isinstance(command, commands.Abort):
        assert walk.search.outcome == "aborted"
        assert len(walk.of_kind(MissionEnded)) == 1


def test_one_of_two_craft_that_a_pilot_flies_does_not_keep_the_other_from_being_held() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    walk.to_craft(inputs.AuthorityHeard(GIVEN_BACK), FIRST_CRAFT)
    asked = walk.command(commands.Hold())
    assert refusal(asked) is None
    assert (sent(asked, FIRST_CRAFT), sent(asked, OTHER_CRAFT)) == ([], [effects.HoldVehicle()])


def test_an_order_for_one_of_several_craft_must_name_it() -> None:
    walk = two_craft()
    for command in (commands.Resume(), commands.Override(place=HOME), commands.Accept(), commands.Veto()):
        assert isinstance(refusal(walk.command(command)), refusals.NoSuchCraft)
    assert refusal(walk.command(commands.Hold(craft_id="craft-3"))) == refusals.NoSuchCraft("craft-3")
    assert refusal(walk.command(commands.Override(craft_id=FIRST_CRAFT, place=HOME))) is None


def test_the_area_changes_only_when_every_craft_is_held() -> None:
    walk = two_craft()
    walk.command(commands.Hold(craft_id=FIRST_CRAFT))
    change = commands.ChangeArea(search=OTHER_AREA)
    assert refusal(walk.command(change)) == refusals.AreaOnlyInHold()
    walk.command(commands.Hold(craft_id=OTHER_CRAFT))
    assert refusal(walk.command(change)) is None


def test_why_a_craft_is_in_its_phase_is_its_own() -> None:
    walk = two_craft()
    walk.command(commands.Hold(craft_id=FIRST_CRAFT))
    first, other = (walk.state.crafts[name] for name in (FIRST_CRAFT, OTHER_CRAFT))
    assert first.phase_reason == Ordered("hold", "anna")
    assert other.phase_reason == Proceeds("climb")
