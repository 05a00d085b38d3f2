"""The simulated truth: emitters, reflectors, antenna and receiver front end. It knows nothing of any estimator.

Positions WGS84, headings degrees clockwise from true north, powers dBm. Every random draw comes from the seed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sim.antenna import AntennaField, YagiOnAirframe
from hardware.sim.beat import Beat
from hardware.sim.propagation import SPEED_OF_LIGHT_M_S, Fading, FadingProcess, two_ray_gain
from hardware.sim.walk import Walk

THERMAL_NOISE_DBM_HZ = -173.98


class WorldError(ValueError):
    """A world that cannot exist; the message says which value and what it may be."""


@dataclass(frozen=True, slots=True)
class Emitter:
    """A transmitter. `pulse_period_s` None: a carrier; else pulses of `pulse_width_s`, whose phase, clock and straying
    are as in `Beat`. walk: how it moves, having been at `place` when the walk began; None: it stands still."""

    place: Place
    frequency_hz: float = 868_300_000.0
    power_dbm: float = -10.0
    height_m: float = 1.5
    polarization_loss_db: float = 3.0
    pulse_period_s: float | None = None
    pulse_width_s: float = 0.02
    pulse_phase_s: float = 0.0
    clock_error: float = 0.0
    pulse_stray_s: float = 0.0
    walk: Walk | None = None

    @property
    def beat(self) -> Beat | None:
        """None: it sends without pause."""
        if self.pulse_period_s is None:
            return None
        return Beat(self.pulse_period_s, self.pulse_width_s, self.pulse_phase_s, self.clock_error, self.pulse_stray_s)

    def at(self, at_s: float) -> Emitter:
        """Where it is at that time of the world's clock."""
        if self.walk is None:
            return self
        return replace(self, place=LocalFrame(self.place).to_geo(*self.walk.way(at_s)), walk=None)

    def __post_init__(self) -> None:
        if not self.frequency_hz > 0:
            raise WorldError(f"the emitter's frequency is {self.frequency_hz} Hz; it must be greater than zero")
        if self.pulse_period_s is not None and not 0 < self.pulse_width_s < self.pulse_period_s:
            raise WorldError("a pulse must be shorter than its period: give 0 < pulse_width_s < pulse_period_s")


@dataclass(frozen=True, slots=True)
class Reflector:
    """A wall, hill or vehicle that sends a copy of the wave on from where it stands.

    loss_db: power lost in the reflection; phase_rad: phase turned by it.
    """

    place: Place
    loss_db: float = 6.0
    phase_rad: float = math.pi


@dataclass(frozen=True, slots=True)
class FrontEnd:
    """What the receiver adds: thermal noise, gain jitter, an upper limit.

    averages: independent noise samples in one power reading. clip_dbm: readings above it are clipped and flagged.
    """

    noise_figure_db: float = 7.0
    bandwidth_hz: float = 12_500.0
    averages: int = 100
    jitter_db: float = 0.3
    clip_dbm: float = -10.0

    @property
    def noise_dbm(self) -> float:
        """kTB + noise figure."""
        return THERMAL_NOISE_DBM_HZ + 10.0 * math.log10(self.bandwidth_hz) + self.noise_figure_db


Lean = tuple[float, float]
"""rad, by how much the vehicle's upright axis leans to the east and to the north."""
UPRIGHT: Lean = (0.0, 0.0)
"""As a vehicle that hovers in calm air."""


@dataclass(frozen=True, slots=True)
class Pose:
    """The vehicle in the world. heading_deg: what the vehicle reports for its nose; height above the (flat) ground."""

    place: Place
    height_m: float
    heading_deg: float
    lean: Lean = UPRIGHT


Coordinate = TypeVar("Coordinate", float, NDArray[np.float64])


