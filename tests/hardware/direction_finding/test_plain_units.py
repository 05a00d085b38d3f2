"""Radians, linear power and values that stand for "nothing" are reported, never taken for degrees and decibels."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from refusals import refusing

from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError
from hardware.reasons.table import CellUnusable, DecibelsAssumed, HeadingsInRadians, PowerLinear

LEVELS = [-80.0 + 1.5 * abs(k - 18) for k in range(37)]
HEADINGS = [10.0 * k for k in range(37)]


def file_of(folder: Path, header: str, headings: list[float], powers: list[float]) -> Path:
    path = folder / "turn.csv"
    path.write_text("\n".join([header, *(f"{h!r},{p!r}" for h, p in zip(headings, powers, strict=True))]))
    return path


@pytest.mark.parametrize("from_deg", [0.0, -180.0])
def test_headings_within_one_turn_in_radians_are_refused(tmp_path: Path, from_deg: float) -> None:
    radians = [round(math.radians(heading + from_deg), 4) for heading in HEADINGS]
    path = file_of(tmp_path, "heading,power_db", radians, LEVELS)
    with refusing(HeadingsInRadians(str(path), 1, radians[0], radians[-1]), RecordingError):
        read_recording(path)


def test_headings_that_are_named_radians_are_refused_as_far_as_they_go(tmp_path: Path) -> None:
    path = file_of(tmp_path, "Heading (rad),power_db", [0.5, 1.5], [-60.0, -70.0])
    with refusing(HeadingsInRadians(str(path), 1, 0.5, 1.5), RecordingError):
        read_recording(path)


def test_a_few_headings_near_north_are_degrees(tmp_path: Path) -> None:
    path = file_of(tmp_path, "heading,power_db", [-3.0, 0.0, 3.0], [-60.0, -61.0, -60.0])
    assert read_recording(path).sweeps[0].sweep.heading_deg.tolist() == [357.0, 0.0, 3.0]


@pytest.mark.parametrize("header", ["power_mw", "Power (mW)", "mW", "rssi_lin", "Leistung [µW]"])
def test_power_that_is_named_linear_is_refused(tmp_path: Path, header: str) -> None:
    path = file_of(tmp_path, f"heading_deg,{header}", [0.0, 10.0], [3.0, 4.0])
    with refusing(PowerLinear(str(path), 2, "name", 3.0, 4.0), RecordingError):
        read_recording(path)


def test_decibels_beside_linear_power_are_used(tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_text("heading_deg,power_mw,power_dbm\n0,0.001,-30\n10,0.002,-27\n")
    assert read_recording(path).sweeps[0].sweep.power_db.tolist() == [-30.0, -27.0]


@pytest.mark.parametrize(
    ("name", "powers"),
    [
        ("power", [float(f"{10 ** (level / 10):.3e}") for level in LEVELS]),
        ("rssi", [round(0.5 * 10 ** (k / 9), 3) for k in range(37)]),
        ("power_dbm", [float(f"{10 ** (level / 10):.3e}") for level in LEVELS]),
        ("power_db", [round(0.5 * 10 ** (k / 9), 3) for k in range(37)]),
    ],
)
def test_power_whose_values_are_linear_is_refused(tmp_path: Path, name: str, powers: list[float]) -> None:
    path = file_of(tmp_path, f"heading_deg,{name}", HEADINGS, powers)
    with refusing(PowerLinear(str(path), 2, "values", min(powers), max(powers)), RecordingError):
        read_recording(path)


@pytest.mark.parametrize("header", ["heading_deg,power", "heading_deg,rssi"])
def test_power_without_unit_or_negative_values_is_remarked(tmp_path: Path, header: str) -> None:
    path = file_of(tmp_path, header, HEADINGS, [level + 90.0 for level in LEVELS])
    recording = read_recording(path)
    assert recording.remarks == (DecibelsAssumed(str(path), 2, 10.0, 37.0),)
    assert recording.sweeps[0].sweep.power_db.tolist() == [level + 90.0 for level in LEVELS]


@pytest.mark.parametrize("name", ["power", "power_db", "snr_db"])
def test_what_can_only_be_decibels_is_not_remarked(tmp_path: Path, name: str) -> None:
    powers = LEVELS if name == "power" else [round(0.01 + k, 2) for k in range(37)]
    recording = read_recording(file_of(tmp_path, f"heading_deg,{name}", HEADINGS, powers))
    assert recording.remarks == ()


@pytest.mark.parametrize("nothing", [-200.0, -999.0])
def test_a_power_that_no_receiver_hears_is_left_out_as_one_that_is_no_number(tmp_path: Path, nothing: float) -> None:
    path = file_of(tmp_path, "heading_deg,power_db", HEADINGS, [*LEVELS[:36], nothing])
    recording = read_recording(path)
    assert recording.remarks == (CellUnusable(str(path), 38, 2, str(nothing), "power"),)
    assert recording.sweeps[0].sweep.power_db.min() > -100.0
