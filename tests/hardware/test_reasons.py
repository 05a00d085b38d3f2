"""Every reason of the hardware, and its English with values."""

from __future__ import annotations

import pytest

from hardware.reasons.channels import BandTooNarrow
from hardware.reasons.union import HardwareReason
from planner.reason import Reason, sentence_of
from planner.reasons import PlannerReason
from tests.reasons import assert_codes_differ, assert_well_said, classes_of, examples


@pytest.mark.parametrize("reason", classes_of(HardwareReason))
def test_every_reason_is_well_said(reason: type[Reason]) -> None:
    for one in examples(reason):
        assert_well_said(one)


def test_codes_are_unique() -> None:
    assert_codes_differ([HardwareReason, PlannerReason])


def test_each_value_of_a_list_has_its_unit() -> None:
    assert sentence_of(BandTooNarrow(250e3, 2.4e6, (868.3e6, 869.525e6))) == (
        "At a sample rate of 250.0 kHz the receiver cannot hear 868.3000 MHz, 869.5250 MHz at the same time as the "
        "others. Raise the sample rate to 2.4000 MHz, or state in the mission how wide a band the receiver hears: then "
        "it hears them one after another."
    )
