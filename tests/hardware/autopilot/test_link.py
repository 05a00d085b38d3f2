from __future__ import annotations

import asyncio
import math
import socket
from collections.abc import Callable
from functools import cache
from threading import Event, get_ident
from typing import Any, ClassVar

import pytest

from hardware.autopilot import opening
from hardware.autopilot.fence_items import FenceItem
from hardware.autopilot.link import FenceTransferFailed, MavlinkLink
from hardware.autopilot.opening import check_url
from hardware.ports import VehicleUnreachable
from hardware.sim.autopilot.launch import Setting, launch_simulated


@pytest.mark.parametrize(
    "url",
    ["udpin://0.0.0.0:14540", "udpout://10.0.0.2:14550", "tcpout://127.0.0.1:5760", "serial:///dev/ttyUSB0:57600"],
)
def test_mavsdks_addresses_pass_as_they_are(url: str) -> None:
    assert check_url(url) == url


def test_plain_tcp_means_to_connect_to_it() -> None:
    assert check_url("tcp://127.0.0.1:5760") == "tcpout://127.0.0.1:5760"


@pytest.mark.parametrize("url", ["", "14540", "udp://:14540", "http://vehicle", "udpin://"])
def test_other_addresses_are_refused_with_the_forms_there_are(url: str) -> None:
    with pytest.raises(ValueError, match=r"udpin://0\.0\.0\.0:14540"):
        check_url(url)


async def test_before_it_is_open_nothing_is_sent_and_closing_twice_is_harmless() -> None:
    link = MavlinkLink("udpin://127.0.0.1:14999", (), lambda name, fields: None)

    assert await link.send("HEARTBEAT", {}, lambda: True) is False
    assert await link.parameter("NAV_DLL_ACT") is None
    await link.close()
    await link.close()


class SlowAutopilot:
    """MAVSDK and its parameters: `done`, in order."""

    def __init__(self) -> None:
        self.asked, self.answer = Event(), Event()
        self.done: list[str] = []

    def get_param_int(self, name: str) -> int:
        self.asked.set()
        self.answer.wait(10.0)
        self.done.append(name)
        return 5

    def destroy(self) -> None:
        self.done.append("destroyed")


async def test_another_link_leaves_the_log_of_those_that_are_open_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    subscribed = list[object]()
    monkeypatch.setattr(opening, "log_subscribe", subscribed.append)
    monkeypatch.setattr(opening, "_take_log_over", cache(opening._take_log_over.__wrapped__))  # pyright: ignore
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        for _ in range(3):
            link = MavlinkLink(f"udpin://127.0.0.1:{taken.getsockname()[1]}", (), lambda name, fields: None)
            with pytest.raises(VehicleUnreachable):
                await link.open(1.0)
            await link.close()

    assert len(subscribed) == 1


async def test_what_waits_for_an_answer_ends_before_the_link_does(monkeypatch: pytest.MonkeyPatch) -> None:
    link, slow = MavlinkLink("udpin://127.0.0.1:14999", (), lambda name, fields: None), SlowAutopilot()
    monkeypatch.setattr(link, "_mavsdk", slow)
    monkeypatch.setattr(link, "_param", slow)
    monkeypatch.setattr(link, "_parameters", {"RC_MAP_FLTMODE": 6})
    asking = asyncio.create_task(link.parameter("RC_MAP_FLTMODE"))
    await asyncio.to_thread(slow.asked.wait, 10.0)
    asking.cancel()
    closing = asyncio.create_task(link.close())
    await asyncio.sleep(0.05)
    assert slow.done == []

    slow.answer.set()
    await closing

    assert slow.done == ["RC_MAP_FLTMODE", "destroyed"]


@pytest.mark.parametrize("told", [math.nan, math.inf, -math.inf])
async def test_a_value_that_is_no_number_is_none(monkeypatch: pytest.MonkeyPatch, told: float) -> None:
    """It would hold against no rule and could be stored in no fact."""

    class Odd:
        def get_param_float(self, name: str) -> float:
            return told

    link = MavlinkLink("udpin://127.0.0.1:14999", (), lambda name, fields: None)
    monkeypatch.setattr(link, "_param", Odd())
    monkeypatch.setattr(link, "_parameters", {"RTL_RETURN_ALT": 9})
    assert await link.parameter("RTL_RETURN_ALT") is None
    await link.close()


