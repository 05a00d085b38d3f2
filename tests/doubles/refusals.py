"""`with refusing(NoPlaceToFly()):` as pytest.raises, for errors that carry a reason; `near` for a reason's values."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from planner.reason import Reason, ReasonedError


@contextmanager
def refusing(expected: Reason | type[Reason], error: type[ReasonedError] = ReasonedError) -> Iterator[None]:
    """The block must raise an `error` with this reason, or with one of this class."""
    with pytest.raises(error) as caught:
        yield
    reason = caught.value.reason
    assert isinstance(reason, expected) if isinstance(expected, type) else reason == expected


def near(value: float, rel: float = 0.01) -> Any:
    """In an expected reason: equal to what is that close."""
    return pytest.approx(value, rel=rel)
