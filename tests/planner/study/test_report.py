import pytest
from matplotlib.image import imread

from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.figures import FIGURES
from planner.study.report import cell_of, report
from planner.study.runner import run_cell

CELLS = [
    Cell(scenario="1", planner="base"),
    Cell(planner="vander_hook"),
    Cell(planner="vander_hook", config="slow"),
    *(Cell(planner="rollout", budget=budget, actions="6x6") for budget in (250, 500)),
    Cell(planner="rollout", budget=500, actions="8x8"),
]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    directory = tmp_path_factory.mktemp("results")
    frames = {cell: run_cell(cell, 12, directory) for cell in CELLS}
    return directory, frames


@pytest.mark.slow
def test_every_figure_is_drawn_and_every_cell_summed_up(results, tmp_path):
    directory, frames = results
    remarks: list[str] = []
    summaries, drawn = report(directory, tmp_path / "figures", remarks.append, paths=10)
    assert {s.cell for s in summaries} == set(CELLS)
    for summary in summaries:
        assert summary.mean_s == pytest.approx(frames[summary.cell]["time"].mean())
    assert remarks == []
    assert {path.stem for path in drawn} == set(FIGURES)
    for path in drawn:
        assert imread(path).std() > 0.01


def test_figures_without_data_are_named(tmp_path):
    run_cell(CELLS[0], 3, tmp_path / "results")
    remarks: list[str] = []
    _, drawn = report(tmp_path / "results", tmp_path / "figures", remarks.append, paths=10)
    assert {path.stem for path in drawn} == {"time_by_target", "courses"}
    assert len(remarks) == len(FIGURES) - 2


def test_a_cell_survives_its_file(results):
    _, frames = results
    for cell, frame in frames.items():
        assert cell_of(frame) == cell


def test_an_empty_directory_is_refused(tmp_path):
    with pytest.raises(StudyError, match="no study results"):
        report(tmp_path, tmp_path / "figures", print)
