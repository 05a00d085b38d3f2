from __future__ import annotations

import asyncio

import pytest
from paper import POSCTL, Scene

from hardware.autopilot.commander import CommandDenied, Manoeuvre
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.messages import REPOSITION, SET_MODE, reposition
from hardware.autopilot.monitor import MODE_S
from hardware.autopilot.px4 import HOLD, PX4, TAKING_OFF
from hardware.ports import NotInControl
from hardware.readings import Place

THERE = reposition(Place(47.4, 8.5), 540.0, 5.0, None)
UNSUPPORTED, DENIED = 3, 2


def steering(scene: Scene) -> asyncio.Task[None]:
    return asyncio.create_task(Guidance(scene.monitor).steer(Manoeuvre("flight"), THERE, "place"))


def selecting(scene: Scene) -> asyncio.Task[None]:
    return asyncio.create_task(Guidance(scene.monitor).select(Manoeuvre("return"), PX4.return_home))


async def all_that_can_go_on_has() -> None:
    for _ in range(20):
        await asyncio.sleep(0)


async def test_steering_never_asks_for_a_mode_and_px4_is_taken_at_its_deeds(flying: Scene) -> None:
    flying.link.result = UNSUPPORTED
    assert THERE.fields["param2"] == 0.0
    await steering(flying)
    assert flying.link.sent == [REPOSITION]


async def test_what_denies_steering_may_be_in_the_pilots_hands_so_its_next_word_is_heard_first(flying: Scene) -> None:
    """With no more than the refusal, the caller might order a hold and take the vehicle from the pilot."""
    flying.link.result = DENIED
    command = steering(flying)
    await all_that_can_go_on_has()
    assert not command.done()
    flying.mode(POSCTL)
    with pytest.raises(NotInControl, match="POSCTL"):
        await command


async def test_steering_denied_in_our_own_mode_is_a_refusal(flying: Scene) -> None:
    flying.link.result = DENIED
    command = steering(flying)
    await all_that_can_go_on_has()
    flying.mode(HOLD)
    with pytest.raises(CommandDenied, match="refused the next place: denied"):
        await command


async def test_a_mode_is_selected_right_after_the_vehicle_has_reported_its_own(flying: Scene) -> None:
    command = selecting(flying)
    await all_that_can_go_on_has()
    assert flying.link.sent == []
    flying.mode(HOLD)
    await all_that_can_go_on_has()
    assert flying.link.sent == [SET_MODE]
    command.cancel()


async def test_a_pilots_switch_in_that_report_is_not_undone(flying: Scene) -> None:
    command = selecting(flying)
    await all_that_can_go_on_has()
    flying.mode(POSCTL)
    with pytest.raises(NotInControl, match="POSCTL"):
        await command
    assert flying.link.sent == []


async def test_an_autopilot_that_is_silent_about_its_mode_is_not_waited_for_long(flying: Scene) -> None:
    command = selecting(flying)
    await all_that_can_go_on_has()
    flying.clock.at += 2 * MODE_S
    await asyncio.sleep(1.5 * MODE_S)
    assert flying.link.sent == [SET_MODE]
    command.cancel()


@pytest.mark.parametrize(("mode", "selected"), [(HOLD, []), (TAKING_OFF, [SET_MODE])])
async def test_the_mode_for_steering_is_selected_only_when_it_is_another(
    flying: Scene, mode: int, selected: list[int]
) -> None:
    flying.mode(mode)
    entering = asyncio.create_task(Guidance(flying.monitor).enter_steering(Manoeuvre("flight")))
    await all_that_can_go_on_has()
    flying.mode(mode)
    await all_that_can_go_on_has()
    assert flying.link.sent == selected
    entering.cancel()
