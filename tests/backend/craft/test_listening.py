from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable

import pytest
from equipment import HummingReceiver
from facts import AREA

from backend.craft import listening as module
from backend.craft.listening import Listening, channels_of
from backend.spec import EmitterSpec, MissionSpec
from hardware.clock import ScaledClock
from hardware.readings import Channel, PowerSample, Pulses
from hardware.reasons.channels import FrequencyNotAskedFor
from hardware.reasons.receiver import ReceiverSilent, ReceiverStreamEnded, ReceiverUnplugged

CARRIER_HZ, TAG_HZ = 868.3e6, 150e6
BEACON = EmitterSpec(frequency_hz=CARRIER_HZ)
CARRIER, TAG = Channel(CARRIER_HZ), Channel(TAG_HZ, Pulses(0.02, 1.3))


def made(*channels: Channel) -> tuple[Listening, HummingReceiver, ScaledClock]:
    clock = ScaledClock(factor=50.0)
    receiver = HummingReceiver(clock)
    return Listening(receiver, clock, channels or (CARRIER,), silent_after_s=5.0), receiver, clock


async def until(happened: Callable[[], bool]) -> None:
    async with asyncio.timeout(60):
        while True:
            if happened():
                return
            await asyncio.sleep(0.002)


async def test_samples_of_an_interval_come_in_order() -> None:
    listening, _, clock = made()
    assert listening.state == "off"
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    begin = clock.now()
    await clock.sleep(3.0)
    end = clock.now()
    await clock.sleep(1.0)
    found = listening.of(BEACON, begin, end)
    assert found
    assert [s.at_s for s in found] == sorted(s.at_s for s in found)
    assert all(begin <= s.at_s <= end for s in found)
    assert listening.of(BEACON, end + 100.0, end + 200.0) == []
    assert listening.state == "ok"
    await listening.stop()
    assert listening.state == "off"


@pytest.mark.parametrize(("told", "said"), [(math.nan, 0.0), (math.inf, 0.0), (-5.0, 0.0), (400.0, 100.0), (6.5, 6.5)])
async def test_what_a_receiver_says_that_it_loses_is_a_share(told: float, said: float) -> None:
    """It becomes a fact: one that holds no number could not be read again, nor the mission that it is part of."""
    listening, receiver, _ = made()
    receiver.lost_percent = told
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    assert listening.lost_percent == said
    await listening.stop()


async def test_samples_that_come_late_are_waited_for() -> None:
    listening, receiver, clock = made()
    due_s = clock.now() + 2.0

    async def late() -> AsyncIterator[PowerSample]:
        await clock.sleep(6.0)
        for k in range(5):
            yield PowerSample(due_s - 1.0 + 0.5 * k, CARRIER_HZ, -60.0)
        await asyncio.Event().wait()

    receiver.samples = late  # type: ignore[method-assign]
    listening.start()
    async with asyncio.timeout(60):
        await listening.heard_until(due_s)
    in_time = listening.of(BEACON, due_s - 2.0, due_s)
    assert [s.at_s for s in in_time] == pytest.approx([due_s - 1.0, due_s - 0.5, due_s])
    await listening.stop()


async def test_a_silent_receiver_is_not_waited_for_longer_than_it_may_be_silent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "LATE_WALL_S", 0.01)
    listening, receiver, clock = made()
    receiver.mute = True
    listening.start()
    began_s = clock.now()
    async with asyncio.timeout(60):
        await listening.heard_until(began_s)
    assert clock.now() - began_s >= 5.0
    assert listening.last(CARRIER_HZ) is None
    await listening.stop()


async def test_a_receiver_with_a_backlog_without_end_keeps_nobody_waiting() -> None:
    listening, receiver, clock = made()

    async def flood() -> AsyncIterator[PowerSample]:
        while True:
            yield PowerSample(clock.now(), CARRIER_HZ, -60.0)

    receiver.samples = flood  # type: ignore[method-assign]
    listening.start()
    async with asyncio.timeout(60):
        for _ in range(50):
            await asyncio.sleep(0)
    assert listening.last(CARRIER_HZ) is not None
    await listening.stop()


async def test_silence_is_counted_in_time_that_was_watched() -> None:
    listening, receiver, _ = made()
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    receiver.mute = True
    await asyncio.sleep(0.2)
    assert listening.state == "ok"
    for _ in range(6):
        listening.wait(1.0)
    assert listening.state == "silent"
    assert listening.trouble == ReceiverSilent(6.0)
    receiver.mute = False
    await until(lambda: listening.state == "ok")
    await listening.stop()


async def test_a_receiver_that_vanishes_is_lost_and_found_again() -> None:
    listening, receiver, _ = made()
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    receiver.gone = True
    await until(lambda: listening.state == "lost")
    assert listening.trouble == ReceiverUnplugged()
    receiver.gone = False
    await until(lambda: listening.state == "ok")
    assert listening.trouble is None
    await listening.stop()


async def test_a_mute_receiver_gives_no_first_sample() -> None:
    listening, receiver, _ = made()
    receiver.mute = True
    listening.start()
    assert not await listening.first_sample(CARRIER_HZ, 0.1)
    await listening.stop()


async def test_a_receiver_that_hears_no_pulse_of_the_tag_is_well_and_has_heard_nothing() -> None:
    listening, receiver, _ = made()
    receiver.unheard = True
    listening.start()
    await until(lambda: listening.last(CARRIER_HZ) is not None)
    assert not await listening.first_sample(CARRIER_HZ, 0.05)
    assert listening.state == "ok"
    receiver.unheard = False
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    await listening.stop()


