"""What the benchmarks make of their findings: wanted figures with the right bound, rows that fit their columns."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from planner.study.table import summarize
from tests.benchmarks import joint_speed, live_load, storage_faults, studies, takeover
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pieces import numbers, rows_kept
from tests.benchmarks.figures.reader import read
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import write
from tests.benchmarks.kill_findings import Findings, figures, runs
from tests.benchmarks.study_cells import STUDIES

FANOUT = {
    "seconds": 600.0,
    "messages": 599_000,
    "expected": 600_000,
    "p50_ms": 21.0,
    "p99_ms": 265.04,
    "max_ms": 749.0,
    "dropped_at_most": 1,
    "event_gaps": 0,
    "broken_viewers": 0,
    "server_cpu_share": 0.08,
    "server_rss_mb": [197.0, 197.3, 197.9],
}
STORED = {
    "facts_during": 486,
    "bearings_during": 56,
    "most_entries_waiting": 761,
    "facts_shown": 542,
    "facts_stored": 542,
    "lost_doubled_or_changed": 0,
    "bearings_without_sweep": 0,
}


def met(found: list[Figure]) -> dict[str, bool | None]:
    """By the key of what is wanted."""
    return {figure.wanted.key: figure.met for figure in found if figure.wanted is not None}


def test_the_fan_out_is_judged_by_its_p99_and_the_growth_of_memory() -> None:
    found = live_load.fanout_figures(FANOUT)
    assert met(found) == {"fanout": False, "fanout_memory": True}
    assert [figure.value for figure in found[:2]] == [265.0, 0.46]


@pytest.mark.parametrize(("joint_ms", "right"), [(30.0, True), (31.0, False)])
def test_a_plan_on_the_joint_belief_may_take_twice_one_on_the_plain_belief(joint_ms: float, right: bool) -> None:
    assert met([joint_speed.over_plain(joint_ms, 15.0, count=3)]) == {"joint_plan_3600": right}


def test_aborts_are_judged_by_their_p99() -> None:
    told = {"receipt_to_vehicle_p50_ms": 10.0, "receipt_to_vehicle_p99_ms": 57.0, "receipt_to_vehicle_max_ms": 71.0}
    found = live_load.abort_figures(
        told | {"answer_median_ms": 12.0, "aborts": 60, "in": {"flying": 47, "planning": 13}}
    )
    assert met(found) == {"abort": True}
    assert [figure.name for figure in found[-2:]] == ["aborted while flying", "aborted while planning"]


@pytest.mark.parametrize(("latest_ms", "right"), [(0.0, True), (200.0, True), (201.0, False)])
def test_a_takeover_allows_200_ms(latest_ms: float, right: bool) -> None:
    told = {"flavour": "px4", "takeovers": 50, "with_a_command_afterwards": 1, "in": {"flying": 50}}
    assert met(takeover.figures(told | {"latest_command_ms": latest_ms})) == {"takeover": right}


def test_a_database_away_for_ten_minutes_may_lose_nothing() -> None:
    outage = storage_faults.outage_figures(STORED | {"away_minutes": 10.0, "drained_after_s": 12.0})
    assert met(outage) == {"outage_minutes": True, "outage_lost": True}
    full = storage_faults.full_disk_figures(STORED | {"warned_after_s": 2.1, "lost_doubled_or_changed": 1})
    assert met(full) == {"disk_full": False, "disk_full_lost": False}


@pytest.mark.parametrize(
    ("load_before", "start"),
    [
        (0.4, {"start_idle": False, "hold_order_idle": True}),
        (5.0, {}),
        (14.0, {"start_loaded": True, "hold_order_loaded": True}),
    ],
)
def test_the_bound_of_a_whole_start_is_that_of_the_machines_load(load_before: float, start: dict[str, bool]) -> None:
    found = Findings(kills=30, hold_s={"forked": [0.8, 0.9], "whole": [3.0, 3.2]}, told_s={"whole": [1.5, 1.9]})
    kept = {"kills": False, "kill_lost": True, "kill_beliefs": True, "restart": True}
    assert met(figures(found, runs(found, begin(__file__), 3), "SQLite", load_before)) == kept | start


def test_a_loop_of_kills_is_a_row_whether_or_not_it_had_whole_starts() -> None:
    for whole in ([], [3.0]):
        table = runs(Findings(kills=2, hold_s={"forked": [0.8, 0.9], "whole": whole}), begin(__file__), 3)
        assert numbers(table, "whole starts") == [len(whole)]


def test_kills_of_several_runs_count_together(tmp_path: Path) -> None:
    begun = begin(__file__)
    early, late = Findings(kills=600, hold_s={"forked": [4.0], "whole": []}), Findings(kills=400, lost=1)
    for found, seed in ((early, 3), (late, 4)):
        table = rows_kept(tmp_path, "kill_sqlite", runs(found, begun, seed))
        made = figures(found, table, "SQLite", 5.0)
        write(tmp_path, "kill_sqlite", "Kill -9", begun, made, tables=[table])
    assert met(list(read(tmp_path / "kill_sqlite.json").figures)) == {
        "kills": True,
        "kill_lost": False,
        "kill_beliefs": True,
        "restart": True,
    }
    with pytest.raises(ValueError, match="seed 4"):
        rows_kept(tmp_path, "kill_sqlite", runs(late, begun, 4))


def missions(time_s: float, runs: int) -> pd.DataFrame:
    row = {"time": time_s, "bearings": 2, "travel": 100.0, "localized": True, "in_c95": True, "error": 3.0}
    return pd.DataFrame([row | {"target_y": float(25 * k), "planning_rollouts": 7000} for k in range(runs)])


def test_a_cell_beside_the_thesis_counts_when_no_reading_explains_it() -> None:
    flown = [(summarize(cell, missions(1.0, 3)), missions(1.0, 3)) for cell, _ in STUDIES["table_4_2"].cells]
    found = studies.figures("table_4_2", flown, 1.0, 2)
    assert (found[0].value, found[0].met) == (9, False), "fifteen cells, six of them of planners that are explained"
    assert len(studies.row(*flown[0])) == len(studies.COLUMNS)
    assert [studies.row(*one)[6] for one in flown] == ["*"] * 15


def test_each_time_to_localization_has_its_bound() -> None:
    flown = [(summarize(cell, missions(100.0, 3)), missions(100.0, 3)) for cell, _ in STUDIES["times"].cells]
    times = met(studies.figures("times", flown, 1.0, 2))
    assert times == {"s2_fast": False, "s2_medium": False, "s2_slow": True, "s3_medium": False, "field_medium": True}


def test_the_speed_of_a_study_is_that_of_all_its_missions() -> None:
    cell = STUDIES["speed"].cells[0][0]
    few = replace(summarize(cell, missions(57.0, 3)), runs=200)
    assert studies.figures("speed", [(few, missions(57.0, 3))], 0.2, 2)[0].value == 20.0


def test_scenario_1_is_shown_by_target() -> None:
    flown = [(summarize(cell, missions(80.0, 3)), missions(80.0, 3)) for cell, _ in STUDIES["scenario_1"].cells]
    table = studies.by_target(flown)
    assert [column.name for column in table.columns] == ["planner", "0", "25", "50"]
    assert table.rows[-1] == ("base", 80.0, 80.0, 80.0)
