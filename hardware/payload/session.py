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
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, field, replace

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
    agent_messages,
    parse_from_agent,
)
from hardware.readings import Channel, PowerSample
from hardware.reasons.payload_link import MessageOutOfTurn, OtherProtocol, PayloadConnectedAgain, PayloadLinkReason
from hardware.reasons.union import HardwareReason
from planner.reason import sentence_of

CLOCK_OFFSET_LIMIT_S = 0.005
"""A measured clock offset below this is taken as none: the measurement is not better."""
SHORTEST_TOKEN = 16


@dataclass(frozen=True, slots=True)
class AgentState:
    """A payload as the server knows it. receiver: how its receiver is, None until it has said so.

    clock_offset_s: server minus agent. newest_sample_s: server time.
    """

    agent: str
    connected: bool
    heard_at_s: float
    software: str = ""
    receiver: HardwareReason | None = None
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
    _samples: deque[PowerSample] = field(default_factory=deque[PowerSample])
    _ready: asyncio.Event = field(default_factory=asyncio.Event)

    def put(self, sample: PowerSample) -> None:
        """Never waits: beyond `capacity` the oldest sample goes."""
        self._samples.append(sample)
        if len(self._samples) > self.capacity:
            self._samples.popleft()
            self.dropped += 1
        self._ready.set()

    async def get(self) -> PowerSample:
        """Waits for the next sample, for ever if none comes."""
        while not self._samples:
            self._ready.clear()
            await self._ready.wait()
        return self._samples.popleft()


class PayloadHub:
    """All payloads of one server. `tokens`: what agents authenticate with. `now`: UTC epoch seconds."""

    def __init__(self, tokens: tuple[str, ...], now: Callable[[], float] = time.time) -> None:
        if any(len(token) < SHORTEST_TOKEN for token in tokens):
            raise ValueError(f"a payload token must have at least {SHORTEST_TOKEN} characters; make a longer one")
        agent_messages()  # now, not while an agent waits and a mission flies
        self._tokens = tokens
        self.now = now
        self.agents: dict[str, AgentState] = {}
        self.channels: list[WireChannel] | None = None
        self._received: dict[str, int] = {}
        self._subscriptions: list[Subscription] = []
        self._sessions: dict[str, PayloadSession] = {}

    def authenticate(self, token: str) -> bool:
        """Whether `token` is one of ours; takes the same time either way."""
        matches = [hmac.compare_digest(token.encode(), known.encode()) for known in self._tokens]
        return any(matches)

    def tune(self, channels: Sequence[Channel]) -> None:
        """Ask every payload, now and when it connects, to listen to these channels."""
        self.channels = [WireChannel.of(channel) for channel in channels]
        for session in self._sessions.values():
            session.send(Tune(channels=self.channels))

    def subscribe(self) -> Subscription:
        """Samples of all agents from now on; `unsubscribe` it when done."""
        subscription = Subscription()
        self._subscriptions.append(subscription)
        return subscription

    def unsubscribe(self, subscription: Subscription) -> None:
        """Harmless for a subscription that has ended already."""
        if subscription in self._subscriptions:
            self._subscriptions.remove(subscription)

    def connected(self) -> bool:
        """Whether any payload is on the line now."""
        return any(agent.connected for agent in self.agents.values())

    async def serve(self, receive: Callable[[], Awaitable[str]], send: Callable[[str], Awaitable[None]]) -> None:
        """Talk with one agent until `receive` raises (the transport's own exception passes on) or the agent errs.

        A protocol error is sent to the agent (Refused) and ends the talk normally: close the socket afterwards.
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
            older.refuse(PayloadConnectedAgain(hello.agent))
        self._sessions[hello.agent] = session
        known = self.agents.get(hello.agent) or AgentState(hello.agent, True, self.now())
        self.agents[hello.agent] = replace(known, connected=True, heard_at_s=self.now(), software=hello.software)
        # numbers the agent no longer holds cannot be asked for: they were acknowledged or lost there
        received = max(self._received.get(hello.stream, 0), hello.first_seq - 1)
        self._received[hello.stream] = received
        return received

    def leave(self, session: PayloadSession, agent: str) -> None:
        """Does nothing when a newer connection of that agent has taken the session's place."""
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
        """Queues the message; never waits."""
        self.outgoing.put_nowait(message.model_dump_json())

    def refuse(self, reason: PayloadLinkReason) -> None:
        """The last message: what is received after it is ignored."""
        self.send(Refused(reason=sentence_of(reason)[:300]))
        self.refused = True

    def receive(self, text: str | bytes) -> None:
        """Take in one message; never raises whatever it holds."""
        if self.refused:
            return
        try:
            self._handle(parse_from_agent(text))
        except PayloadProtocolError as error:
            self.refuse(error.reason)

    def _handle(self, message: Hello | Samples | Status | Ping) -> None:
        if isinstance(message, Hello):
            if self._hello is not None:
                raise PayloadProtocolError(MessageOutOfTurn("second_hello"))
            if message.protocol != PROTOCOL:
                older = "payload" if message.protocol < PROTOCOL else "server"
                raise PayloadProtocolError(OtherProtocol(message.protocol, PROTOCOL, older))
            self._hello = message
            received = self._hub.welcome(self, message)
            self.send(Welcome(received_seq=received, channels=self._hub.channels))
        elif isinstance(message, Ping):
            self.send(Pong(agent_s=message.agent_s, server_s=self._hub.now()))
        elif self._hello is None:
            raise PayloadProtocolError(MessageOutOfTurn("no_hello"))
        elif isinstance(message, Samples):
            self.send(self._hub.take(self._hello.agent, self._hello.stream, message))
        else:
            state = self._hub.agents[self._hello.agent]
            values = {name: value for name, value in message if name != "type"}
            self._hub.agents[self._hello.agent] = replace(state, heard_at_s=self._hub.now(), **values)

    async def flushed(self, sending: asyncio.Task[None], timeout_s: float = 1.0) -> None:
        """Wait until everything was sent, or the sender failed."""
        joined = asyncio.create_task(self.outgoing.join())
        await asyncio.wait({joined, sending}, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        joined.cancel()

    def close(self) -> None:
        """Marks the agent as disconnected; its state and numbers stay for when it comes back."""
        if self._hello is not None:
            self._hub.leave(self, self._hello.agent)
