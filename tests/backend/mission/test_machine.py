"""The machine in every state against every input, and the rules that must hold on any walk through it."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from missions import (
    HOME,
    MOVES,
    PHASES,
    SPEC,
    WAITING_SPEC,
    Walk,
    bearing,
    belief_ready,
    commanded,
    every_input,
    kinds,
    moves,
    plan,
    rejected,
    walk_in,
)

from backend import commands
from backend.events import AlertRaised, MissionEnded
from backend.mission import effects as asked
from backend.mission import inputs
from backend.mission.effects import Effect
from backend.mission.machine import transition
from backend.mission.state import AUTOMATIC, HOMEWARD, TERMINAL, MissionState, fold

VEHICLE = (*MOVES, asked.HoldVehicle)
IN_FLIGHT = tuple(AUTOMATIC | HOMEWARD)


def check_rules(before: MissionState, given_: inputs.Input, after: MissionState, effects: tuple[Effect, ...]) -> None:
    """What holds for any state and input."""
    command = given_.command if isinstance(given_, inputs.Commanded) else None
    if before.pilot_has_control and not isinstance(command, commands.Resume):
        assert not any(isinstance(e, VEHICLE) for e in effects), "a command went out while the pilot had control"
    if before.phase in ("hold", "manual") and moves(effects):
        ordered = isinstance(command, commands.Resume | commands.Return | commands.Abort)
        timer = isinstance(given_, inputs.TimerExpired) and given_.name == "console_return"
        assert ordered or timer, f"{given_} moved a held vehicle"
    if isinstance(command, commands.Resume) and given_.objections:  # type: ignore[union-attr]
        assert not any(isinstance(e, (*VEHICLE, asked.ReleasePilotLatch)) for e in effects)
        assert (after.phase, after.pilot_has_control) == (before.phase, before.pilot_has_control)
    if isinstance(command, commands.ChangeArea):
        assert not any(isinstance(e, VEHICLE) for e in effects), "an edit sent something to the vehicle"
    if before.started_at_s is not None and after.spec != before.spec:
        assert isinstance(command, commands.ChangeArea)
        assert before.phase == "hold"
    if before.phase in TERMINAL:
        assert after.phase == before.phase
        assert after.outcome == before.outcome
    if isinstance(given_, inputs.PilotTookOver):
        assert not any(isinstance(e, VEHICLE) for e in effects)
        assert after.phase == "manual" or before.phase in TERMINAL or not before.started_at_s
    if before.phase in IN_FLIGHT and answered_first(before, given_):
        if isinstance(command, commands.Hold):
            assert after.phase == "hold"
            assert kinds(effects)[:2] == [asked.CancelWork, asked.HoldVehicle]
        if isinstance(command, commands.Abort):
            assert after.phase == "aborted"
            assert effects[:2] == (asked.CancelWork(), asked.ReturnHome(hold_first=True))
    if command is not None:
        assert sum(isinstance(e, asked.Reply) for e in effects) == 1
        assert given_.command_id in after.answered  # type: ignore[union-attr]
    if after.outcome is not None:
        assert after.phase in TERMINAL


def answered_first(before: MissionState, given_: inputs.Input) -> bool:
    return isinstance(given_, inputs.Commanded) and given_.command_id not in before.answered


@pytest.mark.parametrize("phase", PHASES)
def test_every_input_is_answered_in_every_phase(phase: str) -> None:
    start = walk_in(phase).state
    assert start.phase == phase
    for given_ in every_input(start):
        after, effects = transition(start, given_, 2_000.0)
        check_rules(start, given_, after, effects)
        for again in every_input(after):
            twice, more = transition(after, again, 2_001.0)
            check_rules(after, again, twice, more)


@settings(max_examples=150, deadline=None)
@given(automatic=st.booleans(), picks=st.lists(st.integers(0, 10_000), min_size=5, max_size=60))
def test_on_any_walk_the_rules_hold_and_the_journal_gives_the_state_back(automatic: bool, picks: list[int]) -> None:
    walk = Walk(SPEC if automatic else WAITING_SPEC)
    if picks[0] % 3:
        walk.to("planning")
    ended = 0
    for number, pick in enumerate(picks):
        choices = every_input(walk.state)
        given_ = choices[pick % len(choices)]
        if isinstance(given_, inputs.Commanded):
            given_ = commanded(
                given_.command, f"walk-{number}", objections=given_.objections, on_ground=given_.on_ground
            )
        before = walk.state
        effects = walk.give(given_)
        check_rules(before, given_, walk.state, effects)
        ended += sum(isinstance(e, asked.Record) and isinstance(e.event, MissionEnded) for e in effects)
        assert ended <= 1
    assert fold(walk.recorded) == walk.state


def test_a_localized_mission_goes_from_draft_to_done() -> None:
    walk = Walk()
    walk.command(commands.Start())
    assert walk.state.phase == "taking_off"
    assert kinds(walk.give(inputs.InTheAir(HOME, 40.0)))[-1] is asked.UpdateBelief
    for number in (1, 2):
        effects = walk.give(belief_ready(walk.state))
        assert effects[-1] == asked.PlanNext(number, ())
        effects = walk.give(inputs.Planned(plan(number)))
        assert effects[-1] == asked.FlyTo(number, plan(number).place, 140.0, 7.0)
        assert walk.give(inputs.Arrived(HOME, 0.3, 9.0))[-1] == asked.Measure(number, 1)
        walk.give(inputs.SweepTaken(bearing(number)))
    localized_at = walk.at_s + 1
    assert walk.give(belief_ready(walk.state, localized=True))[-1] == asked.ReturnHome()
    walk.give(inputs.HomeReached())
    assert walk.state.phase == "landing"
    walk.give(inputs.Landed())
    assert (walk.state.phase, walk.state.outcome) == ("done", "localized")
    ended = next(r.event for r in walk.recorded if isinstance(r.event, MissionEnded))
    started = next(r for r in walk.recorded if r.event.kind == "mission_started").at_utc.timestamp()
    assert ended.mission_time_s == localized_at - started


def test_rejected_sweeps_are_taken_again_and_then_another_place_is_chosen() -> None:
    walk = Walk().to("measuring")
    place = walk.state.chosen.place if walk.state.chosen else None
    assert walk.give(inputs.SweepRefused(rejected(1)))[-1] == asked.Measure(1, 2)
    effects = walk.give(inputs.SweepRefused(rejected(2)))
    assert effects[-1] == asked.PlanNext(2, (place,))
    assert walk.state.phase == "planning"


def test_a_mission_that_ran_out_of_places_goes_home_honestly() -> None:
    walk = Walk().to("planning")
    for number in range(1, SPEC.localization.maximum_bearings + 1):
        walk.give(belief_ready(walk.state))
        walk.give(inputs.Planned(plan(number)))
        walk.give(inputs.Arrived(HOME, 0.3, 9.0))
        walk.give(inputs.SweepTaken(bearing(number)))
    walk.give(belief_ready(walk.state))
    assert walk.state.phase == "returning"
    walk.give(inputs.Landed())
    ended = walk.recorded[-2].event
    assert isinstance(ended, MissionEnded)
    assert ended.outcome == "not_localized"
    assert "4 places" in ended.reason
    assert "not yet: too few" in ended.reason


def test_nothing_left_to_plan_goes_home_not_localized() -> None:
    walk = Walk().to("planning")
    walk.give(belief_ready(walk.state))
    walk.give(inputs.NothingToPlan("every place is forbidden"))
    walk.give(inputs.Landed())
    assert walk.state.outcome == "not_localized"


def test_a_mission_whose_bearing_was_excluded_on_the_way_home_does_not_say_that_it_is_localized() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.give(belief_ready(walk.state, localized=True))
    assert walk.state.phase == "returning"
    walk.command(commands.ExcludeBearing(bearing_id="b1"))
    walk.give(belief_ready(walk.state))
    walk.give(inputs.Landed())
    (ended,) = [r.event for r in walk.recorded if isinstance(r.event, MissionEnded)]
    assert ended.outcome == "not_localized"
    assert ended.reason == "no longer localized since a bearing was excluded (not yet: too few)"


def test_a_vehicle_that_landed_by_itself_waits_on_the_ground_and_takes_off_again_on_resume() -> None:
    for phase in ("hold", "flying"):
        walk = Walk().to(phase)
        effects = walk.give(inputs.Landed())
        assert not moves(effects)
        assert walk.state.phase == "hold"
        assert walk.give(inputs.Landed()) == ()
        effects = walk.command(commands.Resume(), on_ground=True)
        assert moves(effects) == [asked.TakeOff(SPEC.flight.altitude_relative_m)]
        assert walk.state.phase == "taking_off"
        assert not walk.state.open_alerts
        walk.give(inputs.InTheAir(HOME, 40.0))
        assert walk.state.phase == "flying"


def test_a_localized_mission_whose_vehicle_landed_in_hold_is_done() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.command(commands.Hold())
    walk.give(belief_ready(walk.state, localized=True))
    walk.give(inputs.Landed())
    assert (walk.state.phase, walk.state.outcome) == ("done", "localized")


def test_a_place_that_jumped_is_told_until_a_bearing_comes_from_a_sure_one() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1).model_copy(update={"drift_m": 30.0})))
    told = [r.event for r in walk.recorded if isinstance(r.event, AlertRaised)]
    assert [(alert.level, alert.text) for alert in told] == [
        ("caution", "the place of bearing 1 is unsure by 30 m; it counts for less")
    ]
    walk.give(belief_ready(walk.state))
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    assert walk.state.open_alerts
    walk.give(inputs.SweepTaken(bearing(2)))
    assert not walk.state.open_alerts


def test_the_end_of_a_claim_against_a_bearing_says_so() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    ready = belief_ready(walk.state, localized=True)
    walk.give(inputs.BeliefReady(ready.bearing_ids, ready.fact.model_copy(update={"contradicting": ["b1"]})))
    walk.give(inputs.Landed())
    ended = next(r.event for r in walk.recorded if isinstance(r.event, MissionEnded))
    assert ended.reason == "the expected error is below the threshold; it stands against 1 of 1 bearings"


def test_an_offset_common_to_all_bearings_is_told_until_it_is_none() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    ready = belief_ready(walk.state)
    doubted = ready.fact.model_copy(update={"heading_offset_deg": 12.4, "heading_offset_std_error_deg": 1.6})
    walk.give(inputs.BeliefReady(ready.bearing_ids, doubted))
    (told,) = [r.event for r in walk.recorded if isinstance(r.event, AlertRaised)]
    assert told.level == "caution"
    assert "about +12 ± 2 degrees" in told.text
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    assert walk.state.open_alerts
    walk.give(inputs.SweepTaken(bearing(2)))
    walk.give(belief_ready(walk.state))
    assert not walk.state.open_alerts


def test_a_stale_belief_is_not_recorded() -> None:
    walk = Walk().to("measuring")
    old = belief_ready(walk.state, localized=True)
    walk.give(inputs.SweepTaken(bearing(1)))
    assert walk.give(old) == ()
