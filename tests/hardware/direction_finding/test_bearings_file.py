"""Bearing files of both kinds; rows not understood are named."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import pytest
from refusals import refusing

from hardware.direction_finding import bearings_file
from hardware.direction_finding.bearings_file import (
    DEFAULT_SIGMA_DEG,
    EXPECTED,
    RecordedBearings,
    bearings_in,
    holds_bearings,
)
from hardware.direction_finding.table_file import RecordingError, Row, read_table
from hardware.direction_finding.table_places import Places, place_columns
from hardware.reasons.table import CellUnusable, ColumnsUnknown, FileUnusable, HeadingsInRadians, Quantity, TooManyCells


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "bearings.csv"
    path.write_text(text)
    return path


def read_bearings(path: Path, sigma_deg: float = DEFAULT_SIGMA_DEG) -> RecordedBearings:
    return bearings_in(read_table(path), sigma_deg)


def test_uavrt_bearing_file_with_and_without_quotes(tmp_path: Path) -> None:
    text = (
        "2,rotation_example.csv,137.592747,0.061582,35.178241,-111.656587,9.569501,2107.248081,1684766889.8,1684767153.8\n"
        "2,'Rot1.csv',-45,0.5,35.177870,-111.656956,10,2050,0,30\n"
    )
    first, second = read_bearings(written(tmp_path, text)).bearings
    assert (first.bearing_deg, first.tag) == (137.592747, "2")
    assert (first.place.lat, first.place.lon) == (35.178241, -111.656587)
    assert first.sigma_deg == DEFAULT_SIGMA_DEG
    assert second.bearing_deg == 315.0


@pytest.mark.parametrize(
    "text",
    [
        "lat,lon,bearing_deg,sigma_deg\n50.1,7.2,10,3\n50.2,7.3,20,\n",
        "50.1,7.2,10,3\n50.2,7.3,20\n",
        "bearing;longitude;latitude;sigma\n10;7.2;50.1;3\n20;7.3;50.2;\n",
        "# lat, lon, bearing_deg, sigma_deg\n50.1,7.2,10,3\n\n50.2,7.3,20\n",
        "\ufefflat;lon;bearing_deg;sigma_deg\r\n50,1;7,2;10,0;3\r\n50,2;7,3;20;\r\n",
        "50,1\t7,2\t10,0\t3\n50.2\t7.3\t20\n",
        "bearing,lat,lon,sigma,note\n10,50.1,7.2,3,hill;1,5\n20,50.2,7.3,,a;b\n",
        "sep=;\nlat;lon;bearing;sigma\n50,1 N;7,2 E;10;3\n50,2 N;7,3 E;20;\n",
        "lat;lon;bearing;sigma\n50°06,000 N;E 7 12,000';10;3\n50°12'0,0\"N;7,3;20;\n",
        "lat,N/S,lon,E/W,bearing_deg,sigma\n50.1,N,7.2,E,10,3\n50.2,N,7.3,E,20,\n",
        "Beacon on the ridge\nTaken, on foot, 2026\n\nlat,lon,bearing,sigma\n50.1,7.2,10,3\n50.2,7.3,20,\n",
        "% lat, lon, bearing_deg, sigma_deg\n50.1,7.2,10,3\n50.2,7.3,20\n",
        "# bearing, as the compass has it\n# lat, lon, bearing_deg, sigma_deg\n50.1,7.2,10,3\n50.2,7.3,20\n",
    ],
)
def test_plain_csv_with_and_without_header_and_sigma(tmp_path: Path, text: str) -> None:
    first, second = read_bearings(written(tmp_path, text), sigma_deg=5.0).bearings
    assert (first.place.lat, first.place.lon, first.bearing_deg, first.sigma_deg) == (50.1, 7.2, 10.0, 3.0)
    assert (second.bearing_deg, second.sigma_deg) == (20.0, 5.0)


@pytest.mark.parametrize(
    ("row", "column", "cell", "quantity"),
    [
        ("50.1,7.2,north", 3, "north", "bearing"),
        ("150.1,7.2,3", 1, "150.1", "latitude"),
        ("50.1,720,3", 2, "720", "longitude"),
        ("50.1,7.2,999", 3, "999", "bearing"),
        ("50.1,7.2,3,-4", 4, "-4", "sigma"),
        ("50.1,7.2", 3, "", "bearing"),
        ("nan,7.2,3", 1, "nan", "latitude"),
        ("0,0,3", 1, "0", "latitude"),
        ("50.1,,3", 2, "", "longitude"),
        ("50.1,7.2O,3", 2, "7.2O", "longitude"),
    ],
)
def test_bad_rows_are_named_and_left_out(tmp_path: Path, row: str, column: int, cell: str, quantity: Quantity) -> None:
    path = written(tmp_path, f"50.1,7.2,10\n{row}\n")
    recorded = read_bearings(path)
    assert len(recorded.bearings) == 1
    assert recorded.remarks == (CellUnusable(str(path), 2, column, cell, quantity),)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "a,b\n",
        "1,50.1,7.2,10\n2,50.2,7.3,20\n",
        "50.1,7.2,10,0.9\n50.2,7.3,20,0.8\n",
        "lat,lon,bearing\n",
        "lat,lon,angle\n1,2,3\n",
        "x,y,z,w,v\n",
        "12,10:30:36,45\n12,10:33:10,95\n",
        "lat_deg,lat_min,lon_deg,lon_min,bearing_deg\n50,30.5,7,15.2,45\n",
        "50.1,7.2,north\n",
    ],
)
def test_useless_files_are_refused_with_their_name(tmp_path: Path, text: str) -> None:
    with pytest.raises(RecordingError, match=r"bearings\.csv"):
        read_bearings(written(tmp_path, text))


@pytest.mark.parametrize(
    ("more", "row"), [("", "50,000,7,000,45,0"), ("", "1,50.1,7.2,45"), (",quality", "50,0,7,0,45,0,0,9")]
)
def test_rows_with_more_numbers_than_columns_are_refused(tmp_path: Path, more: str, row: str) -> None:
    path = written(tmp_path, f"lat,lon,bearing_deg{more}\n{row}\n")
    with refusing(TooManyCells(str(path), 2, row.count(",") + 1, 3 + more.count(",")), RecordingError):
        read_bearings(path)


@pytest.mark.parametrize("name", ["bearing", "azimuth"])
def test_bearings_that_seem_to_be_radians_are_refused_unless_named_as_degrees(tmp_path: Path, name: str) -> None:
    rows = "50.1,7.2,0.785\n50.2,7.3,5.5\n50.3,7.2,3.1\n"
    for header in (f"lat,lon,{name}\n", ""):
        path = written(tmp_path, header + rows)
        with refusing(HeadingsInRadians(str(path), 3, 0.785, 5.5), RecordingError):
            read_bearings(path)
    assert len(read_bearings(written(tmp_path, f"lat,lon,{name}_deg\n{rows}")).bearings) == 3
    for all_north in ("50.1,7.2,0.785\n50.2,7.3,5.5\n", "50.1,7.2,1\n50.2,7.3,5\n50.3,7.2,3\n"):
        assert read_bearings(written(tmp_path, all_north)).bearings[1].bearing_deg in (5.0, 5.5)


@pytest.mark.parametrize(
    "text", ["lat,lon,azimuth,power_db\n50.1,7.2,10,-60\n", "10,50.1,7.1,140\n7,2,146e6,0,0,20\n11,50.1,7.1,140\n"]
)
def test_sweeps_are_no_bearings(tmp_path: Path, text: str) -> None:
    path = written(tmp_path, text)
    with refusing(FileUnusable(str(path), "sweeps"), RecordingError):
        read_bearings(path)


@pytest.mark.parametrize("tag", ["7", "10", "11"])
def test_a_bearing_of_a_tag_that_is_a_command_elsewhere_is_one(tmp_path: Path, tag: str) -> None:
    row = f"{tag},turn.csv,137.6,0.06,35.2,-111.7,9.6,2107.2,1684766889.8,1684767153.8\n"
    assert read_bearings(written(tmp_path, row)).bearings[0].bearing_deg == 137.6


def test_biologists_files_in_utm_hold_the_bearings_of_each_frequency(tmp_path: Path) -> None:
    """The columns of a snowshoe hare's VHF tracking (see `bearing_scatter.py`)."""
    rows = [
        "149.142,A6704,1,22N,279215,5359442,342,2017-07-13,16:40:31",
        "149.142,A6704,2,22N,278939,5359617,79,2017-07-13,17:14:17",
        "149.394,A3707,1,22N,279212,5359446,22,2017-07-13,17:42:52",
        "149.394,A3707,2,22N,278951,5359709,116,2017-07-13,18:10:13",
        "149.394,A3707,3,22N,278647,5359881,,2017-07-13,18:57:09",
    ]
    header = "Frequency,EarTag,Point,UTMZone,Easting,Northing,Azimuth,Date,Time_O"
    path = written(tmp_path, "\n".join([header, *rows]))
    recorded = read_bearings(path)
    assert [one.tag for one in recorded.bearings] == ["149.142", "149.142", "149.394", "149.394"]
    assert [one.bearing_deg for one in recorded.bearings] == [342.0, 79.0, 22.0, 116.0]
    assert recorded.bearings[0].place.lat == pytest.approx(48.349526, abs=1e-6)
    assert recorded.remarks == (CellUnusable(str(path), 6, 7, "", "bearing"),)
    without = written(tmp_path, "\n".join([header, *rows]).replace("UTMZone", "Line"))
    with refusing(
        ColumnsUnknown(str(without), 1, 9, ("easting", "northing", "utm_zone", "bearing_deg")), RecordingError
    ):
        read_bearings(without)


