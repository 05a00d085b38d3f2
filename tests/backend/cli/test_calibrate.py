"""`crossfix calibrate` at its edge: a pattern file that `crossfix sweep` can use, the check, errors in one line."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from backend.cli.calibrate import calibrate
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.readings import Place

APP = typer.Typer()
APP.command()(calibrate)
EMITTER = Place(50.6, 7.2)


def flight(tmp_path: Path, offset_deg: float = 0.0) -> list[str]:
    files = []
    for k, bearing in enumerate((0.0, 120.0, 240.0)):
        angle = math.radians(bearing + 180.0)
        place = LocalFrame(EMITTER).to_geo(150.0 * math.sin(angle), 150.0 * math.cos(angle))
        heading = np.arange(0.0, 360.0, 3.0)
        power = -50.0 - 5.0 * k + load_pattern(SMALL_YAGI).gain_at(bearing - heading - offset_deg)
        rows = [f"{place.lat},{place.lon},{h},{p}" for h, p in zip(heading, power, strict=True)]
        path = tmp_path / f"sweep{k}.csv"
        path.write_text("lat,lon,heading_deg,power_db\n" + "\n".join(rows))
        files.append(str(path))
    return files


def test_measured_pattern_is_written_and_passes_its_own_check(tmp_path: Path) -> None:
    out = tmp_path / "mine.json"
    arguments = [*flight(tmp_path, 25.0), "--emitter", "50.6,7.2"]
    answer = json.loads(CliRunner().invoke(APP, [*arguments, "--out", str(out), "--json"]).stdout)
    assert answer["sweeps"] == 3
    assert answer["offset_to_nose_deg"] == pytest.approx(25.0, abs=6.0)
    assert load_pattern(out).offset_to_nose_deg == pytest.approx(answer["offset_to_nose_deg"], abs=0.01)
    check = CliRunner().invoke(APP, [*arguments, "--check", str(out), "--json"])
    assert json.loads(check.stdout)["ok"] is True
    assert check.exit_code == 0


def test_check_against_the_wrong_pattern_fails_with_exit_code_1(tmp_path: Path) -> None:
    arguments = [*flight(tmp_path, 25.0), "--emitter", "50.6,7.2", "--check", str(SMALL_YAGI)]
    result = CliRunner().invoke(APP, arguments)
    assert result.exit_code == 1
    assert "offset to 25" in result.stdout or "offset to 24" in result.stdout


@pytest.mark.parametrize("emitter", ["somewhere", "50.601347,7.2"])
def test_bad_input_is_one_line_and_exit_code_2(tmp_path: Path, emitter: str) -> None:
    (tmp_path / "near.csv").write_text("lat,lon,heading_deg,power_db\n50.601347,7.2,0,-50\n")
    result = CliRunner().invoke(APP, [str(tmp_path / "near.csv"), "--emitter", emitter, "--json"])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1
