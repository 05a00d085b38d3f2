"""What is kept of a planner study's missions: nothing flown twice, nothing counted that has a gap before it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from planner.study.cell import Cell
from planner.study.mission import Mission
from planner.study.table import summarize
from tests.benchmarks import study_pieces
from tests.benchmarks.studies import figures, flown_in_pieces, row
from tests.benchmarks.study_cells import STUDIES
from tests.benchmarks.study_pieces import missions_of

CELL = Cell(planner="vander_hook")
MISSION = Mission(0, 0, 50.0, 100.0, 2, True, 3.0, 4.0, True, 1.0, 2.0, float("nan"), float("nan"), 60.0, 7)


@pytest.fixture
def flown(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """Configuration and number of each mission that was flown; mission k takes k s. Pieces of ten missions."""
    found: list[tuple[str, int]] = []

    def fly_block(cell: Cell, runs: list[int]) -> list[Mission]:
        found.extend((cell.config, run) for run in runs)
        return [replace(MISSION, run=run, time=float(run)) for run in runs]

    monkeypatch.setattr(study_pieces.runner, "fly_block", fly_block)
    monkeypatch.setattr(study_pieces, "PIECE", 10)
    return found


def test_a_study_that_broke_off_goes_on_where_it_was(flown: list[tuple[str, int]], tmp_path: Path) -> None:
    missions_of(CELL, 20, tmp_path, "one")
    missions, commits = missions_of(CELL, 40, tmp_path, "two")
    assert flown == [("medium", run) for run in range(40)]
    assert missions["run"].tolist() == list(range(40))
    assert summarize(CELL, missions).mean_s == 19.5
    assert commits == {"one", "two"}


def test_missions_count_up_to_the_first_gap(flown: list[tuple[str, int]], tmp_path: Path) -> None:
    missions_of(CELL, 40, tmp_path, "one")
    (tmp_path / f"{CELL.name()}-20-29.json").unlink()
    assert missions_of(CELL, 10, tmp_path, "one")[0]["run"].tolist() == list(range(20))
    assert len(flown) == 40


def test_a_last_piece_may_be_short(flown: list[tuple[str, int]], tmp_path: Path) -> None:
    assert len(missions_of(CELL, 13, tmp_path, "one")[0]) == 13
    assert len(missions_of(CELL, 20, tmp_path, "one")[0]) == 20
    assert len(flown) == 23


def test_what_was_broken_off_while_it_was_written_is_flown_again(
    flown: list[tuple[str, int]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, target: Path) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(OSError, match="space"):
        missions_of(CELL, 10, tmp_path, "one")
    monkeypatch.undo()
    assert not list(tmp_path.glob("*.json"))


def test_processes_fly_the_same_missions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_pieces, "PIECE", 2)
    alone, _ = missions_of(CELL, 4, tmp_path / "one", "one")
    together, _ = missions_of(CELL, 4, tmp_path / "two", "one", workers=2)
    pd.testing.assert_frame_equal(alone, together)


def test_cells_that_are_not_flown_now_count_with_what_is_kept(flown: list[tuple[str, int]], tmp_path: Path) -> None:
    runs_of = {cell: 20 for cell, _ in STUDIES["times"].cells}
    flown_in_pieces(runs_of, ["slow"], tmp_path, "one", 1)
    found, remark = flown_in_pieces(runs_of, ["fast"], tmp_path, "two", 1)
    assert flown == [("slow", run) for run in range(20)] + [("fast", run) for run in range(20)]
    assert [(summary.cell.config, summary.runs) for summary, _ in found] == [("fast", 20), ("slow", 20)]
    assert remark == "flown by one, two"
    made = figures("times", found, 1.0, 1)
    assert [figure.wanted.key for figure in made if figure.wanted] == ["s2_fast", "s2_slow"]
    assert len(row(*found[0])) == len(row(*found[1]))
