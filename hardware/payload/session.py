"""The server's side of the payload link, whatever carries it: who is connected, what arrived, exactly once.

Mount it on a websocket in a few lines (the token comes in the header "Authorization: Bearer TOKEN"):

    if not hub.authenticate(token): close with code 1008
    await hub.serve(websocket.receive_text, websocket.send_text)
"""

from __future__ import annotations

import asyncio
import hmac
import time
from collections import deque
from collections.abc import Awaitable, Callable
from dataclasses import asdict, dataclass, field, replace

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
    WirePulses,
    parse_from_agent,
)
from hardware.readings import PowerSample, Pulses

CLOCK_OFFSET_LIMIT_S = 0.005
"""A measured clock offset below this is taken as none: the measurement is not better."""
SHORTEST_TOKEN = 16


@dataclass(frozen=True, slots=True)
class AgentState:
    """A payload as the server knows it. clock_offset_s: server minus agent. newest_sample_s: server time."""

    agent: str
    connected: bool
    heard_at_s: float
    software: str = ""
    receiver: str = ""
    receiver_ok: bool = False
    temperature_c: float | None = None
    clock_offset_s: float | None = None
    round_trip_s: float | None = None
    clipped_percent: float = 0.0
    waiting: int = 0
    lost: int = 0
    received: int = 0
    newest_sample_s: float | None = None


@dataclass(slots=True)
class Subscription:
    """Samples for one reader. Bounded: when nobody reads, the oldest go and `dropped` counts them."""

    capacity: int = 20_000
    dropped: int = 0
    _samples: deque[PowerSample] = field(default_factory=deque)
    _ready: asyncio.Event = field(default_factory=asyncio.Event)

    def put(self, sample: PowerSample) -> None:
        self._samples.append(sample)
        if len(self._samples) > self.capacity:
            self._samples.popleft()
            self.dropped += 1
        self._ready.set()

    async def get(self) -> PowerSample:
        while not self._samples:
            self._ready.clear()
            await self._ready.wait()
        return self._samples.popleft()


class PayloadHub:
    """All payloads of one server. `tokens`: what agents authenticate with. `now`: UTC epoch seconds."""

    def __init__(self, tokens: tuple[str, ...], now: Callable[[], float] = time.time) -> None:
        if any(len(token) < SHORTEST_TOKEN for token in tokens):
            raise ValueError(f"a payload token must have at least {SHORTEST_TOKEN} characters; make a longer one")
        self._tokens = tokens
        self.now = now
        self.agents: dict[str, AgentState] = {}
        self.frequency_hz: float | None = None
        self.pulses: WirePulses | None = None
        self._received: dict[str, int] = {}
        self._subscriptions: list[Subscription] = []
        self._sessions: dict[str, PayloadSession] = {}

    def authenticate(self, token: str) -> bool:
        """Whether `token` is one of ours; takes the same time either way."""
        matches = [hmac.compare_digest(token.encode(), known.encode()) for known in self._tokens]
        return any(matches)

    def tune(self, frequency_hz: float, pulses: Pulses | None = None) -> None:
        """Ask every payload, now and when it connects, to listen at this frequency, to this tag's pulses."""
        self.frequency_hz = frequency_hz
        self.pulses = None if pulses is None else WirePulses(**asdict(pulses))
        for session in self._sessions.values():
            session.send(Tune(frequency_hz=frequency_hz, pulses=self.pulses))

    def subscribe(self) -> Subscription:
        subscription = Subscription()
        self._subscriptions.append(subscription)
        return subscription

    def unsubscribe(self, subscription: Subscription) -> None:
        if subscription in self._subscriptions:
            self._subscriptions.remove(subscription)

    def connected(self) -> bool:
        return any(agent.connected for agent in self.agents.values())

    async def serve(self, receive: Callable[[], Awaitable[str]], send: Callable[[str], Awaitable[None]]) -> None:
        """Talk with one agent until `receive` raises (the transport's own exception passes on) or the agent errs.

        A protocol error is told to the agent (Refused) and ends the talk normally: close the socket afterwards.
        """
        session = PayloadSession(self)
        sending = asyncio.create_task(self._send_all(session, send))
        try:
            while not session.refused:
                session.receive(await receive())
            await session.flushed(sending)
        finally:
            sending.cancel()
            session.close()

    @staticmethod
    async def _send_all(session: PayloadSession, send: Callable[[str], Awaitable[None]]) -> None:
        while True:
            text = await session.outgoing.get()
            await send(text)
            session.outgoing.task_done()

    def welcome(self, session: PayloadSession, hello: Hello) -> int:
        """Register the agent (a newer connection of the same agent replaces the older); last number received."""
        older = self._sessions.pop(hello.agent, None)
        if older is not None:
            older.refuse("the same agent connected again")
        self._sessions[hello.agent] = session
        known = self.agents.get(hello.agent) or AgentState(hello.agent, True, self.now())
        self.agents[hello.agent] = replace(known, connected=True, heard_at_s=self.now(), software=hello.software)
        # numbers the agent no longer holds cannot be asked for: they were acknowledged or lost there
        received = max(self._received.get(hello.stream, 0), hello.first_seq - 1)
        self._received[hello.stream] = received
        return received

    def leave(self, session: PayloadSession, agent: str) -> None:
        if self._sessions.get(agent) is session:
            del self._sessions[agent]
            self.agents[agent] = replace(self.agents[agent], connected=False)

    def take(self, agent: str, stream: str, batch: Samples) -> Ack | Resend:
        """Pass on what is new in a batch; each number once, in order, without gaps."""
        received = self._received.get(stream, 0)
        # numbers before `oldest_seq` are gone for good (the spool was full): no use asking for them
        received = max(received, min(batch.oldest_seq, batch.first_seq) - 1)
        if batch.first_seq > received + 1:
            return Resend(seq=received)
        fresh = batch.samples[received + 1 - batch.first_seq :]
        offset = batch.clock_offset_s or 0.0
        offset = offset if abs(offset) > CLOCK_OFFSET_LIMIT_S else 0.0
        for at_s, frequency_hz, power_db, noise_db, clipped, detected in fresh:
            sample = PowerSample(at_s + offset, frequency_hz, power_db, noise_db, clipped, detected)
            for subscription in self._subscriptions:
                subscription.put(sample)
        self._received[stream] = received + len(fresh)
        state = self.agents[agent]
        newest = state.newest_sample_s if not fresh else fresh[-1][0] + offset
        self.agents[agent] = replace(
            state, heard_at_s=self.now(), received=state.received + len(fresh), newest_sample_s=newest
        )
        return Ack(seq=self._received[stream])


