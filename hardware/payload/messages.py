"""What the payload agent and the server say to each other: JSON text, one object a message.

agent:  hello, samples, status, ping          server: welcome, ack, resend, tune, pong, refused
Every power sample has a sequence number that is never reused within a stream (the life of one spool file). The server
acknowledges the last number received without a gap; only then does the agent forget.
"""

from __future__ import annotations

from dataclasses import asdict
from functools import cache
from typing import Annotated, Any, Literal, TypeVar, cast

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from hardware.readings import Channel, Pulses
from hardware.reasons.payload import PayloadStateUnknown
from hardware.reasons.payload_link import MessageNotUnderstood, PayloadLinkReason
from hardware.reasons.union import HardwareReason
from planner.reason import ReasonedError

PROTOCOL = 4
"""3: several channels at once, and the receiver's state as a reason. 4: several tags at one frequency. Others are
refused: update payload and server together."""
MAXIMUM_MESSAGE_BYTES = 256 * 1024
MAXIMUM_BATCH = 1000
MAXIMUM_CHANNELS = 100
MAXIMUM_RHYTHMS = 16
M = TypeVar("M")


class PayloadProtocolError(ReasonedError):
    """The talk ends with this reason."""

    def __init__(self, reason: PayloadLinkReason) -> None:
        super().__init__(reason)
        self._link_reason: PayloadLinkReason = reason

    @property
    def reason(self) -> PayloadLinkReason:
        """What was wrong with the message, or with its turn."""
        return self._link_reason


class Message(BaseModel):
    """Of fields that are all known and numbers that are all finite: anything else is refused when it is parsed."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


Seconds = Annotated[float, Field(ge=0, le=1e11)]
Seq = Annotated[int, Field(ge=1, le=2**62)]
Name = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[\w.\-]+$")]
Hertz = Annotated[float, Field(gt=0, le=1e12)]
Decibel = Annotated[float, Field(ge=-400, le=400)]
WireSample = tuple[Seconds, Hertz, Decibel, Decibel | None, bool, bool]
"""at_s by the agent's clock, frequency_hz, power_db, noise_floor_db, clipped, detected."""


class Hello(Message):
    """first_seq: the oldest sample the agent still holds (the next one it will make when it holds none).

    The same in every version of the protocol, so that another version is refused with a clear reason.
    """

    type: Literal["hello"] = "hello"
    protocol: int
    agent: Name
    stream: Name
    software: str = Field(max_length=80)
    first_seq: Seq


class Samples(Message):
    """Consecutive samples from `first_seq` on. oldest_seq: what the agent still holds begins here.

    clock_offset_s: server time minus agent time, as last measured.
    """

    type: Literal["samples"] = "samples"
    first_seq: Seq
    oldest_seq: Seq
    clock_offset_s: float | None
    samples: list[WireSample] = Field(min_length=1, max_length=MAXIMUM_BATCH)


def _known_reason(value: object, check: ValidatorFunctionWrapHandler) -> Any:
    """A payload that is newer may be in a state that this server has no reason for: its samples count all the same."""
    try:
        return check(value)
    except ValidationError:
        if isinstance(value, dict) and isinstance(code := cast(dict[str, object], value).get("code"), str):
            return PayloadStateUnknown(code[:80])
        raise


WireReason = Annotated[Annotated[HardwareReason, Field(discriminator="code")], WrapValidator(_known_reason)]


class Status(Message):
    """How the agent is. waiting: samples not yet acknowledged; lost: dropped since the spool was full."""

    model_config = ConfigDict(defer_build=True)  # see agent_messages
    type: Literal["status"] = "status"
    receiver: WireReason
    receiver_ok: bool
    temperature_c: float | None
    clock_offset_s: float | None
    round_trip_s: float | None
    clipped_percent: float = Field(ge=0, le=100)
    waiting: int = Field(ge=0)
    lost: int = Field(ge=0)


class Ping(Message):
    """agent_s: UTC by the agent's clock; comes back in Pong, for the round trip and the offset."""

    type: Literal["ping"] = "ping"
    agent_s: Seconds


AgentMessage = Annotated[Hello | Samples | Status | Ping, Field(discriminator="type")]


