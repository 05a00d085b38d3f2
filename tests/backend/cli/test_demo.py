from __future__ import annotations

import json
from datetime import UTC, datetime

import pytest

from backend.cli.demo import CARRIER, TAG, movement, simulated, sought
from backend.cli.demo_grade import MissionLog, sentences, summary
from backend.cli.progress import progress_line
from backend.events import (
    FIRST_CRAFT,
    BeliefUpdated,
    EstimateFact,
    Event,
    MissionDrafted,
    MissionEnded,
    MissionStarted,
    PhaseChanged,
    Recorded,
    SweepStarted,
)
from backend.reasons import NotLocalized, PlacesUsedUp
from backend.reasons.search import Localized
from backend.settings import Settings
from backend.simulation.emitters import Signal
from backend.spec import FIRST_EMITTER, EmitterSpec, MissionSpec, Polygon
from hardware.frame import LocalFrame
from hardware.readings import Place

TRUTH = Place(50.0, 7.0)
TRUTHS = {Signal(EmitterSpec().frequency_hz): TRUTH}


def log(*events: Event, emitters: list[EmitterSpec] | None = None) -> MissionLog:
    at = datetime(2026, 1, 1, tzinfo=UTC)
    ring = [(7.0, 50.0), (7.01, 50.0), (7.0, 50.01), (7.0, 50.0)]
    drafted = MissionDrafted(
        spec=MissionSpec(name="m", area=Polygon(coordinates=[ring]), emitters=emitters or sought(CARRIER, 1))
    )
    told = [drafted, *events]
    return MissionLog("m", [Recorded(seq=i, mission_id="m", at_utc=at, event=e) for i, e in enumerate(told, 1)])


def belief(east: float, size: float, emitter_id: str = FIRST_EMITTER) -> BeliefUpdated:
    frame = LocalFrame(TRUTH)
    place = frame.to_geo(east, 0.0)
    corners = (
        (east - size, -size),
        (east + size, -size),
        (east + size, size),
        (east - size, size),
        (east - size, -size),
    )
    ring = [(p.lon, p.lat) for p in (frame.to_geo(*corner) for corner in corners)]
    estimate = EstimateFact(
        lat=place.lat,
        lon=place.lon,
        expected_rmse_m=4.0,
        c95=Polygon(coordinates=[ring]),
        c95_area_m2=4 * size**2,
        major_axis_m=3.0,
        minor_axis_m=2.0,
        major_axis_deg=10.0,
    )
    return BeliefUpdated(
        emitter_id=emitter_id, bearings=2, estimate=estimate, consistent=True, localized=True, not_yet=[], digest="d"
    )


def ended(outcome: str) -> MissionEnded:
    reason = Localized() if outcome == "localized" else NotLocalized(PlacesUsedUp(3))
    return MissionEnded(outcome=outcome, reason=reason, mission_time_s=95.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(("east", "size", "inside"), [(3.0, 10.0, True), (30.0, 10.0, False)])
def test_the_last_estimate_is_compared_with_the_truth(east: float, size: float, inside: bool) -> None:
    result = summary(log(belief(100.0, 5.0), belief(east, size), ended("localized")), Settings(seed=7), TRUTHS)
    assert result["localized"]
    assert result["error_m"] == pytest.approx(east, rel=1e-3)
    assert result["in_c95"] is inside
    assert result["seed"] == 7
    assert result["database"].endswith("crossfix.sqlite")
    json.dumps(result, allow_nan=False)
    assert f"{east:.1f} m from the emitter" in sentences(result)[0]
    assert "emitters" not in result


def test_not_localized_is_said_with_its_reason_and_no_made_up_numbers() -> None:
    nothing = BeliefUpdated(
        emitter_id=FIRST_EMITTER, bearings=3, estimate=None, consistent=False, localized=False, not_yet=[], digest="d"
    )
    result = summary(log(nothing, ended("not_localized")), Settings(), TRUTHS)
    assert not result["localized"]
    assert result["error_m"] is None
    assert result["in_c95"] is None
    assert result["expected_rmse_m"] is None
    assert result["reason"].startswith("Not localized. 3 places were used")
    assert result["reason"] in sentences(result)[0]


def test_every_emitter_is_graded_against_its_own_truth() -> None:
    emitters = sought(CARRIER, 2)
    flown = log(belief(3.0, 10.0), belief(30.0, 10.0, "emitter-2"), ended("localized"), emitters=emitters)
    result = summary(flown, Settings(), {Signal(emitter.frequency_hz): TRUTH for emitter in emitters})
    assert [graded["emitter_id"] for graded in result["emitters"]] == ["emitter-1", "emitter-2"]
    assert [graded["in_c95"] for graded in result["emitters"]] == [True, False]
    assert result["emitters"][1]["error_m"] == pytest.approx(30.0, rel=1e-3)
    assert result["error_m"] == result["emitters"][0]["error_m"]
    assert len(sentences(result)) == 3


def test_the_one_to_look_for_first_is_marked_and_each_says_when_it_was_found() -> None:
    emitters = sought(CARRIER, 3, most_important=2)
    assert [emitter.priority for emitter in emitters] == [None, 1, None]
    with pytest.raises(ValueError, match="--first 4: there are 3 emitters"):
        sought(CARRIER, 3, most_important=4)
    home = Place(50.0, 7.0)
    begun = MissionStarted(craft_id=FIRST_CRAFT, by="demo", home=home, home_amsl_m=100.0, software="test")
    flown = log(begun, belief(3.0, 10.0, "emitter-2"), ended("not_localized"), emitters=emitters)
    flown.recorded[2] = flown.recorded[2].model_copy(update={"at_utc": datetime(2026, 1, 1, 0, 2, tzinfo=UTC)})
    graded = summary(flown, Settings(), {Signal(emitter.frequency_hz): TRUTH for emitter in emitters})["emitters"]
    assert [(one["priority"], one["found_s"]) for one in graded] == [(None, None), (1, 120.0), (None, None)]


@pytest.mark.parametrize("first", [CARRIER, TAG])
def test_every_emitter_sought_is_simulated_once(first: EmitterSpec) -> None:
    emitters = sought(first, 8)
    there = [emitter.frequency_hz for emitter in simulated(emitters)]
    assert len(set(there)) == len(there)
    assert {emitter.frequency_hz for emitter in emitters} <= set(there)


def test_a_pace_of_what_stands_still_is_refused() -> None:
    assert movement("animal", None).speed_m_s == 0.2
    assert movement("animal", 0.5).speed_m_s == 0.5
    with pytest.raises(ValueError, match="add --moves"):
        movement(None, 0.5)


def test_progress_tells_of_phases_and_estimates_and_little_else() -> None:
    changed = PhaseChanged(craft_id=FIRST_CRAFT, before="measuring", after="returning", reason=Localized())
    assert progress_line(changed) == "craft-1: returning: Localized: the expected error is within the goal."
    assert progress_line(belief(3.0, 10.0)) == "emitter-1: localized, expected error 4.0 m"
    assert progress_line(belief(3.0, 10.0).model_copy(update={"bearings": 0})) is None
    assert progress_line(SweepStarted(craft_id=FIRST_CRAFT, place_number=1, attempt=1)) is None
