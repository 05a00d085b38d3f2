"""Whether a battery lasts for the first turn, on doubles: who is refused, who is cautioned, who need not be asked."""

from __future__ import annotations

from dataclasses import replace

import pytest
from equipment import FRAME, HOME, TWO_EMITTERS, spec
from stage import Stage

from backend.craft import checklist as module
from backend.craft import first_turn as asked
from backend.craft.checklist import checklist, task_at
from backend.craft.first_turn import FirstTurn, first_turn
from backend.craft.safety import Limits, Situation, limits_of, place_vetoes
from backend.events import CheckFact, MissionDrafted
from backend.reasons import checks, safety
from backend.search.choosing import choose_place
from backend.search.state import SearchState, evolve
from backend.search.task import SearchTask
from backend.spec import MissionSpec, Polygon


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "RECEIVER_WALL_S", 0.2)


def area_of(west: float, south: float, east: float, north: float) -> Polygon:
    ring = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    return Polygon(coordinates=[[(p.lon, p.lat) for p in (FRAME.to_geo(x, y) for x, y in ring)]])


def away(north_m: float, **flight: object) -> MissionSpec:
    """An area of 200 x 100 m that begins so far north of home, in a fence that holds both."""
    fence = area_of(-140.0, -40.0, 140.0, north_m + 140.0)
    found = spec(fence=fence, **flight)  # type: ignore[arg-type]
    return found.model_copy(update={"area": area_of(-100.0, north_m, 100.0, north_m + 100.0)})


def knowing(mission: MissionSpec) -> SearchState:
    return evolve(SearchState(), MissionDrafted(spec=mission), 0.0)


async def of_battery(mission: MissionSpec, charge: float = 95.0) -> list[CheckFact]:
    """The lines about safety and battery, with what is known before the start."""
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=charge)
    lines, _ = await checklist(mission, stage.craft(), None, search=knowing(mission))
    return [line for line in lines if line.name in ("safety", "battery")]


def found(mission: MissionSpec, charge: float = 95.0) -> tuple[FirstTurn, SearchTask, Limits, Situation]:
    stage = Stage()
    telemetry = replace(stage.vehicle.state, battery_percent=charge)
    task, _ = task_at(mission, telemetry, None)
    assert task is not None
    limits, situation = limits_of(task), Situation(telemetry, 0.0)
    return first_turn(task, knowing(mission), limits, situation, 1), task, limits, situation


async def test_an_area_that_no_battery_reaches_is_refused_with_what_mends_it() -> None:
    (line,) = await of_battery(away(800.0))
    assert (line.name, line.ok, line.blocking) == ("safety", False, True)
    assert isinstance(line.reason, safety.FirstTurnBeyondBattery)
    assert line.reason.far_m > 800.0
    assert line.reason.takes_percent + line.reason.needed_percent + line.reason.reserve_percent > 100.0


async def test_an_area_that_a_full_battery_reaches_is_refused_to_this_charge() -> None:
    (line,) = await of_battery(away(250.0), 60.0)
    assert isinstance(line.reason, safety.FirstTurnBeyondCharge)
    reason = line.reason
    assert reason.charge_percent - reason.takes_percent < reason.needed_percent + reason.reserve_percent
    assert all(line.ok or not line.blocking for line in await of_battery(away(250.0), 95.0))


async def test_where_only_wind_makes_it_too_far_it_is_a_caution() -> None:
    charges = [95.0 - step for step in range(60)]
    verdicts = [(charge, found(away(250.0), charge)[0]) for charge in charges]
    kinds = ["refused" if v.refusal else "caution" if v.caution else "quiet" for _, v in verdicts]
    assert kinds == sorted(kinds, key=["quiet", "caution", "refused"].index), "the lower the charge, the more is said"
    assert set(kinds) == {"quiet", "caution", "refused"}
    cautious = [charge for (charge, _), kind in zip(verdicts, kinds, strict=True) if kind == "caution"]
    safe, *cautions = await of_battery(away(250.0), max(cautious))
    assert safe.ok
    assert [type(line.reason) for line in cautions] == [checks.FirstTurnInLittleWind]
    assert not cautions[0].blocking


@pytest.mark.parametrize("charge", [30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 95.0])
@pytest.mark.parametrize("north_m", [0.0, 100.0, 250.0, 400.0])
@pytest.mark.parametrize("emitters", [1, 2])
def test_it_is_refused_where_the_flights_own_rule_would_end_it_and_nowhere_else(
    charge: float, north_m: float, emitters: int
) -> None:
    mission = away(north_m)
    mission = mission.model_copy(update={"emitters": list(TWO_EMITTERS[:emitters])})
    said, task, limits, situation = found(mission, charge)
    climb = situation.endurance.likely_percent(limits.altitude_relative_m / 2.0)
    flies = replace(
        situation.telemetry, in_air=True, armed=True, battery_percent=charge - climb, altitude_relative_m=40.0
    )
    place = choose_place(task, knowing(mission), (0.0, 0.0), 1, 0.0, 1).place
    vetoes = place_vetoes(limits, replace(situation, telemetry=flies), place, task.altitude_at(place))
    assert (said.refusal is not None) == any(isinstance(veto, safety.BatteryShort) for veto in vetoes)


def test_around_a_no_fly_area_the_way_is_as_long_as_it_is_flown() -> None:
    wall = area_of(-100.0, 120.0, 135.0, 140.0)
    straight, round_it = found(away(250.0), 70.0)[0], found(away(250.0, no_fly=[wall]), 70.0)[0]
    assert straight.refusal is None
    assert isinstance(round_it.refusal, safety.FirstTurnBeyondCharge)


async def test_an_area_that_no_way_leads_to_is_refused() -> None:
    """It took off, found nothing to plan, and came home."""
    across = area_of(-141.0, 20.0, 141.0, 30.0)
    (line,) = await of_battery(away(100.0, no_fly=[across]))
    assert (line.name, line.ok, line.blocking) == ("safety", False, True)
    left_open = area_of(-141.0, 20.0, 100.0, 30.0)
    assert all(line.ok for line in await of_battery(away(100.0, no_fly=[left_open])))


async def test_a_near_area_is_not_planned_for(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> None:
        raise AssertionError("nobody needs to know where it turns first")

    monkeypatch.setattr(asked, "choose_place", never)
    (line,) = await of_battery(spec())
    assert line.ok


async def test_of_a_vehicle_that_reports_no_battery_nothing_is_asked() -> None:
    mission = away(800.0, battery_telemetry=False)
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=None)
    lines, task = await checklist(mission, stage.craft(), None, search=knowing(mission))
    assert task is not None
    assert task.home == HOME
    assert all(line.ok or not line.blocking for line in lines)
