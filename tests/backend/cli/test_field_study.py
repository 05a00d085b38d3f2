"""Whole searches in the field world, by the command that flies them."""

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from backend.cli.field_missions import FieldMission, FieldOptions, FieldStudy, summary
from backend.cli.main import app


def run(*arguments):
    return CliRunner().invoke(app, ["study", "run", "--scenario", "field-world", *arguments])


FLOWN = FieldMission(
    seed=1,
    localized=True,
    time_s=100.0,
    in_c95=True,
    error_m=5.0,
    stated_m=8.0,
    bearings=4,
    rejected=0,
    turned_deg=1440.0,
    off_deg=(1.0, -2.0),
)


def test_a_mission_is_its_seed():
    study = FieldStudy.of(FieldOptions("fisher"), 4.0)
    first, again, other = study.fly(5), study.fly(5), study.fly(6)
    assert first == again
    assert first.time_s != other.time_s
    assert first.turned_deg == 360.0 * (first.bearings + first.rejected)


def test_a_row_counts_claims_and_bearings_from_afar():
    missions = [
        FLOWN,
        replace(FLOWN, error_m=30.0, in_c95=False, off_deg=(45.0, 3.0)),
        replace(FLOWN, localized=False, in_c95=False, error_m=90.0, time_s=400.0),
    ]
    row = summary(FieldOptions(), missions)
    assert (row.localized, row.in_c95, row.false_claims) == pytest.approx((2 / 3, 0.5, 0.5))
    assert (row.outliers, row.bearings_far) == (1, 6)
    assert row.time_s == pytest.approx(200.0)
    assert row.energy_kj == pytest.approx(50.0)


def test_a_row_without_a_claim_says_nothing_of_claims():
    facts = summary(FieldOptions(), [replace(FLOWN, localized=False)]).as_json()
    assert facts["in_c95"] is None
    assert facts["false_claims"] is None
    assert facts["planner"] == "crossfix"


def test_the_command_flies_a_row_a_planner():
    found = run("--planner", "fisher", "--planner", "random_walk", "--runs", "1", "--seed", "5", "--json")
    assert found.exit_code == 0, found.output
    rows = json.loads(found.stdout)
    assert [row["planner"] for row in rows] == ["fisher", "random_walk"]
    assert all(row["missions"] == 1 and row["time_s"] > 0 for row in rows)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--planner", "sopt"), "choose one of"),
        (("--scenario", "2"), "by itself"),
        (("--seed", "1", "--seed", "2"), "by itself"),
        (("--runs", "0"), "--runs"),
        (("--turn-rate", "1"), "--turn-rate"),
        (("--compass-sd", "-1"), "--compass-sd"),
    ],
)
def test_what_cannot_be_flown_is_refused_in_words(arguments, told):
    found = run(*arguments)
    assert found.exit_code != 0
    assert told in found.output
    assert "Traceback" not in found.output
