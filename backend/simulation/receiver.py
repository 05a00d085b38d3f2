"""A receiver in a simulated world that is made around the vehicle's home once that is known."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from dataclasses import replace
from typing import Literal

from backend.simulation.emitters import EMITTERS, Signal, SimulatedEmitter, beats, emitter_places
from backend.simulation.walls import walls
from hardware.clock import ScaledClock
from hardware.ports import ReceiverError, Vehicle
from hardware.readings import Channel, HeadingSample, Place, PowerSample, Telemetry
from hardware.reasons.receiver import ReceiverNotOpen
from hardware.reasons.simulation import HomeNotKnown
from hardware.sim.receiver import SimulatedReceiver
from hardware.sim.walk import Walk
from hardware.sim.world import Emitter, World

TELEMETRY_HELD_WALL_S = 0.25
"""Telemetry may be so late before the receiver says that it is alive without it, however fast the simulation runs."""


class EmittersAroundHome:
    """The Receiver port.

    truth: where each simulated emitter is at first; empty until the home is known.
    """

    lost_percent = 0.0

    def __init__(
        self,
        vehicle: Vehicle,
        clock: ScaledClock,
        seed: int,
        world: Literal["open", "multipath"] = "open",
        emitters: Sequence[SimulatedEmitter] = EMITTERS,
        band_hz: float | None = None,
    ) -> None:
        self._vehicle = vehicle
        self._clock = clock
        self._seed = seed
        self._world = world
        self._emitters = emitters
        self._band_hz = band_hz
        self._receiver: SimulatedReceiver | None = None
        self.truth: Mapping[Signal, Place] = {}
        self._transmitting: Mapping[Signal, Emitter] = {}
        self._pose: Callable[[], Telemetry] = vehicle.telemetry
        self._headings: Callable[[float], Sequence[HeadingSample]] | None = vehicle.headings

    def follow(self, pose: Callable[[], Telemetry]) -> None:
        """Where the antenna is, from somebody who knows it better than the vehicle's link; before the first opening."""
        self._pose, self._headings = pose, None

    async def open(self, channels: Sequence[Channel]) -> None:
        """See the Receiver port. Raises ReceiverError also while the home is not known."""
        if self._receiver is None:
            self._receiver = self._made()
        await self._receiver.open(channels)

    def _made(self) -> SimulatedReceiver:
        telemetry = self._vehicle.telemetry()
        home = telemetry.home or telemetry.position
        if home is None:
            raise ReceiverError(HomeNotKnown())
        self.truth = emitter_places(self._seed, home, self._emitters)
        own = beats(self._seed, self._emitters)
        self._transmitting = {e.signal: replace(self._emitter(e), **own.get(e.signal, {})) for e in self._emitters}
        emitters = tuple(self._transmitting.values())
        reflectors = walls(self._seed, home) if self._world == "multipath" else ()
        return SimulatedReceiver(
            World(emitters, reflectors=reflectors, seed=self._seed),
            self._pose,
            self._clock,
            ground_amsl_m=telemetry.home_amsl_m or 0.0,
            telemetry_held_s=max(0.5, TELEMETRY_HELD_WALL_S * self._clock.factor),
            headings=self._headings,
            band_hz=self._band_hz,
        )

    def _emitter(self, wanted: SimulatedEmitter) -> Emitter:
        walk = None
        if wanted.gait is not None:
            seed = self._seed + round(wanted.frequency_hz / 1000.0)
            walk = Walk(wanted.gait, wanted.speed_m_s, self._clock.now(), seed)
        place = self.truth[wanted.signal]
        return Emitter(place, wanted.frequency_hz, pulse_period_s=wanted.pulse_period_s, walk=walk)

    def truth_at(self, at_s: float) -> Mapping[Signal, Place]:
        """Where each is at that time (UTC epoch seconds); empty until the home is known."""
        return {signal: emitter.at(at_s).place for signal, emitter in self._transmitting.items()}

    async def close(self) -> None:
        """Harmless while the home is not known."""
        if self._receiver is not None:
            await self._receiver.close()

    def silence(self, silent: bool) -> None:
        """Stop or resume delivering samples, as a hung driver would. Raises ReceiverError before the first opening."""
        self._opened().silence(silent)

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port."""
        async for sample in self._opened().samples():
            yield sample

    def _opened(self) -> SimulatedReceiver:
        if self._receiver is None:
            raise ReceiverError(ReceiverNotOpen())
        return self._receiver
