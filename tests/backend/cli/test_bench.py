"""`crossfix bench`: the shape of its answer, what each figure is of; how fast it is stands in docs/measurements.md."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from backend.cli import bench
from backend.cli.main import app


def call(*arguments: str):
    return CliRunner().invoke(app, ["bench", *arguments])


def test_prints_one_json_object_of_positive_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "BUDGETS", (400, 1000))
    monkeypatch.setattr(bench, "ROLLOUTS", {"reference": 4, "compiled": 200})
    result = call("--repeats", "1", "--json")
    assert result.exit_code == 0
    told = json.loads(result.stdout)
    assert told.keys() == {"rollout_us", "ratio", "plan_ms", "repeats"}
    assert told["rollout_us"].keys() == {"reference", "compiled_1_thread", "compiled_2_threads"}
    assert all(value > 0 for value in (*told["rollout_us"].values(), *told["plan_ms"].values()))
    assert told["ratio"] == pytest.approx(told["rollout_us"]["reference"] / told["rollout_us"]["compiled_1_thread"])
    assert list(told["plan_ms"]) == ["400", "1000"]


@pytest.fixture
def second_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever is timed takes one second."""
    monkeypatch.setattr(bench, "_median_s", lambda work, repeats: 1.0)


@pytest.mark.usefixtures("second_each")
def test_a_rollout_is_a_run_divided_by_its_rollouts_and_a_plan_is_whole() -> None:
    told = json.loads(call("--json").stdout)
    assert told["rollout_us"]["reference"] == pytest.approx(1e6 / bench.ROLLOUTS["reference"])
    assert told["rollout_us"]["compiled_2_threads"] == pytest.approx(1e6 / bench.ROLLOUTS["compiled"])
    assert told["plan_ms"] == {str(n): 1000.0 for n in (400, 1000, 1600, 3600, 6400, 12800, 25600)}


@pytest.mark.usefixtures("second_each")
def test_without_json_there_is_a_line_for_each_figure() -> None:
    lines = call().stdout.splitlines()
    assert len(lines) == 3 + 1 + len(bench.BUDGETS)
    assert lines[-1] == "one plan, 25600 rollouts: 1000.0 ms"


def test_times_the_median_run_after_one_that_warms_up(monkeypatch: pytest.MonkeyPatch) -> None:
    now, durations = 0.0, iter([100.0, 3.0, 1.0, 2.0])

    def work() -> None:
        nonlocal now
        now += next(durations)

    monkeypatch.setattr(bench, "time", SimpleNamespace(perf_counter=lambda: now))
    assert bench._median_s(work, 3) == 2.0


@pytest.mark.parametrize("arguments", [("--repeats", "0"), ("--repeats", "many"), ("--budget", "5")])
def test_refuses_what_it_cannot_do(arguments: tuple[str, ...]) -> None:
    result = call(*arguments, "--json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert arguments[0] in result.stderr
    assert "Traceback" not in result.stderr
