"""What an operator orders of a craft: carried out, or refused with a reason."""

from __future__ import annotations

from dataclasses import replace

import pytest
from craft_walk import PHASES, CraftWalk, craft_in, moves, refusal, sent
from facts import (
    CHECK,
    FAILED_CHECK,
    HOME,
    IMPORT,
    OTHER_AREA,
    OURS,
    SPEC,
    START,
    VETO,
    WAITING_SPEC,
    bearing,
    plan,
)
from narrowing import known

from backend import commands
from backend.craft import effects, inputs
from backend.events import (
    AreaChanged,
    BearingExcluded,
    FlightStarted,
    GroundFact,
    MissionEnded,
    MissionStarted,
    Phase,
    PlanChosen,
    PreflightChecked,
    SafetyVetoed,
)
from backend.reasons import PreflightFailed, refusals
from backend.reasons.safety import NotGivenBack, PilotControls
from backend.reasons.search import Localized


def test_a_failed_preflight_refuses_the_start_and_says_why() -> None:
    walk = CraftWalk()
    asked = walk.order(commands.Start(), start=inputs.StartFacts((FAILED_CHECK,), HOME, 100.0, "test"))
    assert refusal(asked) == PreflightFailed("gps", FAILED_CHECK.reason)
    assert (walk.craft.phase, walk.search.stage) == ("ground", "draft")
    assert "mission_started" not in walk.kinds
    assert [fact.passed for fact in walk.of_kind(PreflightChecked)] == [False]


def test_a_start_needs_a_vehicle_and_its_home() -> None:
    assert refusal(CraftWalk().order(commands.Start(), start=None)) == refusals.VehicleUnknown()
    homeless = inputs.StartFacts((CHECK,), None, None, "test")
    assert refusal(CraftWalk().order(commands.Start(), start=homeless)) == refusals.NoHome()


def test_the_home_of_the_first_craft_is_the_searchs() -> None:
    walk = CraftWalk()
    walk.order(commands.Start())
    assert (walk.search.home, walk.search.home_amsl_m) == (START.home, START.home_amsl_m)
    walk.craft = CraftWalk(craft_id="craft-2").craft
    walk.order(commands.Start(), start=inputs.StartFacts((CHECK,), plan(3).place, 200.0, "test"))
    assert (walk.search.home, walk.search.home_amsl_m) == (START.home, START.home_amsl_m)


def test_objections_refuse_the_start_and_an_override_and_become_facts() -> None:
    walk = CraftWalk()
    assert refusal(walk.order(commands.Start(), objections=(VETO,))) == VETO
    walk.to("flying")
    chosen = walk.craft.chosen
    asked = walk.order(commands.Override(place=HOME), objections=(VETO,))
    assert refusal(asked) == VETO
    assert walk.craft.chosen == chosen
    assert walk.craft.phase == "flying"
    assert not moves(asked)
    assert [fact.reason for fact in walk.of_kind(SafetyVetoed)] == [VETO, VETO]


def test_without_automatic_acceptance_the_place_waits_for_accept_or_veto() -> None:
    walk = CraftWalk(WAITING_SPEC).to("waiting")
    refused = walk.craft.chosen
    assert refused is not None
    assert effects.PlanNext(2, (refused.place,)) in walk.order(commands.Veto())
    walk.give(inputs.Planned(plan(2)))
    assert walk.craft.phase == "waiting"
    assert moves(walk.order(commands.Accept()))
    assert walk.craft.phase == "flying"


def test_only_a_proposed_place_is_accepted_or_refused() -> None:
    for phase in PHASES:
        walk = craft_in(phase)
        accepted = refusal(walk.order(commands.Accept()))
        assert (accepted is None) == (phase == "waiting")
        vetoed = refusal(craft_in(phase).order(commands.Veto()))
        assert (vetoed is None) == (phase in ("waiting", "flying", "hold"))
        assert {accepted, vetoed} <= {None, refusals.NoProposedPlace()}


def test_a_veto_in_flight_stops_the_vehicle_first() -> None:
    walk = CraftWalk().to("flying")
    asked = walk.order(commands.Veto())
    assert asked[0] == effects.CancelWork()
    assert sent(asked) == [effects.HoldVehicle()]
    assert walk.craft.phase == "planning"


def test_arming_automatic_acceptance_releases_a_waiting_place() -> None:
    walk = CraftWalk(WAITING_SPEC).to("waiting")
    walk.order(commands.SetAutomatic(automatic=True))
    assert walk.craft.phase == "flying"


