"""The wait that is stated to somebody who tried too often."""

from __future__ import annotations

import pytest

from backend.auth.limits import too_many
from planner.reason import remedy_of


@pytest.mark.parametrize(("wait_s", "words"), [(0.08, "1 s"), (0.41, "1 s"), (1.0, "1 s"), (5.2, "6 s")])
def test_whoever_waits_as_long_as_was_said_is_let_in(wait_s: float, words: str) -> None:
    assert remedy_of(too_many(wait_s).reason) == f"Try again in {words}."
