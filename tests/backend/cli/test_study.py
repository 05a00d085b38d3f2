"""`crossfix study` at its edge: one JSON value on stdout, one clear line and exit code 2 for bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest
import typer
from narrowing import a
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


def test_a_scenario_that_is_not_there_is_refused_with_all_that_are():
    result = call("run", "--scenario", "9")
    assert result.exit_code == 2
    assert "there is no scenario '9': choose one of 1, 2, 3, field, field-world" in " ".join(result.stderr.split())


def test_several_cells_print_a_list_and_a_report_reads_them(tmp_path):
    common = ("--runs", "3", "--workers", "1", "--results", tmp_path / "results", "--json")
    result = call("run", "--planner", "base", "--planner", "vander_hook", "--config", "slow", *common)
    assert [cell["planner"] for cell in json.loads(result.stdout)] == ["base", "vander_hook"]
    figures, table = tmp_path / "figures", tmp_path / "table.md"
    result = call("report", tmp_path / "results", "--figures", figures, "--markdown", table, "--paths", "10", "--json")
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
        (("run", "--config", "quick"), "quick"),
        (("run", "--seed", "-1"), "seed"),
        (("run", "--workers", "0"), "--workers"),
        (("run", "--measurement-time", "nan"), "measurement time"),
        (("run", "--measurement-time", "inf"), "measurement time"),
        (("run", "--planner", "rollout", "--selection", "uniform", "--sampling", "sobol"), "sobol"),
        (("report", "nowhere"), "no study results"),
        (("report", ".", "--paths", "1"), "2 sample paths"),
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


@pytest.mark.parametrize("arguments", [("run", "--planner", "best"), ("run", "--budget", "0"), ("report", "nowhere")])
def test_bad_values_are_an_object_for_programs(tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    result = call(*arguments, "--json")
    assert result.exit_code == 2
    error = json.loads(result.stdout)["error"]
    assert result.stderr == f"crossfix: {error}\n"
    assert json.loads(result.stdout).keys() == {"error"}


def test_an_option_of_the_field_world_is_not_passed_over_elsewhere(tmp_path):
    result = call("run", "--turns", "sector", "--runs", "1", "--results", tmp_path)
    assert result.exit_code == 2
    assert "--turns is of the field world: add --scenario field-world" in result.stderr


@pytest.mark.slow
def test_a_dask_cluster_of_processes_flies_the_same_missions(tmp_path):
    from distributed import LocalCluster

    asked = ("run", "--planner", "base", "--runs", "6", "--json")
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0"
    ) as cluster:
        there = call(*asked, "--scheduler", a(LocalCluster, cluster).scheduler_address, "--results", tmp_path / "there")
    here = call(*asked, "--workers", "1", "--results", tmp_path / "here")
    assert there.exit_code == here.exit_code == 0
    assert json.loads(there.stdout) == json.loads(here.stdout)
    (one,), (other,) = ((tmp_path / where).glob("*.parquet") for where in ("there", "here"))
    pd.testing.assert_frame_equal(pd.read_parquet(one), pd.read_parquet(other))


@pytest.mark.parametrize("command", ["run", "report"])
def test_help_has_an_example(command):
    assert "Example: crossfix study" in " ".join(call(command, "--help").stdout.split())


def test_an_option_that_changes_nothing_is_named(tmp_path):
    few = ("run", "--runs", "2", "--workers", "1", "--budget", "100", "--results", str(tmp_path), "--json")
    said = call(*few, "--planner", "base").stderr
    assert "--budget is of --planner rollout and changes nothing here" in said
    assert "changes nothing" not in call(*few, "--planner", "base", "--planner", "rollout").stderr