def as_leaning(
    east: Coordinate, north: Coordinate, up: Coordinate, lean: tuple[Coordinate, Coordinate]
) -> tuple[Coordinate, Coordinate, Coordinate]:
    """A direction as a vehicle has it whose upright axis leans: what lies where it leans to stands higher for it."""
    angle = np.hypot(*lean)
    upright = angle == 0.0
    to_east, to_north = lean[0] / (angle + upright) + upright, lean[1] / (angle + upright)
    along, across = east * to_east + north * to_north, north * to_east - east * to_north
    along, up = along * np.cos(angle) - up * np.sin(angle), along * np.sin(angle) + up * np.cos(angle)
    return along * to_east - across * to_north, along * to_north + across * to_east, up


@dataclass(frozen=True, slots=True)
class World:
    """Everything that does not change during a mission.

    heading_error_deg: true heading minus reported heading (a compass that lies).
    antenna_offset_deg: the antenna's front is this far clockwise of the nose.
    """

    emitters: tuple[Emitter, ...]
    antenna: AntennaField = field(default_factory=YagiOnAirframe)
    antenna_offset_deg: float = 0.0
    front_end: FrontEnd = field(default_factory=FrontEnd)
    fading: Fading = field(default_factory=Fading)
    reflectors: tuple[Reflector, ...] = ()
    ground_reflection: float = -0.6
    heading_error_deg: float = 0.0
    seed: int = 1

    def __post_init__(self) -> None:
        if not self.emitters:
            raise WorldError("the world has no emitter: give at least one")

    def emitters_at(self, frequency_hz: float) -> list[Emitter]:
        """Every emitter inside the receiver's bandwidth around `frequency_hz`, the nearest first."""
        inside = [e for e in self.emitters if abs(e.frequency_hz - frequency_hz) <= self.front_end.bandwidth_hz / 2]
        return sorted(inside, key=lambda e: abs(e.frequency_hz - frequency_hz))

    def received_field(self, emitter: Emitter, pose: Pose) -> complex:
        """Complex amplitude at the antenna's terminals without fading and noise; |.|^2 in milliwatt."""
        return complex(
            self.received_fields(emitter, pose.place, pose.height_m, np.array([pose.heading_deg]), pose.lean)[0]
        )

    def received_fields(
        self, emitter: Emitter, place: Place, height_m: float, heading_deg: NDArray[np.float64], lean: Lean = UPRIGHT
    ) -> NDArray[np.complex128]:
        """(n,) the same for a vehicle that turns on one place: (n,) reported headings."""
        frame = LocalFrame(place)
        east, north = frame.to_enu(emitter.place)
        up = emitter.height_m - height_m
        wavelength = SPEED_OF_LIGHT_M_S / emitter.frequency_hz
        direct = two_ray_gain(math.hypot(east, north), emitter.height_m, height_m, wavelength, self.ground_reflection)
        total = direct * self._antenna_fields(east, north, up, heading_deg, lean)
        for reflector in self.reflectors:
            wall_east, wall_north = frame.to_enu(reflector.place)
            path = math.hypot(wall_east - east, wall_north - north) + math.hypot(wall_east, wall_north)
            reflected = two_ray_gain(path, emitter.height_m, height_m, wavelength, self.ground_reflection)
            reflected *= 10.0 ** (-reflector.loss_db / 20.0) * np.exp(1j * reflector.phase_rad)
            total = total + reflected * self._antenna_fields(wall_east, wall_north, up, heading_deg, lean)
        return total * 10.0 ** ((emitter.power_dbm - emitter.polarization_loss_db) / 20.0)

    def _antenna_fields(
        self, east: float, north: float, up: float, heading_deg: NDArray[np.float64], lean: Lean
    ) -> NDArray[np.complex128]:
        if lean != UPRIGHT:
            east, north, up = as_leaning(east, north, up, lean)
        bearing = math.degrees(math.atan2(east, north))
        front = heading_deg + self.heading_error_deg + self.antenna_offset_deg
        elevation = math.atan2(up, max(math.hypot(east, north), 0.1))
        return self.antenna.field(np.radians(bearing - front), elevation)


