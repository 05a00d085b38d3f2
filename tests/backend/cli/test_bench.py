from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from backend.cli import bench
from backend.cli.main import app


def test_bench_prints_one_json_object_with_every_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "BUDGETS", (400, 1000))
    monkeypatch.setattr(bench, "ROLLOUTS", {"reference": 4, "compiled": 200})
    result = CliRunner().invoke(app, ["bench", "--repeats", "1", "--json"])
    assert result.exit_code == 0
    told = json.loads(result.stdout)
    assert set(told["rollout_us"]) == {"reference", "compiled_1_thread", "compiled_2_threads"}
    assert all(value > 0 for value in told["rollout_us"].values())
    assert told["ratio"] == pytest.approx(told["rollout_us"]["reference"] / told["rollout_us"]["compiled_1_thread"])
    assert list(told["plan_ms"]) == ["400", "1000"]
