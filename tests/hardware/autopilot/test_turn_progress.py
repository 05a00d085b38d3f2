from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hardware.autopilot.turn_progress import FULL_CIRCLE, TOLERANCE, TurnProgress, next_target, step_size

HEADINGS = st.floats(0.0, 359.999)


@given(HEADINGS, st.lists(st.floats(-60.0, 90.0), min_size=1, max_size=60))
def test_turning_is_the_sum_of_the_changes_wherever_north_lies(start: float, changes: list[float]) -> None:
    progress, heading = TurnProgress(start), start
    for change in changes:
        heading += change
        progress.see(heading % 360.0)

    assert progress.turned_deg == pytest.approx(sum(changes), abs=1e-6)
    assert progress.done == (progress.furthest_deg >= 357.0)


def test_a_swing_to_and_fro_is_no_turn() -> None:
    progress = TurnProgress(10.0)
    for heading in [100.0, 190.0, 100.0, 10.0] * 5:
        progress.see(heading)

    assert not progress.done
    assert progress.furthest_deg == pytest.approx(180.0)


def test_a_compass_that_jumps_half_round_is_not_counted() -> None:
    progress = TurnProgress(0.0)
    for heading in (175.0, 350.0, 165.0, 340.0):
        progress.see(heading)

    assert abs(progress.turned_deg) < 1.0


@given(st.floats(0.0, 200.0), st.floats(1.0, 180.0), st.floats(0.0, 357.0))
def test_the_next_target_is_ahead_but_never_so_far_that_it_turns_the_other_way(
    elapsed: float, rate: float, turned: float
) -> None:
    target = next_target(elapsed, rate, turned, step_size(rate))

    assert target <= turned + 100.0
    assert target <= FULL_CIRCLE + TOLERANCE


@given(st.floats(5.0, 90.0), HEADINGS)
def test_a_vehicle_that_follows_makes_the_circle_at_the_rate(rate: float, start: float) -> None:
    """It turns to each target at twice the rate, as an autopilot with its own limit does."""
    assume(math.isfinite(rate))
    progress, heading, elapsed = TurnProgress(start), 0.0, 0.0
    while not progress.done and elapsed < 1000.0:
        target = next_target(elapsed, rate, progress.turned_deg, step_size(rate))
        heading += min(target - heading, 2.0 * rate * 0.05)
        progress.see((start + heading) % 360.0)
        elapsed += 0.05

    assert progress.done
    assert elapsed == pytest.approx(360.0 / rate, rel=0.15, abs=1.5)
