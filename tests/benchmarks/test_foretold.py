"""What plans said beside what followed."""

from dataclasses import replace
from pathlib import Path

import pytest
from field_flights import FLOWN

from tests.benchmarks import field_world, foretold

SETTING = field_world.Setting(None, "yagi")
SAID = replace(FLOWN, time_s=100.0, foretold=((0, 0.0, 125.0, 180.0), (1, 40.0, 50.0, 55.0), (1, 70.0, 99.0, 99.0)))


def test_the_first_plan_with_so_many_bearings_is_held_against_what_followed() -> None:
    late = replace(SAID, localized=False)
    slower = replace(SAID, time_s=150.0)
    rows = foretold.rows_of(SETTING, "swings", [SAID, slower, late])
    assert rows == [
        ("sd 4", "yagi", "swings", 0, 2, 125.0, 125.0, 1.0, 25.0, 100.0),
        ("sd 4", "yagi", "swings", 1, 2, 50.0, 85.0, 1.7, 35.0, 0.0),
    ]
    assert {figure.value for figure in foretold.figures(rows)} == {1.0, 100.0, 1.7, 0.0}
    assert foretold.figures(foretold.rows_of(SETTING, "whole", [SAID])) == []


def test_missions_that_were_kept_are_told_as_they_were_flown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for seed in (7, 8):
        field_world._keep(tmp_path, SETTING, "swings", replace(SAID, seed=seed))
    assert field_world._kept(tmp_path, SETTING, "swings")[8] == replace(SAID, seed=8)
    asked = ["x", "--told", "--seed", "7", "--missions", "2", "--rows", "swings", "--pieces", str(tmp_path)]
    monkeypatch.setattr("sys.argv", asked)
    foretold.main()
    assert "| sd 4 | yagi | swings | 1 | 2 | 50 | 60 | 1.20 | 10 | 0 |" in capsys.readouterr().out


def test_a_mission_keeps_what_its_plans_said() -> None:
    study = field_world.FieldStudy.of(field_world.ROWS["swings"])
    mission = study.fly(1)
    assert [plan[0] for plan in mission.foretold] == sorted(plan[0] for plan in mission.foretold)
    assert mission.foretold[0][:2] == (0, 0.0)
    assert all(mean <= in_90 for *_, mean, in_90 in mission.foretold)
    assert study.fly(1).foretold == mission.foretold
