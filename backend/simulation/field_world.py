"""A field for studies of whole searches: what a sweep hears there is made from fields, not from any filter's model.

A mission has an emitter anywhere in the suggested area, a compass that is wrong by one angle, an antenna on an airframe
(hardware.sim.antenna), one or two reflectors that lose 4 to 10 dB, fading in time (Rician), and shadowing: the direct
wave and every echo are weakened or strengthened with a standard deviation of 5 dB, each by a random field of its own
that changes over 20 m. In flight the craft leans, so that its antenna looks up or down, and its heading and place are
told LATE_S after they were so.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from backend.simulation.along import received_along
from hardware.direction_finding.antenna import AntennaPattern
from hardware.frame import LocalFrame
from hardware.readings import HeadingSample, Place, PowerSample, Sweep
from hardware.sim.antenna import YagiOnAirframe
from hardware.sim.propagation import Fading
from hardware.sim.turn import turn_once
from hardware.sim.turntable import OWN_POINTING_SIGMA_DEG, measure_pattern, simulated_antenna
from hardware.sim.world import Emitter, RadioLink, Reflector, World

FREQUENCY_HZ = 868_300_000.0
HEIGHT_M = 40.0
MARGIN_M = 10.0
"""Between the emitter and the edge of its area."""
REFLECTORS = (1, 2)
LOSS_DB = (4.0, 10.0)
AROUND_M = 60.0
"""How far outside the area a reflector may stand."""
SCATTERED = Fading(rician_k_db=9.0, coherence_s=0.35)
SHADOW_DB, SHADOW_M = 5.0, 20.0
WAVES = 64
REPORTED_M = 0.1
"""By how much reported places jitter, standard deviation."""
LATE_S = 0.05
"""Of reported headings and places in flight: what clocks and filters leave, some degrees while the nose swings."""

Antenna = Literal["yagi", "wide"]
WIDE = YagiOnAirframe(element_forward=(-0.2, 0.0, 0.2), element_current=YagiOnAirframe().element_current[:3])
"""Without its foremost director: a beam of 86 degrees instead of 68."""
ANTENNAS: Mapping[Antenna, YagiOnAirframe] = {"yagi": YagiOnAirframe(), "wide": WIDE}


@dataclass(frozen=True, slots=True)
class Shadow:
    """A Gaussian random field over places: standard deviation SHADOW_DB, correlation exp(-d^2 / (2 SHADOW_M^2)).

    s(x) = SHADOW_DB sqrt(2 / n) sum_k cos(w_k . x + p_k), w_k ~ N(0, 1 / SHADOW_M^2) (Rahimi and Recht 2007).
    waves: (n, 2) rad/m. phases: (n,) rad.
    """

    waves: NDArray[np.float64]
    phases: NDArray[np.float64]

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Shadow:
        """One realization."""
        return cls(rng.standard_normal((WAVES, 2)) / SHADOW_M, rng.uniform(0.0, 2.0 * math.pi, WAVES))

    def db(self, x: float | NDArray[np.float64], y: float | NDArray[np.float64]) -> NDArray[np.float64]:
        """What is lost at places of any shape, x, y m ENU."""
        phase = np.stack(np.broadcast_arrays(x, y), axis=-1) @ self.waves.T + self.phases
        return np.asarray(SHADOW_DB * math.sqrt(2.0 / WAVES) * np.cos(phase).sum(axis=-1))


@dataclass(frozen=True, slots=True)
class Way:
    """Points at even times. x, y: (n,) m ENU. nose_deg: (n,) clockwise from north, continuous. lean: (n, 2) rad, as of
    `Pose`."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    nose_deg: NDArray[np.float64]
    lean: NDArray[np.float64]

    @property
    def heading(self) -> float:
        """Of the nose at its end, rad ccw from east."""
        return math.radians(90.0 - float(self.nose_deg[-1]))

    @property
    def turned_deg(self) -> float:
        """Either way."""
        return float(np.abs(np.diff(self.nose_deg)).sum())


