"""What is kept of the truth study's missions: nothing flown twice, nothing counted that has a gap before it."""

from __future__ import annotations

from pathlib import Path

import pytest

from planner.study.truth import Claim
from tests.benchmarks import truth
from tests.benchmarks.figures.circumstances import ROOT
from tests.benchmarks.figures.reader import read
from tests.benchmarks.truth import Series, chosen, merged, row, summed_up

RECORDED = ROOT / "docs" / "measurements" / "truth.json"
BIAS5 = Series("bias5", "joint")


@pytest.fixture
def flown(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The seeds that were flown; every tenth mission is beyond. Pieces of ten missions."""
    seeds_flown: list[int] = []

    def row_claims(name: str, seeds: range, *_: object, shared: bool) -> tuple[list[Claim], str]:
        seeds_flown.extend(seeds)
        errors = {seed: 40.0 if seed % 10 == 0 else 5.0 for seed in seeds}
        return [Claim(s, True, True, e, 10.0, 12.0, 0.01, 4, 300.0, 1.0, 2.0) for s, e in errors.items()], "nothing"

    monkeypatch.setattr(truth, "row_claims", row_claims)
    monkeypatch.setattr(truth, "PIECE", 10)
    return seeds_flown


def test_a_run_that_broke_off_goes_on_where_it_was(flown: list[int], tmp_path: Path) -> None:
    summed_up(BIAS5, 20, tmp_path, "one")
    found, commits = summed_up(BIAS5, 40, tmp_path, "two")
    assert flown == list(range(1, 41))
    assert (found.missions, found.beyond_seeds) == (40, (10, 20, 30, 40))
    assert commits == {"one", "two"}


def test_a_row_counts_all_that_is_kept_of_it_up_to_the_first_gap(flown: list[int], tmp_path: Path) -> None:
    for first in (11, 31):
        BIAS5.flown(range(first, first + 10), tmp_path, "one")
    Series("bias5", "joint", told=True).flown(range(21, 31), tmp_path, "one")
    found, _ = summed_up(BIAS5, 10, tmp_path, "one")
    assert (found.missions, found.beyond_3x) == (20, 0.1)
    assert sorted(flown) == [*range(1, 21), *range(21, 31), *range(31, 41)]


def test_without_a_folder_nothing_is_kept_and_a_broken_piece_is_flown_alone(flown: list[int], tmp_path: Path) -> None:
    summed_up(BIAS5, 3, None, "one")
    assert summed_up(BIAS5, 3, tmp_path, "one")[0].missions == 3
    assert flown == [1, 2, 3, 1, 2, 3]
    assert len(row(summed_up(BIAS5, 3, tmp_path, "one")[0])) == len(truth.COLUMNS)


def test_rows_that_are_not_flown_again_stay_in_the_record(flown: list[int], tmp_path: Path) -> None:
    before = read(RECORDED)
    names = [column.name for column in before.tables[0].columns]
    found, _ = summed_up(BIAS5, 30, None, "one")
    figures, table, remark = merged(before, [found])
    rows = {cells[:3]: dict(zip((c.name for c in table.columns), cells, strict=True)) for cells in table.rows}
    old = {cells[:3]: dict(zip(names, cells, strict=True)) for cells in before.tables[0].rows}
    assert list(rows) == list(old)
    assert rows["bias5", "joint", "nothing"]["missions"] == 30
    assert rows["right", "joint", "nothing"]["missions"] == old["right", "joint", "nothing"]["missions"] != 30
    assert [figure.name for figure in figures] == [figure.name for figure in before.figures]
    beyond = {
        figure.name: figure.note for figure in figures if figure.name.endswith(("stated: bias5", "stated: walls"))
    }
    assert [note.startswith("30 missions") for note in beyond.values()] == [True, False]
    assert str(before.commit) in remark


def test_of_tags_a_time_is_wanted_and_of_moving_emitters_the_truth(flown: list[int], tmp_path: Path) -> None:
    rows = [summed_up(Series(name, "joint"), 20, tmp_path, "one")[0] for name in ("tags_8", "moving_0.4")]
    assert [found.shared for found in rows] == [True, False]
    judged = {made.wanted.key: made.value for made in truth.figures(rows) if made.wanted is not None}
    assert judged == {"eight_tags": 300.0, "moving": 100.0}
    assert row(rows[0])[:3] == ("tags_8", "joint, shared", "nothing")


def test_a_row_that_is_named_whole_is_flown_without_those_that_contain_its_name() -> None:
    names = ("bias5", "walls", "walls_bias5", "tags_4_bias5")
    assert chosen(names, ["bias5"]) == ["bias5"]
    assert chosen(names, ["bias5", "walls_"]) == ["bias5", "walls_bias5"]
    assert chosen(names, ["bias"]) == ["bias5", "walls_bias5", "tags_4_bias5"]
    assert chosen(names, [""]) == list(names)
