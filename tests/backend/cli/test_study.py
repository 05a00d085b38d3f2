"""`crossfix study` at its edge: one JSON value on stdout, one clear line and exit code 2 for bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from backend.cli.study import app

APP = typer.Typer()
APP.add_typer(app)


def call(*arguments: str | Path):
    return CliRunner().invoke(APP, ["study", *map(str, arguments)])


def test_one_cell_prints_one_object(tmp_path):
    result = call("run", "--planner", "base", "--runs", "5", "--workers", "1", "--results", tmp_path, "--json")
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert answer["runs"] == 5
    assert answer["thesis_mean_s"] == 74.31
    assert answer["mean_s"] > 0
    assert answer["ci95_s"] > 0
    assert 1 <= answer["bearings_mean"] <= 10
    assert "base" in result.stderr


def test_several_cells_print_a_list_and_a_report_reads_them(tmp_path):
    common = ("--runs", "3", "--workers", "1", "--results", tmp_path / "results", "--json")
    result = call("run", "--planner", "base", "--planner", "vander_hook", "--config", "slow", *common)
    assert [cell["planner"] for cell in json.loads(result.stdout)] == ["base", "vander_hook"]
    figures, table = tmp_path / "figures", tmp_path / "table.md"
    result = call("report", tmp_path / "results", "--figures", figures, "--markdown", table, "--paths", 10, "--json")
    answer = json.loads(result.stdout)
    assert len(answer["cells"]) == 2
    assert {Path(name) for name in answer["figures"]} == set(figures.glob("*.png"))
    assert table.read_text().count("\n") == 4
    assert "note: no time_by_target.png" in result.stderr


def test_without_json_a_table_stands_on_stdout(tmp_path):
    result = call("run", "--planner", "base", "--runs", "3", "--workers", "1", "--results", tmp_path)
    assert "74.31" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("run", "--planner", "best"), "best"),
        (("run", "--scenario", "7"), "7"),
        (("run", "--actions", "20"), "20x20"),
        (("run", "--budget", "0"), "budget"),
        (("run", "--runs", "0"), "--runs"),
        (("run", "--planner", "rollout", "--selection", "bfgs", "--budget", "8", "--runs", "1"), "40 rollouts"),
        (("report", "nowhere"), "no study results"),
    ],
)
def test_bad_values_end_with_one_clear_line(tmp_path, monkeypatch, arguments, word):
    monkeypatch.chdir(tmp_path)
    result = call(*arguments)
    assert result.exit_code == 2
    lines = [line for line in result.stderr.splitlines() if line.startswith("crossfix: ")]
    assert len(lines) == 1
    assert word in lines[0]
    assert result.stdout == ""
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("command", ["run", "report"])
def test_help_has_an_example(command):
    assert "Example: crossfix study" in " ".join(call(command, "--help").stdout.split())