async def test_a_link_that_closes_while_a_parameter_is_asked_for_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """As when the vehicle connects again in the middle of a checklist."""
    monkeypatch.setattr("hardware.autopilot.link.PARAMETER_WALL_S", 0.1)
    link = MavlinkLink("udpin://127.0.0.1:14999", (), lambda name, fields: None)
    monkeypatch.setattr(link, "_direct", Mute())
    monkeypatch.setattr(link, "_parameters", {"KNOWN": 6})
    asking = asyncio.create_task(link.parameter("UNHEARD_OF"))
    await asyncio.sleep(0)
    await link.close()
    assert await asking is None
    assert await link.parameter("KNOWN") is None
    assert not await link.set_parameter("KNOWN", 1.0)


class Mute:
    """MAVSDK, to which nobody answers."""

    def send_message(self, _message: object) -> None:
        pass


class HangingMission:
    """MAVSDK's, while the transfer neither succeeds nor fails."""

    def __init__(self) -> None:
        self.go_on = Event()

    def download_geofence(self) -> list[Any]:
        self.go_on.wait(10.0)
        return []


async def test_a_fence_transfer_that_never_ends_is_an_error_and_holds_up_nothing_else(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("hardware.autopilot.link.FENCE_WALL_S", 0.05)
    link, mission = MavlinkLink("udpin://127.0.0.1:14999", (), lambda name, fields: None), HangingMission()
    monkeypatch.setattr(link, "_mission", mission)
    try:
        for _ in range(3):
            with pytest.raises(FenceTransferFailed, match="timeout"):
                await link.fence()
        assert await link.parameter("NAV_DLL_ACT") is None
    finally:
        mission.go_on.set()
        await link.close()


@pytest.mark.parametrize("flavour", ["px4", "ardupilot"])
async def test_a_fence_arrives_over_a_slow_link(flavour: str) -> None:
    """300 ms each way. ArduCopter ends a transfer in which an item comes twice."""
    corners = ((473970000, 85450000), (473990000, 85450000), (473990000, 85470000))
    fence = [FenceItem(5001, 3.0, lat, lon) for lat, lon in corners]
    autopilot = await launch_simulated(Setting(flavour=flavour, link_delay_s=0.3))
    link = MavlinkLink(autopilot.url, (), lambda name, fields: None)
    try:
        await link.open(10.0)
        await link.set_fence(fence)
        assert await link.fence() == fence
    finally:
        await link.close()
        await autopilot.stop()


class FirstAutopilot:
    """MAVSDK that finds one at once."""

    def first_autopilot_async(self, _timeout_s: float, heard: Callable[[Any], None]) -> int:
        heard(self)
        return 1

    def cancel_first_autopilot(self, _handle: int) -> None:
        pass

    def get_system_id(self) -> int:
        return 1

    def destroy(self) -> None:
        pass


class MadeIn:
    """One of MAVSDK's parts. threads: in which each was made."""

    threads: ClassVar[list[int]] = []

    def __init__(self, _system: object) -> None:
        self.threads.append(get_ident())

    def subscribe_message(self, _name: str, _heard: Callable[..., None]) -> None:
        pass


async def test_the_event_loop_does_not_wait_for_the_definitions_of_messages(monkeypatch: pytest.MonkeyPatch) -> None:
    for part in ("MavlinkDirect", "Param", "MissionRaw", "Geofence"):
        monkeypatch.setattr(f"hardware.autopilot.link.{part}", MadeIn)
    monkeypatch.setattr(MadeIn, "threads", [])
    found = opening.Connection(FirstAutopilot())  # type: ignore[arg-type]
    link = MavlinkLink("udpin://127.0.0.1:14999", ("HEARTBEAT",), lambda name, fields: None, found)
    await link.open(1.0)
    await link.close()
    assert len(MadeIn.threads) == 4
    assert get_ident() not in MadeIn.threads
