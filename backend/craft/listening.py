"""The receiver while a mission runs: opened, drained without pause, and known to be well, silent or gone."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Literal

from backend.craft.shared_frequency import SharedFrequency
from backend.spec import EmitterSpec, MissionSpec
from hardware.deadline import Deadline
from hardware.ports import Clock, Receiver, ReceiverError
from hardware.readings import Channel, PowerSample, Pulses
from hardware.reasons.channels import FrequencyNotAskedFor
from hardware.reasons.receiver import ReceiverSilent, ReceiverStreamEnded
from hardware.reasons.sweep import PulsesNotGiven
from hardware.reasons.union import HardwareReason
from planner.reason import sentence_of

log = logging.getLogger("crossfix.mission")

KEPT_SAMPLES = 60_000
REOPEN_S = 1.0
MISSED_PULSES = 10
"""This many pulses of a distant tag may be missed."""
LATE_WALL_S = 2.0
OPENING_WALL_S = 10.0
SETTLING_S = 0.3
"""After a change of channels, by the receiver's time: what was sampled before it, or while the tuner locks, is neither
channel's."""
CATCH_UP_S = 0.005
"""A receiver that catches up keeps everybody else waiting no longer; a sample a turn of the loop never catches up."""


class Listening:
    """Keeps the last samples of each channel. A receiver that fails is opened again every second until it answers.

    first: what is listened to until `hear` says otherwise, None: all channels. settling_samples: how many were left
    out, since the receiver was still changing to its channels.
    """

    def __init__(
        self,
        receiver: Receiver,
        clock: Clock,
        channels: Sequence[Channel],
        silent_after_s: float,
        first: Sequence[Channel] | None = None,
    ) -> None:
        self._receiver = receiver
        self._clock = clock
        self._tuned = tuple(channels if first is None else first)
        self._opened = asyncio.Event()
        self._settled_s = -math.inf
        self.settling_samples = 0
        self._ears = {channel.frequency_hz: _Ear(channel, silent_after_s) for channel in channels}
        self._heard_at_s: float | None = None
        self._quiet_s = 0.0
        self._fault: HardwareReason | None = None
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        """In the background until `stop`; whatever is wrong with the receiver shows in `trouble`."""
        self._task = asyncio.create_task(self._listen())

    async def stop(self) -> None:
        """Closes the receiver; afterwards the state is "off"."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
            self._task = None
        await self._receiver.close()

    async def hear(self, channels: Sequence[Channel]) -> None:
        """These from now on, of those that it was made for; returns once the receiver has settled, or is known not to
        have come: whatever is wrong shows in `trouble`."""
        if tuple(channels) == self._tuned:
            return
        running, self._task = self._task, None
        self._tuned = tuple(channels)
        if running is None:
            return
        try:
            running.cancel()
            await asyncio.gather(running, return_exceptions=True)
        finally:  # whoever is called away here leaves a receiver that listens
            self._opened = asyncio.Event()
            self._settled_s = math.inf
            self._quiet_s = 0.0
            self._task = asyncio.create_task(self._listen())
        with suppress(TimeoutError):
            async with asyncio.timeout(OPENING_WALL_S):
                await self._opened.wait()
        await self._clock.sleep(SETTLING_S)

    def hears(self, emitter: EmitterSpec) -> bool:
        """Whether it is tuned to that now."""
        return any(channel.frequency_hz == emitter.frequency_hz for channel in self._tuned)

    async def _listen(self) -> None:
        while True:
            try:
                await self._receiver.open(self._tuned)
                if self._settled_s == math.inf:
                    self._settled_s = self._clock.now() + SETTLING_S
                self._opened.set()
                others_due = time.monotonic()
                async for sample in self._receiver.samples():
                    self._take(sample)
                    if time.monotonic() > others_due:
                        await asyncio.sleep(0)
                        others_due = time.monotonic() + CATCH_UP_S
                self._fault = ReceiverStreamEnded()
            except ReceiverError as error:
                if self._fault is None:
                    log.warning("receiver: %s", sentence_of(error.reason))
                self._fault = error.reason
            await self._clock.sleep(REOPEN_S)

    def _take(self, sample: PowerSample) -> None:
        ear = self._ears.get(sample.frequency_hz)
        if ear is None:
            raise ReceiverError(FrequencyNotAskedFor(sample.frequency_hz))
        if sample.at_s < self._settled_s:
            self.settling_samples += 1
            return
        ear.take(sample)
        self._heard_at_s = self._clock.now()
        self._quiet_s = 0.0
        self._fault = None

    @property
    def state(self) -> Literal["ok", "silent", "off", "lost"]:
        """Of the receiver: it is well as long as any channel delivers."""
        if self._task is None:
            return "off"
        if self._fault is not None:
            return "lost"
        return "silent" if self._quiet_s > min(ear.patience_s for ear in self._listening()) else "ok"

    def wait(self, seconds: float) -> None:
        """So much time went by in which a sample would have been noticed; silence is counted in it."""
        self._quiet_s += seconds

    @property
    def trouble(self) -> HardwareReason | None:
        """What is wrong; None when all is well."""
        match self.state:
            case "lost":
                return self._fault
            case "silent":
                return ReceiverSilent(self._quiet_s)
            case "ok" | "off":
                return None

    @property
    def lost_percent(self) -> float:
        """How much of what a receiver that is well took in the last seconds got lost, 0 to 100. What it says that is no
        number counts for nothing: a fact that holds one could not be read again."""
        told = self._receiver.lost_percent if self.state == "ok" else 0.0
        return min(max(told, 0.0), 100.0) if math.isfinite(told) else 0.0

    @property
    def age_s(self) -> float | None:
        """Since anything was last heard."""
        return None if self._heard_at_s is None else self._clock.now() - self._heard_at_s

    def last(self, frequency_hz: float) -> PowerSample | None:
        """The newest sample of a channel, None before the first. Raises KeyError for a channel not listened to."""
        return self._ears[frequency_hz].last

    def of(self, emitter: EmitterSpec, begin_s: float, end_s: float) -> list[PowerSample]:
        """What was heard of an emitter in [begin_s, end_s], oldest first; pulses that were not heard among them. Of
        several tags at its frequency: only pulses that are its own."""
        return self._ears[emitter.frequency_hz].of(channel_of(emitter).pulses, begin_s, end_s)

    def not_given(self, emitter: EmitterSpec, begin_s: float, end_s: float) -> PulsesNotGiven | None:
        """The pulses at its frequency that are no tag's, or nobody knows whose; None where it sends alone, or where
        there are none."""
        return self._ears[emitter.frequency_hz].not_given(begin_s, end_s)

    async def heard_until(self, at_s: float) -> None:
        """Wait for the samples of the time before `at_s`, of every channel that is listened to: a link or a busy
        machine brings them late.

        Not for a channel of which nothing new came for as long as it may be silent.
        """
        await asyncio.gather(*(self._heard_until(at_s, ear) for ear in self._listening()))

    def _listening(self) -> list[_Ear]:
        return [self._ears[channel.frequency_hz] for channel in self._tuned]

    async def _heard_until(self, at_s: float, ear: _Ear) -> None:
        newest_s = -math.inf
        silence = Deadline(self._clock, ear.patience_s, LATE_WALL_S)
        while newest_s < at_s and not silence.passed:
            if ear.last is not None and ear.last.at_s > newest_s:
                newest_s = ear.last.at_s
                silence = Deadline(self._clock, ear.patience_s, LATE_WALL_S)
            else:
                await asyncio.sleep(0.02)

    async def first_sample(self, frequency_hz: float, wall_s: float) -> bool:
        """Whether a carrier's sample or a tag's pulse is heard within that many wall-clock seconds."""
        try:
            async with asyncio.timeout(wall_s):
                await self._ears[frequency_hz].heard.wait()
        except TimeoutError:
            return False
        return True


class _Ear:
    """What was heard of one channel. patience_s: how long it may be silent before that means anything."""

    def __init__(self, channel: Channel, silent_after_s: float) -> None:
        pulses = channel.pulses
        self.patience_s = silent_after_s if pulses is None else max(silent_after_s, MISSED_PULSES * pulses.period_s)
        self.samples: deque[PowerSample] = deque(maxlen=KEPT_SAMPLES)
        self.heard = asyncio.Event()
        self._tags = SharedFrequency(channel.rhythms) if channel.others else None

    @property
    def last(self) -> PowerSample | None:
        return self.samples[-1] if self.samples else None

    def take(self, sample: PowerSample) -> None:
        self.samples.append(sample)
        if sample.detected:
            self.heard.set()
            if self._tags is not None:
                self._tags.take(sample.at_s)

    def of(self, pulses: Pulses | None, begin_s: float, end_s: float) -> list[PowerSample]:
        heard = self._between(begin_s, end_s)
        if self._tags is None or pulses is None:
            return heard
        own = self._tags.times_of(pulses)
        return [sample for sample in heard if not sample.detected or sample.at_s in own]

    def not_given(self, begin_s: float, end_s: float) -> PulsesNotGiven | None:
        return None if self._tags is None else self._tags.not_given(begin_s, end_s)

    def _between(self, begin_s: float, end_s: float) -> list[PowerSample]:
        found: list[PowerSample] = []
        for sample in reversed(self.samples):
            if sample.at_s < begin_s:
                break
            if sample.at_s <= end_s:
                found.append(sample)
        return found[::-1]


def channel_of(emitter: EmitterSpec) -> Channel:
    """What to listen to for an emitter."""
    if emitter.kind == "carrier":
        return Channel(emitter.frequency_hz)
    return Channel(emitter.frequency_hz, Pulses(emitter.pulse_width_s, emitter.pulse_period_s, emitter.pulse_jitter_s))


def channels_of(mission: MissionSpec) -> tuple[Channel, ...]:
    """All that a mission listens to."""
    return channels_for(mission.emitters)


def channels_for(emitters: Sequence[EmitterSpec]) -> tuple[Channel, ...]:
    """One a frequency, in the specification's order: emitters that share one are heard together, and tags among them
    told apart by their rhythms."""
    channels: dict[float, Channel] = {}
    for emitter in emitters:
        own = channel_of(emitter)
        known = channels.setdefault(emitter.frequency_hz, own)
        if own.pulses is not None and known.pulses is not None and own.pulses not in known.rhythms:
            channels[emitter.frequency_hz] = replace(known, others=(*known.others, own.pulses))
    return tuple(channels.values())