def test_an_override_replaces_the_running_flight_and_measurement() -> None:
    for phase in ("planning", "waiting", "flying", "measuring"):
        walk = craft_in(phase)  # type: ignore[arg-type]
        if not walk.search.beliefs_current:
            walk.believe()
        asked = walk.order(commands.Override(place=HOME))
        assert asked[0] == effects.CancelWork()
        assert [e.place for e in asked if isinstance(e, effects.FlyTo)] == [HOME]
        assert walk.craft.phase == "flying"
        chosen = walk.craft.chosen
        assert isinstance(chosen, PlanChosen)
        assert (chosen.source, chosen.by, chosen.emitter_id) == ("operator", "anna", None)


def test_a_flight_starts_at_the_altitude_that_was_foreseen_for_its_place_else_at_the_missions() -> None:
    for foreseen, expected in ((187.5, 187.5), (None, known(START.home_amsl_m) + SPEC.flight.altitude_relative_m)):
        walk = craft_in("waiting")
        walk.order(commands.Override(place=HOME), altitude_amsl_m=foreseen)
        assert walk.of_kind(FlightStarted)[-1].altitude_amsl_m == expected
        walk = CraftWalk().to("planning")
        walk.believe()
        walk.give(inputs.Planned(plan().model_copy(update={"altitude_amsl_m": foreseen})))
        assert walk.of_kind(FlightStarted)[-1].altitude_amsl_m == expected


def test_the_start_names_the_ground_it_is_flown_over() -> None:
    ground = GroundFact(digest="d", sources=["hills"], spacing_m=30.0, home_m=101.0)
    walk = CraftWalk()
    walk.order(commands.Start(), start=replace(START, ground=ground))
    assert walk.of_kind(MissionStarted)[-1].ground == walk.search.ground == ground


def test_an_override_in_hold_waits_for_resume() -> None:
    walk = CraftWalk().to("hold")
    assert not moves(walk.order(commands.Override(place=HOME)))
    asked = walk.order(commands.Resume())
    assert [e.place for e in asked if isinstance(e, effects.FlyTo)] == [HOME]


def test_an_override_is_refused_on_the_way_home_and_while_a_pilot_flies() -> None:
    for phase, reason in (
        ("ground", refusals.NotStarted()),
        ("returning", refusals.OnTheWayHome()),
        ("landing", refusals.OnTheWayHome()),
        ("manual", PilotControls()),
    ):
        assert refusal(craft_in(phase).order(commands.Override(place=HOME))) == reason  # type: ignore[arg-type]


def test_resume_flies_to_the_interrupted_place_again() -> None:
    for phase in ("flying", "measuring"):
        walk = craft_in(phase)  # type: ignore[arg-type]
        place = walk.craft.chosen
        assert place is not None
        walk.order(commands.Hold())
        asked = walk.order(commands.Resume())
        assert [e.place for e in asked if isinstance(e, effects.FlyTo)] == [place.place]


def test_resume_after_the_pilot_takes_control_first() -> None:
    walk = CraftWalk().to("manual")
    asked = walk.order(commands.Resume())
    taken = asked.index(effects.TakeControl())
    assert moves(asked)
    assert all(asked.index(move) > taken for move in moves(asked))
    assert not walk.craft.taken_over
    walk.give(inputs.AuthorityHeard(OURS))
    assert walk.craft.authority.who == "ours"


@pytest.mark.parametrize("phase", PHASES)
def test_resume_takes_nothing_from_a_pilot_who_has_not_given_back_in_whatever_phase(phase: Phase) -> None:
    walk = craft_in(phase)
    authority = walk.craft.authority
    asked = walk.order(commands.Resume(), objections=(NotGivenBack("POSCTL"),))
    assert walk.craft.phase == phase
    assert walk.craft.authority == authority
    expected = NotGivenBack("POSCTL") if phase in ("hold", "manual") else None
    assert refusal(asked) == expected or (expected is None and refusal(asked) is not None)


def test_an_excluded_bearing_moves_no_craft_and_makes_a_waiting_place_obsolete() -> None:
    for phase in ("hold", "flying", "measuring", "returning"):
        walk = craft_in(phase)  # type: ignore[arg-type]
        chosen = walk.craft.chosen
        walk.fold(bearing(3, source=IMPORT))
        assert sent(walk.learn(EXCLUDED)) == []
        assert (walk.craft.phase, walk.craft.chosen) == (phase, chosen)
    waiting = craft_in("waiting")
    waiting.fold(bearing(3, source=IMPORT))
    waiting.learn(EXCLUDED)
    assert (waiting.craft.phase, waiting.craft.chosen) == ("planning", None)


