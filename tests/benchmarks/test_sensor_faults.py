"""The fault study in small: no fault of the sensor crashes the search or makes it lie."""

from __future__ import annotations

import pytest

from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from tests.benchmarks.sensor_faults import FAULTS, HEADING_SIGMA_DEG, Fault, fly, row

PATTERN = load_pattern(SMALL_YAGI)
FINDER = SparseDirectionFinder(heading_sigma_deg=HEADING_SIGMA_DEG)


@pytest.mark.long
@pytest.mark.parametrize("fault", [f for f in FAULTS if f.seen], ids=lambda fault: fault.name)
def test_claims_are_true_under_every_fault_that_can_be_noticed(fault: Fault) -> None:
    outcomes = [fly(seed, fault, PATTERN, FINDER) for seed in range(101, 149)]
    claims = [o for o in outcomes if o.localized]
    assert len(claims) >= 46
    assert sum(o.in_c95 for o in claims) >= len(claims) - 4
    assert sum(not o.in_c95 and o.error_m > 3.0 * o.stated_m for o in claims) <= 4
    assert fault.name in row(fault, outcomes)


@pytest.mark.parametrize("heading_deg", [0.0, 10.0])
def test_what_the_compass_is_off_by_is_found_and_what_is_claimed_is_true(heading_deg: float) -> None:
    outcomes = [fly(seed, Fault("heading", heading_deg=heading_deg), PATTERN, FINDER) for seed in (101, 102, 103)]
    assert all(o.localized and o.in_c95 for o in outcomes)
    found = [o.compass_deg for o in outcomes if o.compass_deg is not None]
    assert found == pytest.approx([-heading_deg] * 3, abs=5.0)  # a compass that says too little


def test_overdriven_sweeps_are_taken_again() -> None:
    outcomes = [fly(seed, Fault("too much gain", clipped=0.5), PATTERN, FINDER) for seed in (1, 2, 3)]
    assert sum(o.rejected for o in outcomes) > 0
    assert all(o.localized for o in outcomes)


def test_a_mission_is_the_same_every_time() -> None:
    assert fly(7, FAULTS[1], PATTERN, FINDER) == fly(7, FAULTS[1], PATTERN, FINDER)
