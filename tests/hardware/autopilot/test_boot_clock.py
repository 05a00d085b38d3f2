from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.autopilot.boot_clock import BootClock

EPOCH = 1_700_000_000.0


@given(st.lists(st.floats(0.0, 0.5), min_size=40, max_size=200))
def test_after_one_prompt_message_late_ones_do_not_move_the_time(delays: list[float]) -> None:
    clock = BootClock()
    boot = 0.0
    clock.to_utc(boot, EPOCH + boot)  # without delay
    for delay in delays:
        boot += 0.05
        utc = clock.to_utc(boot, EPOCH + boot + delay)
        assert EPOCH + boot - 1e-6 <= utc <= EPOCH + boot + 2e-3 * boot + 1e-6


@given(st.lists(st.tuples(st.floats(0.01, 0.2), st.floats(0.0, 3.0)), min_size=1, max_size=100))
def test_a_moment_is_never_later_than_its_message(steps: list[tuple[float, float]]) -> None:
    clock, boot = BootClock(), 0.0
    for gap, delay in steps:
        boot += gap
        heard = EPOCH + boot + delay
        assert clock.to_utc(boot, heard) <= heard + 1e-6


def test_a_reboot_starts_from_zero() -> None:
    clock = BootClock()
    clock.to_utc(500.0, EPOCH)

    assert clock.to_utc(2.0, EPOCH + 10.0) == pytest.approx(EPOCH + 10.0)
    assert clock.reboots == 1


def test_a_lasting_step_is_followed_and_a_burst_of_lateness_is_not() -> None:
    clock, boot = BootClock(), 0.0
    for _ in range(10):
        boot += 0.05
        clock.to_utc(boot, EPOCH + boot)
    for _ in range(5):  # a stalled event loop
        boot += 0.05
        assert clock.to_utc(boot, EPOCH + boot + 4.0) == pytest.approx(EPOCH + boot, abs=0.01)
    for _ in range(40):  # the autopilot stood still for 4 s
        boot += 0.05
        clock.to_utc(boot, EPOCH + boot + 4.0)
    assert clock.to_utc(boot, EPOCH + boot + 4.0) == pytest.approx(EPOCH + boot + 4.0, abs=0.01)
