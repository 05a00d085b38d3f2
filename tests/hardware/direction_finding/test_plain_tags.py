"""Readings of several tags in one plain table are kept apart; what a receiver wrote beside one tag's are not."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from refusals import refusing

from hardware.direction_finding.recordings import Recording, read_recording
from hardware.direction_finding.table_file import RecordingError
from hardware.reasons.table import OtherTagsLeftOut, TagNotHeard

ROUND = range(0, 360, 10)
LOBE = range(40, 160, 10)


def read(folder: Path, header: str, rows: Sequence[str], tag: str | None = None) -> Recording:
    path = folder / "turn.csv"
    path.write_text("\n".join([f"heading_deg,power_db,{header}", *rows]))
    return read_recording(path, tag)


def heard(recording: Recording) -> list[tuple[str | None, int]]:
    return [(one.sweep.tag, one.sweep.power_db.size) for one in recording.sweeps]


def rows_of(headings: Sequence[int], cells: str, power_db: float = -60.0) -> list[str]:
    return [f"{heading},{power_db},{cells}" for heading in headings]


@pytest.mark.parametrize(
    ("header", "one", "other", "names"),
    [
        ("collar", "lynx", "hare", ("lynx", "hare")),
        ("frequency_mhz", "150.1", "150.2", ("150.1", "150.2")),
        ("frequency_mhz", "868.95", "868.95625", ("868.95", "868.95625")),
        ("tag,frequency", "999,150.1", "999,150.2", ("150.1", "150.2")),
        ("tag,frequency", ",150.1", ",150.2", ("150.1", "150.2")),
        ("tag,collar", "VHF,lynx", "VHF,hare", ("lynx", "hare")),
        ("collar,tag", "7,lynx", "7,hare", ("lynx", "hare")),
        ("tag,frequency", "10,150.1", "10,150.2", ("10 150.1", "10 150.2")),
    ],
)
def test_one_that_was_heard_in_its_lobe_is_kept_out_of_anothers_turn(
    tmp_path: Path, header: str, one: str, other: str, names: tuple[str, str]
) -> None:
    rows = [*rows_of(ROUND, one), *rows_of(LOBE, other)]
    recording = read(tmp_path, header, rows)
    assert heard(recording) == [(names[0], 36)]
    assert recording.remarks == (OtherTagsLeftOut(str(tmp_path / "turn.csv"), 2, names[0], 12, (names[1],)),)
    assert heard(read(tmp_path, header, rows, names[1])) == [(names[1], 12)]
    with refusing(TagNotHeard(str(tmp_path / "turn.csv"), 2, "fox", tuple(sorted(names))), RecordingError):
        read(tmp_path, header, rows, "fox")


def test_names_count_before_a_frequency_that_drifts(tmp_path: Path) -> None:
    rows = [
        f"{heading},-60,{collar},{150.1 + 0.005 * k}" for collar in ("lynx", "hare") for k, heading in enumerate(ROUND)
    ]
    assert heard(read(tmp_path, "collar,frequency_mhz", rows, "hare")) == [("hare", 36)]


@pytest.mark.parametrize("nothing", ["", "-", "NA", "None"])
def test_a_tag_named_where_it_was_recognized_has_the_whole_turn(tmp_path: Path, nothing: str) -> None:
    named = [*rows_of(LOBE, "lynx", -50.0), *rows_of([k for k in ROUND if k not in LOBE], nothing, -80.0)]
    for rows in (named, [*rows_of(ROUND[:2], "lynx"), *rows_of(ROUND[2:], nothing)]):
        recording = read(tmp_path, "animal", rows)
        assert (heard(recording), recording.remarks) == ([("lynx", 36)], ())


@pytest.mark.parametrize(
    ("headings", "power_db"),
    [
        pytest.param(ROUND, -70.0, id="where it was read itself"),
        pytest.param([k for k in ROUND if k not in LOBE], -40.0, id="louder than it ever was"),
    ],
)
def test_what_nobody_recognized_is_another_tags(tmp_path: Path, headings: Sequence[int], power_db: float) -> None:
    rows = [*rows_of(LOBE, "lynx", -50.0), *rows_of(headings, "", power_db)]
    recording = read(tmp_path, "animal", rows)
    assert heard(recording) == [("lynx", 12)]
    assert recording.remarks == (OtherTagsLeftOut(str(tmp_path / "turn.csv"), 2, "lynx", len(headings), ("-",)),)


def test_blanks_between_two_tags_are_neithers_where_their_names_are_few(tmp_path: Path) -> None:
    rows = [*rows_of(ROUND[:7], "lynx"), *rows_of(ROUND[7:14], "hare"), *rows_of(ROUND[14:], "")]
    assert heard(read(tmp_path, "tag", rows)) == [("lynx", 7)]


@pytest.mark.parametrize(
    ("header", "cells"),
    [
        ("animal", ["fox", "roe", "roe"]),
        ("tag", [f"{k}" for k in range(36)]),
        ("frequency_mhz", [f"{150.1 + 0.02 * (k * 7 % 3)}" for k in range(12)] + ["150.1"] * 24),
        ("frequency_hz", [f"{433_920_000 + 900 * k}" for k in range(36)]),
    ],
)
def test_what_was_noted_in_a_few_rows_or_instead_of_another_parts_no_turn(
    tmp_path: Path, header: str, cells: list[str]
) -> None:
    cells = [*cells, *[""] * (36 - len(cells))]
    rows = [f"{heading},-60,{cell}" for heading, cell in zip(ROUND, cells, strict=True)]
    recording = read(tmp_path, header, rows)
    assert (heard(recording), recording.remarks) == ([(None, 36)], ())


def test_a_code_that_was_given_twice_is_a_tag_on_each_frequency(tmp_path: Path) -> None:
    rows = [line for cells in ("10,150.1", "10,150.2", "11,150.2", "11,150.205") for line in rows_of(ROUND, cells)]
    rows[-36:] = [f"{heading + 360},-60,11,150.1" for heading in ROUND]
    for tag in ("10 150.1", "10 150.2", "11 150.1", "11 150.2"):
        assert heard(read(tmp_path, "tag,frequency", rows, tag)) == [(tag, 36)]


def test_a_receiver_that_is_tuned_anew_hears_the_same_tag(tmp_path: Path) -> None:
    rows = [*rows_of(ROUND, "lynx,150.1,1"), *rows_of(ROUND, "lynx,150.105,2")]
    assert heard(read(tmp_path, "tag,frequency,sweep", rows, "lynx")) == [("lynx", 36), ("lynx", 36)]


def test_a_tag_that_hops_is_the_one_that_is_named(tmp_path: Path) -> None:
    rows = [f"{k % 360},-60,lynx,{2402 + 2 * (k * 17 % 37)}" for k in range(0, 720, 5)]
    assert heard(read(tmp_path, "tag,frequency_mhz", rows, "lynx")) == [("lynx", 144)]


def test_ids_that_were_misread_do_not_make_two_tags_one(tmp_path: Path) -> None:
    strays = [f"{heading},-75,x{heading}" for heading in range(1, 360, 5)]
    rows = [*rows_of(ROUND, "lynx"), *rows_of(ROUND, "hare"), *strays]
    assert heard(read(tmp_path, "collar", rows, "hare")) == [("hare", 36)]


@pytest.mark.parametrize("header", ["tag", "frequency_mhz", "tag,sweep"])
def test_a_name_in_merged_cells_is_that_of_the_rows_below(tmp_path: Path, header: str) -> None:
    numbered = (",1", ",2") if "sweep" in header else ("", "")
    rows = [
        f"{heading},-60,{name if k == 0 else ''}{number}"
        for name, number in zip(("151", "150"), numbered, strict=True)
        for k, heading in enumerate(ROUND)
    ]
    assert heard(read(tmp_path, header, rows, "150")) == [("150", 36)]
    with refusing(TagNotHeard(str(tmp_path / "turn.csv"), 2, "99", ("150", "151")), RecordingError):
        read(tmp_path, header, rows, "99")


def test_two_that_jitter_side_by_side_are_two(tmp_path: Path) -> None:
    rows = [f"{heading},-60,{150.1 + 0.0005 * (k % 9 - 4):.4f}" for k, heading in enumerate(ROUND)]
    rows += [f"{heading + 3},-60,{150.106 + 0.0005 * (k % 9 - 4):.4f}" for k, heading in enumerate(ROUND)]
    (recorded,) = read(tmp_path, "frequency_mhz", rows).sweeps
    assert recorded.sweep.heading_deg.tolist() == [*map(float, ROUND)]


@pytest.mark.parametrize("megahertz", [150, 433])
def test_a_hop_to_one_channel_after_another_is_one_turn(tmp_path: Path, megahertz: int) -> None:
    rows = [f"{5 * k},-60,{megahertz + 0.05 * (k * 29 % 71):.2f}" for k in range(72)]
    assert heard(read(tmp_path, "frequency_mhz", rows)) == [(None, 72)]


def test_a_few_readings_do_not_own_what_nobody_recognized(tmp_path: Path) -> None:
    rows = [*rows_of(range(40, 110, 10), "lynx", -50.0), *rows_of(ROUND, "", -45.0)]
    assert heard(read(tmp_path, "tag", rows)) == [("lynx", 7)]


def test_a_turn_that_names_nobody_is_not_that_of_a_tag_that_is_asked_for(tmp_path: Path) -> None:
    recording = read(tmp_path, "tag", [*rows_of(ROUND, "7"), "", *rows_of(ROUND, "")], "7")
    assert heard(recording) == [("7", 36)]
    assert recording.remarks == (TagNotHeard(str(tmp_path / "turn.csv"), 39, "7", ("-",)),)


@pytest.mark.parametrize(
    ("header", "one", "other", "asked", "named"),
    [
        ("frequency_mhz", "150.100", "150.2", "150.100", "150.1"),
        ("animal", "Lynx  1", "hare", "lynx 1", "Lynx  1"),
        ("tag,animal", "7,lynx", "8,hare", "Lynx", "lynx"),
        ("frequency_mhz", "150.1004", "150.2", "150.1 MHz", "150.1004"),
        ("collar", "07", "12", "7", "07"),
        ("tag,frequency", "7,150.1", "7,150.2", "7", "7"),
        ("tag,animal", "1.1,1.10", "2.1,hare", "1.10", "1.10"),
        ("tag", "1.1", "1.10", "1.10", "1.10"),
    ],
)
def test_a_tag_may_be_asked_for_as_it_is_written_or_by_another_column(
    tmp_path: Path, header: str, one: str, other: str, asked: str, named: str
) -> None:
    recording = read(tmp_path, header, [*rows_of(ROUND, one), *rows_of(ROUND, other)], asked)
    assert [tag for tag, _ in heard(recording)] == [named]


@pytest.mark.parametrize(("most", "other"), [("Lynx", "lynx"), ("7", "07"), ("7.0", "7")])
def test_other_letters_and_zeros_name_no_other_animal(tmp_path: Path, most: str, other: str) -> None:
    rows = [*rows_of(ROUND[:20], most), *rows_of(ROUND[20:], other)]
    assert heard(read(tmp_path, "animal", rows)) == [(most, 36)]


@pytest.mark.parametrize(
    ("asked", "cells"),
    [("12", ("1_2", "8")), ("0", ("00x", "8")), ("lynx", ("150.1", "150.2")), ("1.100", ("1.1", "1.10"))],
)
def test_a_tag_that_is_asked_for_is_no_other_and_not_several(
    tmp_path: Path, asked: str, cells: tuple[str, str]
) -> None:
    rows = [line for cell in cells for line in rows_of(ROUND, f"{cell},lynx")]
    with refusing(TagNotHeard(str(tmp_path / "turn.csv"), 2, asked, cells), RecordingError):
        read(tmp_path, f"{'frequency' if asked == 'lynx' else 'tag'},animal", rows, asked)


def test_a_name_in_merged_cells_is_that_of_the_turns_below(tmp_path: Path) -> None:
    firsts = ("lynx", "", "hare", "")
    rows = [
        f"{heading},-60,{'' if k else name},{n}" for n, name in enumerate(firsts) for k, heading in enumerate(ROUND)
    ]
    assert heard(read(tmp_path, "animal,sweep", rows)) == [(name, 36) for name in ("lynx", "lynx", "hare", "hare")]


def test_two_that_were_seldom_recognized_are_two(tmp_path: Path) -> None:
    rows = [*rows_of(range(0, 360, 12), "7"), *rows_of(range(5, 365, 15), "12"), *rows_of(range(400), "")]
    assert heard(read(tmp_path, "tag", rows)) == [("7", 30)]
