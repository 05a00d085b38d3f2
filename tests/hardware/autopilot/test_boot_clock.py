from __future__ import annotations

import math
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.autopilot.boot_clock import RATE_LIMIT, BootClock

EPOCH = 1_700_000_000.0
TURN_DEG_S = 30.0


class Link:
    """An autopilot whose clock has a rate, behind a radio; `error_s`: how wrong a message of this moment is dated."""

    def __init__(
        self, rate: float = 1.0, delay_s: float = 0.0, jitter_s: float = 0.0, timesync: bool = True, ping: bool = False
    ) -> None:
        self.clock = BootClock()
        self.rate, self.delay_s, self.jitter_s, self.timesync = rate, delay_s, jitter_s, timesync
        self.at_s, self.boot_s, self.ping = EPOCH, 100.0, ping
        self._chance = Random(5)

    def late(self) -> float:
        return self.delay_s + self._chance.expovariate(1.0) * self.jitter_s

    def step(self, seconds: float = 0.05) -> float:
        self.at_s += seconds
        self.boot_s += seconds * self.rate
        if self.timesync and round(self.at_s / 0.05) % 4 == 0:
            up_s, down_s = self.late(), self.late()
            self.clock.exchanged(self.at_s - up_s, self.boot_s, self.at_s + down_s)
        if self.ping and round(self.at_s / 0.05) % 4 == 0:
            self.clock.went_round(self.at_s - self.late(), self.at_s + self.late())
        return self.clock.to_utc(self.boot_s, self.at_s + self.late()) - self.at_s

    def error_s(self, seconds: float) -> float:
        """The largest of the second half."""
        errors = [self.step() for _ in range(round(seconds / 0.05))]
        return max(abs(error) for error in errors[len(errors) // 2 :])


@given(st.lists(st.floats(0.0, 0.5), min_size=40, max_size=200))
def test_after_one_prompt_message_late_ones_do_not_move_the_time(delays: list[float]) -> None:
    clock = BootClock()
    boot = 0.0
    clock.to_utc(boot, EPOCH + boot)  # without delay
    for delay in delays:
        boot += 0.02
        utc = clock.to_utc(boot, EPOCH + boot + delay)
        assert EPOCH + boot - 1e-6 <= utc <= EPOCH + boot + 1e-6


@given(st.lists(st.tuples(st.floats(0.01, 0.2), st.floats(0.0, 3.0)), min_size=1, max_size=300))
def test_a_moment_is_never_later_than_its_message(steps: list[tuple[float, float]]) -> None:
    clock, boot = BootClock(), 0.0
    for gap, delay in steps:
        boot += gap
        heard = EPOCH + boot + delay
        assert clock.to_utc(boot, heard) <= heard + 1e-6


def test_a_constant_delay_turns_no_heading_once_it_was_measured() -> None:
    """150 ms at 30 degrees a second are 4.5 degrees."""
    assert Link(delay_s=0.15, timesync=False).error_s(20.0) * TURN_DEG_S == pytest.approx(4.5, abs=0.2)
    assert Link(delay_s=0.15).error_s(20.0) * TURN_DEG_S < 0.1
    assert Link(delay_s=0.15, jitter_s=0.03).error_s(20.0) * TURN_DEG_S < 0.5


@pytest.mark.parametrize("rate", [1.0, 0.994])
def test_where_only_pings_are_answered_the_delay_is_taken_from_them(rate: float) -> None:
    def link(**given: float) -> Link:
        made = Link(rate=rate, delay_s=0.15, timesync=False, ping=True, **given)
        made.error_s(10.0)
        return made

    assert link().error_s(30.0) * TURN_DEG_S < 0.1
    assert link(jitter_s=0.02).error_s(30.0) * TURN_DEG_S < 0.5


def test_a_delay_that_changes_turns_headings_for_no_longer_than_the_line_takes() -> None:
    link = Link(rate=0.994, delay_s=0.0, timesync=False, ping=True)
    link.error_s(40.0)
    link.delay_s = 0.25
    assert link.error_s(70.0) * TURN_DEG_S < 0.1
    link.delay_s = 0.0
    assert link.error_s(70.0) * TURN_DEG_S < 0.1


@pytest.mark.parametrize("rate", [0.98, 0.99, 1.0, 1.0001, 1.03])
def test_the_rate_of_the_autopilots_clock_is_learned(rate: float) -> None:
    link = Link(rate=rate, delay_s=0.02, jitter_s=0.01)
    link.error_s(10.0)
    assert link.error_s(120.0) * TURN_DEG_S < 0.5
    assert link.clock.measured_rate == pytest.approx(rate, abs=0.003)
    assert not link.clock.rate_is_odd


@pytest.mark.parametrize(("rate", "within_s"), [(0.5, 100.0), (0.9, 20.0), (1.1, 20.0), (2.0, 20.0)])
@pytest.mark.parametrize("answers", [{"timesync": True}, {"timesync": False, "ping": True}], ids=["timesync", "ping"])
def test_a_clock_that_is_too_far_off_is_said(rate: float, within_s: float, answers: dict[str, bool]) -> None:
    """At half speed the line under the messages starts again and again: the round trips alone have to last a window."""
    link = Link(rate=rate, delay_s=0.08, jitter_s=0.02, **answers)
    link.error_s(within_s)
    assert link.clock.rate_is_odd
    assert link.clock.measured_rate == pytest.approx(rate, abs=0.005 * rate)
    link.rate = 1.0
    link.error_s(30.0)
    assert not link.clock.rate_is_odd


def test_without_any_answer_it_must_look_odd_for_as_long_as_is_looked_back() -> None:
    link = Link(rate=0.9, delay_s=0.08, timesync=False)
    link.error_s(25.0)
    assert not link.clock.rate_is_odd
    link.error_s(20.0)
    assert link.clock.rate_is_odd


@pytest.mark.parametrize("answers", [{"timesync": True}, {"timesync": False, "ping": True}, {"timesync": False}])
def test_a_busy_link_makes_no_clock_odd(answers: dict[str, bool]) -> None:
    """Delays that grow for ten seconds and fall again, as those of a server or a radio with too much to do."""
    link, looked_odd = Link(delay_s=0.05, jitter_s=0.05, **answers), 0
    link.error_s(30.0)
    for second in range(120):
        link.delay_s = 0.05 + 1.2 * max(0.0, 1.0 - abs(second % 40 - 10) / 10.0)
        for _ in range(20):
            link.step()
            looked_odd += abs(1.0 / (link.clock.measured_rate or 1.0) - 1.0) > RATE_LIMIT
            assert not link.clock.rate_is_odd
    assert looked_odd > 0, "the line alone was never misled"


def test_a_clock_that_stalls_for_an_instant_and_catches_up_is_not_odd() -> None:
    """A simulator on a busy machine, ten times as fast as real time: it is late by seconds, and in time again."""
    link = Link(delay_s=0.02, jitter_s=0.02)
    link.error_s(30.0)
    for _ in range(12):
        link.boot_s -= 1.6
        for _ in range(20):
            link.step()
            assert not link.clock.rate_is_odd
        link.boot_s += 1.6
        for _ in range(100):
            link.step()
            assert not link.clock.rate_is_odd


def test_a_rate_at_the_limit_does_not_come_and_go() -> None:
    link, changes, before = Link(rate=1.0 / (1.0 + RATE_LIMIT), delay_s=0.01, jitter_s=0.02), 0, False
    for _ in range(6000):
        link.step()
        changes += link.clock.rate_is_odd != before
        before = link.clock.rate_is_odd
    assert changes <= 1


def test_a_reboot_forgets_that_the_clock_was_odd() -> None:
    link = Link(rate=0.9)
    link.error_s(25.0)
    assert link.clock.rate_is_odd
    link.boot_s = 1.0
    link.step()
    assert not link.clock.rate_is_odd


def test_a_rate_that_changes_is_followed_within_the_bounds_of_timesync() -> None:
    """A simulator on a busy machine."""
    link = Link(delay_s=0.005)
    worst = 0.0
    for rate in (1.0, 0.97, 1.0, 0.96, 0.99):
        link.rate = rate
        worst = max(worst, link.error_s(20.0))
    assert worst * TURN_DEG_S < 1.5


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


def test_timesync_shows_a_small_step_at_once() -> None:
    link = Link(delay_s=0.01)
    link.error_s(10.0)
    link.boot_s -= 0.3  # the autopilot stood still
    assert max(link.step() for _ in range(5)) == pytest.approx(0.0, abs=0.02)


def test_an_answer_that_took_very_long_says_nothing() -> None:
    link = Link(delay_s=0.0)
    link.error_s(10.0)
    link.clock.exchanged(link.at_s - 10.0, link.boot_s, link.at_s)
    assert math.isclose(link.step(), 0.0, abs_tol=1e-6)


def test_the_limit_is_the_one_of_the_guide() -> None:
    assert RATE_LIMIT == 0.05
