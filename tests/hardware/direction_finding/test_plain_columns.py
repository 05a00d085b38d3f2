"""Which column of a plain table holds what; what cannot be told apart is refused, and numbers are never cut in two."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from refusals import refusing

from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError
from hardware.readings import Place
from hardware.reasons.table import ColumnsAlike, ColumnsUnknown, FrequenciesUnread, RowLeftOut, TooManyCells

ROWS = [(float(heading) + 0.25, -60.5 - heading / 20) for heading in range(0, 360, 10)]
EXPECTED = ("heading_deg", "power_db")


def file_of(folder: Path, *lines: str) -> Path:
    path = folder / "turn.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "header",
    [
        "Heading (deg),Power (dBm)",
        "yaw [deg],RSSI [dBm]",
        "Heading [°],Signal strength (dB)",
        "azimuth/degrees,power_dBFS",
        "bearing_deg,rssi",
        "heading,signal_strength_dbm",
        "Richtung,Pegel",
        "Kurs (°),Leistung [dBm]",
    ],
)
def test_names_are_read_with_their_unit_in_any_brackets(tmp_path: Path, header: str) -> None:
    german = header.replace(",", ";"), *(f"{heading};{power}".replace(".", ",") for heading, power in ROWS)
    english = header, *(f"{heading},{power}" for heading, power in ROWS)
    for lines in (german, english):
        recording = read_recording(file_of(tmp_path, *lines))
        (recorded,) = recording.sweeps
        assert recorded.sweep.heading_deg.tolist() == [heading for heading, _ in ROWS]
        assert recorded.sweep.power_db.tolist() == [power for _, power in ROWS]
        assert recording.remarks == ()


@pytest.mark.parametrize(
    "above",
    [
        ["sep=,", "heading_deg,power_db"],
        ["Turn at the bridge", "Receiver 3, 2026, gain 20 dB", "", "heading_deg,power_db"],
        ["% heading_deg, power_db"],
        ["# heading, as the compass has it", "heading_deg,power_db"],
        ["# heading, as the compass has it", "# heading_deg,power_db"],
    ],
)
def test_a_header_is_found_below_titles_and_remarks(tmp_path: Path, above: list[str]) -> None:
    path = file_of(tmp_path, *above, *(f"{heading},{power}" for heading, power in ROWS))
    recording = read_recording(path)
    assert recording.sweeps[0].sweep.heading_deg.tolist() == [heading for heading, _ in ROWS]
    assert recording.remarks == ()


def test_places_of_a_sweep_are_on_the_hemisphere_that_is_written(tmp_path: Path) -> None:
    lines = [f"{heading},{power},33.9,S,18.4,E" for heading, power in ROWS]
    (recorded,) = read_recording(file_of(tmp_path, "heading_deg,power_db,lat,N/S,lon,E/W", *lines)).sweeps
    assert (recorded.place_known, recorded.sweep.position) == (True, Place(-33.9, 18.4))
    (unknown,) = read_recording(file_of(tmp_path, "heading,rssi,lat,lon", *(f"{h},{p},0,0" for h, p in ROWS))).sweeps
    assert not unknown.place_known


def test_a_table_with_a_heading_and_a_bearing_is_turned_by_the_heading(tmp_path: Path) -> None:
    path = file_of(tmp_path, "bearing_deg,heading_deg,power_db", *(f"12,{heading},{power}" for heading, power in ROWS))
    assert read_recording(path).sweeps[0].sweep.heading_deg.tolist() == [heading for heading, _ in ROWS]


def test_rows_with_more_numbers_than_columns_are_left_out_with_their_line(tmp_path: Path) -> None:
    lines = [f"{heading},{power}" for heading, power in ROWS]
    path = file_of(tmp_path, "heading_deg,power_db", *lines[:3], "12,50,-73,20", *lines[3:], "30,-60,hill", "40,-60,,")
    recording = read_recording(path)
    assert recording.remarks == (RowLeftOut(str(path), 5, "wide"),)
    assert recording.sweeps[0].sweep.power_db.size == len(ROWS) + 2
    path = file_of(tmp_path, *lines, "12,50,-73,20")
    assert read_recording(path).remarks == (RowLeftOut(str(path), len(ROWS) + 1, "wide"),)


@pytest.mark.parametrize(
    ("lines", "line", "cells"),
    [
        (["heading_deg,power_db", "12,50,-73,20", "13,-73,25"], 2, 4),
        (["12,50,-73,20", "13,-73,25"], 1, 4),
        (["12,-73,20", "13,-73,25"], 1, 3),
    ],
)
def test_decimal_commas_between_commas_are_refused_with_the_remedy(
    tmp_path: Path, lines: list[str], line: int, cells: int
) -> None:
    path = file_of(tmp_path, *lines)
    with refusing(TooManyCells(str(path), line, cells, 2), RecordingError):
        read_recording(path)


@pytest.mark.parametrize(
    "row",
    [
        lambda k, heading, power: f"{k}.5,{heading},{power}",
        lambda k, heading, power: f"{1_780_000_000 + k},{heading - 180.0},{power}",
        lambda k, heading, power: f"{heading},{k},{power}",
        lambda k, heading, power: f"{heading},{power + 90},50.6,7.2",
        lambda k, heading, power: f"{heading},{power},{power - 3}",
    ],
)
def test_three_unnamed_columns_ask_for_a_header(tmp_path: Path, row: Callable[[int, float, float], str]) -> None:
    path = file_of(tmp_path, *(row(k, *pair) for k, pair in enumerate(ROWS)))
    columns = len(path.read_text().splitlines()[0].split(","))
    with refusing(ColumnsUnknown(str(path), 1, columns, EXPECTED), RecordingError):
        read_recording(path)


def test_headings_of_a_turn_before_power_below_zero_need_no_header(tmp_path: Path) -> None:
    path = file_of(tmp_path, *(f"{heading},{power},-33.61,18.25" for heading, power in ROWS))
    (recorded,) = read_recording(path).sweeps
    assert recorded.sweep.heading_deg.tolist() == [heading for heading, _ in ROWS]


@pytest.mark.parametrize(("one", "other"), [("power_db", "power_db"), ("snr", "snr.")])
def test_two_columns_of_one_name_are_both_named(tmp_path: Path, one: str, other: str) -> None:
    path = file_of(tmp_path, f"heading_deg,{one},{other}", "10,-60,-70")
    with refusing(ColumnsAlike(str(path), 1, 2, one, 3, other), RecordingError):
        read_recording(path)


@pytest.mark.parametrize("first", [7, 10, 11])
def test_a_first_column_like_commands_under_a_header_is_none(tmp_path: Path, first: int) -> None:
    lines = (f"{first},7.2,{heading},{power}" for heading, power in ROWS)
    path = file_of(tmp_path, "lat,lon,heading_deg,power_db", *lines)
    assert read_recording(path).sweeps[0].sweep.position.lat == first


@pytest.mark.parametrize(
    ("name", "cell"),
    [
        ("Frequenz (MHz)", "150,1"),
        ("Frequency..MHz.", "150.1"),
        ("Fréquence (MHz)", "150.1"),
        ("Center Frequency (Hz)", "150100000"),
        ("core:frequency", "150100000"),
        ("freq_GHz", "0.1501"),
    ],
)
def test_a_frequency_is_read_by_the_names_that_others_give_it(name: str, cell: str, tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    rows = "".join(f"{heading};{-70 + heading % 7};{cell}\n" for heading in range(0, 360, 20))
    path.write_text(f"Heading..deg.;Pegel (dBµV);{name}\n{rows}")
    (recorded,) = read_recording(path).sweeps
    assert recorded.sweep.frequency_hz == pytest.approx(150.1e6)
    assert len(recorded.sweep.heading_deg) == 18


def test_frequencies_of_which_none_can_be_read_are_remarked(tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_text(
        "heading_deg,power_db,frequency\n" + "".join(f"{k},{-70 + k % 7},150.100 VHF\n" for k in range(0, 360, 20))
    )
    assert FrequenciesUnread(str(path), 2, 3, "150.100 VHF") in read_recording(path).remarks
