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