class PayloadSession:
    """One connection. Feed `receive`, send what comes out of `outgoing`."""

    def __init__(self, hub: PayloadHub) -> None:
        self._hub = hub
        self._hello: Hello | None = None
        self.refused = False
        self.outgoing: asyncio.Queue[str] = asyncio.Queue()

    def send(self, message: Message) -> None:
        self.outgoing.put_nowait(message.model_dump_json())

    def refuse(self, reason: str) -> None:
        self.send(Refused(reason=reason[:300]))
        self.refused = True

    def receive(self, text: str | bytes) -> None:
        """Take in one message; never raises whatever it holds."""
        if self.refused:
            return
        try:
            self._handle(parse_from_agent(text))
        except PayloadProtocolError as error:
            self.refuse(str(error))

    def _handle(self, message: Hello | Samples | Status | Ping) -> None:
        if isinstance(message, Hello):
            if self._hello is not None:
                raise PayloadProtocolError("hello was said twice")
            if message.protocol != PROTOCOL:
                raise PayloadProtocolError(
                    f"protocol {message.protocol} is not {PROTOCOL}: update the payload's software"
                )
            self._hello = message
            received = self._hub.welcome(self, message)
            self.send(Welcome(received_seq=received, frequency_hz=self._hub.frequency_hz, pulses=self._hub.pulses))
        elif isinstance(message, Ping):
            self.send(Pong(agent_s=message.agent_s, server_s=self._hub.now()))
        elif self._hello is None:
            raise PayloadProtocolError("hello must come first")
        elif isinstance(message, Samples):
            self.send(self._hub.take(self._hello.agent, self._hello.stream, message))
        else:
            state = self._hub.agents[self._hello.agent]
            told = message.model_dump(exclude={"type"})
            self._hub.agents[self._hello.agent] = replace(state, heard_at_s=self._hub.now(), **told)

    async def flushed(self, sending: asyncio.Task[None], timeout_s: float = 1.0) -> None:
        """Wait until everything was sent, or the sender failed."""
        joined = asyncio.create_task(self.outgoing.join())
        await asyncio.wait({joined, sending}, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        joined.cancel()

    def close(self) -> None:
        if self._hello is not None:
            self._hub.leave(self, self._hello.agent)
