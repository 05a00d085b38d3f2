"""The mission machine when the search area changes in flight."""

from __future__ import annotations

import pytest
from facts import (
    OTHER_AREA,
    OURS,
    PILOT,
    SPEC,
    VETO,
    bearing,
    plan,
)
from walks import PHASES, Walk, of_craft, refusal, sent, walk_in

from backend import commands
from backend.craft import effects, inputs
from backend.craft.orders import resume_refusal
from backend.events import AlertRaised, CommandRefused, NetsHung
from backend.mission.inputs import Context, ServerCameBack
from backend.mission.state import fold
from backend.reasons.refusals import NetsChanging
from backend.reasons.safety import NoWayHome, OutsideFence, PilotControls
from backend.search.effects import SearchElsewhere, UpdateBelief
from backend.spec import FIRST_EMITTER, SearchArea


@pytest.mark.parametrize("phase", PHASES)
def test_the_area_changes_in_hold_only_and_moves_nothing(phase: str) -> None:
    walk = walk_in(phase)
    before = walk.search.spec
    asked = walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert sent(asked) == []
    if phase == "hold":
        assert refusal(asked) is None
        assert asked.count(UpdateBelief(FIRST_EMITTER)) == 1
        assert SearchElsewhere() in asked
        assert walk.search.spec == SPEC.searching(OTHER_AREA)
    else:
        assert refusal(asked) is not None
        assert walk.search.spec == before
    assert walk.state.phase == walk_in(phase).state.phase


def test_bearings_count_on_in_another_area_and_what_was_planned_for_the_old_is_void() -> None:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.believe()
    walk.to_craft(inputs.Planned(plan(2)))
    walk.command(commands.SetAutomatic(automatic=False))
    walk.command(commands.Hold())
    walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ("b1",)
    assert (walk.craft.chosen, walk.search.beliefs_current, walk.craft.automatic) == (None, False, False)
    walk.believe()
    walk.to_craft(inputs.NetsUp())
    assert of_craft(walk.command(commands.Resume()))[-1] == effects.PlanNext(3, ())
    assert fold(walk.recorded) == walk.state


def changed() -> Walk:
    walk = Walk().to("hold")
    walk.command(commands.ChangeArea(search=OTHER_AREA))
    walk.believe()
    return walk


@pytest.mark.parametrize("restarts", [0, 1, 2])
def test_nothing_is_resumed_before_the_nets_of_the_new_area_hang_whatever_server_hangs_them(restarts: int) -> None:
    walk = changed()
    for _ in range(restarts):
        assert fold(walk.recorded) == walk.state
        walk.give(ServerCameBack())
        walk.to_craft(inputs.Restarted(OURS))
        walk.believe()
    assert resume_refusal(walk.craft, walk.search) == NetsChanging(), "so the page says what is waited for"
    assert refusal(walk.command(commands.Resume())) == NetsChanging()
    for order in (commands.Return(), commands.Hold()):
        assert refusal(walk.command(order)) is None
    walk.to_craft(inputs.NetsUp())
    assert refusal(walk.command(commands.Resume())) is None


def test_nets_that_are_not_taken_are_said_once_until_they_are() -> None:
    walk = changed()
    for _ in range(3):
        walk.to_craft(inputs.NetsNotTaken(VETO))
    (raised,) = walk.of_kind(AlertRaised)
    assert (raised.topic, raised.reason) == ("nets", VETO)
    assert refusal(walk.command(commands.Resume())) == NetsChanging()
    walk.to_craft(inputs.NetsUp())
    assert walk.craft.open_alerts == ()
    walk.to_craft(inputs.NetsUp())
    assert len(walk.of_kind(NetsHung)) == 1


def test_an_area_changed_again_waits_again_and_a_new_start_waits_for_nothing() -> None:
    walk = changed()
    walk.to_craft(inputs.NetsUp())
    walk.command(commands.ChangeArea(search=SearchArea(**{**OTHER_AREA.model_dump(), "fence_margin_m": 77.0})))
    assert walk.craft.nets_wait
    joined = Walk(SPEC).start("craft-2")
    assert not joined.state.crafts["craft-2"].nets_wait


def test_objections_refuse_another_area() -> None:
    walk = Walk().to("hold")
    asked = walk.command(commands.ChangeArea(search=OTHER_AREA), Context((VETO,)))
    assert refusal(asked) == VETO
    assert walk.search.spec == SPEC
    (refused,) = walk.of_kind(CommandRefused)
    assert refused.reason == VETO


def test_while_nets_wait_resuming_takes_control_back_from_a_pilot_and_flies_nowhere() -> None:
    """Else nothing could be ordered: what a pilot had is held, returned and landed once control is taken back."""
    walk = changed()
    walk.to_craft(inputs.AuthorityHeard(PILOT))
    assert refusal(walk.command(commands.Return())) == PilotControls()
    assert resume_refusal(walk.craft, walk.search) is None
    asked = walk.command(commands.Resume())
    assert refusal(asked) is None
    assert sent(asked) == [effects.HoldVehicle()]
    assert (walk.craft.phase, walk.craft.nets_wait, walk.craft.taken_over) == ("hold", True, False)
    assert refusal(walk.command(commands.Resume())) == NetsChanging()
    for order in (commands.Hold(), commands.Return(), commands.Land()):
        assert refusal(walk.command(order)) is None


def test_a_vehicle_that_hovers_outside_is_said_once_and_again_where_it_has_moved() -> None:
    walk = changed()
    for beyond_m in (12.0, 12.3, 11.8, 40.0, 40.2):
        walk.to_craft(inputs.NetsNotTaken(OutsideFence("vehicle", beyond_m)))
    for distance_m in (200.0, 200.4):
        walk.to_craft(inputs.NetsNotTaken(NoWayHome(distance_m)))
    assert [raised.reason for raised in walk.of_kind(AlertRaised)] == [
        OutsideFence("vehicle", 12.0),
        OutsideFence("vehicle", 40.0),
        NoWayHome(200.0),
    ]