def test_another_search_area_makes_what_was_planned_void() -> None:
    walk = CraftWalk().to("hold")
    walk.fold(AreaChanged(search=OTHER_AREA, by="anna"))
    assert (walk.craft.chosen, walk.craft.avoid, walk.search.beliefs_current) == (None, (), False)
    walk.believe()
    assert walk.craft.phase == "hold"
    assert refusal(walk.order(commands.Resume())) == refusals.NetsChanging()
    walk.give(inputs.NetsUp())
    assert walk.order(commands.Resume())[-1] == effects.PlanNext(2, ())


def test_an_aborted_craft_still_answers_hold_and_return_until_it_is_down_and_goes_out_no_more() -> None:
    walk = CraftWalk().to("measuring")
    asked = walk.order(commands.Abort())
    assert asked[0] == effects.CancelWork()
    assert sent(asked) == [effects.HoldVehicle()]
    assert (walk.craft.phase, walk.search.outcome) == ("returning", "aborted")
    assert effects.HoldVehicle() in walk.order(commands.Hold())
    assert refusal(walk.order(commands.Resume())) == refusals.MissionOver()
    assert effects.ReturnHome() in walk.order(commands.Return())
    walk.give(inputs.HomeReached())
    assert refusal(walk.order(commands.Return())) == refusals.LandingAlready()
    assert effects.HoldVehicle() in walk.order(commands.Hold())
    walk.order(commands.Return())
    walk.give(inputs.Landed())
    everything = (commands.Hold(), commands.Return(), commands.Land(), commands.Abort(), commands.Resume())
    for order in (*everything, commands.Start()):
        assert refusal(walk.order(order)) == refusals.MissionOver()


@pytest.mark.parametrize("ended_by", [commands.Abort(), commands.Return()])
def test_an_abort_brings_home_what_was_held_after_the_end(ended_by: commands.ForCraft) -> None:
    walk = CraftWalk().to("measuring")
    walk.order(ended_by)
    walk.fold(MissionEnded(outcome="not_localized", reason=Localized(), mission_time_s=1.0))
    assert refusal(walk.order(commands.Abort())) == refusals.MissionOver(), "it comes home already"
    walk.order(commands.Hold())
    asked = walk.order(commands.Abort())
    assert sent(asked) == [effects.HoldVehicle()], "held first, as by every abort"
    assert walk.craft.phase == "returning"
    assert not any(isinstance(effect, effects.LeaveSearch) for effect in asked), "it is over already"


def test_a_pilot_who_flies_after_the_end_gives_the_vehicle_back_to_be_held() -> None:
    walk = CraftWalk().to("manual")
    walk.order(commands.Abort())
    assert walk.craft.phase == "manual"
    assert sent(walk.order(commands.Resume())) == [effects.HoldVehicle()]
    assert walk.craft.phase == "hold"


def test_a_craft_whose_return_ended_the_search_can_still_be_held() -> None:
    walk = CraftWalk().to("returning")
    walk.order(commands.Hold())
    assert walk.craft.phase == "hold"
    assert walk.search.stage == "open"
    assert moves(walk.order(commands.Resume()))


def test_before_the_start_orders_are_refused() -> None:
    for order in (commands.Hold(), commands.Return(), commands.Land(), commands.Abort(), commands.Resume()):
        assert refusal(CraftWalk(SPEC).order(order)) == refusals.NotStarted()


EXCLUDED = BearingExcluded(emitter_id="emitter-1", bearing_id="b3", by="anna", reason="")


def test_a_place_of_the_operators_waits_for_a_second_climb_as_for_the_first() -> None:
    walk = CraftWalk().to("hold")
    walk.give(inputs.Landed())
    walk.order(commands.Resume(), on_ground=True)
    assert walk.craft.phase == "taking_off"
    asked = walk.order(commands.Override(place=HOME))
    assert refusal(asked) is None
    assert not sent(asked), "it would leave the ground aslant, or hold half-way up"
    assert effects.CancelWork() not in asked
    asked = walk.give(inputs.InTheAir(HOME, 40.0))
    walk.believe()
    assert [effect.place for effect in moves(asked) if isinstance(effect, effects.FlyTo)] == [HOME]
