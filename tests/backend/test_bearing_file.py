"""Which files hold bearings, and what of them is taken."""

from __future__ import annotations

from pathlib import Path

import pytest

from backend.bearing_file import read_bearing_file
from hardware.direction_finding.table_file import RecordingError
from hardware.reasons.table import CellUnusable, NothingUsable, OneTagOnly

KRAKEN = "{ms}, {deg}, 80.5, -31.2, 868300000, UCA, 412, roof, {lat}, 7.2, 350.0, 10.0, GPS, R, R, R, R"
UAVRT = "{tag},rot.csv,{deg},0.5,50.600,7.200,10.0,110.0,1684766889.8,1684767153.8"


def written(tmp_path: Path, *lines: str) -> Path:
    path = tmp_path / "recording.csv"
    path.write_text("\n".join(lines))
    return path


def test_a_krakens_lines_are_bearings_one_a_minute_and_a_place(tmp_path: Path) -> None:
    lines = [
        KRAKEN.format(ms=1700000000123, deg=40, lat=50.6),
        KRAKEN.format(ms=1700000005123, deg=41, lat=50.6),
        KRAKEN.format(ms=1700000300123, deg=42, lat=50.61),
        KRAKEN.format(ms=1700000600123, deg=999, lat=50.6),
    ]
    found = read_bearing_file(written(tmp_path, *lines), None)
    assert found is not None
    assert [(one.line, one.bearing_deg, one.place.lat) for one in found.bearings] == [(1, 30.0, 50.6), (3, 32.0, 50.61)]
    assert [one.at_s for one in found.bearings] == pytest.approx([1700000000.123, 1700000300.123])
    assert {one.frequency_hz for one in found.bearings} == {868_300_000.0}
    (remark,) = found.remarks
    assert isinstance(remark, CellUnusable)
    assert remark.line == 4


def test_a_kraken_without_a_fix_holds_nothing(tmp_path: Path) -> None:
    line = KRAKEN.format(ms=1700000000123, deg=40, lat=0.0).replace(" 7.2,", " 0.0,")
    with pytest.raises(RecordingError) as refused:
        read_bearing_file(written(tmp_path, line), None)
    assert isinstance(refused.value.reason, NothingUsable)


def test_a_uavrt_bearing_file_of_several_tags_wants_one_named(tmp_path: Path) -> None:
    path = written(tmp_path, UAVRT.format(tag=2, deg=10), UAVRT.format(tag=3, deg=-20), UAVRT.format(tag=2, deg=12))
    found = read_bearing_file(path, "2")
    assert found is not None
    assert [(one.bearing_deg, one.at_s) for one in found.bearings] == [(10.0, 1684767153.8), (12.0, 1684767153.8)]
    for tag in (None, "4"):
        with pytest.raises(RecordingError) as refused:
            read_bearing_file(path, tag)
        assert refused.value.reason == OneTagOnly(str(path), ("2", "3"))


def test_a_file_of_one_tag_or_of_none_needs_no_name(tmp_path: Path) -> None:
    one = read_bearing_file(written(tmp_path, UAVRT.format(tag=2, deg=10)), None)
    plain = read_bearing_file(written(tmp_path, "lat,lon,bearing_deg,sigma_deg", "50.6,7.2,400e-1,3"), "lynx")
    assert one is not None
    assert plain is not None
    assert [b.bearing_deg for b in (*one.bearings, *plain.bearings)] == [10.0, 40.0]
    assert plain.bearings[0].at_s is None


@pytest.mark.parametrize(
    "lines",
    [
        ("heading_deg,power_db", "0,-60", "10,-61"),
        ("0,-60", "10,-61"),
        ("azimuth,power_db,lat,lon", "0,-60,50.6,7.2"),
        ("1,2,3,4,5,6,7,8,9,10,11,12", "1,2,3,4,5,6,7,8,9,10,11,12"),
        ("a,b,c,d,e,f,g,h,i,j",),
    ],
)
def test_headings_with_power_and_what_nobody_knows_are_no_bearings(tmp_path: Path, lines: tuple[str, ...]) -> None:
    assert read_bearing_file(written(tmp_path, *lines), None) is None
