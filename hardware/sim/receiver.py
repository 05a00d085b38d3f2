"""The simulated receiver: the Receiver port on top of the simulated world and the vehicle's real telemetry."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hardware.channels import check_channels
from hardware.ports import Clock, ReceiverError
from hardware.readings import Channel, HeadingSample, PowerSample, Pulses, Telemetry
from hardware.reasons.channels import BandTooNarrow
from hardware.reasons.receiver import ReceiverNotOpen, ReceiverUnplugged
from hardware.sim.beat import Beat
from hardware.sim.pose_track import PoseTrack
from hardware.sim.world import Pose, RadioLink, World

OWN_BAND_HZ = 4_000.0
"""What one emitter takes of a narrow receiver's band."""
LOCKS_AFTER_S, UNLOCKED_DB = 0.2, 40.0
DETECTION_DB = 6.0
"""A pulse must stand so far above the noise in the receiver's bandwidth."""


@dataclass(slots=True)
class _Hearing:
    """A channel that is listened to. links: to whom it hears. next_s: when its next sample is due. last_s: when its
    last one was, if any."""

    channel: Channel
    links: list[RadioLink]
    next_s: float = 0.0
    last_s: float | None = None

    @classmethod
    def of(cls, world: World, channel: Channel) -> _Hearing:
        """A carrier: the nearest emitter. A tag: one of its rhythm, if there is any. Several tags: whoever sends pulses
        there, looked for or not."""
        there = [RadioLink(world, channel.frequency_hz, k) for k in range(len(world.emitters_at(channel.frequency_hz)))]
        if channel.others:
            return cls(channel, [link for link in there if _beat(link) is not None])
        fitting = [link for link in there if _in_rhythm(link, channel.pulses)]
        return cls(channel, [*fitting, *there, RadioLink(world, channel.frequency_hz)][:1])

    def next_pulse_s(self, link: RadioLink, after_s: float) -> float:
        """The middle of the next one; of the rhythm that is listened to, where nobody sends."""
        beat, pulses = _beat(link), self.channel.pulses
        if beat is not None:
            return beat.next_s(after_s) + beat.width_s / 2.0
        assert pulses is not None
        return (math.floor(after_s / pulses.period_s + 1e-6) + 1) * pulses.period_s


