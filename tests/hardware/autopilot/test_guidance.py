from __future__ import annotations

import asyncio

import pytest
from paper import POSCTL, Scene

from hardware.autopilot.commander import Manoeuvre
from hardware.autopilot.guidance import MODE_S, Guidance
from hardware.autopilot.messages import REPOSITION, pause
from hardware.autopilot.px4 import HOLD
from hardware.ports import NotInControl


def steering(scene: Scene) -> asyncio.Task[None]:
    return asyncio.create_task(Guidance(scene.monitor).steer(Manoeuvre("flight"), pause(), "place"))


async def waited_for(scene: Scene) -> None:
    """Everything that can go on without the vehicle's word has gone on."""
    for _ in range(20):
        await asyncio.sleep(0)
    assert scene.link.sent == []


async def test_the_search_is_moved_on_right_after_the_vehicle_has_reported_its_mode(flying: Scene) -> None:
    command = steering(flying)
    await waited_for(flying)
    flying.mode(HOLD)
    await command
    assert flying.link.sent == [REPOSITION]


async def test_a_pilots_change_of_mode_that_was_not_reported_yet_is_not_undone(flying: Scene) -> None:
    command = steering(flying)
    await waited_for(flying)
    flying.mode(POSCTL)
    with pytest.raises(NotInControl, match="POSCTL"):
        await command
    assert flying.link.sent == []


async def test_an_autopilot_that_seldom_reports_its_mode_is_not_waited_for_long(flying: Scene) -> None:
    command = steering(flying)
    await waited_for(flying)
    flying.clock.at += 2 * MODE_S
    await command
    assert flying.link.sent == [REPOSITION]
