"""What is recorded of a sweep: its bearing, or a reason why it has none."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from backend.events import BearingMeasured, CraftSource, ImportSource, PersonSource, SweepRejected
from backend.reasons.search import QualityTooLow, SweepIncomplete
from backend.search.sweep_facts import BINS, Taken, rejected, sweep_fact
from backend.spec import SensorSpec
from hardware.readings import BearingReading, Place, Sweep
from hardware.reasons.sweep import NoDirection

HERE = Place(50.0, 7.0)
SENSOR = SensorSpec(minimum_quality=0.7)
TAKEN = Taken("tag", CraftSource(craft_id="craft-2"), "s1", 3, 2)
TIMES, HEADINGS = np.linspace(0.0, 12.0, 90), np.linspace(0.0, 356.0, 90)
SWEEP = Sweep(TIMES, HEADINGS, np.full(90, -60.0), 150e6, HERE, 140.0, drift_m=0.4)
BINNED = np.full(BINS, -60.0)
READING = BearingReading(45.0, 3.0, 0.95, True, None, (), BINNED, BINNED)


def fact(
    reading: BearingReading = READING, sweep: Sweep = SWEEP, taken: Taken = TAKEN
) -> BearingMeasured | SweepRejected:
    return sweep_fact(taken, SENSOR, sweep, reading, measurement_time_s=14.0)


@pytest.mark.parametrize(
    "source", [CraftSource(craft_id="craft-2"), ImportSource(recording_id="r"), PersonSource(name="ben")]
)
def test_a_bearing_says_of_which_emitter_it_is_and_who_took_it(
    source: CraftSource | ImportSource | PersonSource,
) -> None:
    found = fact(taken=replace(TAKEN, source=source))
    assert isinstance(found, BearingMeasured)
    assert (found.emitter_id, found.source, found.sweep_id, found.place_number) == ("tag", source, "s1", 3)
    assert (found.bearing_deg, found.sigma_deg, found.quality) == (45.0, 3.0, 0.95)
    assert (found.place, found.altitude_amsl_m, found.measurement_time_s) == (HERE, 140.0, 14.0)


def test_two_bearings_of_one_sweep_have_ids_of_their_own() -> None:
    one, other = fact(), fact(taken=replace(TAKEN, emitter_id="collar"))
    assert isinstance(one, BearingMeasured)
    assert isinstance(other, BearingMeasured)
    assert one.bearing_id != other.bearing_id


def test_a_bin_where_nothing_was_heard_is_unknown() -> None:
    gap = BINNED.copy()
    gap[7] = math.nan
    found = fact(replace(READING, binned_db=gap))
    assert [bin for bin, power in enumerate(found.binned_db) if power is None] == [7]


def test_the_finders_own_reason_is_kept() -> None:
    found = fact(replace(READING, accepted=False, reason=NoDirection()))
    assert isinstance(found, SweepRejected)
    assert found.reason == NoDirection()
    assert (found.emitter_id, found.attempt, found.place_number) == ("tag", 2, 3)


def test_a_sweep_too_poor_for_the_mission_is_rejected_by_its_quality() -> None:
    found = fact(replace(READING, quality=0.6))
    assert isinstance(found, SweepRejected)
    assert (found.reason, found.quality) == (QualityTooLow(0.6, 0.7), 0.6)


def test_values_that_are_no_numbers_are_named_and_stored_nowhere() -> None:
    found = fact(replace(READING, sigma_deg=math.nan, quality=math.inf), replace(SWEEP, altitude_amsl_m=math.nan))
    assert isinstance(found, SweepRejected)
    assert found.reason == SweepIncomplete(("sigma", "quality", "altitude"))
    assert found.quality == 0.0


def test_a_rejection_without_a_reading_has_empty_bins() -> None:
    found = rejected(TAKEN, HERE, 0.0, NoDirection())
    assert found.binned_db == found.fitted_db == [None] * BINS