class SimulatedReceiver:
    """Hears every emitter it is asked for at once, each channel with noise and fading of its own.

    Power samples `rate_hz` times a second of the clock's time (of a tag one a pulse; a tag of another rhythm is not
    heard), each made at the vehicle's pose of that moment. Where several tags are listened to at one frequency, every
    pulse there is heard, and pulses that overlap are heard as one.

    Telemetry comes in steps, and late from a busy machine: a sample waits until a heading at or after its own time was
    heard, and place and heading are interpolated between the reports around it. Where these are too far apart, no
    sample is made: power heard in a direction that is not known would turn the bearing. `headings`, the vehicle's
    since a time, spare the reports between two looks. While telemetry is more than `telemetry_held_s` late, an empty
    sample of the last one's time shows that the receiver lives. Nothing is received before the vehicle knows its
    position.
    band_hz: how wide a band it hears at once, None: any. Such a one delivers, until its tuner has locked, samples that
    are no signal's.
    `silence(True)` makes the receiver go mute and `unplug()` makes it vanish, for rehearsing faults.
    """

    lost_percent = 0.0

    def __init__(
        self,
        world: World,
        pose: Callable[[], Telemetry],
        clock: Clock,
        rate_hz: float = 20.0,
        ground_amsl_m: float = 0.0,
        telemetry_held_s: float = 0.5,
        headings: Callable[[float], Sequence[HeadingSample]] | None = None,
        band_hz: float | None = None,
    ) -> None:
        self._world = world
        self._telemetry = pose
        self._clock = clock
        self._period_s = 1.0 / rate_hz
        self._ground_amsl_m = ground_amsl_m
        self._telemetry_held_s = telemetry_held_s
        self._headings = headings
        self._band_hz = band_hz
        self._locks_s = -math.inf
        self._hearings: list[_Hearing] = []
        self._silent = False
        self._gone = False

    async def open(self, channels: Sequence[Channel]) -> None:
        """See the Receiver port."""
        if self._gone:
            raise ReceiverError(ReceiverUnplugged())
        check_channels(channels)
        self._check_band(channels)
        if self._band_hz is not None:
            self._locks_s = self._clock.now() + LOCKS_AFTER_S
        self._hearings = [_Hearing.of(self._world, channel) for channel in channels]

    def _check_band(self, channels: Sequence[Channel]) -> None:
        if self._band_hz is None:
            return
        first = channels[0].frequency_hz
        reach_hz = [channel.frequency_hz for channel in channels]
        needed_hz = max(reach_hz) - min(reach_hz) + OWN_BAND_HZ
        if needed_hz > self._band_hz:
            away = tuple(hz for hz in reach_hz if abs(hz - first) + OWN_BAND_HZ > self._band_hz) or (reach_hz[-1],)
            raise ReceiverError(BandTooNarrow(self._band_hz, needed_hz, away))

    async def close(self) -> None:
        """Ends samples(). A receiver that was unplugged stays so."""
        self._hearings = []

    def silence(self, silent: bool) -> None:
        """Stop or resume delivering samples, as a hung driver would."""
        self._silent = silent

    def unplug(self) -> None:
        """The device is gone: samples() raises ReceiverError."""
        self._gone = True

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port."""
        hearings = self._hearings
        if not hearings:
            raise ReceiverError(ReceiverNotOpen())
        track = PoseTrack(self._ground_amsl_m)
        self._wait(hearings, self._clock.now())
        while self._hearings is hearings:
            if self._gone:
                raise ReceiverError(ReceiverUnplugged())
            now, heard = self._clock.now(), self._hear(track)
            newest_s = track.newest_s if heard else None
            if newest_s is None or self._silent:
                self._wait(hearings, now)
            else:
                while self._hearings is hearings:
                    due = min(hearings, key=lambda hearing: hearing.next_s)
                    if due.next_s > newest_s:
                        break
                    pose, until_s = track.at(due.next_s), due.next_s
                    if pose is not None:
                        sample, until_s = self._sample(due, pose)
                        due.last_s = sample.at_s
                        yield sample
                    due.next_s = self._next_s(due, until_s)
                if now - newest_s > self._telemetry_held_s:
                    for hearing in hearings:
                        if hearing.last_s is not None:
                            yield self._empty(hearing.last_s, hearing.channel)
            await self._clock.sleep(self._period_s)
            await asyncio.sleep(0)

    def _hear(self, track: PoseTrack) -> bool:
        since_s = track.newest_s
        between = () if self._headings is None or since_s is None else self._headings(since_s)
        return track.hear(self._telemetry(), between)

    def _empty(self, at_s: float, channel: Channel) -> PowerSample:
        noise_dbm = self._world.front_end.noise_dbm
        return PowerSample(at_s, channel.frequency_hz, noise_dbm, noise_dbm, detected=False)

    def _wait(self, hearings: Sequence[_Hearing], now_s: float) -> None:
        """What was due until now is not heard."""
        for hearing in hearings:
            hearing.next_s = self._next_s(hearing, now_s)

    def _next_s(self, hearing: _Hearing, after_s: float) -> float:
        """When the next sample is due: the middle of the next pulse, when pulses are listened to."""
        pulses = hearing.channel.pulses
        if pulses is None:
            return after_s + self._period_s
        own_s = (math.floor(after_s / pulses.period_s + 1e-6) + 1) * pulses.period_s
        return min((hearing.next_pulse_s(link, after_s) for link in hearing.links), default=own_s)

    def _sample(self, hearing: _Hearing, pose: Pose) -> tuple[PowerSample, float]:
        """What is heard now, and until when that lasts: pulses that overlap are one, as loud as their waves together,
        at the time of the strongest."""
        at_s, channel = hearing.next_s, hearing.channel
        noise_dbm = self._world.front_end.noise_dbm
        if at_s < self._locks_s:
            return PowerSample(at_s, channel.frequency_hz, noise_dbm + UNLOCKED_DB, noise_dbm), at_s
        if channel.pulses is None:
            (link,) = hearing.links
            power_dbm, clipped = link.power_dbm(at_s, pose)
            return PowerSample(at_s, channel.frequency_hz, power_dbm, noise_dbm, clipped), at_s
        before_s = at_s - channel.pulses.width_s
        sending = [
            (middle_s, link)
            for link in hearing.links
            if (channel.others or _in_rhythm(link, channel.pulses))
            and (middle_s := hearing.next_pulse_s(link, before_s)) <= at_s + channel.pulses.width_s
            and middle_s >= at_s - 1e-6
        ]
        if not sending:
            return self._empty(at_s, channel), at_s
        waves = [link.amplitude(middle_s, pose) for middle_s, link in sending]
        loudest_s, _ = sending[max(range(len(waves)), key=lambda k: abs(waves[k]))]
        readings, clippings = sending[0][1].read_dbm(np.array([sum(waves)]))
        until_s = max(middle_s for middle_s, _ in sending)
        if not readings[0] > noise_dbm + DETECTION_DB:
            return self._empty(loudest_s, channel), until_s
        heard = PowerSample(loudest_s, channel.frequency_hz, float(readings[0]), noise_dbm, bool(clippings[0]))
        return heard, until_s


def _beat(link: RadioLink) -> Beat | None:
    return None if link.emitter is None else link.emitter.beat


def _in_rhythm(link: RadioLink, pulses: Pulses | None) -> bool:
    """Whether it sends the pulses that are listened to."""
    beat = _beat(link)
    return beat is not None and pulses is not None and abs(beat.period_s - pulses.period_s) <= pulses.jitter_s
