"""Numbers as people, spreadsheets and typesetters write them; a unit that cannot be meant is no number."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from hardware.direction_finding.pattern_file import load_pattern
from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError, decoded, lines_of, read_table
from hardware.reasons.table import CellUnusable, ColumnsUnknown, FileUnusable, NothingUsable, Quantity

TURN = "heading_deg,power_db\n" + "\n".join(f"{heading},{-60 - heading / 20}" for heading in range(0, 360, 10))


@pytest.mark.parametrize(
    ("heading", "power"),
    [
        ("12.5°", "-70.5 dBm"),
        ("12.5 deg", "-70.5dB"),
        ("12.5 degrees", "-70.5 DBFS"),
        ("12.5\u00a0°", "\u221270.5"),
        ("12,5°", "\u201370,5 dBm"),
    ],
)
def test_degrees_and_decibels_may_stand_behind_their_numbers(tmp_path: Path, heading: str, power: str) -> None:
    path = tmp_path / "turn.csv"
    path.write_text(f"heading;power\n{heading};{power}\n", encoding="utf-8")
    (recorded,) = read_recording(path).sweeps
    assert (recorded.sweep.heading_deg.tolist(), recorded.sweep.power_db.tolist()) == ([12.5], [-70.5])


@pytest.mark.parametrize(
    ("row", "column", "cell", "quantity"),
    [
        ("-70 dBm,12°", 1, "-70 dBm", "heading"),
        ("12,-70°", 2, "-70°", "power"),
        ("12,3 mW", 2, "3 mW", "power"),
        ("12 m,-70", 1, "12 m", "heading"),
    ],
)
def test_a_unit_of_another_quantity_is_refused(
    tmp_path: Path, row: str, column: int, cell: str, quantity: Quantity
) -> None:
    path = tmp_path / "turn.csv"
    path.write_text(f"heading_deg,power_db\n{row}\n", encoding="utf-8")
    unusable = CellUnusable(str(path), 2, column, cell, quantity)
    with refusing(NothingUsable(str(path), "power", unusable), RecordingError):
        read_recording(path)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_spreadsheets_save_unicode_in_several_ways(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "turn.csv"
    path.write_bytes(TURN.encode(encoding))
    (recorded,) = read_recording(path).sweeps
    assert recorded.sweep.power_db.size == 36
    assert load_pattern(path).gain_db.size == 36


@pytest.mark.parametrize(
    ("raw", "text"),
    [
        ("Richtung;Pegel in dBµV;Füchse;Häher\n".encode() + b"10;-60;F\xfcchsin, \xff\n", "Pegel in dBµV;Füchse"),
        ("10°;-60;Füchse\n".encode("latin-1"), "10°;-60;Füchse"),
        ("10°;-60;Ã\n".encode("latin-1"), "10°;-60;Ã"),
        ("\ufeffheading;note\n".encode() + b"10;F\xfcchsin\n", "heading;note\n10;Füchsin"),
    ],
)
def test_a_few_bytes_of_another_encoding_leave_the_others_as_they_are(raw: bytes, text: str) -> None:
    assert text in decoded(raw)
    assert "Füchs" in decoded(raw) or "Ã" in text
    assert not {"\ufffd", "\ufeff", "ï"}.intersection(decoded(raw))


def test_zeros_are_no_text_in_any_encoding(tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_bytes(TURN.encode("utf-16-le"))
    with refusing(FileUnusable(str(path), "not_text"), RecordingError):
        read_table(path)


def test_an_empty_cell_before_a_tab_keeps_its_column(tmp_path: Path) -> None:
    path = tmp_path / "turn.tsv"
    path.write_text("time\theading_deg\tpower_db\n\t10\t-60\n1\t20\t-61\n")
    assert read_recording(path).sweeps[0].sweep.heading_deg.tolist() == [10.0, 20.0]


def test_numbers_between_blanks_are_columns_with_or_without_a_header(tmp_path: Path) -> None:
    path = tmp_path / "turn.txt"
    for header in ("", "heading_deg power_db\n", "# heading_deg power_db\n", "#\n", '""\n'):
        path.write_text(header + "  10.5   -6.0e+01\n  20.5   -6.1e+01\n")
        (recorded,) = read_recording(path).sweeps
        assert (recorded.sweep.heading_deg.tolist(), recorded.sweep.power_db.tolist()) == ([10.5, 20.5], [-60.0, -61.0])


def test_commas_in_notes_separate_nothing_between_semicolons(tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_text("heading_deg;power_db;note\n10,5;-60,5;tree, left\n")
    assert read_recording(path).sweeps[0].sweep.heading_deg.tolist() == [10.5]


def test_lines_end_where_editors_end_them_and_names_carry_no_controls(tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_bytes("heading_deg,power_db,tag\r\n10,-60,\x1b]0;A\x85B,20,-61\r12,-62,A\n".encode("latin-1"))
    assert [row.line for row in read_table(path).rows] == [1, 2, 3]
    assert read_table(path).rows[1].cells[2] == "]0;A\x85B"


def test_a_header_of_more_words_than_columns_is_no_header_between_blanks(tmp_path: Path) -> None:
    path = tmp_path / "turn.txt"
    path.write_text("# heading (deg) power (dB) other (dB)\n10 -60 -65\n200 -62 -64\n")
    with refusing(ColumnsUnknown(str(path), 2, 3, ("heading_deg", "power_db")), RecordingError):
        read_recording(path)


@pytest.mark.parametrize("row", ["10,40\t", "\t10,40", "10\t40\t"])
def test_tabs_around_a_row_are_no_columns(tmp_path: Path, row: str) -> None:
    path = tmp_path / "turn.csv"
    path.write_text(f"{row}\n")
    assert [cell for cell in read_table(path).rows[0].cells if cell] == ["10", "40"]


@pytest.mark.parametrize(
    "time", ["2024-05-01 12:00:07,123", "01.05.2024 12:00:07,5", "12:00:07,25", "2024-05-01T12:00:07,1Z"]
)
def test_a_time_may_have_a_decimal_comma_between_semicolons(time: str, tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_text(f"Zeit;Richtung;Pegel\n{time};12,5;-70,5\n")
    (recorded,) = read_recording(path).sweeps
    assert (recorded.sweep.heading_deg.tolist(), recorded.sweep.power_db.tolist()) == ([12.5], [-70.5])


@given(st.text(alphabet="\r\na ,\x85\u2028", max_size=12))
def test_lines_have_the_numbers_that_an_editor_shows(text: str) -> None:
    shown = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    assert [*lines_of(text)] == [(number, line) for number, line in enumerate(shown, start=1) if line]