async def test_each_channel_keeps_its_own_samples() -> None:
    listening, _, clock = made(CARRIER, TAG)
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    assert await listening.first_sample(TAG_HZ, 5.0)
    now = clock.now()
    await listening.heard_until(now)
    for frequency_hz in (CARRIER_HZ, TAG_HZ):
        found = listening.of(EmitterSpec(frequency_hz=frequency_hz), 0.0, now)
        assert found
        assert {sample.frequency_hz for sample in found} == {frequency_hz}
    await listening.stop()


async def test_a_receiver_that_delivers_one_channel_is_well_while_the_other_is_waited_for_in_its_own_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "LATE_WALL_S", 0.01)
    listening, receiver, clock = made(CARRIER, TAG)

    async def carrier_only() -> AsyncIterator[PowerSample]:
        while True:
            await clock.sleep(0.2)
            yield PowerSample(clock.now(), CARRIER_HZ, -60.0)

    receiver.samples = carrier_only  # type: ignore[method-assign]
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    began_s = clock.now()
    async with asyncio.timeout(60):
        await listening.heard_until(began_s)
    assert clock.now() - began_s >= module.MISSED_PULSES * 1.3
    assert listening.last(TAG_HZ) is None
    assert listening.state == "ok"
    await listening.stop()


@pytest.mark.parametrize(("channels", "silent_after_s"), [((TAG,), 13.0), ((CARRIER, TAG), 5.0)])
async def test_silence_is_reckoned_by_the_channel_that_is_due_first(
    channels: tuple[Channel, ...], silent_after_s: float
) -> None:
    listening, receiver, _ = made(*channels)
    receiver.mute = True
    listening.start()
    listening.wait(silent_after_s - 0.5)
    assert listening.state == "ok"
    listening.wait(1.0)
    assert listening.state == "silent"
    await listening.stop()


async def test_a_stream_that_ends_or_strays_is_trouble() -> None:
    listening, receiver, clock = made()

    async def once(frequency_hz: float) -> AsyncIterator[PowerSample]:
        yield PowerSample(clock.now(), frequency_hz, -60.0)

    receiver.samples = lambda: once(CARRIER_HZ)  # type: ignore[method-assign]
    listening.start()
    await until(lambda: listening.trouble == ReceiverStreamEnded())
    receiver.samples = lambda: once(TAG_HZ)  # type: ignore[method-assign]
    await until(lambda: listening.trouble == FrequencyNotAskedFor(TAG_HZ))
    assert listening.state == "lost"
    last = listening.last(CARRIER_HZ)
    assert last is not None
    assert last.frequency_hz == CARRIER_HZ, "what strayed is not taken for the channel's own"
    await listening.stop()


def test_emitters_that_share_a_frequency_are_heard_together() -> None:
    tag = EmitterSpec(emitter_id="tag", frequency_hz=TAG_HZ, kind="pulsed", pulse_width_s=0.02, pulse_period_s=1.3)
    others = [EmitterSpec(emitter_id=name, frequency_hz=CARRIER_HZ) for name in ("one", "other")]
    mission = MissionSpec(name="m", area=AREA, emitters=[*others, tag])
    assert channels_of(mission) == (CARRIER, TAG)


async def test_a_change_of_channels_leaves_out_and_counts_what_was_heard_before_the_receiver_settled() -> None:
    clock = ScaledClock(factor=50.0)
    receiver = HummingReceiver(clock)
    listening = Listening(receiver, clock, (CARRIER, TAG), silent_after_s=5.0, first=(CARRIER,))
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    assert receiver.frequencies_hz == [CARRIER_HZ]
    changed_s = clock.now()
    humming = receiver.samples

    async def stale_first() -> AsyncIterator[PowerSample]:
        yield PowerSample(changed_s - 1.0, TAG_HZ, -30.0)
        async for sample in humming():
            yield sample

    receiver.samples = stale_first  # type: ignore[method-assign]
    await listening.hear((TAG,))
    assert receiver.frequencies_hz == [TAG_HZ]
    assert (listening.hears(BEACON), listening.hears(EmitterSpec(frequency_hz=TAG_HZ))) == (False, True)
    assert await listening.first_sample(TAG_HZ, 5.0)
    assert listening.state == "ok"
    first = listening.of(EmitterSpec(frequency_hz=TAG_HZ), 0.0, clock.now())[0]
    assert first.at_s >= changed_s + module.SETTLING_S
    assert listening.settling_samples >= 1
    await listening.hear((TAG,))
    last = listening.last(CARRIER_HZ)
    assert last is not None
    assert last.at_s <= changed_s + 0.5, "the carrier is not listened to any more"
    await listening.stop()


async def test_a_change_that_is_called_off_leaves_a_receiver_that_listens() -> None:
    clock = ScaledClock(factor=50.0)
    listening = Listening(HummingReceiver(clock), clock, (CARRIER, TAG), silent_after_s=5.0, first=(CARRIER,))
    listening.start()
    assert await listening.first_sample(CARRIER_HZ, 5.0)
    changing = asyncio.create_task(listening.hear((TAG,)))
    await asyncio.sleep(0)
    changing.cancel()
    await asyncio.gather(changing, return_exceptions=True)
    assert await listening.first_sample(TAG_HZ, 5.0)
    await listening.stop()
