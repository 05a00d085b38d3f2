"""What every Receiver must do: simulator, the simulator's IQ, rtl_tcp-like IQ, SigMF, recorded sweep, payload link."""

from __future__ import annotations

import asyncio
import itertools
import math
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import numpy as np
import pytest
from stepped_clock import SteppedClock

from hardware.payload.messages import PROTOCOL, Hello, Samples, WireSample
from hardware.payload.receiver import PayloadReceiver
from hardware.payload.session import PayloadHub, PayloadSession
from hardware.ports import Receiver, ReceiverError
from hardware.readings import GeoPoint, PowerSample, Sweep, Telemetry
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.recorded import RecordedReceiver
from hardware.sdr.sigmf_file import write_sigmf
from hardware.sdr.sigmf_playback import SigmfSource
from hardware.sim.iq import SimulatedIq
from hardware.sim.receiver import SimulatedReceiver
from hardware.sim.world import Emitter, World

FREQUENCY_HZ = 868_300_000.0
HOME = GeoPoint(50.6, 7.2)
PATIENCE_S = 20.0
WORLD = World((Emitter(GeoPoint(50.601, 7.2), FREQUENCY_HZ),))


def hovering(clock: SteppedClock) -> Callable[[], Telemetry]:
    return lambda: Telemetry(True, clock.now(), HOME, clock.now(), 100.0, 40.0, clock.now() * 30.0 % 360.0, clock.now())


def simulated(tmp_path: Path) -> Receiver:
    clock = SteppedClock()
    return SimulatedReceiver(WORLD, hovering(clock), clock)


def simulated_iq(tmp_path: Path) -> Receiver:
    clock = SteppedClock()
    return IqReceiver(SimulatedIq(WORLD, hovering(clock), clock))


def sigmf_recording(tmp_path: Path) -> Receiver:
    t = np.arange(48_000) / 24_000.0
    iq = (0.1 * np.exp(2j * np.pi * 1000.0 * t)).astype(np.complex64)
    return IqReceiver(SigmfSource(write_sigmf(tmp_path / "tone", iq, 24_000.0, FREQUENCY_HZ - 1000.0, 1.78e9)))


def recorded(tmp_path: Path) -> Receiver:
    at_s = 0.05 * np.arange(200)
    sweep = Sweep(at_s, 30.0 * at_s, np.full(200, -60.0), FREQUENCY_HZ, HOME, 100.0)
    return RecordedReceiver(sweep, SteppedClock())


class LoopbackPayload:
    """A PayloadReceiver whose agent is a task in this process: batches of five samples as fast as they are wanted."""

    def __init__(self) -> None:
        self.hub = PayloadHub(("a-token-of-some-length",))
        self.receiver = PayloadReceiver(self.hub)
        self.session = PayloadSession(self.hub)
        self.task: asyncio.Task[None] | None = None
        self.next = 1

    async def open(self, frequency_hz: float) -> None:
        if self.task is None:
            self.session.receive(
                Hello(protocol=PROTOCOL, agent="pi", stream="s", software="", first_seq=1).model_dump_json()
            )
            self.task = asyncio.create_task(self._send())
        await self.receiver.open(frequency_hz)

    async def _send(self) -> None:
        while True:
            numbers = range(self.next, self.next + 5)
            rows: list[WireSample] = [(100.0 + k, FREQUENCY_HZ, -60.0, None, False, True) for k in numbers]
            message = Samples(first_seq=self.next, oldest_seq=1, clock_offset_s=None, samples=rows)
            self.session.receive(message.model_dump_json())
            if self.session.refused:
                said = [self.session.outgoing.get_nowait() for _ in range(self.session.outgoing.qsize())]
                raise AssertionError(f"the server refused the samples: {said[-1]}")
            self.next += 5
            await asyncio.sleep(0.005)

    async def close(self) -> None:
        await self.receiver.close()

    def samples(self) -> AsyncIterator[PowerSample]:
        return self.receiver.samples()


def payload(tmp_path: Path) -> Receiver:
    return LoopbackPayload()


@pytest.fixture(params=[simulated, simulated_iq, sigmf_recording, recorded, payload])
async def receiver(request: pytest.FixtureRequest, tmp_path: Path) -> AsyncIterator[Receiver]:
    made = request.param(tmp_path)
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


async def test_samples_are_finite_in_time_order_and_of_the_asked_frequency(receiver: Receiver) -> None:
    await receiver.open(FREQUENCY_HZ)
    heard = await first(receiver, 20)
    await receiver.close()
    assert len(heard) == 20
    assert all(math.isfinite(s.power_db) and s.frequency_hz == FREQUENCY_HZ for s in heard)
    assert all(a.at_s < b.at_s for a, b in itertools.pairwise(heard))
    assert all(s.noise_floor_db is None or s.noise_floor_db < s.power_db + 3.0 for s in heard)


async def test_samples_before_open_are_refused(receiver: Receiver) -> None:
    with pytest.raises(ReceiverError, match="not open"):
        await anext(aiter(receiver.samples()))


async def test_closing_ends_the_samples(receiver: Receiver) -> None:
    await receiver.open(FREQUENCY_HZ)
    count = 0
    async with asyncio.timeout(PATIENCE_S):
        async for _ in receiver.samples():
            count += 1
            if count == 3:
                await receiver.close()
    assert count < 40


async def test_opens_again_after_closing(receiver: Receiver) -> None:
    for _ in range(2):
        await receiver.open(FREQUENCY_HZ)
        assert len(await first(receiver, 3)) == 3
        await receiver.close()


async def test_impossible_frequency_is_refused(receiver: Receiver) -> None:
    with pytest.raises(ReceiverError):
        await receiver.open(-1.0)
