"""A craft in the air without a mission: nothing is sent by itself, and what a person orders is insisted on."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from dataclasses import replace

import pytest
from stage import Stage

from backend import commands
from backend.craft.loose import LooseCraft
from backend.reasons.flight import BatteryRunsLow, PlaceUnknown
from backend.reasons.refusals import MissionOver, OnTheGround
from backend.reasons.safety import BatterySilent, NotGivenBack, PilotControls
from hardware.ports import VehicleError
from hardware.readings import Announcement
from hardware.reasons.vehicle import AutopilotRefused, DoesNotHold
from hardware.reasons.vehicle_news import AutopilotSaid


class Found:
    """A vehicle that hovers somewhere; `busy`: a mission has it."""

    def __init__(self) -> None:
        self.stage = Stage()
        self.vehicle = self.stage.vehicle
        self.vehicle.state = replace(self.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0)
        self.busy = False
        self.craft = LooseCraft(self.stage.craft(), lambda: self.busy)
        self._ids = 0

    def order(self, command: commands.Hold | commands.Return | commands.Land | commands.Resume) -> object:
        self._ids += 1
        return self.craft.order(str(self._ids), "anna", command)

    async def sent(self, *names: str) -> None:
        await self.stage.until_true(lambda: self.vehicle.names == list(names))

    async def stage_of(self, stage: str) -> None:
        await self.stage.until_true(
            lambda: (
                self.craft.state is not None
                and self.craft.state.ladder is not None
                and self.craft.state.ladder.stage == stage
            )
        )


@pytest.fixture
async def found() -> AsyncIterator[Found]:
    made = Found()
    watching = asyncio.create_task(made.craft.run())
    yield made
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)


async def known(found: Found) -> None:
    await found.stage.until_true(lambda: found.craft.state is not None)


async def test_it_is_found_and_nothing_is_sent_by_itself_whatever_becomes_of_its_link(found: Found) -> None:
    await known(found)
    found.vehicle.heard = False
    await found.stage.clock.sleep(10)
    found.vehicle.heard = True
    await found.stage.clock.sleep(10)
    assert found.vehicle.names == []


async def test_hold_return_and_landing_reach_it(found: Found) -> None:
    await known(found)
    assert found.order(commands.Hold()) is None
    await found.sent("hold")
    assert found.order(commands.Return()) is None
    await found.sent("hold", "return_home")
    assert found.order(commands.Land()) is None
    await found.sent("hold", "return_home", "land")
    await found.stage_of("done")
    assert found.order(commands.Resume()) == MissionOver()


async def test_the_same_order_sent_again_is_carried_out_once(found: Found) -> None:
    await known(found)
    for _ in range(3):
        assert found.craft.order("one", "anna", commands.Hold()) is None
    await found.stage_of("done")
    assert found.vehicle.names == ["hold"]


async def test_a_refused_hold_is_tried_again_and_is_not_done_until_the_vehicle_hovers(found: Found) -> None:
    await known(found)
    holds, refusals = found.vehicle.hold, 2

    async def refusing() -> None:
        nonlocal refusals
        refusals -= 1
        if refusals >= 0:
            raise VehicleError(DoesNotHold(AutopilotRefused("hold", "denied")))
        await holds()

    found.vehicle.hold = refusing  # type: ignore[method-assign]
    found.order(commands.Hold())
    await found.stage_of("waits")
    await found.stage_of("done")
    assert found.vehicle.names == ["hold"]


async def test_a_pilot_who_has_it_is_sent_nothing_until_they_gave_it_back_and_an_operator_resumes(found: Found) -> None:
    await known(found)
    found.order(commands.Hold())
    await found.sent("hold")
    found.vehicle.pilot_takes_over()
    for command in (commands.Hold(), commands.Return(), commands.Land()):
        assert found.order(command) == PilotControls()
    assert found.order(commands.Resume()) == NotGivenBack("POSCTL")
    assert found.vehicle.names == ["hold"]
    found.vehicle.pilot_gives_back()
    assert found.order(commands.Resume()) is None
    await found.sent("hold", "hold")


async def test_on_the_ground_there_is_nothing_to_order_and_a_landing_ends_it(found: Found) -> None:
    await known(found)
    found.order(commands.Land())
    await found.sent("land")
    found.vehicle.touch_down()
    await found.stage.until_true(lambda: found.craft.state is None)
    assert found.order(commands.Hold()) == OnTheGround()
    assert found.vehicle.names == ["land"]


async def test_a_mission_that_takes_it_has_it_alone(found: Found) -> None:
    await known(found)
    found.vehicle.heard = False
    found.order(commands.Hold())
    await found.stage_of("waits")
    found.busy = True
    await found.stage.until_true(lambda: found.craft.state is None)
    found.vehicle.heard = True
    await found.stage.clock.sleep(20)
    assert found.vehicle.names == []


def shown(found: Found) -> dict[str, object]:
    return {alert.topic: alert.reason for alert in found.craft.alerts.values()}


async def test_its_autopilots_words_are_shown_once_and_heard_from_the_moment_it_is_found(found: Found) -> None:
    await known(found)
    said = AutopilotSaid("critical", "Battery failure")
    for _ in range(3):
        found.vehicle.announced.put_nowait(Announcement(found.stage.clock.now(), said))
    await found.stage.until_true(lambda: bool(found.craft.alerts))
    assert shown(found) == {"autopilot": said}
    assert [alert.level for alert in found.craft.alerts.values()] == ["warning"]
    assert found.vehicle.names == []


async def test_a_lost_gps_is_shown_and_goes_and_nothing_is_sent(found: Found) -> None:
    await known(found)
    found.vehicle.state = replace(found.vehicle.state, position_lost_since_s=found.stage.clock.now())
    await found.stage.until_true(lambda: shown(found) == {"gps": PlaceUnknown()})
    found.vehicle.state = replace(found.vehicle.state, position_lost_since_s=None)
    await found.stage.until_true(lambda: shown(found) == {})
    assert found.vehicle.names == []


async def test_a_low_battery_is_shown_and_shown_again_when_it_is_lower_and_nobody_is_flown_home(found: Found) -> None:
    await known(found)
    for charge, told in ((24.0, 24.0), (23.0, 24.0), (26.0, 24.0), (12.0, 12.0), (11.0, 12.0), (14.0, 12.0)):
        found.vehicle.state = replace(found.vehicle.state, battery_percent=charge)
        await found.stage.until_true(lambda told=told: shown(found) == {"battery": BatteryRunsLow(told)})
        await found.stage.clock.sleep(40.0)  # longer than a mission counts down
        assert shown(found) == {"battery": BatteryRunsLow(told)}
    found.vehicle.state = replace(found.vehicle.state, battery_percent=60.0)
    await found.stage.until_true(lambda: shown(found) == {})
    assert found.vehicle.names == []


async def test_a_battery_that_fell_silent_is_shown(found: Found) -> None:
    await known(found)
    await found.stage.until_true(lambda: found.vehicle.telemetry().battery_at_s is not None)
    found.vehicle.charge_reported = False
    await found.stage.until_true(lambda: shown(found) == {"battery": BatterySilent()})


async def test_of_a_craft_that_landed_or_flies_for_a_mission_nothing_is_left_open(found: Found) -> None:
    await known(found)
    found.vehicle.state = replace(found.vehicle.state, battery_percent=10.0)
    await found.stage.until_true(lambda: "battery" in shown(found))
    found.busy = True
    await found.stage.until_true(lambda: shown(found) == {})
    found.busy = False
    await found.stage.until_true(lambda: "battery" in shown(found))
    found.vehicle.touch_down()
    await found.stage.until_true(lambda: found.craft.state is None)
    assert shown(found) == {}