class WirePulses(Message):
    """A pulsed tag's rhythm, see hardware.readings.Pulses."""

    width_s: float = Field(gt=0, le=10)
    period_s: float = Field(gt=0, le=100)
    jitter_s: float = Field(ge=0, le=10)


class WireChannel(Message):
    """See hardware.readings.Channel. pulses None: a carrier."""

    frequency_hz: Hertz
    pulses: WirePulses | None
    others: list[WirePulses] = Field(default_factory=list[WirePulses], max_length=MAXIMUM_RHYTHMS - 1)

    @classmethod
    def of(cls, channel: Channel) -> WireChannel:
        """As the payload is asked to listen to it."""
        first, *others = [WirePulses(**asdict(pulses)) for pulses in channel.rhythms] or [None]
        return cls(frequency_hz=channel.frequency_hz, pulses=first, others=[one for one in others if one is not None])

    def channel(self) -> Channel:
        """As the receiver on the payload takes it."""
        if self.pulses is None:
            return Channel(self.frequency_hz)
        first, *others = [Pulses(**pulses.model_dump()) for pulses in (self.pulses, *self.others)]
        return Channel(self.frequency_hz, first, tuple(others))


WireChannels = Annotated[list[WireChannel], Field(min_length=1, max_length=MAXIMUM_CHANNELS)]


class Welcome(Message):
    """received_seq: the server has everything up to here (0: nothing). channels None: listen on to what you know."""

    type: Literal["welcome"] = "welcome"
    received_seq: int = Field(ge=0)
    channels: WireChannels | None


class Ack(Message):
    """The server has everything up to `seq`; the agent may forget it."""

    type: Literal["ack"] = "ack"
    seq: int = Field(ge=0)


class Resend(Message):
    """A gap: go on after `seq`."""

    type: Literal["resend"] = "resend"
    seq: int = Field(ge=0)


class Tune(Message):
    """From now on listen to these channels, and to no others."""

    type: Literal["tune"] = "tune"
    channels: WireChannels


class Pong(Message):
    """agent_s: of the Ping. server_s: UTC by the server's clock when it was answered."""

    type: Literal["pong"] = "pong"
    agent_s: Seconds
    server_s: Seconds


class Refused(Message):
    """reason: in English, for the agent's log; a text, so that an agent of every version can read it."""

    type: Literal["refused"] = "refused"
    reason: str = Field(max_length=300)


ServerMessage = Annotated[Welcome | Ack | Resend | Tune | Pong | Refused, Field(discriminator="type")]

_FROM_SERVER: TypeAdapter[Welcome | Ack | Resend | Tune | Pong | Refused] = TypeAdapter(ServerMessage)


@cache
def agent_messages() -> TypeAdapter[Hello | Samples | Status | Ping]:
    """Some eighty reasons are in it, a fiftieth of a server's start: only one that expects a payload makes it."""
    return TypeAdapter(AgentMessage)


def parse_from_agent(text: str | bytes) -> Hello | Samples | Status | Ping:
    """Raises PayloadProtocolError."""
    return _parse(agent_messages(), text)


def parse_from_server(text: str | bytes) -> Welcome | Ack | Resend | Tune | Pong | Refused:
    """Raises PayloadProtocolError."""
    return _parse(_FROM_SERVER, text)


def _parse(adapter: TypeAdapter[M], text: str | bytes) -> M:
    if len(text) > MAXIMUM_MESSAGE_BYTES:
        problem = f"{len(text)} bytes are longer than {MAXIMUM_MESSAGE_BYTES}"
        raise PayloadProtocolError(MessageNotUnderstood("message", problem))
    try:
        return adapter.validate_json(text)
    except (ValidationError, ValueError) as error:
        place, problem = _first_fault(error) if isinstance(error, ValidationError) else ("", str(error))
        raise PayloadProtocolError(MessageNotUnderstood((place or "message")[:80], problem[:160])) from None


def _first_fault(error: ValidationError) -> tuple[str, str]:
    """Where in the message, and what."""
    first = error.errors()[0]
    return ".".join(str(part) for part in first["loc"]), first["msg"]
