"""The simulated truth: emitters, reflectors, antenna and receiver front end. It knows nothing of any estimator.

Positions WGS84, headings degrees clockwise from true north, powers dBm. Every random draw comes from the seed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from hardware.frame import LocalFrame
from hardware.readings import GeoPoint
from hardware.sim.antenna import AntennaField, YagiOnAirframe
from hardware.sim.propagation import SPEED_OF_LIGHT_M_S, Fading, FadingProcess, two_ray_gain

THERMAL_NOISE_DBM_HZ = -173.98


class WorldError(ValueError):
    """A world that cannot exist; the message says which value and what it may be."""


@dataclass(frozen=True, slots=True)
class Emitter:
    """A transmitter that stands still. `pulse_period_s` None: a carrier; else pulses of `pulse_width_s`."""

    place: GeoPoint
    frequency_hz: float = 868_300_000.0
    power_dbm: float = -10.0
    height_m: float = 1.5
    polarization_loss_db: float = 3.0
    pulse_period_s: float | None = None
    pulse_width_s: float = 0.02

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

    place: GeoPoint
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


@dataclass(frozen=True, slots=True)
class Pose:
    """The vehicle in the world. heading_deg: what the vehicle reports for its nose; height above the (flat) ground."""

    place: GeoPoint
    height_m: float
    heading_deg: float


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

    def emitter_at(self, frequency_hz: float) -> Emitter | None:
        """The emitter inside the receiver's bandwidth around `frequency_hz`, None when there is none."""
        inside = [e for e in self.emitters if abs(e.frequency_hz - frequency_hz) <= self.front_end.bandwidth_hz / 2]
        return min(inside, key=lambda e: abs(e.frequency_hz - frequency_hz)) if inside else None

    def received_field(self, emitter: Emitter, pose: Pose) -> complex:
        """Complex amplitude at the antenna's terminals without fading and noise; |.|^2 in milliwatt."""
        frame = LocalFrame(pose.place)
        east, north = frame.to_enu(emitter.place)
        wavelength = SPEED_OF_LIGHT_M_S / emitter.frequency_hz
        direct = two_ray_gain(
            math.hypot(east, north), emitter.height_m, pose.height_m, wavelength, self.ground_reflection
        )
        total = direct * self._antenna_field(east, north, emitter.height_m - pose.height_m, pose)
        for reflector in self.reflectors:
            wall_east, wall_north = frame.to_enu(reflector.place)
            path = math.hypot(wall_east - east, wall_north - north) + math.hypot(wall_east, wall_north)
            reflected = two_ray_gain(path, emitter.height_m, pose.height_m, wavelength, self.ground_reflection)
            reflected *= 10.0 ** (-reflector.loss_db / 20.0) * np.exp(1j * reflector.phase_rad)
            total += reflected * self._antenna_field(wall_east, wall_north, emitter.height_m - pose.height_m, pose)
        return complex(total * 10.0 ** ((emitter.power_dbm - emitter.polarization_loss_db) / 20.0))

    def _antenna_field(self, east: float, north: float, up: float, pose: Pose) -> complex:
        bearing = math.degrees(math.atan2(east, north))
        front = pose.heading_deg + self.heading_error_deg + self.antenna_offset_deg
        elevation = math.atan2(up, max(math.hypot(east, north), 0.1))
        return complex(self.antenna.field(np.array([math.radians(bearing - front)]), elevation)[0])


@dataclass(slots=True)
class RadioLink:
    """One receiver listening to one frequency of the world: fading, noise and clipping, drawn in time order."""

    world: World
    frequency_hz: float
    _rng: np.random.Generator = field(init=False)
    _fading: FadingProcess = field(init=False)

    def __post_init__(self) -> None:
        self._rng = np.random.default_rng([self.world.seed, round(self.frequency_hz)])
        self._fading = FadingProcess(self.world.fading, self._rng)

    def amplitude(self, at_s: float, pose: Pose) -> complex:
        """Faded complex amplitude at the antenna's terminals (sqrt mW); 0 without an emitter or between pulses."""
        emitter = self.world.emitter_at(self.frequency_hz)
        if emitter is None:
            return 0j
        fading = self._fading.gain(at_s)
        if emitter.pulse_period_s is not None and at_s % emitter.pulse_period_s >= emitter.pulse_width_s:
            return 0j
        return self.world.received_field(emitter, pose) * fading

    def power_dbm(self, at_s: float, pose: Pose) -> tuple[float, bool]:
        """(power reading dBm, clipped). Mean of |signal + noise|^2 over `averages` draws, with gain jitter."""
        front_end = self.world.front_end
        signal_mw = abs(self.amplitude(at_s, pose)) ** 2
        noise_mw = 10.0 ** (front_end.noise_dbm / 10.0)
        # mean of n draws of |s + w|^2: mean S + N, variance (2 S N + N^2) / n
        spread = math.sqrt((2.0 * signal_mw * noise_mw + noise_mw**2) / front_end.averages)
        reading_mw = max(signal_mw + noise_mw + spread * self._rng.normal(), 0.05 * noise_mw)
        reading_dbm = 10.0 * math.log10(reading_mw) + front_end.jitter_db * self._rng.normal()
        if reading_dbm >= front_end.clip_dbm:
            return front_end.clip_dbm, True
        return reading_dbm, False