@dataclass(slots=True)
class RadioLink:
    """One receiver listening to one frequency of the world: fading, noise and clipping, drawn in time order.

    number: which of the emitters there is heard, 0 the nearest.
    """

    world: World
    frequency_hz: float
    number: int = 0
    _rng: np.random.Generator = field(init=False)
    _fading: FadingProcess = field(init=False)

    def __post_init__(self) -> None:
        chance = [self.world.seed, round(self.frequency_hz), *([self.number] if self.number else [])]
        self._rng = np.random.default_rng(chance)
        self._fading = FadingProcess(self.world.fading, self._rng)

    @property
    def emitter(self) -> Emitter | None:
        """Whom it hears, as the world is now."""
        return next(iter(self.world.emitters_at(self.frequency_hz)[self.number :]), None)

    def amplitude(self, at_s: float, pose: Pose) -> complex:
        """Faded complex amplitude at the antenna's terminals (sqrt mW); 0 without an emitter or between pulses."""
        heading = np.array([pose.heading_deg])
        return complex(self.amplitudes(np.array([at_s]), pose.place, pose.height_m, heading, pose.lean)[0])

    def amplitudes(
        self,
        at_s: NDArray[np.float64],
        place: Place,
        height_m: float,
        heading_deg: NDArray[np.float64],
        lean: Lean = UPRIGHT,
    ) -> NDArray[np.complex128]:
        """(n,) the same at (n,) times and headings of a vehicle that turns on one place."""
        emitter = self.emitter
        if emitter is None:
            return np.zeros(at_s.size, dtype=np.complex128)
        fading = np.array([self._fading.gain(float(t)) for t in at_s])
        middle = emitter.at(float(at_s.mean())) if at_s.size else emitter
        received = self.world.received_fields(middle, place, height_m, heading_deg, lean) * fading
        return received if emitter.beat is None else np.where(emitter.beat.sends(at_s), received, 0.0)

    def power_dbm(self, at_s: float, pose: Pose) -> tuple[float, bool]:
        """(power reading dBm, clipped)."""
        heading = np.array([pose.heading_deg])
        reading, clipped = self.powers_dbm(np.array([at_s]), pose.place, pose.height_m, heading, pose.lean)
        return float(reading[0]), bool(clipped[0])

    def powers_dbm(
        self,
        at_s: NDArray[np.float64],
        place: Place,
        height_m: float,
        heading_deg: NDArray[np.float64],
        lean: Lean = UPRIGHT,
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """(n,) readings in dBm and whether each clipped: mean of |signal + noise|^2 over `averages` draws, jittered."""
        return self.read_dbm(self.amplitudes(at_s, place, height_m, heading_deg, lean))

    def powers_dbm_of(
        self, at_s: NDArray[np.float64], received: NDArray[np.complex128]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """The same of fields (n,) as they are received without fading, sqrt mW, each read by itself: what chance there
        is comes in the order of `power_dbm`."""
        readings = [
            self.read_dbm(np.array([amplitude * self._fading.gain(float(t))]))
            for t, amplitude in zip(at_s, received, strict=True)
        ]
        return np.array([power[0] for power, _ in readings]), np.array([clipped[0] for _, clipped in readings])

    def read_dbm(self, amplitude: NDArray[np.complex128]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """(n,) the same of (n,) amplitudes, which may be those of several emitters, added up."""
        front_end = self.world.front_end
        signal_mw = np.abs(amplitude) ** 2
        noise_mw = 10.0 ** (front_end.noise_dbm / 10.0)
        # mean of n draws of |s + w|^2: mean S + N, variance (2 S N + N^2) / n
        spread = np.sqrt((2.0 * signal_mw * noise_mw + noise_mw**2) / front_end.averages)
        reading_mw = np.maximum(signal_mw + noise_mw + spread * self._rng.normal(size=amplitude.size), 0.05 * noise_mw)
        reading_dbm = 10.0 * np.log10(reading_mw) + front_end.jitter_db * self._rng.normal(size=amplitude.size)
        return np.minimum(reading_dbm, front_end.clip_dbm), reading_dbm >= front_end.clip_dbm
