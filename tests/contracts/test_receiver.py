"""What every Receiver must do: simulator, the simulator's IQ, rtl_tcp-like IQ, SigMF, recorded sweep, payload link."""

from __future__ import annotations

import asyncio
import itertools
import math
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from refusals import refusing
from stepped_clock import SteppedClock

from hardware.payload.messages import PROTOCOL, Hello, Samples, WireSample
from hardware.payload.receiver import PayloadReceiver
from hardware.payload.session import PayloadHub, PayloadSession
from hardware.ports import Receiver, ReceiverError
from hardware.readings import Channel, Place, PowerSample, Pulses, Sweep, Telemetry
from hardware.reasons.channels import (
    BandTooNarrow,
    CarriersOnly,
    FrequencyOutOfRange,
    FrequencyTwice,
    NoChannel,
    OneChannelOnly,
)
from hardware.reasons.receiver import ReceiverNotOpen
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.recorded import RecordedReceiver
from hardware.sdr.sigmf_file import write_sigmf
from hardware.sdr.sigmf_playback import SigmfSource
from hardware.sim.iq import SimulatedIq
from hardware.sim.receiver import SimulatedReceiver
from hardware.sim.world import Emitter, World
from planner.reason import Reason

FREQUENCY_HZ = 868_300_000.0
PERIOD_S, WIDTH_S = 0.5, 0.02
CARRIER = Channel(FREQUENCY_HZ)
SECOND = Channel(FREQUENCY_HZ - 9_000.0)
TAG = Channel(FREQUENCY_HZ + 9_000.0, Pulses(WIDTH_S, PERIOD_S))
SHARED = Channel(FREQUENCY_HZ - 18_000.0, Pulses(WIDTH_S, PERIOD_S), (Pulses(WIDTH_S, 0.4),))
FAR = Channel(FREQUENCY_HZ + 40e6)
HOME = Place(50.6, 7.2)
PATIENCE_S = 20.0
NORTH = Place(50.601, 7.2)
WORLD = World(
    (
        Emitter(NORTH, FREQUENCY_HZ),
        Emitter(NORTH, SECOND.frequency_hz),
        Emitter(NORTH, TAG.frequency_hz, pulse_period_s=PERIOD_S, pulse_width_s=WIDTH_S),
        Emitter(NORTH, SHARED.frequency_hz, pulse_period_s=PERIOD_S, pulse_width_s=WIDTH_S, pulse_phase_s=0.3),
        Emitter(NORTH, SHARED.frequency_hz, pulse_period_s=0.4, pulse_width_s=WIDTH_S, pulse_phase_s=0.17),
    )
)


@dataclass(frozen=True, slots=True)
class Rig:
    """several, pulses, far: why it refuses two channels, a tag beside a carrier, and one far away; None: it hears."""

    make: Callable[[Path], Receiver]
    several: type[Reason] | None = None
    pulses: type[Reason] | None = None
    far: type[Reason] | None = None


def hovering(clock: SteppedClock) -> Callable[[], Telemetry]:
    return lambda: Telemetry(True, clock.now(), HOME, clock.now(), 100.0, 40.0, clock.now() * 30.0 % 360.0, clock.now())


def simulated(tmp_path: Path) -> Receiver:
    clock = SteppedClock()
    return SimulatedReceiver(WORLD, hovering(clock), clock)


def simulated_iq(tmp_path: Path) -> Receiver:
    clock = SteppedClock()
    return IqReceiver(SimulatedIq(WORLD, hovering(clock), clock))


def sigmf_recording(tmp_path: Path) -> Receiver:
    rate_hz, centre_hz = 48_000.0, FREQUENCY_HZ - 1000.0
    t = np.arange(int(6 * rate_hz)) / rate_hz

    def tone(channel: Channel) -> np.ndarray:
        return 0.1 * np.exp(2j * np.pi * (channel.frequency_hz - centre_hz) * t)

    iq = tone(CARRIER) + tone(SECOND) + np.where(t % PERIOD_S < WIDTH_S, tone(TAG), 0.0)
    both = ((t - 0.3) % PERIOD_S < WIDTH_S) | ((t - 0.17) % 0.4 < WIDTH_S)
    iq += np.where(both, tone(SHARED), 0.0)
    rng = np.random.default_rng(1)
    iq += 1e-4 * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))
    return IqReceiver(SigmfSource(write_sigmf(tmp_path / "tones", iq, rate_hz, centre_hz, 1.78e9)))


