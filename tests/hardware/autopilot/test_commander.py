"""The promise to the pilot: what is asked in the instant before each send decides, also for a repetition."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from hardware.authority import ModeHeard, SticksTookOver
from hardware.autopilot.commander import CommandDenied, Commander, Manoeuvre, ManoeuvreSuperseded
from hardware.autopilot.control import Control
from hardware.autopilot.link import Fields
from hardware.autopilot.messages import Outgoing, arm, pause, pause_here, set_mode
from hardware.clock import ScaledClock
from hardware.ports import NotInControl, VehicleError
from hardware.reasons.vehicle import CommandUnanswered
from hardware.reasons.vehicle_news import TriedAgain, VehicleNews

MODES = frozenset({1})


class Wire:
    """Stands in for the link: records what was sent; `answer` acts on each message after it was sent."""

    def __init__(self) -> None:
        self.sent: list[Fields] = []
        self.before: Callable[[], object] = lambda: None
        self.answer: Callable[[int], object] = lambda count: None

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        await asyncio.sleep(0)
        self.before()
        if not allowed():
            return False
        self.sent.append(fields)
        self.answer(len(self.sent))
        return True


class Rig:
    def __init__(self) -> None:
        self.wire = Wire()
        self.control = Control(lambda before, after: None)
        self.control.see(ModeHeard(1, "waiting", "HOLD", True, True, False, 0.0))
        self.news: list[VehicleNews] = []
        link: Any = self.wire
        self.mode_asked = 0
        self.quickest_s = 0.0
        clock = ScaledClock(None, 100.0)
        self.commander = Commander(
            link, clock, self.control, self.news.append, self.mode_heard, lambda: self.quickest_s
        )
        self.manoeuvre = Manoeuvre("flight")

    async def mode_heard(self) -> None:
        self.mode_asked += 1

    def acknowledge(self, result: int, number: int = 192) -> None:
        self.commander.acknowledged({"command": number, "result": result})

    def sticks(self) -> None:
        self.control.see(SticksTookOver(0.0))

    async def order(self, outgoing: Outgoing | None = None) -> None:
        await self.commander.send(self.manoeuvre, outgoing or pause(), MODES, "place")


async def test_accepted_is_done_and_refused_is_said() -> None:
    rig = Rig()
    rig.wire.answer = lambda count: rig.acknowledge(0)
    await rig.order()
    rig.wire.answer = lambda count: rig.acknowledge(2)

    with pytest.raises(CommandDenied, match="refused the next place: denied"):
        await rig.order()
    assert len(rig.wire.sent) == 2


async def test_an_order_of_a_mode_that_shows_is_not_repeated_when_its_answer_is_lost() -> None:
    """A repetition would undo a pilot who switched meanwhile."""
    rig = Rig()
    rig.wire.answer = lambda count: rig.control.see(ModeHeard(2, "return", "RETURN", True, True, False, 1.0))

    await rig.commander.send(rig.manoeuvre, set_mode((4.0, 5.0)), frozenset({2}), "return")

    assert len(rig.wire.sent) == 1
    assert rig.control.authority.shown_before is None
    assert rig.news == []


async def test_another_commands_acknowledgement_is_not_ours() -> None:
    rig = Rig()
    rig.wire.answer = lambda count: rig.acknowledge(0, number=400) if count == 1 else rig.acknowledge(0)

    await rig.order()

    assert len(rig.wire.sent) == 2
    assert [fields["confirmation"] for fields in rig.wire.sent] == [0, 1]
    assert rig.news == [TriedAgain(CommandUnanswered("place", 1), 2)]


async def test_an_answer_sooner_than_the_link_is_quick_is_to_an_order_before() -> None:
    """Answers name a command's number and nothing else: PX4's nose on the way and its hold have the same."""
    rig = Rig()
    rig.quickest_s = 0.2
    loop = asyncio.get_running_loop()

    def answer(count: int) -> None:
        if count == 1:  # lost; what comes answers the order of the nose that is under way
            rig.acknowledge(0)
            loop.call_later(0.05, rig.acknowledge, 0)
        else:
            loop.call_later(0.2, rig.acknowledge, 0)

    rig.wire.answer = answer
    await rig.order(pause_here())

    assert len(rig.wire.sent) == 2
    assert rig.news == [TriedAgain(CommandUnanswered("place", 1), 2)]


async def test_an_answer_before_anything_was_sent_is_to_an_order_before() -> None:
    rig = Rig()
    rig.wire.before = lambda: rig.acknowledge(2)
    rig.wire.answer = lambda count: rig.acknowledge(0)

    await rig.order()

    assert len(rig.wire.sent) == 1


async def test_a_late_answer_to_the_first_of_two_sends_counts() -> None:
    rig = Rig()
    rig.quickest_s = 1.5  # longer than an answer is waited for
    rig.wire.answer = lambda count: (
        asyncio.get_running_loop().call_later(1.6, rig.acknowledge, 0) if count == 1 else None
    )

    await rig.order()

    assert len(rig.wire.sent) == 2


async def test_in_progress_waits_for_the_last_word_without_sending_again() -> None:
    rig = Rig()

    def answer(count: int) -> None:
        rig.acknowledge(5)
        asyncio.get_running_loop().call_later(0.02, rig.acknowledge, 4)

    rig.wire.answer = answer
    with pytest.raises(CommandDenied, match="failed"):
        await rig.order()
    assert len(rig.wire.sent) == 1


async def test_a_pilot_who_takes_over_in_the_instant_before_sending_stops_it() -> None:
    rig = Rig()
    rig.wire.before = rig.sticks

    with pytest.raises(NotInControl, match="sticks"):
        await rig.order(arm())
    assert rig.wire.sent == []


async def test_a_pilot_who_takes_over_while_an_answer_is_awaited_gets_no_repetition() -> None:
    rig = Rig()
    rig.wire.answer = lambda count: rig.sticks()

    with pytest.raises(NotInControl):
        await rig.order()
    assert len(rig.wire.sent) == 1


async def test_a_superseded_manoeuvre_sends_nothing_more() -> None:
    rig = Rig()

    def supersede(count: int) -> None:
        rig.manoeuvre.superseded_by = "hold"

    rig.wire.answer = supersede
    with pytest.raises(ManoeuvreSuperseded, match="replaced by the hold"):
        await rig.order()
    with pytest.raises(ManoeuvreSuperseded):
        await rig.order()
    assert len(rig.wire.sent) == 1


async def test_no_answer_at_all_is_an_error_after_three_sends() -> None:
    rig = Rig()

    with pytest.raises(VehicleError, match="did not answer"):
        await rig.order()
    assert len(rig.wire.sent) == 3


async def test_questions_pass_while_the_pilot_flies() -> None:
    rig = Rig()
    rig.sticks()
    rig.wire.answer = lambda count: rig.acknowledge(0)

    assert await rig.commander.ask(pause()) is True


async def test_what_changes_the_mode_waits_for_the_vehicles_word_each_time_and_nothing_else_does() -> None:
    rig = Rig()
    rig.wire.answer = lambda count: rig.acknowledge(0) if count != 1 else None  # the first is lost
    await rig.order(pause())
    assert rig.mode_asked == 2
    await rig.order(pause_here())
    assert rig.mode_asked == 2


async def test_a_takeover_in_the_word_that_was_waited_for_stops_the_change_of_mode() -> None:
    rig = Rig()
    await asyncio.sleep(0)
    rig.control.see(ModeHeard(1, "waiting", "HOLD", True, True, False, 0.0))

    async def pilots() -> None:
        rig.control.see(ModeHeard(9, "other", "POSCTL", True, True, False, 0.1))

    rig.commander._mode_heard = pilots  # pyright: ignore[reportPrivateUsage]
    with pytest.raises(NotInControl, match="POSCTL"):
        await rig.order(pause())
    assert rig.wire.sent == []


async def test_steering_that_px4_calls_unsupported_has_arrived_but_an_order_has_not() -> None:
    rig = Rig()
    rig.wire.answer = lambda count: rig.acknowledge(3)
    await rig.order(pause_here())
    with pytest.raises(CommandDenied, match="unsupported"):
        await rig.order(pause())


async def test_outside_the_mode_that_obeys_it_steering_is_not_sent() -> None:
    rig = Rig()
    with pytest.raises(VehicleError, match="has left the mode in which it obeys the next place"):
        await rig.commander.send(rig.manoeuvre, pause_here(), frozenset({7}), "place")
    assert rig.wire.sent == []
