"""Telemetry and status, shown beside the facts."""

from __future__ import annotations

from dataclasses import replace

from flights import order, stuck
from stage import Stage

from backend import commands
from backend.events import FIRST_CRAFT
from backend.ports import CraftStatus
from backend.reasons.flight import PlaceUnknown
from backend.reasons.safety import NotGivenBack
from backend.wire.messages import CraftStatusMessage
from hardware.reasons.receiver import SamplesLost


async def test_telemetry_and_status_are_shown_without_a_mission(stage: Stage) -> None:
    await stage.until_true(
        lambda: stage.publisher.telemetries.count(FIRST_CRAFT) >= 2 and bool(stage.publisher.statuses)
    )
    status = stage.publisher.statuses[0]
    assert (status.mission_id, status.phase, status.database) == (None, None, "ok")
    assert status.crafts == (CraftStatus(FIRST_CRAFT, None, "ground", "off", None, None, None),)


async def test_the_alerts_of_a_craft_that_flies_for_no_mission_are_in_the_status(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True, position_lost_since_s=1.0)
    await stage.until_true(lambda: bool(stage.room.display.status().crafts[0].alerts))
    (alert,) = stage.room.display.status().crafts[0].alerts
    assert (alert.topic, alert.level, alert.reason) == ("gps", "warning", PlaceUnknown())
    told = CraftStatusMessage.model_validate(stage.room.display.status().crafts[0], from_attributes=True)
    assert told.alerts[0].reason == PlaceUnknown()


async def test_the_status_says_what_the_craft_of_the_mission_does(stage: Stage) -> None:
    mission_id = await stuck(stage)
    running = stage.room.flights.running(mission_id)
    assert running is not None
    running.crafts[FIRST_CRAFT].listening.settling_samples = 7
    stage.receiver.lost_percent = 3.0
    status = stage.room.display.status()
    assert (status.mission_id, status.phase) == (mission_id, "flying")
    (craft,) = status.crafts
    assert (craft.craft_id, craft.mission_id, craft.phase, craft.receiver) == (FIRST_CRAFT, mission_id, "flying", "ok")
    assert craft.receiver_power_db == -60.0
    told = CraftStatusMessage.model_validate(craft, from_attributes=True)
    assert (told.settling_samples, told.receiver_lost_percent) == (7, 3.0)
    assert craft.battery_to_return_percent is not None
    assert craft.battery_to_return_percent > 0.0


async def test_a_receiver_that_loses_a_good_part_of_its_samples_is_told_of_while_it_does(stage: Stage) -> None:
    await stuck(stage)

    def said() -> list[object]:
        running = stage.room.flights.active
        assert running is not None
        return [raised.reason for raised in running.state.crafts[FIRST_CRAFT].open_alerts if raised.topic == "receiver"]

    stage.receiver.lost_percent = 20.0
    await stage.until_true(lambda: said() == [SamplesLost(20.0)])
    stage.receiver.lost_percent = 0.0
    await stage.until_true(lambda: said() == [])


async def test_the_status_says_whether_resuming_would_be_accepted(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert stage.room.display.status().crafts[0].resume_refused is None, "nothing waits to be resumed"
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    refused = stage.room.display.status().crafts[0].resume_refused
    assert isinstance(refused, NotGivenBack)
    assert (await order(stage, mission_id, commands.Resume())).reason == refused
    stage.vehicle.pilot_gives_back()
    assert stage.room.display.status().crafts[0].resume_refused is None
    assert (await order(stage, mission_id, commands.Resume())).accepted


async def test_after_an_abort_the_craft_is_shown_until_it_is_down(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await order(stage, mission_id, commands.Abort())).accepted
    status = stage.room.display.status()
    assert (status.mission_id, status.phase) == (mission_id, "aborted")
    assert status.crafts[0].phase in ("returning", "landing")
    stage.vehicle.stuck = False
    stage.vehicle.touch_down()
    await stage.until_true(lambda: stage.room.display.status().mission_id is None)
