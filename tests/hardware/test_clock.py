from __future__ import annotations

import time

import pytest

from hardware.clock import ScaledClock, WallClock


async def test_a_scaled_clock_starts_where_it_is_told_and_runs_so_many_times_faster() -> None:
    clock = ScaledClock(start_utc=1_000_000.0, factor=50.0)
    before, began, after = time.monotonic(), clock.now(), time.monotonic()

    await clock.sleep(1.0)

    then_before, ended, then_after = time.monotonic(), clock.now(), time.monotonic()
    assert began - 1_000_000.0 >= 0.0
    assert 50.0 * (then_before - after) - 1e-6 <= ended - began <= 50.0 * (then_after - before) + 1e-6
    assert ended - began >= 1.0


async def test_the_wall_clock_is_utc_and_a_negative_sleep_is_none() -> None:
    clock = WallClock()

    assert clock.now() == pytest.approx(time.time(), abs=1.0)
    await clock.sleep(-5.0)
    assert clock.factor == 1.0


@pytest.mark.parametrize("factor", [0.0, -1.0, float("nan"), float("inf")])
def test_a_clock_that_could_not_run_is_refused(factor: float) -> None:
    with pytest.raises(ValueError, match="factor must be a positive number"):
        ScaledClock(factor=factor)


def test_a_start_that_is_no_time_is_refused() -> None:
    with pytest.raises(ValueError, match="UTC epoch seconds"):
        ScaledClock(start_utc=float("nan"))
