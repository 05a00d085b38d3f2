"""What the payload agent and the server say to each other: JSON text, one object a message.

agent:  hello, samples, status, ping          server: welcome, ack, resend, tune, pong, refused
Every power sample has a sequence number that is never reused within a stream (the life of one spool file). The server
acknowledges the last number received without a gap; only then does the agent forget.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

PROTOCOL = 2
MAXIMUM_MESSAGE_BYTES = 256 * 1024
MAXIMUM_BATCH = 1000
M = TypeVar("M")


class PayloadProtocolError(ValueError):
    """A message that cannot be; the connection is closed with this sentence as the reason."""


class Message(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


Seconds = Annotated[float, Field(ge=0, le=1e11)]
Seq = Annotated[int, Field(ge=1, le=2**62)]
Name = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[\w.\-]+$")]
Hertz = Annotated[float, Field(gt=0, le=1e12)]
Decibel = Annotated[float, Field(ge=-400, le=400)]
WireSample = tuple[Seconds, Hertz, Decibel, Decibel | None, bool, bool]
"""at_s by the agent's clock, frequency_hz, power_db, noise_floor_db, clipped, detected."""


class Hello(Message):
    """first_seq: the oldest sample the agent still holds (the next one it will make when it holds none)."""

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


class Status(Message):
    """How the agent is. waiting: samples not yet acknowledged; lost: dropped since the spool was full."""

    type: Literal["status"] = "status"
    receiver: str = Field(max_length=300)
    receiver_ok: bool
    temperature_c: float | None
    clock_offset_s: float | None
    round_trip_s: float | None
    clipped_percent: float = Field(ge=0, le=100)
    waiting: int = Field(ge=0)
    lost: int = Field(ge=0)


class Ping(Message):
    type: Literal["ping"] = "ping"
    agent_s: Seconds


AgentMessage = Annotated[Hello | Samples | Status | Ping, Field(discriminator="type")]


class WirePulses(Message):
    """A pulsed tag's rhythm, see hardware.readings.Pulses."""

    width_s: float = Field(gt=0, le=10)
    period_s: float = Field(gt=0, le=100)
    jitter_s: float = Field(ge=0, le=10)


class Welcome(Message):
    """received_seq: the server has everything up to here (0: nothing). pulses: None for a carrier, or for what the
    agent itself is configured for."""

    type: Literal["welcome"] = "welcome"
    received_seq: int = Field(ge=0)
    frequency_hz: Hertz | None
    pulses: WirePulses | None = None


class Ack(Message):
    type: Literal["ack"] = "ack"
    seq: int = Field(ge=0)


class Resend(Message):
    """A gap: go on after `seq`."""

    type: Literal["resend"] = "resend"
    seq: int = Field(ge=0)


class Tune(Message):
    type: Literal["tune"] = "tune"
    frequency_hz: Hertz
    pulses: WirePulses | None = None


class Pong(Message):
    type: Literal["pong"] = "pong"
    agent_s: Seconds
    server_s: Seconds


class Refused(Message):
    type: Literal["refused"] = "refused"
    reason: str = Field(max_length=300)


ServerMessage = Annotated[Welcome | Ack | Resend | Tune | Pong | Refused, Field(discriminator="type")]

_FROM_AGENT: TypeAdapter[Hello | Samples | Status | Ping] = TypeAdapter(AgentMessage)
_FROM_SERVER: TypeAdapter[Welcome | Ack | Resend | Tune | Pong | Refused] = TypeAdapter(ServerMessage)


def parse_from_agent(text: str | bytes) -> Hello | Samples | Status | Ping:
    """Raises PayloadProtocolError."""
    return _parse(_FROM_AGENT, text)


def parse_from_server(text: str | bytes) -> Welcome | Ack | Resend | Tune | Pong | Refused:
    """Raises PayloadProtocolError."""
    return _parse(_FROM_SERVER, text)


def _parse(adapter: TypeAdapter[M], text: str | bytes) -> M:
    if len(text) > MAXIMUM_MESSAGE_BYTES:
        raise PayloadProtocolError(f"a message of {len(text)} bytes is longer than {MAXIMUM_MESSAGE_BYTES}")
    try:
        return adapter.validate_json(text)
    except (ValidationError, ValueError) as error:
        first = error.errors()[0] if isinstance(error, ValidationError) else {"loc": (), "msg": str(error)}
        place = ".".join(str(part) for part in first["loc"]) or "message"
        raise PayloadProtocolError(f"not understood: {place}: {first['msg']}"[:300]) from None
