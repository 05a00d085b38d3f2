from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, cast

from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.timesync import UNANSWERED, Timesync
from hardware.clock import WallClock


class Wire:
    def __init__(self) -> None:
        self.sent: list[Fields] = []
        self.pings: list[Fields] = []

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        assert allowed()
        {"TIMESYNC": self.sent, "PING": self.pings}[name].append(fields)
        return True


class Learned:
    def __init__(self) -> None:
        self.exchanges: list[Any] = []
        self.trips: list[tuple[float, float]] = []

    def exchanged(self, sent_at_s: float, boot_s: float, heard_at_s: float) -> None:
        self.exchanges.append((sent_at_s, boot_s, heard_at_s))

    def went_round(self, sent_at_s: float, heard_at_s: float) -> None:
        self.trips.append((sent_at_s, heard_at_s))


def made() -> tuple[Timesync, Wire, Learned]:
    wire, learned = Wire(), Learned()
    return Timesync(cast(MavlinkLink, wire), WallClock(), learned), wire, learned


async def asked() -> tuple[Timesync, Wire, list[Any]]:
    timesync, wire, learned = made()
    await timesync.ask()
    return timesync, wire, learned.exchanges


async def test_while_nothing_answers_a_ping_goes_with_each_question_and_no_longer() -> None:
    """PX4's answers are addressed to anybody, and do not reach us."""
    timesync, wire, learned = made()
    for _ in range(UNANSWERED):
        await timesync.ask()
    assert wire.pings == []
    await timesync.ask()
    (ping,) = wire.pings
    assert (ping["target_system"], ping["target_component"]) == (0, 0)  # else it is an answer

    timesync.came_back(ping, 9e9)  # a question of somebody else, by chance of the same time
    assert learned.trips == []
    await timesync.ask()
    answer = wire.pings[-1] | {"target_system": 255, "target_component": 190}
    timesync.came_back(answer, 9e9)
    timesync.came_back(answer, 9e9)
    assert [heard_s for _, heard_s in learned.trips] == [9e9]

    timesync.heard({"tc1": 42_500_000_000, "ts1": wire.sent[-1]["ts1"]}, 9e9)
    pings = len(wire.pings)
    await timesync.ask()
    assert len(wire.pings) == pings


async def test_how_long_no_answer_has_come_is_counted_from_the_first_answer_of_either_kind() -> None:
    timesync, wire, _ = made()
    for _ in range(UNANSWERED + 1):
        await timesync.ask()
    assert timesync.unanswered is None
    timesync.came_back(wire.pings[-1] | {"target_system": 255, "target_component": 190}, 9e9)
    assert timesync.unanswered is not None
    timesync.unanswered.look(0.3)
    timesync.came_back({"time_usec": 7, "target_system": 255}, 9e9)
    assert timesync.unanswered.seconds == 0.3
    timesync.heard({"tc1": 42_500_000_000, "ts1": wire.sent[-1]["ts1"]}, 9e9)
    assert timesync.unanswered.seconds == 0.0


async def test_an_answer_to_ours_is_an_exchange_and_it_is_one_only_once() -> None:
    timesync, wire, exchanges = await asked()
    answer = {"tc1": 42_500_000_000, "ts1": wire.sent[0]["ts1"]}
    timesync.heard(answer, 9e9)
    timesync.heard(answer, 9e9)
    assert [(boot_s, heard_s) for _, boot_s, heard_s in exchanges] == [(42.5, 9e9)]


async def test_what_others_ask_and_answer_is_none() -> None:
    timesync, wire, exchanges = await asked()
    timesync.heard({"tc1": 42_500_000_000, "ts1": 7}, 9e9)
    timesync.heard({"tc1": 0, "ts1": wire.sent[0]["ts1"]}, 9e9)
    assert exchanges == []


async def test_the_quickest_way_round_is_known_from_questions_of_either_kind() -> None:
    timesync, wire, _ = made()
    assert timesync.quickest_s == 0.0
    for _ in range(UNANSWERED + 1):
        await timesync.ask()
    await asyncio.sleep(0.05)
    timesync.came_back(wire.pings[-1] | {"target_system": 255, "target_component": 190}, 9e9)
    slow_s = timesync.quickest_s
    assert slow_s >= 0.05

    await timesync.ask()
    timesync.heard({"tc1": 42_500_000_000, "ts1": wire.sent[-1]["ts1"]}, 9e9)
    assert 0.0 < timesync.quickest_s < slow_s
