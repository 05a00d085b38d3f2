from __future__ import annotations

from datetime import UTC, datetime

import numpy as np
import pytest
from ground import AREA, HOME

from backend.events import FIRST_CRAFT, Event, MissionDrafted, MissionStarted, Recorded, RecordingImported
from backend.search.antenna import antenna_fact, antenna_flown
from backend.spec import FIRST_EMITTER, MissionSpec
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


def test_of_a_mission_that_kept_none_there_is_none() -> None:
    assert antenna_flown(recorded(DRAFTED, started(None))) is None
