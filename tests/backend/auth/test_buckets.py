"""Token buckets by their law, and with clocks that step."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from backend.auth import buckets
from backend.auth.buckets import Buckets, neighbourhood


@given(st.lists(st.floats(0, 20), max_size=200))
def test_no_more_than_the_burst_and_what_came_back_is_ever_let_through(steps: list[float]) -> None:
    limit, now_s, passed = Buckets(burst=5, every_s=2.0), 0.0, 0
    for step in steps:
        now_s += step
        if limit.wait_s("k", now_s) == 0:
            passed += 1
        limit.take("k", now_s)
        assert passed <= 5 + now_s / 2.0 + 1e-6


@given(st.lists(st.floats(-100, 1), max_size=100))
def test_a_clock_that_steps_back_gives_nothing(steps: list[float]) -> None:
    limit = Buckets(burst=3, every_s=1e6)
    now_s, passed = 0.0, 0
    for step in steps:
        now_s += step
        passed += limit.wait_s("k", now_s) == 0
        limit.take("k", now_s)
    assert passed <= 3


def test_a_key_waits_as_long_as_it_is_told_and_others_do_not() -> None:
    limit = Buckets(burst=2, every_s=10.0)
    for _ in range(2):
        limit.take("k", 0.0)
    wait_s = limit.wait_s("k", 0.0)
    assert wait_s == pytest.approx(10.0)
    assert limit.wait_s("k", wait_s - 0.1) > 0
    assert limit.wait_s("k", wait_s) == 0
    assert limit.wait_s("other", 0.0) == 0


def test_keys_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(buckets, "KEYS", 10)
    limit = Buckets(burst=1, every_s=1e9)
    for number in range(100):
        limit.take(str(number), 0.0)
    assert limit.wait_s("99", 0.0) > 0
    assert limit.wait_s("1", 0.0) == 0


@pytest.mark.parametrize(
    ("address", "counted"),
    [
        ("10.0.0.1", "10.0.0.1"),
        ("::ffff:10.0.0.1", "10.0.0.1"),
        ("2001:db8:1:2:3::4", "2001:db8:1:2::"),
        ("unknown", "unknown"),
    ],
)
def test_what_counts_as_one_address(address: str, counted: str) -> None:
    assert neighbourhood(address) == counted
