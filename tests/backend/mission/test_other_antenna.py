"""A server that comes back in flight with another antenna pattern: it is said, and the mission keeps its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from equipment import PATTERN
from flights import order, stuck
from stage import Stage

from backend import commands
from backend.events import AlertRaised, BearingMeasured, MissionStarted
from backend.reasons.flight import OtherAntenna
from backend.search.antenna import antenna_fact, pattern_of
from hardware.direction_finding.antenna import AntennaPattern

TURNED = replace(PATTERN, offset_to_nose_deg=PATTERN.offset_to_nose_deg + 30.0)
"""Of the same name: the file was replaced."""
OTHER = replace(PATTERN, name="long yagi", gain_db=PATTERN.gain_db - np.linspace(0.0, 1.0, len(PATTERN.gain_db)))


async def restarted_with(stage: Stage, pattern: AntennaPattern) -> None:
    await stage.room.shut_down()
    stage.room = stage.new_room(pattern)
    await stage.room.start_up()


def said(stage: Stage, mission_id: str) -> list[object]:
    raised = stage.journal.of_kind(mission_id, AlertRaised)
    return [fact.reason for fact in raised if isinstance(fact.reason, OtherAntenna)]


def flown_with(stage: Stage) -> AntennaPattern:
    (craft,) = stage.active.crafts.values()
    return craft.equipment.pattern


def test_a_pattern_is_what_its_fact_says_to_the_last_digit() -> None:
    fact = antenna_fact(OTHER)
    assert antenna_fact(pattern_of(type(fact).model_validate_json(fact.model_dump_json()))) == fact


async def test_the_same_pattern_is_no_news(stage: Stage) -> None:
    mission_id = await stuck(stage)
    await stage.restart()
    await stage.until_phase(mission_id, "hold")
    assert said(stage, mission_id) == []


async def test_a_replaced_file_is_noticed_said_and_not_flown_with(stage: Stage) -> None:
    mission_id = await stuck(stage)
    expected: list[object] = []
    for pattern in (TURNED, OTHER):
        await restarted_with(stage, pattern)
        await stage.until_phase(mission_id, "hold")
        expected.append(OtherAntenna(PATTERN.name, pattern.name))
        await stage.until_true(lambda: said(stage, mission_id) == expected)
        assert [raised.topic for raised in stage.active.state.craft.open_alerts].count("antenna") == 1
        assert antenna_fact(flown_with(stage)) == antenna_fact(PATTERN)
    await restarted_with(stage, PATTERN)
    await stage.until_true(lambda: "antenna" not in {raised.topic for raised in stage.active.state.craft.open_alerts})
    assert said(stage, mission_id) == expected


async def test_bearings_after_the_restart_are_those_of_the_antenna_of_before(stage: Stage) -> None:
    mission_id = await stuck(stage)
    await restarted_with(stage, TURNED)
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "bearing_measured")
    assert {id(pattern) for pattern in stage.finder.patterns} == {id(flown_with(stage))}
    assert stage.journal.of_kind(mission_id, BearingMeasured)
    (started,) = stage.journal.of_kind(mission_id, MissionStarted)
    assert started.antenna == antenna_fact(flown_with(stage))


async def test_the_next_mission_flies_with_what_the_server_was_given(stage: Stage) -> None:
    mission_id = await stuck(stage)
    await restarted_with(stage, OTHER)
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.stuck = False
    await order(stage, mission_id, commands.Land())
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    await stage.until_true(lambda: stage.room.flights.active is None)
    later = await stuck(stage)
    (started,) = stage.journal.of_kind(later, MissionStarted)
    assert started.antenna is not None
    assert started.antenna.name == OTHER.name
