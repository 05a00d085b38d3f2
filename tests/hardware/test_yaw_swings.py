"""The swings of a nose in flight: every stage with every input, and whole legs with noses that follow well or badly."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.reasons.on_the_way import SwingsEnd
from hardware.yaw_swings import (
    BESIDE_M,
    LARGEST_AMPLITUDE_DEG,
    LEAD_DEG,
    SPARE_M,
    Seen,
    Stage,
    SwingPlan,
    Swings,
    braking_m,
    over,
    swung,
)

PLAN = SwingPlan(middle_deg=350.0, amplitude_deg=75.0, rate_deg_s=30.0, facing_deg=200.0)
FAR_M = 200.0
LOOK = Seen(at_s=10.0, heading_deg=0.0, flown_m=50.0, to_go_m=50.0, speed_m_s=7.0, clear_m=FAR_M, ours=True)


def reached(stage: Stage) -> Swings:
    """The swings in this stage, the nose seen ten degrees clockwise of the middle at 9.9 s."""
    looked = replace(Swings(PLAN), nose_deg=10.0, at_s=9.9, followed=(9.9, 10.0))
    match stage:
        case "before":
            return looked
        case "over":
            return over(looked, "refused")
        case _:
            going, _ = swung(looked, replace(LOOK, at_s=9.9))
            return replace(going, stage=stage)


INPUTS = [
    Seen(at_s, heading_deg, flown_m, to_go_m, speed_m_s, clear_m, ours)
    for at_s, heading_deg, flown_m, to_go_m, speed_m_s, clear_m, ours in itertools.product(
        (9.0, 9.95, 30.0),
        (0.0, 100.0, 170.0, 260.0),
        (0.0, BESIDE_M, 80.0),
        (0.0, BESIDE_M - 0.1, 80.0),
        (0.0, 8.0, 15.0),
        (0.0, 10.0, 30.0, FAR_M),
        (True, False),
    )
]


@pytest.mark.parametrize("stage", get_args(Stage))
def test_every_stage_with_every_input_is_safe(stage: Stage) -> None:
    before = reached(stage)
    asked = 0
    for seen in INPUTS:
        after, yaw_deg = swung(before, seen)
        if stage == "over":
            assert (after, yaw_deg) == (before, None)
            continue
        if not seen.ours:
            assert (after.stage, after.end, yaw_deg) == ("over", "not_ours", None)
            continue
        needed = braking_m(seen.speed_m_s) + SPARE_M
        if seen.to_go_m < BESIDE_M:
            assert (after.stage, after.end) == ("over", "near_place")
            assert yaw_deg == PLAN.facing_deg
        elif seen.clear_m < needed:
            assert after.stage == ("kept" if stage == "swinging" else stage)
            assert yaw_deg == (seen.heading_deg if stage == "swinging" else None)
        elif yaw_deg is not None:
            asked += 1
            assert after.stage == "swinging"
            off = math.remainder(yaw_deg - PLAN.middle_deg, 360.0)
            nose = math.remainder(seen.heading_deg - PLAN.middle_deg, 360.0)
            assert abs(off) <= max(PLAN.amplitude_deg, abs(nose)) + 1e-9
        assert after.end is None or after.end in get_args(SwingsEnd)
        assert (after.stage == "over") == (after.end is not None)
    assert (asked > 0) == (stage != "over")


def leg(plan: SwingPlan, follows_deg_s: float, begin_deg: float, length_m: float = 120.0, clear_m=lambda flown: FAR_M):
    """A leg at 7 m/s, looked at ten times a second, with a nose that turns to where it is sent by this rate at most:
    (swings, [(flown m, nose, asked or None)])."""
    swings, nose, goal, told = Swings(plan), begin_deg, begin_deg, []
    for k in range(int(10.0 * length_m / 7.0)):
        flown = 0.7 * k
        left = math.remainder(goal - nose, 360.0)
        nose += math.copysign(min(abs(left), follows_deg_s / 10.0), left)
        seen = Seen(0.1 * k, nose % 360.0, flown, length_m - flown, 7.0, clear_m(flown), True)
        swings, asked = swung(swings, seen)
        goal = goal if asked is None else asked
        told.append((flown, nose, asked))
    return swings, told


def test_the_nose_comes_to_both_sides_and_is_laid_for_the_turn_at_the_end() -> None:
    swings, told = leg(PLAN, 60.0, 90.0)
    assert swings.end == "near_place"
    assert swings.swung >= 2
    off = [math.remainder(nose - PLAN.middle_deg, 360.0) for flown, nose, _ in told if flown > 40.0]
    assert min(off) < -60.0
    assert max(off) > 60.0
    assert told[-1][2] is None
    assert [asked for _, _, asked in told if asked is not None][-1] == PLAN.facing_deg
    assert swings.rate_deg_s == pytest.approx(PLAN.rate_deg_s, rel=0.25)


def test_beside_the_ends_the_nose_is_left_alone() -> None:
    _, told = leg(replace(PLAN, facing_deg=None), 60.0, 90.0)
    sent = [flown for flown, _, asked in told if asked is not None]
    assert min(sent) >= BESIDE_M
    assert max(sent) <= 120.0 - BESIDE_M


def test_a_slow_nose_sets_its_own_pace_and_its_lag_is_bounded() -> None:
    swings, told = leg(PLAN, 9.0, 350.0, 400.0)
    assert swings.rate_deg_s == pytest.approx(9.0, rel=0.15)
    assert swings.lag_deg <= LEAD_DEG + 1e-9
    goal = 350.0
    for _, nose, asked in told:
        goal = goal if asked is None else asked
        if asked is not None and asked != PLAN.facing_deg:
            assert abs(math.remainder(goal - nose, 360.0)) <= LEAD_DEG + PLAN.step_deg + 1e-6
    assert swings.swung >= 3


def test_a_nose_that_does_not_follow_is_left_alone_after_seconds() -> None:
    swings, told = leg(PLAN, 0.0, 90.0)
    assert swings.end == "lags"
    sent = [flown for flown, _, asked in told if asked is not None]
    assert max(sent) < BESIDE_M + 7.0 * 6.0


def test_near_a_fence_the_nose_is_kept_and_swings_again_beyond() -> None:
    braking = braking_m(7.0) + SPARE_M
    swings, told = leg(PLAN, 60.0, 350.0, 200.0, lambda flown: braking - 1.0 if 60.0 < flown < 120.0 else FAR_M)
    kept = [nose for flown, nose, _ in told if 66.0 < flown < 120.0]
    assert max(kept) - min(kept) < 1.0
    again = [nose for flown, nose, _ in told if 125.0 < flown < 190.0]
    assert max(again) - min(again) > 90.0
    assert swings.end == "near_place"


@given(
    st.floats(0.0, 359.9),
    st.floats(30.0, LARGEST_AMPLITUDE_DEG),
    st.floats(5.0, 90.0),
    st.floats(0.0, 359.9),
    st.floats(1.0, 120.0),
)
def test_wherever_the_nose_begins_it_is_never_sent_past_its_sides_or_far_ahead(
    middle_deg: float, amplitude_deg: float, rate_deg_s: float, begin_deg: float, follows_deg_s: float
) -> None:
    plan = SwingPlan(middle_deg, amplitude_deg, rate_deg_s)
    _, told = leg(plan, follows_deg_s, begin_deg)
    first = abs(math.remainder(begin_deg - middle_deg, 360.0))
    for _, nose, asked in told:
        if asked is None:
            continue
        assert abs(math.remainder(asked - nose, 360.0)) <= LEAD_DEG + plan.step_deg + 1e-6
        assert abs(math.remainder(asked - middle_deg, 360.0)) <= max(amplitude_deg, first) + 1e-6


@pytest.mark.parametrize(
    "wrong", [{"amplitude_deg": 0.0}, {"amplitude_deg": 170.0}, {"rate_deg_s": 0.0}, {"middle_deg": math.nan}]
)
def test_a_plan_that_means_nothing_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="The nose cannot swing"):
        replace(PLAN, **wrong)
