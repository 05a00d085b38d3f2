"""The simulated receiver: the Receiver port on top of the simulated world and the vehicle's real telemetry."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable

from hardware.ports import Clock, ReceiverError
from hardware.readings import PowerSample, Pulses, Telemetry
from hardware.sim.pose_track import PoseTrack
from hardware.sim.world import Pose, RadioLink, World

DETECTION_DB = 6.0
"""A pulse must stand so far above the noise in the receiver's bandwidth."""


class SimulatedReceiver:
    """Power samples `rate_hz` times a second of the clock's time, each made at the vehicle's pose of that moment.

    Telemetry comes in steps: a sample waits until a heading at or after its own time was heard, and place and heading
    are interpolated between the two snapshots around it; what is `telemetry_held_s` late is not waited for. Nothing is
    received before the vehicle knows its position.
    `silence(True)` makes the receiver go mute and `unplug()` makes it vanish, for rehearsing faults.
    """

    def __init__(
        self,
        world: World,
        pose: Callable[[], Telemetry],
        clock: Clock,
        rate_hz: float = 20.0,
        ground_amsl_m: float = 0.0,
        telemetry_held_s: float = 0.5,
    ) -> None:
        if not rate_hz > 0:
            raise ReceiverError(f"the sample rate is {rate_hz} Hz; it must be greater than zero")
        self._world = world
        self._telemetry = pose
        self._clock = clock
        self._period_s = 1.0 / rate_hz
        self._ground_amsl_m = ground_amsl_m
        self._telemetry_held_s = telemetry_held_s
        self._link: RadioLink | None = None
        self._silent = False
        self._gone = False
        self._pulses: Pulses | None = None

    def expect(self, pulses: Pulses | None) -> None:
        """See HearsPulses: one sample a pulse of the world's tag; a tag of another rhythm is not heard."""
        self._pulses = pulses

    async def open(self, frequency_hz: float) -> None:
        """Tune. Raises ReceiverError when the frequency is not positive or the device was unplugged."""
        if self._gone:
            raise ReceiverError("the simulated receiver was unplugged; plug it in again (restart the simulation)")
        if not frequency_hz > 0:
            raise ReceiverError(f"cannot tune to {frequency_hz} Hz; give the emitter's frequency in hertz")
        if self._link is None or self._link.frequency_hz != frequency_hz:
            self._link = RadioLink(self._world, frequency_hz)

    async def close(self) -> None:
        self._link = None

    def silence(self, silent: bool) -> None:
        """Stop or resume delivering samples, as a hung driver would."""
        self._silent = silent

    def unplug(self) -> None:
        """The device is gone: samples() raises ReceiverError."""
        self._gone = True

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port."""
        if self._link is None:
            raise ReceiverError("the receiver is not open: call open(frequency_hz) first")
        link = self._link
        track = PoseTrack(self._ground_amsl_m, self._telemetry_held_s)
        next_s = self._next_s(link, self._clock.now())
        while self._link is link:
            if self._gone:
                raise ReceiverError("the simulated receiver was unplugged")
            now = self._clock.now()
            known_until = track.hear(self._telemetry(), now)
            if known_until is None or self._silent:
                next_s = self._next_s(link, now)
            else:
                while next_s <= known_until and self._link is link:
                    yield self._sample(link, next_s, track.at(next_s))
                    next_s = self._next_s(link, next_s)
            await self._clock.sleep(self._period_s)
            await asyncio.sleep(0)

    def _next_s(self, link: RadioLink, after_s: float) -> float:
        """When the next sample is due: the middle of the next pulse, when pulses are listened to."""
        if self._pulses is None:
            return after_s + self._period_s
        emitter = self._world.emitter_at(link.frequency_hz)
        period_s, middle_s = self._pulses.period_s, 0.0
        if emitter is not None and emitter.pulse_period_s is not None:
            period_s, middle_s = emitter.pulse_period_s, emitter.pulse_width_s / 2.0
        return (math.floor((after_s - middle_s) / period_s + 1e-6) + 1) * period_s + middle_s

    def _sample(self, link: RadioLink, at_s: float, pose: Pose) -> PowerSample:
        power_dbm, clipped = link.power_dbm(at_s, pose)
        noise_dbm = self._world.front_end.noise_dbm
        if self._pulses is not None and not (self._in_rhythm(link) and power_dbm > noise_dbm + DETECTION_DB):
            return PowerSample(at_s, link.frequency_hz, noise_dbm, noise_dbm, detected=False)
        return PowerSample(at_s, link.frequency_hz, power_dbm, noise_dbm, clipped)

    def _in_rhythm(self, link: RadioLink) -> bool:
        """Whether the world sends the pulses that are listened to."""
        emitter, pulses = self._world.emitter_at(link.frequency_hz), self._pulses
        if emitter is None or emitter.pulse_period_s is None or pulses is None:
            return False
        return abs(emitter.pulse_period_s - pulses.period_s) <= pulses.jitter_s
