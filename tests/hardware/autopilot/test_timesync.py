from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.timesync import Timesync
from hardware.clock import WallClock


class Wire:
    def __init__(self) -> None:
        self.sent: list[Fields] = []

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        assert name == "TIMESYNC"
        assert allowed()
        self.sent.append(fields)
        return True


async def asked() -> tuple[Timesync, Wire, list[Any]]:
    wire, exchanges = Wire(), list[Any]()
    timesync = Timesync(cast(MavlinkLink, wire), WallClock(), lambda *exchange: exchanges.append(exchange))
    await timesync.ask()
    return timesync, wire, exchanges


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
