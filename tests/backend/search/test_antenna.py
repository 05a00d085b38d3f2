from __future__ import annotations

from datetime import UTC, datetime

import numpy as np
import pytest
from ground import AREA, HOME

from backend.events import (
    FIRST_CRAFT,
    CraftSource,
    Event,
    ImportSource,
    MissionDrafted,
    MissionEdited,
    MissionStarted,
    Recorded,
    RecordingImported,
)
from backend.search.antenna import antenna_fact, antenna_flown, antennas, corrected, correction_flown
from backend.spec import FIRST_EMITTER, MissionSpec, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern

ANGLE_DEG, GAIN_DB = np.array([0.0, 90.0, 180.0, 270.0]), np.array([0.0, -6.0, -12.0, -6.0])
YAGI = AntennaPattern("yagi", ANGLE_DEG, GAIN_DB, 12.0, 150e6)
LOOP = AntennaPattern("loop", ANGLE_DEG, GAIN_DB)
DRAFTED = MissionDrafted(spec=MissionSpec(name="m", area=AREA))


def started(pattern: AntennaPattern | None) -> MissionStarted:
    antenna = None if pattern is None else antenna_fact(pattern)
    return MissionStarted(
        craft_id=FIRST_CRAFT, by="anna", home=HOME, home_amsl_m=100.0, software="test", antenna=antenna
    )


def imported(pattern: AntennaPattern) -> RecordingImported:
    return RecordingImported(
        emitter_id=FIRST_EMITTER,
        recording_id="r",
        filename="turn.csv",
        by="anna",
        recorded_at_utc=None,
        sweep_ids=[],
        remarks=[],
        antenna=antenna_fact(pattern),
    )


def recorded(*events: Event) -> list[Recorded]:
    at_utc = datetime(2026, 5, 1, tzinfo=UTC)
    return [Recorded(seq=n, mission_id="m", at_utc=at_utc, event=event) for n, event in enumerate(events, start=1)]


@pytest.mark.parametrize("pattern", [YAGI, LOOP])
def test_an_antenna_comes_back_out_of_its_fact(pattern: AntennaPattern) -> None:
    found = antenna_flown(recorded(DRAFTED, started(pattern)))
    assert found is not None
    assert (found.name, found.offset_to_nose_deg, found.frequency_hz) == (
        pattern.name,
        pattern.offset_to_nose_deg,
        pattern.frequency_hz,
    )
    assert np.array_equal(found.relative_bearing_deg, pattern.relative_bearing_deg)
    assert np.array_equal(found.gain_db, pattern.gain_db)


def test_it_is_the_last_one_flown_or_imported_with() -> None:
    for events, name in (((started(YAGI), imported(LOOP)), "loop"), ((imported(LOOP), started(YAGI)), "yagi")):
        found = antenna_flown(recorded(DRAFTED, *events))
        assert found is not None
        assert found.name == name


def test_each_source_has_its_own() -> None:
    found = antennas(recorded(DRAFTED, started(YAGI), imported(LOOP)))
    craft, file = CraftSource(craft_id=FIRST_CRAFT), ImportSource(recording_id="r")
    assert [(source, one.name) for source, one in found.items()] == [(craft, "yagi"), (file, "loop")]
    assert found[craft].offset_to_nose_deg == YAGI.offset_to_nose_deg
    assert antennas(recorded(DRAFTED, started(None))) == {}


def test_of_a_mission_that_kept_none_there_is_none() -> None:
    assert antenna_flown(recorded(DRAFTED, started(None))) is None


def test_what_is_taken_off_bearings_turns_the_antenna_the_other_way_and_nothing_turns_nothing() -> None:
    assert corrected(YAGI, 0.0) is YAGI
    assert corrected(YAGI, 5.0).offset_to_nose_deg == 7.0
    assert corrected(YAGI, -170.0).offset_to_nose_deg == -178.0
    assert corrected(corrected(YAGI, 33.3), -33.3).offset_to_nose_deg == pytest.approx(12.0)


def test_a_recordings_antenna_has_no_correction_in_it_and_a_flown_one_the_last_that_was_specified() -> None:
    def with_offset(deg: float) -> MissionSpec:
        return DRAFTED.spec.model_copy(update={"sensor": SensorSpec(bearing_offset_deg=deg)})

    specified = (MissionDrafted(spec=with_offset(3.0)), MissionEdited(spec=with_offset(4.0)))
    assert correction_flown(recorded(*specified)) == 4.0
    assert correction_flown(recorded(*specified, imported(LOOP), started(YAGI))) == 4.0
    assert correction_flown(recorded(*specified, started(None))) == 4.0
    assert correction_flown(recorded(*specified, started(YAGI), imported(LOOP))) == 0.0
    assert correction_flown([]) == 0.0
