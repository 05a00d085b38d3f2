"""Every reason of the planner, and its English with values."""

from __future__ import annotations

import pytest

from planner.reason import Reason, text_of
from planner.reasons import (
    BearingMissesArea,
    BearingsDisagree,
    PlannerReason,
    QuickestPlace,
    TooFewPlacesAgree,
    disagreement,
)
from planner.types import InconsistentBearings, PlannerError
from tests.reasons import assert_codes_differ, assert_well_said, classes_of, examples


@pytest.mark.parametrize("reason", classes_of(PlannerReason))
def test_every_reason_is_well_said(reason: type[Reason]) -> None:
    for one in examples(reason):
        assert_well_said(one)


def test_codes_are_unique() -> None:
    assert_codes_differ([PlannerReason])


def test_values_are_written_with_their_units() -> None:
    assert text_of(QuickestPlace(134.4, 11.6, 34)) == (
        "Localized in about 2:14 by way of this place, 12 s sooner than by any other of 34 places tried."
    )
    assert text_of(TooFewPlacesAgree(1, 3, 2)) == "1 of 3 places agrees on the estimate; 2 are needed."


def test_one_bearing_contradicts_no_other() -> None:
    assert disagreement(1) == BearingMissesArea()
    assert disagreement(3) == BearingsDisagree(3)


def test_an_error_says_its_reason() -> None:
    error: PlannerError = InconsistentBearings(BearingsDisagree(3))
    assert error.reason == BearingsDisagree(3)
    assert str(error) == "The 3 bearings contradict each other: at least one is an outlier."
