"""The payload agent: the process on the companion computer that listens and sends, whatever the link does."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidHandshake, InvalidStatus, InvalidURI, WebSocketException

from hardware.payload.messages import (
    PROTOCOL,
    Ack,
    Hello,
    Message,
    PayloadProtocolError,
    Ping,
    Pong,
    Refused,
    Resend,
    Samples,
    Status,
    Tune,
    Welcome,
    WireChannel,
    parse_from_server,
)
from hardware.payload.spool import Spool, SpoolError
from hardware.ports import LOST_PERCENT, Receiver, ReceiverError
from hardware.readings import Channel, PowerSample
from hardware.reasons.payload import PayloadListening, PayloadStarting
from hardware.reasons.payload_link import MessageOutOfTurn, RefusedByServer
from hardware.reasons.receiver import NonsensicalPower, ReceiverStreamEnded, SamplesLost
from hardware.reasons.union import HardwareReason
from planner.reason import sentence_of

LOG = logging.getLogger("crossfix.payload")
CLOCK_DRIFT_S = 0.01
"""Between eight round trips, at 250 ppm."""
THERMAL_ZONE = Path("/sys/class/thermal/thermal_zone0/temp")


@dataclass(frozen=True, slots=True)
class AgentSettings:
    """servers: websocket URLs, tried in turn. window: samples sent ahead of their acknowledgement."""

    servers: tuple[str, ...]
    token: str
    name: str = "payload"
    software: str = "crossfix"
    batch: int = 200
    window: int = 2000
    flush_s: float = 0.25
    status_s: float = 2.0
    ping_s: float = 5.0
    retry_s: float = 0.5
    longest_retry_s: float = 10.0


class PayloadAgent:
    """Listens with `receiver`, spools, sends. `run` never returns by itself; cancel it.

    Clock offset: server minus agent, from the round trip with the least delay of the last eight pings.
    """

    def __init__(
        self,
        settings: AgentSettings,
        receiver: Receiver,
        spool: Spool,
        channels: Sequence[Channel],
        now: Callable[[], float] = time.time,
    ) -> None:
        self._settings = settings
        self._receiver = receiver
        self._spool = spool
        self._now = now
        self._channels = spool.channels or tuple(channels)
        self._retune = asyncio.Event()
        self._arrived = asyncio.Event()
        self._receiver_state: HardwareReason = PayloadStarting()
        self._clipped: deque[bool] = deque(maxlen=200)
        self._round_trips: deque[tuple[float, float]] = deque(maxlen=8)
        self._acknowledged = 0
        self._sent = 0

    async def run(self) -> None:
        """Listen and keep the link, until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._listen())
            group.create_task(self._keep_link())

    # -- radio to disk

    async def _listen(self) -> None:
        """Receiver to spool; a receiver that fails is opened again."""
        while True:
            try:
                self._retune.clear()
                await self._receiver.open(self._channels)
                self._receiver_state = PayloadListening(len(self._channels))
                await self._spool_until_retuned()
            except (ReceiverError, SpoolError) as error:
                self._receiver_state = error.reason
                LOG.warning("receiver: %s", sentence_of(error.reason))
                await asyncio.sleep(self._settings.retry_s * 2.0)
            finally:
                await self._receiver.close()

    async def _spool_until_retuned(self) -> None:
        heard: list[PowerSample] = []
        flushed_at = time.monotonic()
        samples = aiter(self._receiver.samples())
        pending: asyncio.Task[PowerSample] | None = None
        try:
            while not self._retune.is_set():
                pending = pending or asyncio.ensure_future(anext(samples))
                await asyncio.wait({pending}, timeout=self._settings.flush_s)
                if pending.done():
                    finished, pending = pending, None
                    try:
                        sample = finished.result()
                    except StopAsyncIteration:
                        self._receiver_state = ReceiverStreamEnded()
                        await self._retune.wait()
                        return
                    self._clipped.append(sample.clipped)
                    if sendable(sample):
                        heard.append(sample)
                    else:
                        self._receiver_state = NonsensicalPower(f"{sample.power_db:g}")
                if heard and time.monotonic() - flushed_at >= self._settings.flush_s:
                    batch, heard, flushed_at = heard, [], time.monotonic()
                    await self._flush(batch)
        finally:
            if pending is not None and not pending.cancel() and pending.exception() is None:
                heard += [sample for sample in (pending.result(),) if sendable(sample)]
            if heard:
                await self._flush(heard)

    async def _flush(self, heard: list[PowerSample]) -> None:
        """A batch is written to its end even when the agent is being stopped."""
        writing = asyncio.ensure_future(asyncio.to_thread(self._spool.append, heard))
        try:
            await asyncio.shield(writing)
        except asyncio.CancelledError:
            await writing
            raise
        self._arrived.set()

    # -- disk to server

    async def _keep_link(self) -> None:
        """Connect, and connect again, to the servers in turn, waiting longer each time up to a limit."""
        wait_s = self._settings.retry_s
        attempt = 0
        while True:
            url = self._settings.servers[attempt % len(self._settings.servers)]
            attempt += 1
            try:
                headers = {"Authorization": f"Bearer {self._settings.token}"}
                async with connect(
                    url, additional_headers=headers, open_timeout=10, ping_interval=5, ping_timeout=10
                ) as link:
                    wait_s = self._settings.retry_s
                    await self._talk(link)
            except InvalidStatus as error:
                LOG.error("%s refuses this payload (%s); check its token", url, error.response.status_code)
            except (OSError, TimeoutError, InvalidURI, InvalidHandshake, WebSocketException) as error:
                LOG.warning("%s: %s; trying again in %.1f s", url, error or type(error).__name__, wait_s)
            except PayloadProtocolError as error:
                LOG.error("%s: %s", url, sentence_of(error.reason))
            await asyncio.sleep(wait_s)
            wait_s = min(wait_s * 1.7, self._settings.longest_retry_s)

    async def _talk(self, link: ClientConnection) -> None:
        first = await asyncio.to_thread(self._spool.first_seq)
        await self._send(
            link,
            Hello(
                protocol=PROTOCOL,
                agent=self._settings.name,
                stream=self._spool.stream,
                software=self._settings.software,
                first_seq=first,
            ),
        )
        greeting = parse_from_server(await link.recv())
        if isinstance(greeting, Refused):
            raise PayloadProtocolError(RefusedByServer(greeting.reason))
        if not isinstance(greeting, Welcome):
            raise PayloadProtocolError(MessageOutOfTurn("no_welcome"))
        await self._received(greeting.received_seq)
        self._sent = greeting.received_seq
        if greeting.channels is not None:
            self._tune(greeting.channels)
        LOG.info("connected; the server has everything up to %d", greeting.received_seq)
        tasks = [
            asyncio.create_task(work)
            for work in (self._send_samples(link), self._send_status(link), self._measure_clock(link), self._hear(link))
        ]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _send_samples(self, link: ClientConnection) -> None:
        while True:
            self._arrived.clear()
            room = self._settings.window - (self._sent - self._acknowledged)
            batch: list[tuple[int, PowerSample]] = []
            if room > 0:
                batch = await asyncio.to_thread(self._spool.after, self._sent, min(self._settings.batch, room))
            if not batch:
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(self._settings.flush_s):
                        await self._arrived.wait()
                continue
            run = _consecutive(batch)
            rows: list[Any] = [astuple(sample) for _, sample in run]
            await self._send(
                link,
                Samples(
                    first_seq=run[0][0],
                    oldest_seq=min(await asyncio.to_thread(self._spool.first_seq), run[0][0]),
                    clock_offset_s=self._clock_offset(),
                    samples=rows,
                ),
            )
            self._sent = run[-1][0]

    async def _send_status(self, link: ClientConnection) -> None:
        while True:
            await self._send(link, await asyncio.to_thread(self._status))
            await asyncio.sleep(self._settings.status_s)

    async def _measure_clock(self, link: ClientConnection) -> None:
        while True:
            await self._send(link, Ping(agent_s=self._now()))
            await asyncio.sleep(self._settings.ping_s if len(self._round_trips) >= 4 else self._settings.ping_s / 10.0)

    async def _hear(self, link: ClientConnection) -> None:
        async for text in link:
            message = parse_from_server(text)
            if isinstance(message, Ack):
                await self._received(message.seq)
            elif isinstance(message, Resend):
                self._sent = message.seq
                self._arrived.set()
            elif isinstance(message, Tune):
                self._tune(message.channels)
            elif isinstance(message, Pong):
                self._measured(message)
            elif isinstance(message, Refused):
                raise PayloadProtocolError(RefusedByServer(message.reason))

    async def _received(self, seq: int) -> None:
        self._acknowledged = max(self._acknowledged, seq)
        await asyncio.to_thread(self._spool.forget, seq)
        self._arrived.set()

    def _tune(self, asked: Sequence[WireChannel]) -> None:
        channels = tuple(channel.channel() for channel in asked)
        if channels != self._channels:
            self._channels = self._spool.channels = channels
            self._retune.set()

    def _measured(self, pong: Pong) -> None:
        """An offset errs by at most half its round trip: what contradicts the best so far shows a set clock."""
        back_s = self._now()
        trip_s = max(back_s - pong.agent_s, 0.0)
        offset_s = pong.server_s - (pong.agent_s + back_s) / 2.0
        if self._round_trips:
            best_s, known_s = min(self._round_trips)
            if abs(offset_s - known_s) > (trip_s + best_s) / 2.0 + CLOCK_DRIFT_S:
                self._round_trips.clear()
        self._round_trips.append((trip_s, offset_s))

    def _clock_offset(self) -> float | None:
        return min(self._round_trips)[1] if self._round_trips else None

    def _status(self) -> Status:
        trips, state, lost_percent = self._round_trips, self._receiver_state, self._receiver.lost_percent
        listens = isinstance(state, PayloadListening)
        loses = listens and lost_percent > LOST_PERCENT
        return Status(
            receiver=SamplesLost(lost_percent) if loses else state,
            receiver_ok=listens and not loses,
            temperature_c=_temperature_c(),
            clock_offset_s=self._clock_offset(),
            round_trip_s=min(trips)[0] if trips else None,
            clipped_percent=100.0 * sum(self._clipped) / max(len(self._clipped), 1),
            waiting=self._spool.waiting(),
            lost=self._spool.lost,
        )

    @staticmethod
    async def _send(link: ClientConnection, message: Message) -> None:
        await link.send(message.model_dump_json())


def sendable(sample: PowerSample) -> bool:
    """Whether the wire takes it: a sample it does not take would block all that follow."""
    try:
        row: Any = astuple(sample)
        Samples(first_seq=1, oldest_seq=1, clock_offset_s=None, samples=[row])
    except ValidationError:
        return False
    return True


def _consecutive(batch: list[tuple[int, PowerSample]]) -> list[tuple[int, PowerSample]]:
    """The leading run of consecutive numbers (a full spool may have dropped some in between)."""
    end = next((k for k in range(1, len(batch)) if batch[k][0] != batch[k - 1][0] + 1), len(batch))
    return batch[:end]


def _temperature_c() -> float | None:
    """The board's temperature where Linux tells it."""
    try:
        return int(THERMAL_ZONE.read_text()) / 1000.0
    except (OSError, ValueError):
        return None
