"""What an operator orders: carried out, refused with a reason, and never twice."""

from __future__ import annotations

import pytest
from missions import (
    CHECK,
    FAILED_CHECK,
    HOME,
    PHASES,
    SPEC,
    START,
    VETO,
    WAITING_SPEC,
    Walk,
    answer,
    bearing,
    belief_ready,
    commanded,
    moves,
    plan,
    walk_in,
)

from backend import commands
from backend.events import CommandRefused, PlanChosen, SafetyVetoed
from backend.mission import effects as asked
from backend.mission import inputs
from backend.mission.safety import Veto
from backend.mission.state import fold


def test_a_failed_preflight_refuses_the_start_and_says_why() -> None:
    walk = Walk()
    effects = walk.command(commands.Start(), start=inputs.StartFacts((FAILED_CHECK,), HOME, 100.0, "test"))
    assert answer(effects) == asked.Reply("c1", False, "preflight: gps: no fix", "wait")
    assert walk.state.phase == "draft"
    assert "preflight_checked" in walk.kinds
    assert "mission_started" not in walk.kinds


def test_objections_refuse_the_start_and_an_override_and_become_facts() -> None:
    walk = Walk()
    assert not answer(walk.command(commands.Start(), objections=(VETO,))).accepted
    walk.to("flying")
    chosen = walk.state.chosen
    effects = walk.command(commands.Override(place=HOME), objections=(VETO,))
    assert answer(effects).reason == VETO.detail
    assert walk.state.chosen == chosen
    assert walk.state.phase == "flying"
    assert not moves(effects)
    assert [r.event for r in walk.recorded if isinstance(r.event, SafetyVetoed)][-1].rule == "fence"


def test_a_repeated_command_gets_the_first_answer_and_does_nothing() -> None:
    walk = Walk().to("flying")
    first = walk.give(commanded(commands.Hold(), "same"))
    recorded = len(walk.recorded)
    again = walk.give(commanded(commands.Hold(), "same"))
    assert again == (answer(first),)
    refused = walk.give(commanded(commands.Accept(), "no"))
    assert walk.give(commanded(commands.Accept(), "no")) == (answer(refused),)
    assert len(walk.recorded) == recorded + 1
    assert fold(walk.recorded).answered == walk.state.answered


def test_without_automatic_acceptance_the_place_waits_for_accept_or_veto() -> None:
    walk = Walk(WAITING_SPEC).to("waiting")
    refused = walk.state.chosen
    assert refused is not None
    effects = walk.command(commands.Veto())
    assert asked.PlanNext(2, (refused.place,)) in effects
    walk.give(inputs.Planned(plan(2)))
    assert walk.state.phase == "waiting"
    assert moves(walk.command(commands.Accept()))
    assert walk.state.phase == "flying"


def test_arming_automatic_acceptance_releases_a_waiting_place() -> None:
    walk = Walk(WAITING_SPEC).to("waiting")
    walk.command(commands.SetAutomatic(automatic=True))
    assert walk.state.phase == "flying"


def test_an_override_replaces_the_running_flight_and_measurement() -> None:
    for phase in ("planning", "waiting", "flying", "measuring"):
        walk = walk_in(phase)
        if not walk.state.belief_current:
            walk.give(belief_ready(walk.state))
        effects = walk.command(commands.Override(place=HOME))
        assert effects[0] == asked.CancelWork()
        assert [e.place for e in effects if isinstance(e, asked.FlyTo)] == [HOME]
        assert walk.state.phase == "flying"
        chosen = walk.state.chosen
        assert isinstance(chosen, PlanChosen)
        assert chosen.source == "operator"


def test_an_override_in_hold_waits_for_resume() -> None:
    walk = Walk().to("hold")
    assert not moves(walk.command(commands.Override(place=HOME)))
    effects = walk.command(commands.Resume())
    assert [e.place for e in effects if isinstance(e, asked.FlyTo)] == [HOME]


def test_resume_flies_to_the_interrupted_place_again() -> None:
    for phase in ("flying", "measuring"):
        walk = Walk().to(phase)
        place = walk.state.chosen
        assert place is not None
        walk.command(commands.Hold())
        effects = walk.command(commands.Resume())
        assert [e.place for e in effects if isinstance(e, asked.FlyTo)] == [place.place]


def test_resume_after_the_pilot_releases_the_latch_first() -> None:
    walk = Walk().to("manual")
    effects = walk.command(commands.Resume())
    released = effects.index(asked.ReleasePilotLatch())
    assert all(effects.index(move) > released for move in moves(effects))
    assert not walk.state.pilot_has_control


@pytest.mark.parametrize("phase", PHASES)
def test_resume_takes_nothing_from_a_pilot_who_has_not_given_back_in_whatever_phase(phase: str) -> None:
    walk = walk_in(phase)
    effects = walk.command(commands.Resume(), objections=(Veto("pilot", "still in POSCTL", "switch to HOLD"),))
    assert not answer(effects).accepted
    assert walk.state.phase == phase
    if phase in ("hold", "manual"):
        assert answer(effects) == asked.Reply("c" + str(walk._commands), False, "still in POSCTL", "switch to HOLD")


def test_an_excluded_bearing_is_taken_out_of_the_belief_without_moving_the_vehicle() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.command(commands.Hold())
    walk.give(belief_ready(walk.state))
    effects = walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert asked.UpdateBelief() in effects
    assert walk.state.bearing_ids == ()
    assert not answer(walk.command(commands.ExcludeBearing(bearing_id="b1"))).accepted
    assert not answer(walk.command(commands.ExcludeBearing(bearing_id="b9"))).accepted


def test_an_aborted_vehicle_still_answers_hold_and_return_until_it_is_down() -> None:
    walk = Walk().to("aborted")
    assert asked.HoldVehicle() in walk.command(commands.Hold())
    assert asked.ReturnHome() in walk.command(commands.Return())
    assert not answer(walk.command(commands.Hold(), objections=(VETO,))).accepted
    assert not answer(Walk().to("done").command(commands.Hold())).accepted


def test_every_refusal_is_a_fact() -> None:
    walk = Walk(SPEC)
    walk.command(commands.Hold())
    last = walk.recorded[-1].event
    assert isinstance(last, CommandRefused)
    assert last.reason == "the mission has not started"


def test_editing_takes_readiness_back() -> None:
    walk = Walk()
    walk.give(inputs.PreflightDone((CHECK,)))
    assert walk.state.phase == "ready"
    walk.give(inputs.Edited(WAITING_SPEC))
    assert walk.state.phase == "draft"
    assert walk.state.spec == WAITING_SPEC
    started = Walk().to("flying")
    started.give(inputs.Edited(WAITING_SPEC))
    assert started.state.spec == SPEC
    assert START.home == HOME
