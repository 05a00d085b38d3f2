from __future__ import annotations

from tests.benchmarks.campaign import verdicts
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.reader import read_all
from tests.benchmarks.figures.writer import wanted, write


def found(tmp_path, *figures):
    write(tmp_path, "some", "Some", begin(__file__), list(figures), page="user-guide.md")
    return read_all(tmp_path)


def test_a_figure_that_is_missed_or_not_measured_is_said(tmp_path):
    records = found(tmp_path, wanted("abort", 150.0), wanted("fanout", 20.0))
    lines = verdicts(records, ["abort", "fanout", "fanout_memory"], 1.0)
    assert [met for met, _ in lines] == [False, True, False]
    assert "MISSED" in lines[0][1]
    assert "not measured" in lines[2][1]


def test_effort_is_wanted_in_the_share_of_the_run_and_nothing_else_is(tmp_path):
    records = found(tmp_path, wanted("kills", 10), wanted("kill_lost", 1))
    lines = verdicts(records, ["kills", "kill_lost"], 0.01)
    assert [met for met, _ in lines] == [True, False]
    assert "share of 1000" in lines[0][1]
    assert [met for met, _ in verdicts(records, ["kills"], 1.0)] == [False]
