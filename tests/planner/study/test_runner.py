import signal
import subprocess
import sys
import time

import pandas as pd
import pytest

from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.runner import fly_block, run_cell

CELL = Cell(planner="vander_hook")


def test_a_broken_off_study_goes_on_with_what_is_missing(tmp_path):
    told: list[int] = []
    first = run_cell(CELL, 4, tmp_path, progress=told.append)
    assert sum(told) == 4
    told.clear()
    second = run_cell(CELL, 6, tmp_path, progress=told.append)
    assert told[0] == 4
    assert sum(told) == 6
    pd.testing.assert_frame_equal(second.head(4), first)
    pd.testing.assert_frame_equal(run_cell(CELL, 6, tmp_path / "afresh"), second)


@pytest.mark.slow
def test_a_study_killed_half_way_ends_with_the_rows_of_one_that_was_not(tmp_path):
    killed, runs = tmp_path / "killed", 3000
    program = (
        "import pathlib, sys\n"
        "from planner.study import runner\n"
        "from planner.study.cell import Cell\n"
        "runner.WRITE_EVERY, runner.BLOCK_SECONDS = 0.0, 0.02\n"
        f"runner.run_cell(Cell(planner='vander_hook'), {runs}, pathlib.Path(sys.argv[1]))\n"
    )
    study = subprocess.Popen([sys.executable, "-c", program, str(killed)])
    file = killed / f"{CELL.name()}.parquet"
    while not file.exists():
        assert study.poll() is None
        time.sleep(0.01)
    study.kill()
    assert study.wait() == -signal.SIGKILL
    flown = len(pd.read_parquet(file))
    assert 0 < flown < runs
    whole = run_cell(CELL, flown + 5, killed)
    pd.testing.assert_frame_equal(whole, run_cell(CELL, flown + 5, tmp_path / "afresh"))


def test_fewer_runs_are_a_beginning_of_more(tmp_path):
    six = run_cell(CELL, 6, tmp_path)
    pd.testing.assert_frame_equal(run_cell(CELL, 2, tmp_path), six.head(2))


def test_processes_change_nothing(tmp_path):
    alone = run_cell(CELL, 8, tmp_path / "one")
    together = run_cell(CELL, 8, tmp_path / "two", workers=2)
    pd.testing.assert_frame_equal(alone, together)


def test_a_dask_cluster_changes_nothing(tmp_path):
    from distributed import LocalCluster

    cluster = LocalCluster(
        n_workers=1,
        threads_per_worker=1,
        processes=False,
        protocol="tcp://",
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
    )
    with cluster:
        on_dask = run_cell(CELL, 5, tmp_path / "dask", scheduler=cluster.scheduler_address)
    pd.testing.assert_frame_equal(on_dask, run_cell(CELL, 5, tmp_path / "here"))


def test_a_scheduler_that_does_not_answer_is_named(tmp_path, monkeypatch):
    def refuse(address, timeout):
        raise OSError(f"timed out connecting to {address}")

    monkeypatch.setattr("distributed.Client", refuse)
    with pytest.raises(StudyError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        run_cell(CELL, 3, tmp_path, scheduler="tcp://127.0.0.1:9")


def test_rollout_missions_repeat_themselves_with_their_seed():
    cell = Cell(planner="rollout", budget=700, actions="10x10")
    assert fly_block(cell, [0, 1]) == fly_block(cell, [0, 1])
    other = fly_block(Cell(planner="rollout", budget=700, actions="10x10", seed=2), [0])
    assert other[0].target_x != fly_block(cell, [0])[0].target_x


def test_torn_or_foreign_results_are_refused(tmp_path):
    (tmp_path / f"{CELL.name()}.parquet").write_bytes(b"not parquet")
    with pytest.raises(StudyError, match="cannot hold results"):
        run_cell(CELL, 1, tmp_path)


@pytest.mark.parametrize(("runs", "workers"), [(0, 1), (1, 0)])
def test_refuses_nothing_to_do(tmp_path, runs, workers):
    with pytest.raises(StudyError, match="1 or more"):
        run_cell(CELL, runs, tmp_path, workers=workers)
