import pandas as pd
import pytest

from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.mission import Mission
from planner.study.store import CODE, COLUMNS, Results, read_results

CELL = Cell(planner="rollout", budget=500)


def mission(run):
    return Mission(run, 0, 60.0 + run, 200.0, 2, True, 3.0, 4.0, True, 150.0, 150.0, 200.0, 140.0, 58.0, 500)


def test_rows_are_tidy_and_know_their_cell(tmp_path):
    results = Results(tmp_path, CELL)
    results.add([mission(2), mission(0)])
    frame = pd.read_parquet(results.path)
    assert frame["run"].tolist() == [0, 2]
    assert set(COLUMNS) | set(CELL.fields()) | {CODE} == set(frame.columns)
    assert frame["budget"].tolist() == [500, 500]
    assert not list(tmp_path.glob("*.partial"))


def test_what_is_missing_is_known_after_a_restart(tmp_path):
    Results(tmp_path, CELL).add([mission(2), mission(0)])
    again = Results(tmp_path, CELL)
    assert again.missing(5) == [1, 3, 4]
    again.add([mission(1)])
    assert Results(tmp_path, CELL).missing(3) == []
    assert len(again.frame(2)) == 2


def test_all_cells_of_a_directory_are_read_and_told_apart(tmp_path):
    for cell in (CELL, Cell(planner="base"), Cell(planner="base", scenario="1")):
        Results(tmp_path, cell).add([mission(0), mission(1)])
    results = read_results(tmp_path)
    assert results.groupby("cell").size().tolist() == [2, 2, 2]
    assert set(results["scenario"]) == {"1", "2"}


def test_a_file_of_another_kind_is_refused(tmp_path):
    results = Results(tmp_path, CELL)
    pd.DataFrame({"run": [1]}).to_parquet(results.path)
    with pytest.raises(StudyError, match="lacks the columns"):
        Results(tmp_path, CELL)


def test_a_directory_that_cannot_be_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StudyError, match="choose another directory"):
        Results(tmp_path / "file", CELL)


def test_missions_of_another_planner_do_not_count(tmp_path):
    results = Results(tmp_path, CELL)
    results.add([mission(0), mission(1)])
    frame = pd.read_parquet(results.path)
    frame.loc[0, CODE] = "another"
    frame.to_parquet(results.path)
    again = Results(tmp_path, CELL)
    assert again.stale == 1
    assert again.missing(2) == [0]
