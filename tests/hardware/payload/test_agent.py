"""Agent and server over real sockets: cut links, restarts in mid-sweep, a killed process; nothing lost or doubled."""

from __future__ import annotations

import asyncio
import contextlib
import math
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from refusals import refusing
from websockets.asyncio.server import ServerConnection, serve

from hardware.channels import only_carrier
from hardware.payload.agent import AgentSettings, PayloadAgent
from hardware.payload.messages import Pong
from hardware.payload.receiver import PayloadReceiver
from hardware.payload.session import PayloadHub
from hardware.payload.spool import Spool
from hardware.ports import ReceiverError
from hardware.readings import Channel, PowerSample, Pulses
from hardware.reasons.channels import CarriersOnly
from hardware.reasons.payload import NoPayloadConnected, PayloadListening
from hardware.reasons.receiver import NonsensicalPower, ReceiverUnplugged, SamplesLost

TOKEN = "a-token-of-some-length"
FREQUENCY_HZ = 868_300_000.0
CARRIER = Channel(FREQUENCY_HZ)


class CountingReceiver:
    """Sample k has power -k/100 dB, of each channel in turn; a new one counts on from the last."""

    def __init__(self, begin: int = 0, rate_hz: float = 200.0) -> None:
        self.made = begin
        self.rate_hz = rate_hz
        self.channels: Sequence[Channel] = ()
        self.fails = 0
        self.lost_percent = 0.0

    async def open(self, channels: Sequence[Channel]) -> None:
        self.channels = channels

    async def close(self) -> None: ...

    async def samples(self) -> AsyncIterator[PowerSample]:
        while True:
            await asyncio.sleep(1.0 / self.rate_hz)
            if self.fails:
                self.fails -= 1
                raise ReceiverError(ReceiverUnplugged())
            self.made += 1
            channel = self.channels[self.made % len(self.channels)]
            yield PowerSample(1000.0 + self.made, channel.frequency_hz, -self.made / 100.0)


class Server:
    """The hub on a websocket, as the API mounts it; `cut` drops every connection."""

    def __init__(self) -> None:
        self.hub = PayloadHub((TOKEN,))
        self.links: set[ServerConnection] = set()
        self.port = 0

    async def handle(self, link: ServerConnection) -> None:
        assert link.request is not None
        token = link.request.headers.get("Authorization", "").removeprefix("Bearer ")
        if not self.hub.authenticate(token):
            await link.close(1008, "token")
            return
        self.links.add(link)

        async def receive() -> str:
            return str(await link.recv())

        with contextlib.suppress(Exception):
            await self.hub.serve(receive, link.send)
        self.links.discard(link)

    def cut(self) -> None:
        for link in list(self.links):
            link.transport.abort()


@asynccontextmanager
async def running_server(port: int = 0) -> AsyncIterator[Server]:
    server = Server()
    async with serve(server.handle, "127.0.0.1", port) as listening:
        server.port = listening.sockets[0].getsockname()[1]
        yield server


@asynccontextmanager
async def running_agent(
    tmp_path: Path, port: int, receiver: CountingReceiver, token: str = TOKEN
) -> AsyncIterator[PayloadAgent]:
    settings = AgentSettings(
        (f"ws://127.0.0.1:{port}/api/payload",),
        token,
        flush_s=0.02,
        status_s=0.1,
        ping_s=0.2,
        retry_s=0.05,
        longest_retry_s=0.1,
    )
    spool = Spool(tmp_path / "samples.sqlite")
    agent = PayloadAgent(settings, receiver, spool, (CARRIER,))
    task = asyncio.create_task(agent.run())
    try:
        yield agent
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        spool.close()


def numbers(samples: list[PowerSample]) -> list[int]:
    return [round(-s.power_db * 100.0) for s in samples]


async def collect(receiver: PayloadReceiver, into: list[PowerSample]) -> None:
    async for sample in receiver.samples():
        into.append(sample)  # noqa: PERF401 - read while it grows


async def until(condition: Callable[[], object], timeout_s: float = 20.0) -> None:
    async with asyncio.timeout(timeout_s):
        while not condition():  # noqa: ASYNC110 - other tasks' state, no event of its own
            await asyncio.sleep(0.01)


async def test_everything_arrives_once_over_a_link_that_is_cut_again_and_again(tmp_path: Path) -> None:
    radio = CountingReceiver()
    async with running_server() as server, running_agent(tmp_path, server.port, radio):
        receiver = PayloadReceiver(server.hub)
        await receiver.open([CARRIER])
        heard: list[PowerSample] = []
        collecting = asyncio.create_task(collect(receiver, heard))
        for _ in range(8):
            await asyncio.sleep(0.15)
            server.cut()
        await until(lambda: len(heard) > 250)
        collecting.cancel()
    got = numbers(heard)
    assert got == list(range(got[0], got[0] + len(got)))