@pytest.mark.parametrize(
    ("header", "cells", "tags"),
    [
        ("frequency_mhz", ("148.5201", "148.5203", "148.5207"), (None,) * 3),
        ("frequency", ("148.52", "148.52", "148.52"), (None,) * 3),
        ("Freq (MHz)", ("150.12", "150.120", "150.34"), ("150.12", "150.12", "150.34")),
        ("frequency_hz", ("150120000", "150121000", "151900000"), ("150120000", "150120000", "151900000")),
        ("collar,animal", ("VHF,fox", "VHF,hare", "VHF,fox"), ("fox", "hare", "fox")),
        ("tag,frequency", (",150.12", ",150.34", ",150.12"), ("150.12", "150.34", "150.12")),
        ("collar", ("VHF", "VHF", "VHF"), ("VHF",) * 3),
        ("tag,collar", ("7,old", "7,new", "7,old"), ("7", "7", "7")),
        ("tag,frequency_hz", ("7,150100000", "7,150104000", "7,150108000"), ("7", "7", "7")),
        ("animal,frequency", ("fox,150.1", "fox,150.2", "badger,150.3"), ("150.1", "150.2", "150.3")),
        ("frequency", ("150.123 MHz", "150.223MHz", "150.123"), ("150.123", "150.223", "150.123")),
        ("frequency_mhz", ("433.100", "433.105", "433.110"), ("433.1", "433.105", "433.11")),
        ("frequency_mhz", ("868.95", "868.95625", "868.95"), ("868.95", "868.95625", "868.95")),
        ("frequency_hz", ("150100000", "150101000", "150102000"), (None,) * 3),
        ("tag,frequency", ("999,150.12", "999,150.34", "999,150.12"), ("150.12", "150.34", "150.12")),
        ("tag,frequency", ("999,150.12", "999,150.12", "999,150.12"), ("999",) * 3),
        ("animal", ("fox", "NA", "-"), ("fox", None, None)),
        ("tag,collar", ("VHF,fox", "VHF,hare", "VHF,Fox"), ("fox", "hare", "fox")),
    ],
)
def test_tags_are_named_by_the_column_that_tells_several(
    tmp_path: Path, header: str, cells: tuple[str, ...], tags: tuple[str | None, ...]
) -> None:
    rows = "\n".join(f"50.{k},7.2,{k}0,{cell}" for k, cell in enumerate(cells, start=1))
    recorded = read_bearings(written(tmp_path, f"lat,lon,bearing_deg,{header}\n{rows}"))
    assert tuple(one.tag for one in recorded.bearings) == tags


