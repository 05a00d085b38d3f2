"""Several turns in one plain table are several sweeps; one turn stays one, whatever its places say."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from hardware.direction_finding.recordings import Recording, read_recording
from hardware.reasons.table import CellUnusable, PlacesApart

TURN = range(0, 360, 10)


def read(folder: Path, header: str, rows: Iterable[str]) -> Recording:
    path = folder / "turn.csv"
    path.write_text("\n".join([header, *rows]))
    return read_recording(path)


def turn(front: str, loudest: int, headings: Iterable[int] = TURN) -> list[str]:
    return [f"{front},{heading},{-60 - abs(heading - loudest) / 10}" for heading in headings]


@pytest.mark.parametrize("name", ["sweep", "Turn", "rotation", "sweep_id", "place"])
def test_a_column_that_numbers_turns_makes_a_sweep_of_each(tmp_path: Path, name: str) -> None:
    recording = read(tmp_path, f"{name},heading_deg,power_db", [*turn("B", 100), *turn("A", 250), *turn("B", 100)])
    assert [recorded.sweep.power_db.size for recorded in recording.sweeps] == [72, 36]
    assert [recorded.sweep.heading_deg[recorded.sweep.power_db.argmax()] for recorded in recording.sweeps] == [100, 250]
    assert recording.sweeps[1].sweep.at_s[0] > recording.sweeps[0].sweep.at_s[35]
    assert recording.remarks == ()


def test_a_column_that_changes_from_row_to_row_numbers_no_turns(tmp_path: Path) -> None:
    rows = [f"{heading / 7},{heading},-60" for heading in TURN]
    assert len(read(tmp_path, "turn,heading_deg,power_db", rows).sweeps) == 1


def test_a_turn_at_each_of_two_places_is_a_sweep_each(tmp_path: Path) -> None:
    rows = [*turn("50.0,7.0", 100), *turn("50.0003,7.0", 250), *turn(",", 250, range(0, 50, 10))]
    recording = read(tmp_path, "lat,lon,heading_deg,power_db", rows)
    assert [recorded.sweep.power_db.size for recorded in recording.sweeps] == [36, 41]
    assert [recorded.sweep.position.lat for recorded in recording.sweeps] == [50.0, 50.0003]
    assert recording.remarks == ()


@pytest.mark.parametrize(
    ("places", "apart_m"),
    [
        (["50.0,7.0"] * 35 + ["50.001,7.0"], 111.0),
        (["50.0,7.0"] * 18 + ["50.001,7.0"] * 18, 56.0),
        ([f"{50.0 + k / 1e4:.4f},7.0" for k in range(36)], 195.0),
    ],
)
def test_one_turn_whose_places_lie_apart_stays_one_and_says_so(
    tmp_path: Path, places: list[str], apart_m: float
) -> None:
    rows = [f"{place},{heading},-60" for place, heading in zip(places, TURN, strict=True)]
    recording = read(tmp_path, "lat,lon,heading_deg,power_db", rows)
    assert len(recording.sweeps) == 1
    (told,) = recording.remarks
    assert isinstance(told, PlacesApart)
    assert told.line == 2
    assert told.apart_m == pytest.approx(apart_m, rel=0.02)


def test_a_vehicle_that_drifts_as_it_hovers_is_not_remarked(tmp_path: Path) -> None:
    rows = [f"{50.0 + heading / 4e6:.7f},7.0,{heading},-60" for heading in TURN]
    recording = read(tmp_path, "lat,lon,heading_deg,power_db", rows)
    assert (len(recording.sweeps), recording.remarks) == (1, ())


@pytest.mark.parametrize("between", ["", "# second turn", " ;"])
def test_turns_with_a_blank_line_or_a_comment_between_are_a_sweep_each(tmp_path: Path, between: str) -> None:
    rows = [*turn("B", 100), between, *turn("A", 250)]
    recording = read(tmp_path, "id,heading_deg,power_db", rows)
    assert [recorded.sweep.heading_deg[recorded.sweep.power_db.argmax()] for recorded in recording.sweeps] == [100, 250]


def test_blank_lines_within_one_turn_part_nothing(tmp_path: Path) -> None:
    rows = [line for row in turn("A", 100) for line in (row, "")]
    assert [one.sweep.power_db.size for one in read(tmp_path, "id,heading_deg,power_db", rows).sweeps] == [36]


def test_a_row_left_out_parts_no_turn(tmp_path: Path) -> None:
    rows = [*turn("A", 100), "A,0,", *turn("A", 250)]
    assert [one.sweep.power_db.size for one in read(tmp_path, "id,heading_deg,power_db", rows).sweeps] == [72]


def test_a_part_that_did_not_go_round_is_a_sweep_beside_those_that_did(tmp_path: Path) -> None:
    rows = [*turn("B", 100), "", *turn("A", 250), "", *turn("A", 250, range(0, 60, 10))]
    assert [one.sweep.power_db.size for one in read(tmp_path, "id,heading_deg,power_db", rows).sweeps] == [36, 36, 6]


def test_two_halves_are_one_turn_whatever_stands_between(tmp_path: Path) -> None:
    rows = [*turn("B", 100, range(0, 180, 10)), "# other way", *turn("B", 100, range(180, 360, 10))]
    assert [one.sweep.power_db.size for one in read(tmp_path, "id,heading_deg,power_db", rows).sweeps] == [36]


def test_a_header_again_begins_another_turn(tmp_path: Path) -> None:
    header = "id,heading_deg,power_db"
    recording = read(tmp_path, header, [*turn("B", 100), header, *turn("A", 250)])
    assert [one.sweep.power_db.size for one in recording.sweeps] == [36, 36]
    assert recording.remarks == (CellUnusable(str(tmp_path / "turn.csv"), 38, 2, "heading_deg", "heading"),)


def test_a_turn_over_the_dateline_was_made_there(tmp_path: Path) -> None:
    rows = [f"12,{'-' if heading % 20 else ''}179.99999,{heading},-60" for heading in TURN]
    (recorded,) = read(tmp_path, "lat,lon,heading_deg,power_db", rows).sweeps
    assert abs(recorded.sweep.position.lon) > 179.99


@pytest.mark.parametrize("name", ["tag", "collar", "frequency"])
def test_blocks_of_one_tag_each_are_turns_of_that_tag(tmp_path: Path, name: str) -> None:
    halves = (range(0, 180, 10), range(180, 360, 10))
    rows = [*turn("151", 100), "", *turn("150", 250), "", *turn("151", 250), "", "150,0,-90"]
    rows += [line for half in halves for line in ("", *turn("152", 40, half))]
    recording = read(tmp_path, f"{name},heading_deg,power_db", rows)
    assert [(one.sweep.tag, one.sweep.power_db.size) for one in recording.sweeps] == [
        ("151", 36), ("150", 37), ("151", 36), ("152", 36),
    ]  # fmt: skip
    assert recording.remarks == ()


def test_a_half_that_is_not_named_is_of_the_same_turn(tmp_path: Path) -> None:
    halves = turn("lynx", 100, range(0, 180, 10)), turn("", 100, range(180, 360, 10))
    (recorded,) = read(tmp_path, "tag,heading_deg,power_db", [*halves[0], "", *halves[1]]).sweeps
    assert (recorded.sweep.tag, recorded.sweep.power_db.size) == ("lynx", 36)