def recorded(tmp_path: Path) -> Receiver:
    at_s = np.linspace(0.0, 9.95, 200)
    sweep = Sweep(at_s, 30.0 * at_s, np.full(200, -60.0), FREQUENCY_HZ, HOME, 100.0)
    return RecordedReceiver(sweep, SteppedClock())


class LoopbackPayload:
    """A PayloadReceiver whose agent is a task in this process: five samples a channel as fast as they are wanted."""

    def __init__(self) -> None:
        self.hub = PayloadHub(("a-token-of-some-length",))
        self.receiver = PayloadReceiver(self.hub)
        self.session = PayloadSession(self.hub)
        self.task: asyncio.Task[None] | None = None
        self.next = 1

    @property
    def lost_percent(self) -> float:
        return self.receiver.lost_percent

    async def open(self, channels: Sequence[Channel]) -> None:
        if self.task is None:
            self.session.receive(
                Hello(protocol=PROTOCOL, agent="pi", stream="s", software="", first_seq=1).model_dump_json()
            )
            self.task = asyncio.create_task(self._send())
        await self.receiver.open(channels)

    async def _send(self) -> None:
        while True:
            await asyncio.sleep(0.005)
            rows: list[WireSample] = [
                (100.0 + self.next + k, channel.frequency_hz, -60.0, None, False, True)
                for k in range(5)
                for channel in self.hub.channels or []
            ]
            if not rows:
                continue
            message = Samples(first_seq=self.next, oldest_seq=1, clock_offset_s=None, samples=rows)
            self.session.receive(message.model_dump_json())
            if self.session.refused:
                said = [self.session.outgoing.get_nowait() for _ in range(self.session.outgoing.qsize())]
                raise AssertionError(f"the server refused the samples: {said[-1]}")
            self.next += len(rows)

    async def close(self) -> None:
        await self.receiver.close()

    def samples(self) -> AsyncIterator[PowerSample]:
        return self.receiver.samples()


def payload(tmp_path: Path) -> Receiver:
    return LoopbackPayload()


RIGS = {
    "simulated": Rig(simulated),
    "simulated_iq": Rig(simulated_iq, far=BandTooNarrow),
    "sigmf_recording": Rig(sigmf_recording, far=BandTooNarrow),
    "recorded": Rig(recorded, several=OneChannelOnly, pulses=CarriersOnly, far=OneChannelOnly),
    "payload": Rig(payload),
}


@pytest.fixture(params=RIGS)
def rig(request: pytest.FixtureRequest) -> Rig:
    return RIGS[request.param]


@pytest.fixture
async def receiver(rig: Rig, tmp_path: Path) -> AsyncIterator[Receiver]:
    made = rig.make(tmp_path)
    yield made
    if isinstance(made, LoopbackPayload) and made.task is not None:
        if made.task.done():
            made.task.result()  # says why the double stopped sending
        made.task.cancel()


async def first(receiver: Receiver, count: int) -> list[PowerSample]:
    heard: list[PowerSample] = []
    try:
        async with asyncio.timeout(PATIENCE_S):
            async for sample in receiver.samples():
                heard.append(sample)
                if len(heard) == count:
                    break
    except TimeoutError:
        pytest.fail(f"{count} samples were wanted, {len(heard)} came within {PATIENCE_S:.0f} s")
    return heard


async def hear_each(receiver: Receiver, channels: Sequence[Channel], count: int) -> dict[float, list[PowerSample]]:
    """At least `count` samples of every channel."""
    await receiver.open(channels)
    heard: dict[float, list[PowerSample]] = {channel.frequency_hz: [] for channel in channels}
    try:
        async with asyncio.timeout(PATIENCE_S):
            async for sample in receiver.samples():
                heard[sample.frequency_hz].append(sample)  # a frequency nobody asked for is a KeyError
                if min(map(len, heard.values())) >= count:
                    break
    except TimeoutError:
        pytest.fail(f"{count} samples of each were wanted, there are {[len(one) for one in heard.values()]}")
    await receiver.close()
    assert min(map(len, heard.values())) >= count, "it ended before"
    return heard


async def test_a_receiver_that_loses_nothing_says_so(receiver: Receiver) -> None:
    assert receiver.lost_percent == 0.0
    await receiver.open([Channel(FREQUENCY_HZ)])
    await first(receiver, 5)
    assert receiver.lost_percent == 0.0


