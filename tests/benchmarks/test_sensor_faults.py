"""The fault study in small: no fault of the sensor crashes the search or makes it lie."""

from __future__ import annotations

import pytest

from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from tests.benchmarks.sensor_faults import FAULTS, HEADING_SIGMA_DEG, Fault, fly, row

PATTERN = load_pattern(SMALL_YAGI)
FINDER = SparseDirectionFinder(heading_sigma_deg=HEADING_SIGMA_DEG)


@pytest.mark.parametrize("fault", [f for f in FAULTS if f.seen], ids=lambda fault: fault.name)
def test_claims_are_true_under_every_fault_that_can_be_noticed(fault: Fault) -> None:
    outcomes = [fly(seed, fault, PATTERN, FINDER) for seed in range(101, 105)]
    claims = [o for o in outcomes if o.localized]
    assert claims
    assert sum(not o.in_c95 and o.error_m > 3.0 * o.stated_m for o in claims) == 0
    assert fault.name in row(fault, outcomes)


@pytest.mark.parametrize(("heading_deg", "least", "most"), [(0.0, 0, 0), (20.0, 2, 3)])
def test_a_compass_that_is_far_off_is_told_and_a_right_one_not(heading_deg: float, least: int, most: int) -> None:
    """Three bearings cannot always tell."""
    outcomes = [fly(seed, Fault("heading", heading_deg=heading_deg), PATTERN, FINDER) for seed in (101, 102, 103)]
    assert least <= sum(o.offset_told for o in outcomes) <= most


def test_overdriven_sweeps_are_taken_again() -> None:
    outcomes = [fly(seed, Fault("too much gain", clipped=0.5), PATTERN, FINDER) for seed in (1, 2, 3)]
    assert sum(o.rejected for o in outcomes) > 0
    assert all(o.localized for o in outcomes)


def test_a_mission_is_the_same_every_time() -> None:
    assert fly(7, FAULTS[1], PATTERN, FINDER) == fly(7, FAULTS[1], PATTERN, FINDER)
