"""What the field world's rows say of pairs, and that what was flown is kept to the last digit."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from field_flights import FLOWN

from backend.cli.field_missions import FieldMission
from tests.benchmarks import field_world

SETTING = field_world.Setting()


def row(*times: float) -> dict[int, FieldMission]:
    return {seed: replace(FLOWN, seed=seed, time_s=time_s) for seed, time_s in enumerate(times)}


@pytest.fixture(autouse=True)
def _recorded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "widening.json"
    path.write_text(json.dumps({"figures": [{"name": f"A wedge: {field_world.WIDENING}{SETTING.name}", "value": 1.7}]}))
    monkeypatch.setattr(field_world, "WIDENINGS", path)


def test_rows_are_compared_mission_by_mission() -> None:
    found = {"whole": row(300.0, 100.0), "sector": row(280.0, 70.0), "widened": row(310.0, 120.0)}
    longer, half = field_world.paired(found["sector"], found["whole"])
    assert longer == pytest.approx(-25.0)
    assert half == pytest.approx(1.96 * 5.0)
    assert dict(zip((c.name for c in field_world.COLUMNS), field_world.row(SETTING, "sector", found), strict=True))[
        "localized in 400 s, %"
    ] == pytest.approx(100.0)
    judged = [figure for figure in field_world.figures({SETTING: found}, {}) if figure.wanted is not None]
    assert [(figure.value, figure.met) for figure in judged] == [(40.0, True)], "ahead of the widened wedge"


def test_claims_of_new_missions_are_counted_on_all_their_seeds() -> None:
    beyond = replace(FLOWN, seed=3, error_m=100.0, stated_m=10.0, in_c95=False)
    more = row(200.0, 250.0, 450.0) | {3: beyond}
    found = field_world.figures({SETTING: {"swings": row(200.0, 250.0)}}, {SETTING: {"swings": more}})
    told = {figure.name.split(": ")[1]: figure.value for figure in found if figure.name.startswith("field world")}
    assert told == {"localized in 400 s": 75.0, "truth in C95 at the claim": 75.0, "error beyond 3 x stated": 25.0}
    assert "2 missions" in next(figure.note for figure in found if figure.name.startswith("time until the claim"))


def test_what_was_kept_is_not_flown_again(tmp_path: Path) -> None:
    for mission in row(200.0, 300.0).values():
        field_world._keep(tmp_path, SETTING, "whole", mission)
    assert field_world.flown(["whole"], [SETTING], range(2), tmp_path) == {SETTING: {"whole": row(200.0, 300.0)}}


def test_a_row_that_was_broken_off_leaves_the_pairs_that_all_have(tmp_path: Path) -> None:
    for name, missions in (("whole", row(200.0, 300.0, 250.0)), ("sector", row(190.0, 280.0))):
        for mission in missions.values():
            field_world._keep(tmp_path, SETTING, name, mission)
    found = field_world.flown(["whole", "sector", "swings"], [SETTING], range(3), tmp_path, told=True)
    assert found == {SETTING: {"whole": row(200.0, 300.0), "sector": row(190.0, 280.0)}}


def test_settings_are_each_antenna_with_each_compass() -> None:
    names = [one.name for one in field_world.settings_of("0,sd", "yagi,wide")]
    assert names == ["yagi, compass 0", "yagi, compass sd 4", "wide, compass 0", "wide, compass sd 4"]
    assert field_world.Setting(8.0, "wide").options("sector").compass_deg == 8.0


def test_the_widened_wedge_is_the_wedge_with_the_factor_of_its_setting() -> None:
    assert SETTING.options("widened") == SETTING.options("wedge*1.7") != SETTING.options("wedge")


def test_a_setting_in_which_no_wedge_was_widened_goes_without(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = field_world.Setting(8.0, "wide")
    for one, name in ((SETTING, "whole"), (SETTING, "widened"), (other, "whole")):
        field_world._keep(tmp_path, one, name, FLOWN)
    found = field_world.flown(["whole", "widened"], [SETTING, other], range(FLOWN.seed, FLOWN.seed + 1), tmp_path)
    assert [list(rows) for rows in found.values()] == [["whole", "widened"], ["whole"]]
    assert "widened is left out: no wedge as wide as true is recorded for wide, compass 8" in capsys.readouterr().err