async def test_samples_are_finite_in_time_order_and_of_the_asked_frequency(receiver: Receiver) -> None:
    await receiver.open([CARRIER])
    heard = await first(receiver, 20)
    await receiver.close()
    assert len(heard) == 20
    assert all(math.isfinite(s.power_db) and s.frequency_hz == FREQUENCY_HZ for s in heard)
    assert all(a.at_s < b.at_s for a, b in itertools.pairwise(heard))
    assert all(s.noise_floor_db is None or s.noise_floor_db < s.power_db + 3.0 for s in heard)


async def test_of_several_tags_at_one_frequency_every_pulse_is_heard(receiver: Receiver, rig: Rig) -> None:
    if rig.pulses is not None:
        with refusing(CarriersOnly(SHARED.frequency_hz), ReceiverError):
            await receiver.open([SHARED])
        return
    heard = [sample for sample in (await hear_each(receiver, [SHARED], 12))[SHARED.frequency_hz] if sample.detected]
    assert all(a.at_s < b.at_s for a, b in itertools.pairwise(heard))
    if isinstance(receiver, LoopbackPayload):
        assert receiver.hub.channels is not None
        assert [one.channel() for one in receiver.hub.channels] == [SHARED], "the payload hears of every rhythm"
        return
    seconds = heard[-1].at_s - heard[0].at_s
    assert len(heard) > 1.3 * seconds / 0.4, "more than either tag sends alone"


async def test_samples_before_open_are_refused(receiver: Receiver) -> None:
    with refusing(ReceiverNotOpen(), ReceiverError):
        await anext(aiter(receiver.samples()))
    await receiver.open([CARRIER])
    assert await first(receiver, 1), "it can be opened all the same"


async def test_closing_ends_the_samples(receiver: Receiver) -> None:
    await receiver.open([CARRIER])
    count = 0
    async with asyncio.timeout(PATIENCE_S):
        async for _ in receiver.samples():
            count += 1
            if count == 3:
                await receiver.close()
    assert count < 40


async def test_opens_again_after_closing(receiver: Receiver) -> None:
    for _ in range(2):
        await receiver.open([CARRIER])
        assert len(await first(receiver, 3)) == 3
        await receiver.close()


async def test_two_channels_are_heard_at_once_or_refused(rig: Rig, receiver: Receiver) -> None:
    if rig.several is not None:
        with refusing(rig.several, ReceiverError):
            await receiver.open([CARRIER, SECOND])
        return
    for samples in (await hear_each(receiver, [CARRIER, SECOND], 20)).values():
        assert all(a.at_s < b.at_s for a, b in itertools.pairwise(samples))
        assert all(s.detected and math.isfinite(s.power_db) for s in samples)


async def test_a_tag_is_heard_beside_a_carrier_or_refused(rig: Rig, receiver: Receiver) -> None:
    if rig.pulses is not None:
        with refusing(rig.pulses, ReceiverError):
            await receiver.open([TAG])
        return
    heard = await hear_each(receiver, [CARRIER, TAG], 6)
    pulses = heard[TAG.frequency_hz]
    assert any(pulse.detected for pulse in pulses)
    assert all(a.at_s < b.at_s for a, b in itertools.pairwise(pulses))
    assert all(sample.detected for sample in heard[FREQUENCY_HZ])


async def test_a_channel_out_of_band_is_refused_by_name_or_heard(rig: Rig, receiver: Receiver) -> None:
    if rig.far is None:
        assert await hear_each(receiver, [CARRIER, FAR], 5)
        return
    with pytest.raises(ReceiverError) as refused:
        await receiver.open([CARRIER, FAR])
    reason = refused.value.reason
    assert isinstance(reason, rig.far)
    if isinstance(reason, BandTooNarrow):
        assert reason.refused_hz == (FAR.frequency_hz,)
        assert reason.needed_hz > 40e6
    assert len((await hear_each(receiver, [CARRIER], 3))[FREQUENCY_HZ]) >= 3


@pytest.mark.parametrize(
    ("channels", "reason"),
    [
        ([Channel(-1.0)], FrequencyOutOfRange(-1.0)),
        ([], NoChannel()),
        ([CARRIER, Channel(FREQUENCY_HZ, Pulses(WIDTH_S, PERIOD_S))], FrequencyTwice(FREQUENCY_HZ)),
    ],
)
async def test_channels_that_cannot_be_are_refused(receiver: Receiver, channels: list[Channel], reason: Reason) -> None:
    with refusing(reason, ReceiverError):
        await receiver.open(channels)
    await receiver.open([CARRIER])
    assert await first(receiver, 1), "it can be opened all the same"
