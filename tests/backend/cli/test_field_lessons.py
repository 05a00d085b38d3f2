"""Flights of the field world teach the next ones what bearings are worth."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from backend.cli.field_lessons import taught
from backend.cli.field_missions import FieldOptions, FieldStudy
from backend.cli.main import app
from planner.study.errors import StudyError


@pytest.mark.long
def test_flights_with_a_right_compass_teach_that_it_is_right_and_change_what_is_flown() -> None:
    study = FieldStudy.of(FieldOptions(compass_deg=0.0))
    after = taught(study, 5)
    before, now = study.spec.sensor.learned, after.spec.sensor.learned
    assert before is not None
    assert now is not None
    assert (before.flights, now.flights) == (0, 5)
    assert now.spread_weight[0] > before.spread_weight[0]
    assert now.spread_weight[-1] < before.spread_weight[-1]
    assert after.fly(5) != study.fly(5)
    assert taught(study, 0).fly(5) == study.fly(5)


def test_bearings_that_are_taken_to_be_independent_teach_nothing() -> None:
    with pytest.raises(StudyError, match="teach"):
        taught(FieldStudy.of(FieldOptions(errors="independent")), 1)


def test_the_command_flies_after_flights_and_says_so() -> None:
    asked = ["study", "run", "--scenario", "field-world", "--planner", "fisher", "--runs", "1", "--flights", "2"]
    said = CliRunner().invoke(app, [*asked, "--workers", "1", "--json"])
    assert json.loads(said.stdout)["flights"] == 2
