from __future__ import annotations

from tests.benchmarks import campaign
from tests.benchmarks.campaign import Ran, Step, of_failures, run, verdicts
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.reader import read_all
from tests.benchmarks.figures.writer import wanted, write


def found(tmp_path, *figures):
    write(tmp_path, "some", "Some", begin(__file__), list(figures), page="user-guide.md")
    return read_all(tmp_path)


def standings(records, keys, scale):
    return [verdict.standing for verdict in verdicts(records, keys, scale)]


def test_a_figure_that_is_missed_or_not_measured_is_said(tmp_path):
    records = found(tmp_path, wanted("abort", 150.0), wanted("fanout", 20.0))
    said = verdicts(records, {"abort": False, "fanout": False, "fanout_memory": False}, 1.0)
    assert [verdict.standing for verdict in said] == ["MISSED", "met", "MISSED"]
    assert "not measured" in said[2].line


def test_effort_is_wanted_in_the_share_of_the_run_and_nothing_else_is(tmp_path):
    records = found(tmp_path, wanted("kills", 10), wanted("kill_lost", 1))
    lines = verdicts(records, {"kills": False, "kill_lost": False}, 0.01)
    assert [verdict.standing for verdict in lines] == ["met", "MISSED"]
    assert "share of 1000" in lines[0].line
    assert standings(records, {"kills": False}, 1.0) == ["MISSED"]


def test_a_busy_machine_excuses_a_time_and_never_a_loss(tmp_path):
    records = found(tmp_path, wanted("abort", 150.0), wanted("kill_lost", 1))
    assert standings(records, {"abort": True, "kill_lost": True, "restart": True}, 1.0) == [
        "undecided",
        "MISSED",
        "undecided",
    ]


def test_a_benchmark_that_fails_is_a_defect_unless_its_figure_says_why(tmp_path):
    step, failed = Step("aborts", (), ("abort",)), Ran(1, 9.0, 0.0, "")
    missed = verdicts(found(tmp_path, wanted("abort", 150.0)), {"abort": False}, 1.0)
    assert not of_failures([(step, failed)], missed)
    met = verdicts(found(tmp_path, wanted("abort", 15.0)), {"abort": False}, 1.0)
    assert [verdict.standing for verdict in of_failures([(step, failed)], met)] == ["MISSED"]
    assert not of_failures([(step, Ran(0, 9.0, 0.0, ""))], met)


def test_a_step_that_hangs_is_ended_with_all_that_it_started(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, "LOOK_S", 0.05)
    child = "import subprocess, sys; subprocess.run([sys.executable, '-c', 'import time; time.sleep(600)'])"
    (tmp_path / "hangs.py").write_text(child)
    hangs = Step("hangs", ("hangs",), environment={"PYTHONPATH": str(tmp_path)}, within_s=0.5)
    ran = run(hangs, tmp_path / "log")
    assert ran.status is None
    assert "hung" in ran.how
    assert run(Step("says", ("this",)), tmp_path / "log").said.startswith("The Zen")
