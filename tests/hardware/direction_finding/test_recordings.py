"""Recorded sweeps: UAV-RT rotation files in their layouts, plain tables, and every row not understood named."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refusing

from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError
from hardware.reasons.table import (
    CellUnusable,
    OtherTagsLeftOut,
    PulsesOutsideRotations,
    Quantity,
    RotationIrregular,
    RowLeftOut,
    TagNotHeard,
)

LAT, LON, AMSL = 35.177966, -111.65683, 2124.4
HEADER_21 = (
    "# 7, tag_id, frequency_hz, start_time_seconds, predict_next_start_seconds, snr, stft_score, group_seq_counter, "
    "group_ind, group_snr, noise_psd, detection_status, confirmed_status, position_x, _y, _z, orientation_x, _y, _z, "
    "_w, antenna_offset"
)


def pulse(
    yaw_deg: float,
    signal_db: float,
    psd: float = 1e-9,
    tag: int | str = 4,
    columns: int = 21,
    frequency: int = 148_520_230,
    offset: float = 0.0,
    offset_column: int = 20,
) -> str:
    """A pulse row whose received power (SNR + PSD) is `signal_db` whatever the PSD."""
    snr = signal_db - 10.0 * math.log10(psd)
    front = ["7", str(tag), str(frequency), "1.5", "3.0", f"{snr:.6f}", "10", "1", "1", "50"]
    status = ["1", "1", f"{LAT}", f"{LON}", "8.2"]
    if columns == 19:
        half = math.radians(yaw_deg) / 2.0
        return ",".join([*front, *status, "0", "0", f"{math.sin(half):.6f}", f"{math.cos(half):.6f}"])
    cells = [*front, f"{psd:.4e}", *status, "0.5", "-1.0", f"{(yaw_deg + 180) % 360 - 180:.3f}", "0"]
    if columns == 21:
        cells.append("0")
        cells[offset_column - 1] = f"{offset}"
    return ",".join(cells)


def rotation(columns: int = 21, **more: Any) -> list[str]:
    yaws = np.arange(0.0, 360.0, 15.0)
    rows = [
        pulse(yaw, -40.0 - 10.0 * (1 - math.cos(math.radians(yaw - 200.0))), columns=columns, **more) for yaw in yaws
    ]
    return [f"10,{LAT},{LON},{AMSL}", *rows, f"11,{LAT},{LON},{AMSL}"]


def write(tmp_path: Path, lines: list[str], newline: str = "\n", bom: bool = False) -> Path:
    path = tmp_path / "rotation.csv"
    path.write_bytes((b"\xef\xbb\xbf" if bom else b"") + newline.join(lines).encode())
    return path


@pytest.mark.parametrize("columns", [19, 20, 21])
@pytest.mark.parametrize("header", [[], ["#EXAMPLE OF HEADER COMMENTS,,,"], [HEADER_21], [HEADER_21.lstrip("# ")]])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_every_layout_gives_the_same_sweep(tmp_path: Path, columns: int, header: list[str], newline: str) -> None:
    if columns == 19 and header and "tag_id" in header[0]:
        header = [header[0].replace(" noise_psd,", "").replace(", antenna_offset", "")]
    recording = read_recording(write(tmp_path, header + rotation(columns), newline, bom=columns == 20))
    assert recording.remarks == ()
    (recorded,) = recording.sweeps
    assert recorded.sweep.tag == "4"
    assert recorded.place_known
    assert (recorded.sweep.position.lat, recorded.sweep.position.lon) == (LAT, LON)
    assert recorded.sweep.altitude_amsl_m == pytest.approx(AMSL)
    assert recorded.sweep.frequency_hz == 148_520_230
    assert recorded.sweep.heading_deg == pytest.approx(np.arange(0.0, 360.0, 15.0), abs=0.01)


def test_power_is_snr_times_noise_so_that_a_leaking_pulse_counts_fully(tmp_path: Path) -> None:
    lines = [pulse(10.0, -30.0, psd=1e-9), pulse(10.0, -30.0, psd=2e-6)]
    (recorded,) = read_recording(write(tmp_path, lines)).sweeps
    assert recorded.sweep.power_db == pytest.approx([-30.0, -30.0])


@pytest.mark.parametrize("column", [20, 21])
def test_antenna_offset_is_read_from_either_of_the_last_columns(tmp_path: Path, column: int) -> None:
    lines = [pulse(10.0, -30.0, offset=35.0, offset_column=column)] * 3
    assert read_recording(write(tmp_path, lines)).sweeps[0].antenna_offset_deg == 35.0


def test_header_names_decide_which_column_is_the_offset(tmp_path: Path) -> None:
    lines = [HEADER_21, pulse(10.0, -30.0, offset=35.0, offset_column=20)]
    assert read_recording(write(tmp_path, lines)).sweeps[0].antenna_offset_deg == 0.0


def test_a_table_of_headings_through_7_10_and_11_degrees_is_no_rotation_file(tmp_path: Path) -> None:
    rows = [f"{heading},{-60 - heading / 10},{heading / 30},50.6,7.2" for heading in range(0, 360, 1)]
    (recorded,) = read_recording(write(tmp_path, ["heading_deg,power_db,time_s,lat,lon", *rows])).sweeps
    assert len(recorded.sweep.heading_deg) == 360


def test_several_rotations_and_tags_give_one_sweep_each_of_the_commonest_tag(tmp_path: Path) -> None:
    first = rotation()
    first.insert(3, pulse(44.0, -60.0, tag=2))
    path = write(tmp_path, first + rotation(tag=9) + [pulse(1.0, -30.0)])
    recording = read_recording(path)
    assert [recorded.sweep.tag for recorded in recording.sweeps] == ["4", "9"]
    assert recording.remarks == (
        PulsesOutsideRotations(str(path), 1),
        OtherTagsLeftOut(str(path), 1, "4", 1, ("2",)),
    )
    assert [recorded.sweep.tag for recorded in read_recording(path, tag="2").sweeps] == ["2"]
    with refusing(TagNotHeard(str(path), 1, "77", ("2", "4")), RecordingError):
        read_recording(path, tag="77")


def test_a_tag_of_another_rotation_is_not_looked_for_by_another_spelling(tmp_path: Path) -> None:
    path = write(tmp_path, rotation(tag="1.1") + rotation(tag="1.10"))
    assert [recorded.sweep.tag for recorded in read_recording(path, tag="1.10").sweeps] == ["1.10"]
    assert [recorded.sweep.tag for recorded in read_recording(path, tag="1.1").sweeps] == ["1.1"]
    alone = write(tmp_path, rotation(tag="1.1"))
    assert [recorded.sweep.tag for recorded in read_recording(alone, tag="1.10").sweeps] == ["1.1"]


@pytest.mark.parametrize(
    ("bad", "column", "cell", "quantity"),
    [
        ("7,4,148520230,1,2,-9999,1,1,1,50,1e-9,1,1,35,-111,8,0,0,10,0,0", 6, "-9999", "snr"),
        ("7,4,148520230,1,2,oops,1,1,1,50,1e-9,1,1,35,-111,8,0,0,10,0,0", 6, "oops", "snr"),
        ("7,4,148520230,1,2,50,1,1,1,50,-9999,1,1,35,-111,8,0,0,10,0,0", 11, "-9999", "noise_psd"),
        ("7,4,148520230,1,2,50,1,1,1,50,1e-9,1,1,95,-111,8,0,0,10,0,0", 14, "95", "latitude"),
        ("12,what,is,this", 1, "12", "kind_of_row"),
    ],
)
def test_cells_not_understood_are_named_with_their_line(
    tmp_path: Path, bad: str, column: int, cell: str, quantity: Quantity
) -> None:
    lines = rotation()
    lines.insert(4, bad)
    path = write(tmp_path, lines)
    recording = read_recording(path)
    assert recording.remarks == (CellUnusable(str(path), 5, column, cell, quantity),)
    assert recording.sweeps[0].sweep.power_db.size == 24


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        ("7,4,148520230,1,2,50", "columns"),
        ("7,4,148520230,1,2,50,1,1,1,50,1e-9,1,1,35,-111,8,0,0,10,3,4", "two_offsets"),
    ],
)
def test_rows_not_understood_are_named_with_their_line(
    tmp_path: Path, bad: str, why: Literal["columns", "two_offsets"]
) -> None:
    lines = rotation()
    lines.insert(4, bad)
    path = write(tmp_path, lines)
    recording = read_recording(path)
    assert recording.remarks == (RowLeftOut(str(path), 5, why),)
    assert recording.sweeps[0].sweep.power_db.size == 24


def test_heartbeat_rows_are_understood_and_are_no_pulses(tmp_path: Path) -> None:
    lines = rotation()
    lines.insert(4, pulse(50.0, -20.0, frequency=0))
    recording = read_recording(write(tmp_path, lines))
    assert recording.remarks == ()
    assert recording.sweeps[0].sweep.power_db.size == 24


def test_unclosed_and_reopened_rotations_are_remarked(tmp_path: Path) -> None:
    lines = rotation()[:-1] + rotation()[:-1]
    path = write(tmp_path, lines)
    recording = read_recording(path)
    assert len(recording.sweeps) == 2
    assert recording.remarks == (
        RotationIrregular(str(path), 1, "not_closed"),
        RotationIrregular(str(path), 26, "not_closed"),
    )


@pytest.mark.parametrize(
    "text",
    [
        "heading_deg,power_db\n0,-50\n10,-51.5\nx,y\n20,nan\n370,-60\n",
        "0,-50\n10,-51.5\nx,y\n20,nan\n370,-60\n",
        "# heading_deg; power_db\n0;-50\n10;-51.5\nx;y\n20;nan\n370;-60\n",
        "power_dbm\theading\n-50\t0\n-51.5\t10\ny\tx\nnan\t20\n-60\t370\n",
        "0,-50\n10,-51.5\n1e308,-40\n20,-1e308\n370,-60\n",
    ],
)
def test_plain_tables(tmp_path: Path, text: str) -> None:
    path = tmp_path / "plain.csv"
    path.write_text(text)
    recording = read_recording(path)
    (recorded,) = recording.sweeps
    assert recorded.sweep.heading_deg.tolist() == [0.0, 10.0, 10.0]
    assert recorded.sweep.power_db.tolist() == [-50.0, -51.5, -60.0]
    assert len(recording.remarks) == 2
    assert not recorded.place_known


def test_plain_table_with_place_and_time(tmp_path: Path) -> None:
    path = tmp_path / "plain.csv"
    path.write_text("time_s,lat,lon,heading_deg,power_db\n5,50.1,7.2,0,-50\n6,50.1,7.2,10,-40\n")
    (recorded,) = read_recording(path).sweeps
    assert recorded.place_known
    assert recorded.sweep.position.lat == pytest.approx(50.1)
    assert recorded.sweep.at_s.tolist() == [5.0, 6.0]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "holds no rows"),
        (b"# only\n\n", "holds no rows"),
        (b"\x89PNG\0\0\0\0", "not a text file"),
        (b"heading_deg,power_db\n", "holds no rows"),
        (b"name,colour\na,b\n", "cannot be told apart"),
        (b"a b c\n", "cannot be told apart"),
        (b"10,35,-111,2000\n11,35,-111,2000\n", "no pulse"),
        (b"10,35,-111,2000\n7,4,1,1,1,bad\n11,35,-111,2000\n", "6 columns"),
    ],
)
def test_useless_files_say_what_is_wrong(tmp_path: Path, content: bytes, words: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=words) as raised:
        read_recording(path)
    assert "bad.csv" in str(raised.value)


@settings(max_examples=150, deadline=None)
@given(st.text(alphabet="0123456789.,;-#\n7e+ naN\"'xyz", max_size=400))
def test_any_text_is_read_or_refused_never_a_crash(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzz.csv"
    path.write_text(text)
    with contextlib.suppress(RecordingError):
        recording = read_recording(path)
        assert all(np.isfinite(recorded.sweep.power_db).all() for recorded in recording.sweeps)
