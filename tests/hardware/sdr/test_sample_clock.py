"""Times of samples that arrive in bursts, late, from a radio whose crystal is not the computer's."""

from __future__ import annotations

import itertools

import pytest

from hardware.sdr.sample_clock import SampleClock

RATE_HZ = 1000.0


class Wall:
    """A monotonic clock that is set by hand, and UTC beside it."""

    def __init__(self) -> None:
        self.elapsed_s = 0.0
        self.utc_s = 1.8e9

    def clock(self) -> SampleClock:
        return SampleClock(RATE_HZ, lambda: self.utc_s + self.elapsed_s, lambda: self.elapsed_s)


def test_a_burst_read_in_pieces_is_timed_right_from_the_second_burst_on() -> None:
    wall = Wall()
    clock = wall.clock()
    errors = []
    for burst, piece in itertools.product(range(4), range(5)):
        wall.elapsed_s = (burst + 1) * 0.5  # all five pieces of 0.1 s are there when the last has been taken
        first = burst * 500 + piece * 100
        errors.append(clock.arrived(first, 100) - wall.utc_s - first / RATE_HZ)
    assert errors[0] == pytest.approx(0.4)
    assert errors[4:] == pytest.approx([0.0] * 16, abs=1e-6)


def test_a_burst_read_whole_is_timed_right_at_once_and_after_a_loss() -> None:
    wall = Wall()
    clock = wall.clock()
    wall.elapsed_s = 0.5
    assert clock.arrived(0, 500) == pytest.approx(wall.utc_s)
    clock.restart()  # an unknown number of samples is missing
    wall.elapsed_s = 7.5
    assert clock.arrived(500, 500) == pytest.approx(wall.utc_s + 7.0)


@pytest.mark.parametrize("ppm", [-100.0, 100.0])
def test_a_crystal_that_is_off_does_not_add_up(ppm: float) -> None:
    wall = Wall()
    clock = wall.clock()
    at_s = 0.0
    for block in range(36_000):  # an hour
        wall.elapsed_s = (block + 1) * 0.1 / (1.0 + 1e-6 * ppm)
        at_s = clock.arrived(block * 100, 100)
    assert at_s == pytest.approx(wall.utc_s + wall.elapsed_s - 0.1, abs=0.003)


def test_a_late_arrival_changes_nothing_and_a_clock_that_is_set_counts_at_once() -> None:
    wall = Wall()
    clock = wall.clock()
    wall.elapsed_s = 0.1
    clock.arrived(0, 100)
    wall.elapsed_s = 3.0
    assert clock.arrived(100, 100) == pytest.approx(wall.utc_s + 0.1)
    wall.utc_s += 86_400.0
    assert clock.arrived(200, 100) == pytest.approx(wall.utc_s + 0.2)
