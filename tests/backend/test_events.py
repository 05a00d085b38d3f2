"""A fact holds no number that cannot be stored: it is refused where it is made, or unknown where that is allowed."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from pydantic import ValidationError

from backend.events import (
    BearingMeasured,
    CraftSource,
    ImportSource,
    MissionDrafted,
    MissionEnded,
    PersonSource,
    Recorded,
)
from backend.reasons import Interrupted
from backend.spec import MissionSpec, Place, Polygon, TimerSpec

SQUARE = Polygon(coordinates=[[(7.0, 50.0), (7.01, 50.0), (7.01, 50.01), (7.0, 50.0)]])

BEARING: dict[str, Any] = {
    "emitter_id": "emitter-1",
    "source": CraftSource(craft_id="craft-1"),
    "bearing_id": "b",
    "sweep_id": "s",
    "place_number": 1,
    "place": Place(lat=50.0, lon=7.0),
    "altitude_amsl_m": 140.0,
    "bearing_deg": 10.0,
    "sigma_deg": 7.0,
    "quality": 0.9,
    "peaks": [],
    "snr_db": 20.0,
    "drift_m": 0.1,
    "binned_db": [],
    "fitted_db": [],
}


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["altitude_amsl_m", "bearing_deg", "sigma_deg", "quality", "drift_m"])
def test_a_number_that_must_be_known_is_refused_when_it_is_not_finite(name: str, number: float) -> None:
    with pytest.raises(ValidationError, match=name):
        BearingMeasured(**{**BEARING, name: number})


def test_a_number_that_may_be_unknown_is_none_when_it_is_not_finite() -> None:
    made = BearingMeasured(**{**BEARING, "snr_db": math.nan, "binned_db": [math.inf, 1.0, None]})
    assert made.snr_db is None
    assert made.binned_db == [None, 1.0, None]


def test_what_is_made_can_be_written_and_read_back() -> None:
    record = Recorded(
        seq=1,
        mission_id="m",
        at_utc="2026-01-01T00:00:00Z",  # type: ignore[arg-type]
        event=MissionEnded(outcome="failed", reason=Interrupted("unreadable"), mission_time_s=0.0),
    )
    assert Recorded.model_validate_json(record.model_dump_json()) == record


@pytest.mark.parametrize(
    "source", [CraftSource(craft_id="craft-2"), ImportSource(recording_id="r"), PersonSource(name="ben")]
)
def test_a_bearing_keeps_its_source(source: CraftSource | ImportSource | PersonSource) -> None:
    made = BearingMeasured(**{**BEARING, "source": source})
    assert BearingMeasured.model_validate_json(made.model_dump_json()).source == source


def test_a_fact_names_its_craft_or_emitter_by_an_id() -> None:
    with pytest.raises(ValidationError, match="emitter_id"):
        BearingMeasured(**{**BEARING, "emitter_id": "no id: blanks"})


def test_timers_are_bounded_for_what_is_drafted_and_read_bounded_from_what_was_stored() -> None:
    long = {"console_lost_hold_s": 1e9, "console_lost_return_s": 3_600.0, "receiver_silent_s": 1e12}
    for name, value in long.items():
        with pytest.raises(ValidationError, match=name):
            TimerSpec.model_validate({name: value})
    drafted = MissionDrafted(spec=MissionSpec(name="before", area=SQUARE)).model_dump(mode="json")
    drafted["spec"]["timers"] = long
    read = MissionDrafted.model_validate_json(json.dumps(drafted))
    assert read.spec.timers == TimerSpec(console_lost_hold_s=120.0, console_lost_return_s=600.0, receiver_silent_s=60.0)