def test_rows_above_a_header_are_no_titles_that_are_lost(tmp_path: Path) -> None:
    path = written(tmp_path, "50.0N,7.0E,32.7\n50.0N,7.01E,327.3\nlat,lon,bearing\n50.01,7.0,147.3\n")
    with refusing(ColumnsUnknown(str(path), 1, 3, EXPECTED), RecordingError):
        read_bearings(path)


def test_radians_are_told_by_the_rows_that_are_used(tmp_path: Path) -> None:
    rows = "50.1,7.2,0.57\n50.2,7.3,5.71\n50.3,7.2,2.57\n,,359\n"
    with pytest.raises(RecordingError, match="radians"):
        read_bearings(written(tmp_path, f"lat,lon,bearing\n{rows}"))


def test_a_named_table_of_ten_columns_holds_bearings(tmp_path: Path) -> None:
    header = "date,time,obs,st,easting,northing,zone,azimuth,frequency,notes"
    row = "2017-07-13,16:40,MR,1,279215,5359442,22N,342,149.142,weak"
    assert holds_bearings(read_table(written(tmp_path, f"{header}\n{row}\n")))
    sweep = written(tmp_path, f"{header.replace('notes', 'level')}\n{row.replace('weak', '-60')}\n")
    assert not holds_bearings(read_table(sweep))


