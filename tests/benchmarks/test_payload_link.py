"""The benchmark of a payload's lost link finds what it looks for."""

from __future__ import annotations

import pytest

from tests.benchmarks.payload_link import wrong_with

BEGAN_S = 1_780_000_000.0
HEARD_S = [BEGAN_S - 1.0 + 0.05 * k for k in range(200)]


@pytest.mark.parametrize(
    ("kept", "said"),
    [
        (range(20, 150), None),
        ([*range(20, 70), *range(71, 150)], "129 of 130 readings"),
        ([*range(20, 71), *range(70, 150)], "1 readings twice or out of order"),
        ([*range(20, 70), 71, 70, *range(72, 150)], "0 readings twice or out of order"),
    ],
)
def test_a_sweep_holds_each_reading_once(kept, said) -> None:
    sweep = {"began_at_utc": "2026-05-28T20:26:40+00:00", "at_s": [HEARD_S[k] - BEGAN_S for k in kept]}
    assert wrong_with(sweep, HEARD_S) == said
