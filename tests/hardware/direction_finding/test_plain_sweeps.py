"""A plain table with a tag column: of each turn the rows of one tag, the one that is asked for or heard most."""

from __future__ import annotations

from pathlib import Path

import pytest
from refusals import refusing

from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError
from hardware.reasons.table import OtherTagsLeftOut, TagNotHeard


@pytest.fixture
def two_tags(tmp_path: Path) -> Path:
    rows = [f"A,{heading},-60" for heading in range(0, 360, 10)] + [f"B,{heading},-70" for heading in range(0, 360, 5)]
    path = tmp_path / "turn.csv"
    path.write_text("\n".join(["Tag,heading_deg,power_db", *rows, ",0,-50"]))
    return path


def test_rows_of_the_tag_that_is_asked_for_are_used(two_tags: Path) -> None:
    recording = read_recording(two_tags, "A")
    (recorded,) = recording.sweeps
    assert (recorded.sweep.tag, recorded.sweep.power_db.tolist()) == ("A", [-60.0] * 36)
    assert recording.remarks == ()


def test_the_tag_heard_most_is_used_else_and_the_others_are_told(two_tags: Path) -> None:
    recording = read_recording(two_tags)
    (recorded,) = recording.sweeps
    assert (recorded.sweep.tag, recorded.sweep.power_db.tolist()) == ("B", [-70.0] * 72)
    assert recording.remarks == (OtherTagsLeftOut(str(two_tags), 2, "B", 37, ("-", "A")),)


def test_a_tag_that_is_not_in_the_file_is_refused_with_those_that_are(two_tags: Path) -> None:
    with refusing(TagNotHeard(str(two_tags), 2, "C", ("A", "B")), RecordingError):
        read_recording(two_tags, "C")


def test_a_table_without_tags_is_of_the_tag_that_is_named(tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_text("heading_deg,power_db\n0,-60\n")
    assert read_recording(path, "C").sweeps[0].sweep.tag == "C"


def test_a_tag_that_only_one_turn_heard_gives_that_one_sweep(two_tags: Path) -> None:
    lines = two_tags.read_text().splitlines()[:-1]
    turned = [lines[0] + ",sweep", *(f"{line},{1 + line.startswith('B')}" for line in lines[1:])]
    two_tags.write_text("\n".join(turned))
    recording = read_recording(two_tags, "B")
    assert [recorded.sweep.tag for recorded in recording.sweeps] == ["B"]
    assert recording.remarks == (TagNotHeard(str(two_tags), 2, "B", ("A",)),)


def turn_of(names: str, rows: list[str], path: Path) -> Path:
    path.write_text("\n".join([names, *rows]))
    return path


@pytest.mark.parametrize(
    ("name", "one", "other", "tag"),
    [
        ("Frequency (MHz)", "150.1001", "150.2", "150.2"),
        ("freq_khz", "150100", "150200", "150200"),
        ("frequency", "150.1 MHz", "150.2 MHz", "150.2"),
        ("Freq", "150.1", "150.2", "150.2"),
    ],
)
def test_what_was_heard_at_another_frequency_is_another_tag(
    name: str, one: str, other: str, tag: str, tmp_path: Path
) -> None:
    rows = [f"{heading},-60,{one}" for heading in range(0, 360, 10)]
    rows += [f"{heading},-70,{other}" for heading in range(0, 360, 5)]
    recording = read_recording(turn_of(f"heading_deg,power_db,{name}", rows, tmp_path / "turn.csv"))
    (recorded,) = recording.sweeps
    assert (recorded.sweep.tag, recorded.sweep.power_db.tolist()) == (tag, [-70.0] * 72)
    assert recorded.sweep.frequency_hz == pytest.approx(150.2e6)
    assert [type(remark) for remark in recording.remarks] == [OtherTagsLeftOut]


def test_the_frequency_of_whatever_was_loudest_is_no_tag(tmp_path: Path) -> None:
    rows = [f"{heading},-60,{150_000_000 + 100 * heading}" for heading in range(0, 360, 10)]
    recording = read_recording(turn_of("heading_deg,power_db,frequency_hz", rows, tmp_path / "turn.csv"))
    assert [len(recorded.sweep.power_db) for recorded in recording.sweeps] == [36]
    assert recording.sweeps[0].sweep.frequency_hz == pytest.approx(150_017_500)


def test_collars_that_went_round_one_after_another_are_not_one_turn(tmp_path: Path) -> None:
    rows = [f"{collar},{heading},-60" for collar in ("lynx", "hare") for heading in range(0, 360, 10)]
    path = turn_of("Collar,heading_deg,power_db", rows, tmp_path / "turn.csv")
    assert [one.sweep.power_db.size for one in read_recording(path, "hare").sweeps] == [36]


def test_a_column_of_tags_counts_before_frequencies(two_tags: Path) -> None:
    lines = two_tags.read_text().splitlines()
    mended = [lines[0] + ",frequency_mhz", *(f"{line},{150.1 + 0.1 * (k % 2)}" for k, line in enumerate(lines[1:]))]
    two_tags.write_text("\n".join(mended))
    assert [one.sweep.power_db.size for one in read_recording(two_tags, "A").sweeps] == [36]


def test_blocks_of_one_collar_each_stay_apart(tmp_path: Path) -> None:
    blocks = [[f"{collar},{heading},-60" for heading in range(0, 360, 10)] for collar in ("lynx", "hare")]
    path = turn_of("collar,heading_deg,power_db", [*blocks[0], "", *blocks[1]], tmp_path / "turn.csv")
    assert [one.sweep.tag for one in read_recording(path).sweeps] == ["lynx", "hare"]
