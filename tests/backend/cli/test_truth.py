"""`crossfix study truth` at its edge."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from backend.cli.study import app
from planner.study.truth import Truth

PROMISED = {"row", "missions", "claimed", "in_c95", "beyond_3x", "mean_s", "bearings_mean"}


def run(*arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["truth", *arguments])
    return result.exit_code, result.stdout, result.stderr


def test_a_row_is_one_json_object_with_what_was_promised() -> None:
    code, out, _ = run("--row", "right", "--missions", "2", "--json")
    found = json.loads(out)
    assert code == 0
    assert set(found) >= PROMISED
    assert (found["row"], found["missions"], found["claimed"]) == ("right", 2, 1.0)
    assert run("--row", "right", "--missions", "2", "--json")[1] == out


def test_for_people_it_is_a_sentence() -> None:
    code, out, _ = run("--row", "right", "--missions", "1", "--model", "independent")
    assert code == 0
    assert "independent errors: 1 missions" in out


def test_earlier_flights_are_learned_from() -> None:
    code, out, err = run("--row", "right", "--missions", "1", "--flights", "2", "--json")
    assert code == 0
    assert "learned from 2 flights" in err
    assert Truth(**json.loads(out)).claimed == 1.0


def test_a_search_that_is_told_the_true_errors_says_so() -> None:
    code, out, _ = run("--row", "right", "--missions", "1", "--told")
    assert code == 0
    assert "joint errors, the true errors known before: 1 missions" in out


def test_the_flown_planner_chooses_other_places_in_the_same_world() -> None:
    flown = json.loads(run("--row", "right", "--missions", "2", "--planner", "crossfix", "--json")[1])
    base = json.loads(run("--row", "right", "--missions", "2", "--json")[1])
    assert (flown["planner"], base["planner"]) == ("crossfix", "fisher")
    assert flown["claimed"] == base["claimed"] == 1.0
    assert flown["mean_s"] != base["mean_s"]
    assert "planned by crossfix" in run("--row", "right", "--missions", "1", "--planner", "crossfix")[1]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--row", "bias5", "--told", "--flights", "3"), "--told goes with the joint model"),
        (("--row", "bias5", "--told", "--model", "independent"), "--told goes with the joint model"),
        (("--row", "walls", "--told"), "the errors of walls"),
        (("--row", "bias6"), "there is no row 'bias6'"),
        (("--row", "tags_5"), "tags_4, "),
        (("--row", "tags_4", "--flights", "3"), "--flights goes with the joint model of one emitter"),
        (("--row", "moving_0.1", "--flights", "3"), "--flights goes with the joint model of one emitter"),
        (("--row", "bias5", "--model", "independent", "--flights", "3"), "--flights goes with the joint model"),
        (("--row", "bias5", "--missions", "0"), "--missions must be 1 or more"),
        (("--row", "bias5", "--model", "some"), "there is no model 'some'"),
        (("--row", "bias5", "--planner", "mine"), "there is no planner 'mine'"),
        (("--row", "tags_4", "--planner", "crossfix"), "not with tags_4"),
        (("--row", "bias5", "--shared-errors"), "--shared-errors goes with the joint model of several tags"),
        (("--row", "tags_4", "--model", "independent", "--shared-errors"), "--shared-errors goes with the joint model"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_line(arguments: tuple[str, ...], says: str) -> None:
    code, out, err = run(*arguments, "--json")
    assert code == 2
    assert says in err
    assert says in json.loads(out)["error"]
