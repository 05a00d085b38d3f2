"""The simulated world as an IQ stream: the same physics as receiver.py, one step further left in the data's way."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable

import numpy as np
from numpy.typing import NDArray

from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.ports import Clock, ReceiverError
from hardware.readings import Telemetry
from hardware.reasons.receiver import ReceiverNotOpen
from hardware.sim.pose_track import PoseTrack
from hardware.sim.world import RadioLink, World

_STEP_S = 0.005
"""Fading, pose and pulses are evaluated so often."""
TELEMETRY_HELD_S = 0.5
"""What is later is not waited for: the blocks of that time hold noise only."""


class SimulatedIq:
    """An IqSource: every emitter of the world inside the band, noise, and a converter that clips at full scale.

    Full scale is the front end's clip_dbm without `extra_gain_db`; `power_db` of a meter is in dBm with any.
    drift_hz_s: how fast the emitters' oscillators drift. block_s: length of a block.
    """

    def __init__(
        self,
        world: World,
        pose: Callable[[], Telemetry],
        clock: Clock,
        sample_rate_hz: float = 48_000.0,
        drift_hz_s: float = 0.0,
        block_s: float = 0.05,
        ground_amsl_m: float = 0.0,
        extra_gain_db: float = 0.0,
    ) -> None:
        self._world = world
        self._telemetry = pose
        self._clock = clock
        self._rate = sample_rate_hz
        self._drift_hz_s = drift_hz_s
        self._block_s = block_s
        self._ground_amsl_m = ground_amsl_m
        self._extra_gain_db = extra_gain_db
        self._centre_hz: float | None = None
        self._rng = np.random.default_rng([world.seed, 7])

    @property
    def sample_rate_hz(self) -> float:
        """As given; every emitter inside this band is heard."""
        return self._rate

    @property
    def gain_db(self) -> float:
        """dB from the front end's input in dBm to full scale."""
        return self._extra_gain_db - self._world.front_end.clip_dbm

    async def open(self, centre_hz: float) -> float:
        """Any frequency can be tuned to, and exactly."""
        self._centre_hz = centre_hz
        return centre_hz

    async def close(self) -> None:
        """`blocks` ends after the block at hand."""
        self._centre_hz = None

    async def blocks(self) -> AsyncIterator[IqBlock]:
        """As late as the telemetry: no block is made for a time at which the pose is not yet known."""
        centre_hz = self._centre_hz
        if centre_hz is None:
            raise ReceiverError(ReceiverNotOpen())
        links = [
            RadioLink(self._world, emitter.frequency_hz, self._world.emitters_at(emitter.frequency_hz).index(emitter))
            for emitter in self._world.emitters
            if abs(emitter.frequency_hz - centre_hz) < self._rate / 2.0
        ]
        track = PoseTrack(self._ground_amsl_m)
        size = int(self._block_s * self._rate)
        begin_s = next_s = self._clock.now()
        while self._centre_hz == centre_hz:
            known_until = track.newest_s if track.hear(self._telemetry()) else None
            if known_until is not None:  # later than this the link is lost, and what comes is noise
                known_until = max(known_until, self._clock.now() - TELEMETRY_HELD_S)
            else:
                begin_s = next_s = self._clock.now()
            while known_until is not None and next_s + self._block_s <= known_until and self._centre_hz == centre_hz:
                yield self._block(links, track, next_s, next_s - begin_s, size, centre_hz)
                next_s += size / self._rate
            await self._clock.sleep(self._block_s)
            await asyncio.sleep(0)

    def _block(
        self, links: list[RadioLink], track: PoseTrack, start_s: float, since_s: float, size: int, centre_hz: float
    ) -> IqBlock:
        front_end = self._world.front_end
        time_s = np.arange(size) / self._rate
        noise_mw = 10.0 ** (front_end.noise_dbm / 10.0) * self._rate / front_end.bandwidth_hz
        total: NDArray[np.complex128] = math.sqrt(noise_mw / 2.0) * (
            self._rng.normal(size=size) + 1j * self._rng.normal(size=size)
        )
        steps = np.minimum((time_s / _STEP_S).astype(np.int64), int(self._block_s / _STEP_S) - 1)
        for link in links:
            moments = start_s + (np.arange(int(steps.max()) + 1) + 0.5) * _STEP_S
            poses = [(float(t), track.at(float(t))) for t in moments]
            amplitude = np.array([0.0 if pose is None else link.amplitude(t, pose) for t, pose in poses])
            offset_hz = link.frequency_hz - centre_hz
            phase = offset_hz * (since_s + time_s) + 0.5 * self._drift_hz_s * (since_s + time_s) ** 2
            total += amplitude[steps] * np.exp(2j * np.pi * phase)
        full_scale = 10.0 ** ((front_end.clip_dbm - self._extra_gain_db) / 20.0)
        scaled = total / full_scale
        limited = np.clip(scaled.real, -1.0, 1.0) + 1j * np.clip(scaled.imag, -1.0, 1.0)
        samples = limited.astype(np.complex64)
        return IqBlock(start_s, samples, clipped_at_full_scale(samples))