async def test_agent_restarted_in_mid_sweep_loses_and_doubles_nothing(tmp_path: Path) -> None:
    async with running_server() as server:
        radio = CountingReceiver()
        heard: list[PowerSample] = []
        collecting = None
        for _ in range(4):
            async with running_agent(tmp_path, server.port, radio):
                await until(server.hub.connected)
                if collecting is None:
                    receiver = PayloadReceiver(server.hub)
                    await receiver.open([CARRIER])
                    collecting = asyncio.create_task(collect(receiver, heard))
                await until(lambda radio=radio, made=radio.made: radio.made > made + 40)
            radio = CountingReceiver(radio.made)
        async with running_agent(tmp_path, server.port, radio):
            await until(lambda: len(heard) > 160)
        assert collecting is not None
        collecting.cancel()
    got = numbers(heard)
    assert got == list(range(got[0], got[0] + len(got)))


async def test_server_away_and_back_gets_what_was_spooled(tmp_path: Path) -> None:
    radio = CountingReceiver()
    async with running_server() as first:
        port = first.port
        async with running_agent(tmp_path, port, radio):
            await until(lambda: first.hub.agents and next(iter(first.hub.agents.values())).received > 20)
            agent_state = next(iter(first.hub.agents.values()))
            first.cut()
    # the agent is gone too: a fresh one finds the spool and a server that remembers nothing
    assert agent_state.software == "crossfix"
    async with running_server() as second, running_agent(tmp_path, second.port, CountingReceiver(radio.made)):
        receiver = PayloadReceiver(second.hub)
        subscription = second.hub.subscribe()
        await receiver.open([CARRIER])
        got = [numbers([await subscription.get()])[0] for _ in range(60)]
    assert got == list(range(got[0], got[0] + 60))


async def test_receiver_fault_is_told_and_mended(tmp_path: Path) -> None:
    radio = CountingReceiver()
    radio.fails = 15
    async with running_server() as server, running_agent(tmp_path, server.port, radio):
        states = server.hub.agents
        await until(lambda: states and states["payload"].receiver == ReceiverUnplugged())
        await until(lambda: states["payload"].receiver_ok)
        assert states["payload"].receiver == PayloadListening(1)
        await until(lambda: states["payload"].clock_offset_s is not None)
        assert abs(states["payload"].clock_offset_s or 1.0) < 0.5


def test_a_clock_that_is_set_replaces_the_offset_at_once(tmp_path: Path) -> None:
    clock = {"agent": 1000.0, "server": 1000.2}
    spool = Spool(tmp_path / "samples.sqlite")
    agent = PayloadAgent(AgentSettings((), TOKEN), CountingReceiver(), spool, (CARRIER,), lambda: clock["agent"])

    def offset_after(trip_s: float, set_by_s: float = 0.0) -> float | None:
        sent_s = clock["agent"]
        clock["agent"] += trip_s + set_by_s
        clock["server"] += trip_s
        agent._measured(Pong(agent_s=sent_s, server_s=clock["server"] - trip_s / 2.0))
        return agent._clock_offset()

    assert offset_after(0.010) == pytest.approx(0.2)
    assert offset_after(0.300) == pytest.approx(0.2)
    clock["agent"] += 5000.0
    assert offset_after(0.200) == pytest.approx(0.2 - 5000.0)
    offset_after(0.050, set_by_s=-40.0)  # set while the answer was under way: half of it is missed ...
    assert offset_after(0.200) == pytest.approx(0.2 - 4960.0)  # ... and mended by the next
    spool.close()


async def test_samples_the_wire_cannot_carry_are_left_out_and_told(tmp_path: Path) -> None:
    class Nonsense(CountingReceiver):
        async def samples(self) -> AsyncIterator[PowerSample]:
            async for sample in super().samples():
                yield sample if self.made % 5 else PowerSample(sample.at_s, sample.frequency_hz, math.nan)

    async with running_server() as server, running_agent(tmp_path, server.port, Nonsense()):
        subscription = server.hub.subscribe()
        got = [numbers([await subscription.get()])[0] for _ in range(30)]
        states = server.hub.agents
        await until(lambda: states["payload"].receiver == NonsensicalPower("nan"))
    assert all(number % 5 for number in got)
    assert got == sorted(set(got))


async def test_what_the_payloads_radio_loses_is_told(tmp_path: Path) -> None:
    radio = CountingReceiver()
    radio.lost_percent = 20.0
    async with running_server() as server, running_agent(tmp_path, server.port, radio):
        states, receiver = server.hub.agents, PayloadReceiver(server.hub)
        await receiver.open([CARRIER])
        await until(lambda: states["payload"].receiver == SamplesLost(20.0))
        assert not states["payload"].receiver_ok
        assert receiver.lost_percent == 20.0
        radio.lost_percent = 0.5
        await until(lambda: states["payload"].receiver_ok)
        assert receiver.lost_percent == 0.0


