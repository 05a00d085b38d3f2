"""The checklist on doubles: what refuses a start, and what only says so."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import replace

import numpy as np
import pytest
from equipment import TWO_EMITTERS, HummingReceiver, spec
from facts import CHECK
from relief import hill, level, terrain
from stage import Stage

from backend.craft import checklist as module
from backend.craft.checklist import checklist, home_of
from backend.craft.listening import Listening, channels_of
from backend.events import CheckFact
from backend.reasons import checks, refusals, safety, search
from backend.reasons import terrain as terrain_reasons
from backend.spec import EmitterSpec, MissionSpec, Polygon
from backend.terrain import Terrain
from hardware.frame import LocalFrame
from hardware.readings import CheckName, Place, PowerSample, ReturnAltitude
from hardware.reasons.receiver import ReceiverUnplugged, SamplesLost
from planner.reason import remedy_of, text_of


async def checked(stage: Stage, mission: MissionSpec | None = None) -> dict[CheckName, CheckFact]:
    found, _ = await checklist(mission or spec(), stage.craft(), None)
    return {check.name: check for check in found}


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "RECEIVER_WALL_S", 0.2)


async def test_a_vehicle_that_stands_ready_passes_every_check() -> None:
    found, task = await checklist(spec(), Stage().craft(), None)
    assert [check.name for check in found if not check.ok] == ["terrain"]
    names = {check.name for check in found}
    assert names == {"vehicle_link", "failsafe", "area", "terrain", "nets", "safety", "receiver", "pattern"}
    assert task is not None


async def test_the_check_of_the_antenna_stays_in_the_list() -> None:
    antenna = CHECK.model_copy(update={"name": "antenna"})
    found, _ = await checklist(spec(), Stage().craft(), None, antenna)
    assert antenna in found


@pytest.mark.parametrize(
    ("altitude", "ok", "blocking"), [(0.0, True, True), (120.0, True, True), (121.0, False, True), (None, False, True)]
)
async def test_the_autopilots_own_return_stays_below_the_missions_ceiling(
    altitude: float | None, ok: bool, blocking: bool
) -> None:
    stage = Stage()
    stage.vehicle.returns_at = ReturnAltitude("RTL_ALT", altitude)
    check = (await checked(stage))["failsafe"]
    assert (check.ok, check.blocking) == (ok, blocking)
    assert "RTL_ALT" in text_of(check.reason)
    assert ok or "120 m" in remedy_of(check.reason)


@pytest.mark.parametrize(
    ("climb", "ok", "told"),
    [
        (0.0, True, checks.ReturnAltitudeChecked("RTL_ALT", 15.0, 120.0)),
        (80.0, True, checks.ReturnAltitudeChecked("RTL_ALT", 15.0, 120.0)),
        (80.5, False, checks.ReturnClimbs("RTL_CLIMB_MIN", 80.5, 40.0, 120.0)),
        (None, False, checks.ReturnAltitudeUnread("RTL_CLIMB_MIN", 120.0)),
    ],
)
async def test_a_return_that_climbs_from_wherever_it_begins_stays_below_the_ceiling(
    climb: float | None, ok: bool, told: object
) -> None:
    stage = Stage()
    stage.vehicle.returns_at = ReturnAltitude("RTL_ALT", 15.0, "RTL_CLIMB_MIN", climb)
    check = (await checked(stage))["failsafe"]
    assert (check.ok, check.blocking, check.reason) == (ok, True, told)
    assert ok or remedy_of(check.reason)


async def test_over_terrain_a_return_may_begin_at_the_ceiling() -> None:
    stage = Stage()
    stage.vehicle.returns_at = ReturnAltitude("RTL_ALT", 15.0, "RTL_CLIMB_MIN", 0.5)
    lines, _ = await checklist(spec(), stage.craft(), None, grounds=Known(terrain(level())))
    assert checks.ReturnClimbs("RTL_CLIMB_MIN", 0.5, 120.0, 120.0) in [line.reason for line in lines]


async def test_a_vehicle_without_a_home_has_no_task() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, position=None, home=None)
    found, task = await checklist(spec(), stage.craft(), None)
    assert task is None
    assert [check.reason for check in found if check.name == "area"] == [refusals.NoHome()]
    assert all(check.name != "safety" for check in found)


async def test_an_area_that_cannot_be_searched_from_here_blocks() -> None:
    nowhere = spec().model_copy(update={"area": Polygon(coordinates=[])})
    area = (await checked(Stage(), nowhere))["area"]
    assert (area.ok, area.blocking, area.reason) == (False, True, search.AreaEmpty("area"))


async def test_what_safety_has_against_the_start_blocks() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=None)
    check = (await checked(stage))["safety"]
    assert (check.ok, check.blocking, check.reason) == (False, True, safety.BatteryUnknown())


async def test_a_receiver_that_is_gone_blocks_and_says_why() -> None:
    stage = Stage()
    stage.receiver.gone = True
    check = (await checked(stage))["receiver"]
    assert (check.ok, check.blocking, check.reason) == (False, True, ReceiverUnplugged())


@pytest.mark.parametrize("flies", [False, True])
async def test_a_receiver_that_loses_samples_is_cautioned_about(flies: bool) -> None:
    stage, mission = Stage(), spec()
    stage.receiver.lost_percent = 12.5
    listening = Listening(stage.receiver, stage.clock, channels_of(mission), 5.0)
    listening.start()
    found, _ = await checklist(mission, stage.craft(), listening if flies else None)
    await listening.stop()
    (check,) = (check for check in found if check.name == "receiver")
    assert (check.ok, check.blocking, check.reason) == (False, False, SamplesLost(12.5))


async def test_a_receiver_is_asked_what_it_loses_once_that_can_be_said() -> None:
    """Its first readings are there after a tenth of a second: seldom has anything got lost by then."""

    class LaterLosing(HummingReceiver):
        async def samples(self) -> AsyncIterator[PowerSample]:
            began_s = self.clock.now()
            async for sample in super().samples():
                self.lost_percent = 10.0 if self.clock.now() > began_s + 1.0 else 0.0
                yield sample

    stage = Stage()
    stage.receiver = LaterLosing(stage.clock)
    check = (await checked(stage))["receiver"]
    assert (check.ok, check.blocking, check.reason) == (False, False, SamplesLost(10.0))


async def test_a_receiver_that_delivers_nothing_blocks() -> None:
    stage = Stage()
    stage.receiver.mute = True
    check = (await checked(stage))["receiver"]
    assert (check.ok, check.blocking, check.reason) == (False, True, checks.NoSamples())


async def test_a_tag_that_is_not_heard_here_does_not_block() -> None:
    stage = Stage()
    stage.receiver.unheard = True
    tag = EmitterSpec(kind="pulsed", pulse_period_s=0.5)
    check = (await checked(stage, spec((tag,))))["receiver"]
    assert (check.ok, check.blocking, check.reason) == (False, False, checks.TagUnheard(tag.frequency_hz))


async def test_what_a_receiver_loses_is_told_before_a_tag_that_is_not_heard_here() -> None:
    stage = Stage()
    stage.receiver.unheard = True
    stage.receiver.lost_percent = 12.5
    check = (await checked(stage, spec((EmitterSpec(kind="pulsed", pulse_period_s=0.5),))))["receiver"]
    assert (check.ok, check.blocking, check.reason) == (False, False, SamplesLost(12.5))


async def test_every_emitter_is_listened_for() -> None:
    stage = Stage()
    check = (await checked(stage, spec(TWO_EMITTERS)))["receiver"]
    assert (check.ok, check.reason) == (True, checks.ReceiverDelivers(2))
    assert stage.receiver.frequencies_hz == [emitter.frequency_hz for emitter in TWO_EMITTERS]


async def test_the_receiver_of_a_mission_that_flies_is_not_opened_again() -> None:
    stage = Stage()
    mission = spec()
    listening = Listening(stage.receiver, stage.clock, channels_of(mission), 5.0)
    found, _ = await checklist(mission, stage.craft(), listening)
    assert stage.receiver.frequencies_hz == []
    assert [check.ok for check in found if check.name == "receiver"] == [True]


def test_home_is_where_the_vehicle_stands_while_the_autopilot_says_none() -> None:
    state = replace(Stage().vehicle.state, home=None, home_amsl_m=None, altitude_amsl_m=140.0, altitude_relative_m=40.0)
    assert home_of(replace(state, in_air=True)) == (state.position, 100.0)
    assert home_of(replace(state, armed=False, in_air=False)) == (state.position, 140.0)


def test_home_is_where_the_vehicle_will_be_armed_and_not_where_it_was_armed_before() -> None:
    """ArduCopter tells of the last flight's home until it is armed elsewhere, PX4 for some seconds; the height is set
    again in any case: a real ArduCopter whose barometer had drifted by 2.8 m was sent 2.8 m too high."""
    before = Place(47.0, 8.0)
    frame = LocalFrame(before)
    state = replace(Stage().vehicle.state, home=before, home_amsl_m=100.0, altitude_amsl_m=97.0, in_air=False)
    carried = replace(state, armed=False, position=frame.to_geo(0.0, 20.0))
    assert home_of(carried) == (carried.position, 97.0)
    assert home_of(replace(carried, position=frame.to_geo(0.0, 3.0))) == (before, 97.0), "a position wanders"
    for flies in (replace(carried, armed=True), replace(carried, in_air=True), replace(carried, armed=None)):
        assert home_of(flies) == (before, 100.0)


async def test_a_home_that_is_elsewhere_is_a_caution() -> None:
    stage = Stage()
    home = stage.vehicle.state.home
    assert home is not None
    away = LocalFrame(home).to_geo(0.0, 20.0)
    stage.vehicle.state = replace(stage.vehicle.state, position=away, armed=False, in_air=False)
    facts, task = await checklist(spec(), stage.craft(), None)
    (caution,) = [fact for fact in facts if fact.name == "home" and not fact.ok]
    assert not caution.blocking
    assert isinstance(caution.reason, checks.HomeMovesHere)
    assert caution.reason.away_m == pytest.approx(20.0, abs=0.1)
    assert task is not None
    assert task.home == away


class Known:
    """Grounds of one terrain."""

    def __init__(self, found: Terrain | None) -> None:
        self.found = found

    async def around(self, home: Place) -> Terrain | None:
        return self.found

    async def keep(self, terrain: Terrain) -> None:
        pass

    async def kept(self, digest: str) -> Terrain | None:
        return self.found


async def ground_lines(found: Terrain | None) -> list[CheckFact]:
    lines, _ = await checklist(spec(), Stage().craft(), None, grounds=Known(found))
    return [line for line in lines if line.name == "terrain"]


async def test_without_terrain_it_says_that_the_ground_counts_as_level() -> None:
    (line,) = await ground_lines(None)
    assert (line.ok, line.blocking, line.reason) == (False, False, terrain_reasons.NoTerrain())
    (elsewhere,) = await ground_lines(Terrain(10.0, 10.0, 0.001, 0.001, np.ones((9, 9), np.float32)))
    assert elsewhere.reason == terrain_reasons.NoTerrain()


async def test_terrain_under_the_whole_fence_passes_and_names_the_highest_ground() -> None:
    (line,) = await ground_lines(terrain(hill(0.0, 60.0, 12.0)))
    assert line.ok
    assert isinstance(line.reason, terrain_reasons.TerrainCovers)
    assert line.reason.highest_above_home_m == pytest.approx(12.0, abs=1.0)


async def test_terrain_under_a_part_is_a_caution() -> None:
    (line,) = await ground_lines(terrain(level(), reach_m=100.0))
    assert (line.ok, line.blocking) == (False, False)
    assert isinstance(line.reason, terrain_reasons.TerrainPartly)


async def test_a_home_that_terrain_and_autopilot_put_elsewhere_is_a_caution() -> None:
    covers, differs = await ground_lines(terrain(level(130.0)))
    assert isinstance(covers.reason, terrain_reasons.TerrainCovers)
    assert differs.reason == terrain_reasons.HomeHeightDiffers(130.0, 100.0)
    assert (differs.ok, differs.blocking) == (False, False)


async def return_line(found: Terrain | None, altitude_m: float) -> CheckFact:
    stage = Stage()
    stage.vehicle.returns_at = ReturnAltitude("RTL_ALT", altitude_m)
    lines, _ = await checklist(spec(), stage.craft(), None, grounds=Known(found))
    (line,) = [
        line for line in lines if isinstance(line.reason, checks.ReturnAltitudeChecked | checks.ReturnMeetsGround)
    ]
    return line


async def test_the_autopilots_own_return_clears_the_ground_between_the_area_and_home() -> None:
    ridge = terrain(hill(0.0, 60.0, 50.0, wide_m=15.0))  # 30 m below it, beside it the mission flies at 40 m
    low, high = await return_line(ridge, 60.0), await return_line(ridge, 75.0)

    assert (low.ok, low.blocking) == (False, True)
    assert isinstance(low.reason, checks.ReturnMeetsGround)
    assert low.reason.least_relative_m == pytest.approx(70.0, abs=2.0)
    assert "RTL_ALT" in remedy_of(low.reason)
    assert high.ok


@pytest.mark.parametrize("found", [None, terrain(level()), terrain(hill(0.0, 300.0, 60.0, wide_m=120.0))])
async def test_where_the_ground_only_rises_away_from_home_any_return_altitude_will_do(found: Terrain | None) -> None:
    assert (await return_line(found, 0.0)).ok


async def test_turns_that_no_battery_lasts_for_twice_are_a_caution_and_those_it_cannot_make_once_block() -> None:
    tag = EmitterSpec(kind="pulsed", pulse_period_s=7.0)
    seldom = await checked(Stage(), spec((tag,)))
    assert isinstance(seldom["battery"].reason, checks.FewTurnsOnABattery)
    assert (seldom["battery"].ok, seldom["battery"].blocking, seldom["safety"].ok) == (False, False, True)
    beacon = tag.model_copy(update={"pulse_period_s": 50.0})
    never = await checked(Stage(), spec((beacon,)))
    assert isinstance(never["safety"].reason, safety.TurnBeyondBattery)
    assert never["safety"].blocking


async def test_a_charge_that_lasts_for_one_turn_and_the_way_home_is_a_caution() -> None:
    stage = Stage()
    assert "battery" not in await checked(_charged(stage, 90.0))
    low = await checked(_charged(stage, 45.0))
    assert isinstance(low["battery"].reason, checks.FewTurnsOnThisCharge)
    assert (low["battery"].ok, low["battery"].blocking, low["safety"].ok) == (False, False, True)
    empty = await checked(_charged(stage, 20.0))
    assert isinstance(empty["safety"].reason, safety.BatteryShort)
    assert "battery" not in empty, "who may not start needs no caution"


def _charged(stage: Stage, percent: float) -> Stage:
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=percent)
    return stage