def test_an_antenna_that_was_turned_at_one_place_is_no_list_of_bearings(tmp_path: Path) -> None:
    rows = [f"{azimuth},{azimuth % 50},{47.0 + azimuth * 1e-8:.7f},8.5" for azimuth in range(0, 360, 10)]
    path = written(tmp_path, "\n".join(["azimuth,snr,lat,lon", *rows]))
    assert not holds_bearings(read_table(path))
    with refusing(FileUnusable(str(path), "sweeps"), RecordingError):
        read_bearings(path)


@pytest.mark.parametrize(
    "rows",
    [
        ["10,20,47.0,8.5", "130,22,47.001,8.5", "250,9,47.0,8.502"],
        [f"{80 + k},{k},47.0,8.5" for k in range(10)],
        [f"{36 * k},12,{47 + k * 1e-3},8.5" for k in range(10)],
    ],
    ids=["three places", "one direction", "ten places round it"],
)
def test_bearings_with_their_strengths_are_bearings(rows: list[str], tmp_path: Path) -> None:
    table = read_table(written(tmp_path, "\n".join(["azimuth,snr,lat,lon", *rows])))
    assert holds_bearings(table)
    assert len(bearings_in(table).bearings) == len(rows)


@pytest.mark.parametrize("drift_m", [1.5, 3.0, 14.0])
@pytest.mark.parametrize("power", ["signal_strength", "level", "snr"])
def test_a_turn_that_drifts_is_no_list_of_bearings(drift_m: float, power: str, tmp_path: Path) -> None:
    rows = [f"{a},{a % 50},{50.10004 + a / 360 * drift_m / 111e3:.7f},7.20004" for a in range(0, 360, 10)]
    path = written(tmp_path, "\n".join([f"azimuth,{power},lat,lon", *rows]))
    with refusing(FileUnusable(str(path), "sweeps"), RecordingError):
        read_bearings(path)


def test_bearings_from_all_around_with_their_strengths_are_bearings(tmp_path: Path) -> None:
    """From 40 m away, every 14 m."""
    angles = [math.radians(20 * k) for k in range(18)]
    rows = [
        f"{math.degrees(a):.0f},9,{50 - 40 / 111.2e3 * math.cos(a):.7f},{7 - 40 / 71.7e3 * math.sin(a):.7f}"
        for a in angles
    ]
    assert holds_bearings(read_table(written(tmp_path, "\n".join(["azimuth,snr,lat,lon", *rows]))))


@pytest.mark.parametrize("above", ["# ", "Survey 1 May\n", "# Survey, 1 May\n# "])
@pytest.mark.parametrize("power", ["rssi_dbm", "power_db", "level"])
def test_sweeps_below_a_comment_or_a_title_are_no_bearings(above: str, power: str, tmp_path: Path) -> None:
    rows = "\n".join(f"{azimuth},{azimuth % 50},50.1,7.2" for azimuth in range(0, 360, 10))
    path = written(tmp_path, f"{above}azimuth,{power},lat,lon\n{rows}")
    with refusing(FileUnusable(str(path), "sweeps"), RecordingError):
        read_bearings(path)


def test_a_header_that_is_repeated_is_looked_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at: list[tuple[str, ...]] = []

    def counted(names: tuple[str, ...], rows: Sequence[Row]) -> Places | None:
        looked_at.append(names)
        return place_columns(names, rows)

    monkeypatch.setattr(bearings_file, "place_columns", counted)
    block = "\n".join(["# azimuth,snr,lat,lon", *(f"{azimuth},9,50.1,7.2" for azimuth in range(0, 360, 20))])
    assert not holds_bearings(read_table(written(tmp_path, "\n".join([block] * 20))))
    assert len(looked_at) == 1