async def test_server_tunes_the_payload_to_several_channels_and_it_remembers(tmp_path: Path) -> None:
    radio = CountingReceiver()
    wanted = (Channel(433_920_000.0), Channel(434_100_000.0))
    async with running_server() as server, running_agent(tmp_path, server.port, radio):
        receiver = PayloadReceiver(server.hub)
        await receiver.open(wanted)
        stream = aiter(receiver.samples())
        got = [await asyncio.wait_for(anext(stream), 60) for _ in range(10)]
        assert {sample.frequency_hz for sample in got} == {433_920_000.0, 434_100_000.0}
        await until(lambda: server.hub.agents["payload"].receiver == PayloadListening(2))
    assert Spool(tmp_path / "samples.sqlite").channels == wanted


class TagReceiver(CountingReceiver):
    """Hears every third pulse."""

    async def samples(self) -> AsyncIterator[PowerSample]:
        async for sample in super().samples():
            yield replace(sample, detected=self.made % 3 == 0)


async def test_a_tag_is_passed_on_to_the_payload_which_says_what_it_heard_and_missed(tmp_path: Path) -> None:
    radio, tag = TagReceiver(), Channel(150e6, Pulses(0.02, 1.3, 0.03))
    async with running_server() as server, running_agent(tmp_path, server.port, radio):
        receiver = PayloadReceiver(server.hub)
        await receiver.open([tag])
        await until(lambda: radio.channels == (tag,))
        stream = aiter(receiver.samples())
        got = [await asyncio.wait_for(anext(stream), 60) for _ in range(10)]
    assert [sample.detected for sample in got] == [number % 3 == 0 for number in numbers(got)]
    assert {sample.detected for sample in got} == {True, False}


async def test_a_payload_that_finds_no_pulses_says_so(tmp_path: Path) -> None:
    class CarrierReceiver(CountingReceiver):
        async def open(self, channels: Sequence[Channel]) -> None:
            await super().open([only_carrier(channels)])

    async with running_server() as server, running_agent(tmp_path, server.port, CarrierReceiver()):
        await PayloadReceiver(server.hub).open([Channel(150e6, Pulses(0.02, 1.3))])
        await until(lambda: server.hub.agents["payload"].receiver == CarriersOnly(150e6))
        assert not server.hub.agents["payload"].receiver_ok


async def test_wrong_token_never_gets_in(tmp_path: Path) -> None:
    async with running_server() as server:
        async with running_agent(tmp_path, server.port, CountingReceiver(), token="not-the-right-token"):
            await asyncio.sleep(0.4)
        assert server.hub.agents == {}
        with refusing(NoPayloadConnected(), ReceiverError):
            await PayloadReceiver(server.hub, connect_within_s=0.1).open([CARRIER])


async def test_killed_process_goes_on_where_it_was(tmp_path: Path) -> None:
    rows = "\n".join(f"{k * 0.02:.2f},{k % 360},{-k / 100.0}" for k in range(3000))
    (tmp_path / "rotation.csv").write_text("time_s,heading_deg,power_db\n" + rows + "\n")
    program = (
        "import typer; from backend.cli.payload import payload; app = typer.Typer(); app.command()(payload); app()"
    )
    async with running_server() as server:
        subscription = server.hub.subscribe()
        arguments = [
            "--config",
            "none.toml",
            "--server",
            f"ws://127.0.0.1:{server.port}",
            "--token",
            TOKEN,
            "--receiver",
            "recording:rotation.csv",
            "--frequency-hz",
            "868300000",
            "--data-dir",
            "spool",
        ]

        async def start() -> asyncio.subprocess.Process:
            return await asyncio.create_subprocess_exec(
                sys.executable, "-c", program, *arguments, cwd=tmp_path, stderr=asyncio.subprocess.DEVNULL
            )

        received: list[int] = []
        for _ in range(2):
            process = await start()
            before = len(received)
            while len(received) < before + 40:
                received += numbers([await asyncio.wait_for(subscription.get(), 120)])
            os.kill(process.pid, signal.SIGKILL)
            await process.wait()
    # each process plays the recording from its beginning: 0, 1, 2 ... then 0, 1, 2 ...
    starts = [k for k, number in enumerate(received) if number == 0]
    assert len(starts) >= 2
    for begin, end in zip(starts, [*starts[1:], len(received)], strict=True):
        assert received[begin:end] == list(range(end - begin))
    assert math.isclose(server.hub.agents["payload"].lost, 0)