@dataclass(frozen=True, slots=True)
class Field:
    """One mission's world. truth: m ENU. shadows: of the direct wave, then of each reflector's."""

    world: World
    frame: LocalFrame
    truth: tuple[float, float]
    shadows: tuple[Shadow, ...]
    seed: int

    def sweep(self, x: float, y: float, number: int, rate_deg_s: float, start_deg: float | None = None) -> Sweep:
        """A whole turn at (x, y), from this heading of the nose on, None: from any. What chance there is depends on the
        seed and the number of the sweep alone."""
        rng = np.random.default_rng([self.seed, number, 2])
        here = dataclasses.replace(self.at(x, y), seed=int(rng.integers(2**31)))
        place, any_deg = self.frame.to_geo(x, y), float(rng.uniform(0.0, 360.0))
        link = RadioLink(here, FREQUENCY_HZ)
        begin_deg = any_deg if start_deg is None else start_deg
        return turn_once(link, place, HEIGHT_M, start_deg=begin_deg, rate_deg_s=rate_deg_s)

    def along(self, way: Way, rate_hz: float, leg: int) -> tuple[list[PowerSample], list[HeadingSample]]:
        """What a craft hears and reports on its way, `rate_hz` points a second. Chance depends on the seed and the
        number of the leg alone."""
        rng = np.random.default_rng([self.seed, leg, 4])
        link = RadioLink(dataclasses.replace(self.world, seed=int(rng.integers(2**31))), FREQUENCY_HZ)
        way_m, at_s = np.column_stack([way.x, way.y]), np.arange(len(way.x)) / rate_hz
        told = self.frame.to_lon_lat(way_m + REPORTED_M * rng.standard_normal(way_m.shape))
        received = received_along(
            self.world,
            self.world.emitters[0],
            np.array(self.frame.to_lon_lat(way_m)),
            HEIGHT_M,
            way.nose_deg,
            way.lean,
            [shadow.db(way.x, way.y) for shadow in self.shadows],
        )
        power_dbm, clipped = link.powers_dbm_of(at_s, received)
        noise_dbm = self.world.front_end.noise_dbm
        samples = [
            PowerSample(float(t), FREQUENCY_HZ, float(power), noise_dbm, bool(clips))
            for t, power, clips in zip(at_s, power_dbm, clipped, strict=True)
        ]
        headings = [
            HeadingSample(float(t) + LATE_S, float(nose) % 360.0, Place(lat, lon))
            for t, nose, (lon, lat) in zip(at_s, way.nose_deg, told, strict=True)
        ]
        return samples, headings

    def at(self, x: float, y: float) -> World:
        """The world as it is shadowed at (x, y)."""
        direct, *echoes = (float(shadow.db(x, y)) for shadow in self.shadows)
        emitter = dataclasses.replace(self.world.emitters[0], power_dbm=self.world.emitters[0].power_dbm - direct)
        reflectors = tuple(
            dataclasses.replace(one, loss_db=one.loss_db + lost - direct)
            for one, lost in zip(self.world.reflectors, echoes, strict=True)
        )
        return dataclasses.replace(self.world, emitters=(emitter,), reflectors=reflectors)


@functools.cache
def antenna_pattern(antenna: Antenna = "yagi") -> AntennaPattern:
    """Of the antenna that is flown, as it was measured: what a direction finder works with."""
    if antenna == "yagi":
        return simulated_antenna()
    hall = World((Emitter(Place(0.0, 0.0), FREQUENCY_HZ),), antenna=ANTENNAS[antenna])
    return dataclasses.replace(measure_pattern(hall), pointing_sigma_deg=OWN_POINTING_SIGMA_DEG)


def drawn_field(
    seed: int,
    frame: LocalFrame,
    area: tuple[float, float, float, float],
    compass_sd_deg: float,
    compass_deg: float | None = None,
    antenna: Antenna = "yagi",
) -> Field:
    """area: x_min, y_min, x_max, y_max, m ENU. compass_sd_deg: of the flights' heading errors; compass_deg: their
    error, to either side, instead. Whatever the compass and the antenna, a seed has the same waves."""
    rng = np.random.default_rng([seed, 1])
    x_min, y_min, x_max, y_max = area
    truth = (
        float(rng.uniform(x_min + MARGIN_M, x_max - MARGIN_M)),
        float(rng.uniform(y_min + MARGIN_M, y_max - MARGIN_M)),
    )
    reflectors = tuple(
        Reflector(
            frame.to_geo(
                float(rng.uniform(x_min - AROUND_M, x_max + AROUND_M)),
                float(rng.uniform(y_min - AROUND_M, y_max + AROUND_M)),
            ),
            loss_db=float(rng.uniform(*LOSS_DB)),
            phase_rad=float(rng.uniform(0.0, 2.0 * math.pi)),
        )
        for _ in range(int(rng.integers(REFLECTORS[0], REFLECTORS[1] + 1)))
    )
    off = float(rng.standard_normal())
    world = World(
        (Emitter(frame.to_geo(*truth), FREQUENCY_HZ),),
        fading=SCATTERED,
        reflectors=reflectors,
        antenna=ANTENNAS[antenna],
        heading_error_deg=compass_sd_deg * off if compass_deg is None else math.copysign(compass_deg, off),
    )
    return Field(world, frame, truth, tuple(Shadow.drawn(rng) for _ in range(1 + len(reflectors))), seed)
