"""Sensors with errors as they happen outside: what the rows of the truth study measure with.

Nothing here knows how a belief accounts for errors. A row says how the compass of a flight is wrong (by one angle for
all its bearings), how single bearings are wrong, how often one is wrong altogether, and whether walls reflect: then
every bearing is read off a simulated sweep of the direct wave and its echoes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from planner.study.errors import StudyError
from planner.types import FloatArray

OWN_SD = float(np.deg2rad(5.3))
"""Of a fielded system's single bearings, and what its direction finder states of them."""
HEADING_SIGMA = float(np.deg2rad(4.0))
"""What a vehicle states of its heading."""

ECHO_LOSS_DB = 6.0
"""A wall returns a quarter of the power."""
BEAM = float(np.deg2rad(60.0))
"""Full width at half power of the simulated antenna."""
FRONT_TO_BACK_DB = 15.0
HEADINGS = 180


@dataclass(frozen=True, slots=True)
class Wall:
    """A reflecting segment from a to b, each (2,) m."""

    a: FloatArray
    b: FloatArray

    def image(self, point: FloatArray) -> FloatArray:
        """The mirror image of a point (2,)."""
        along = (self.b - self.a) / np.hypot(*(self.b - self.a))
        off = point - self.a
        return self.a + 2.0 * (off @ along) * along - off

    def meets(self, start: FloatArray, end: FloatArray) -> bool:
        """Whether the way from start to end crosses the wall."""
        way, wall, off = end - start, self.b - self.a, self.a - start
        turned = way[0] * wall[1] - way[1] * wall[0]
        if turned == 0.0:
            return False
        t = (off[0] * wall[1] - off[1] * wall[0]) / turned
        u = (off[0] * way[1] - off[1] * way[0]) / turned
        return bool(0.0 < t < 1.0 and 0.0 < u < 1.0)


@dataclass(slots=True)
class Sensor:
    """One flight's sensor. bias: rad ccw, what all its bearings are turned by."""

    target: FloatArray
    bias: float
    own_sd: float
    stated_sd: float
    outliers: float
    walls: tuple[Wall, ...]
    rng: np.random.Generator

    def bearing(self, place: FloatArray, number: int) -> tuple[float, float]:
        """(direction measured from `place`, its stated own standard deviation), rad. number: counts bearings from 0."""
        del number
        wrong, noise = self.rng.uniform() < self.outliers, self.own_sd * self.rng.standard_normal()
        if wrong:
            return float(self.rng.uniform(-np.pi, np.pi)), self.stated_sd
        heard = _direction(self.target - place) if not self.walls else self._heard(place)
        return float(np.arctan2(np.sin(heard + self.bias + noise), np.cos(heard + self.bias + noise))), self.stated_sd

    def _heard(self, place: FloatArray) -> float:
        """Where the antenna's pattern fits the sweep best: direct wave and echoes add as waves, phases by chance."""
        directions, amplitudes = [_direction(self.target - place)], [1.0]
        straight = float(np.hypot(*(self.target - place)))
        for wall in self.walls:
            image = wall.image(self.target)
            if wall.meets(place, image):
                detour = float(np.hypot(*(image - place)))
                directions.append(_direction(image - place))
                amplitudes.append(10.0 ** (-ECHO_LOSS_DB / 20.0) * straight / detour)
        phases = self.rng.uniform(0.0, 2.0 * np.pi, len(directions))
        headings = 2.0 * np.pi * np.arange(HEADINGS) / HEADINGS
        gain = np.sqrt(_pattern(headings[:, None] - np.array(directions)))
        power = np.abs(gain @ (np.array(amplitudes) * np.exp(1j * phases))) ** 2
        fit = np.fft.ifft(np.fft.fft(power) * np.conj(np.fft.fft(_pattern(headings)))).real
        best = int(np.argmax(fit))
        left, middle, right = fit[best - 1], fit[best], fit[(best + 1) % HEADINGS]
        beside = 0.5 * (left - right) / (left - 2.0 * middle + right)  # the top of a parabola through three values
        return float(headings[best] + beside * (headings[1] - headings[0]))


@dataclass(frozen=True, slots=True)
class Row:
    """bias_sd: of the flights' compass errors, rad. own_sd: of single bearings, stated_sd: what is stated of them, rad.
    outliers: share of bearings from anywhere. walls: how many stand around."""

    name: str
    bias_sd: float = 0.0
    own_sd: float = OWN_SD
    stated_sd: float = OWN_SD
    heading_sigma: float = HEADING_SIGMA
    outliers: float = 0.0
    walls: int = 0

    def sensor(self, target: FloatArray, rng: np.random.Generator) -> Sensor:
        """Of one flight with the emitter at target (2,), m."""
        walls = tuple(_wall(rng) for _ in range(self.walls))
        bias = self.bias_sd * rng.standard_normal()
        return Sensor(target, bias, self.own_sd, self.stated_sd, self.outliers, walls, rng)


WALLS_AROUND = ((-260.0, -60.0), (260.0, 260.0))
"""South-west and north-east corner of where walls stand, m ENU."""


def _wall(rng: np.random.Generator) -> Wall:
    middle, angle = rng.uniform(*WALLS_AROUND), rng.uniform(0.0, np.pi)
    half = 0.5 * rng.uniform(30.0, 80.0) * np.array([np.cos(angle), np.sin(angle)])
    return Wall(middle - half, middle + half)


def _direction(way: FloatArray) -> float:
    return float(np.arctan2(way[1], way[0]))


def _pattern(off: FloatArray) -> FloatArray:
    """Power gain of the antenna `off` rad from its front."""
    beam = np.exp(-4.0 * np.log(2.0) * (np.arctan2(np.sin(off), np.cos(off)) / BEAM) ** 2)
    return np.asarray(np.maximum(beam, 10.0 ** (-FRONT_TO_BACK_DB / 10.0)))


@dataclass(frozen=True, slots=True)
class Rows:
    """The rows by name."""

    by_name: Mapping[str, Row] = field(default_factory=dict[str, Row])

    def named(self, name: str) -> Row:
        """StudyError for a row that does not exist."""
        if name not in self.by_name:
            raise StudyError(f"there is no row {name!r}: choose one of {', '.join(self.by_name)}")
        return self.by_name[name]


def _degrees(value: float) -> float:
    return float(np.deg2rad(value))


ROWS = Rows(
    {
        row.name: row
        for row in (
            Row("independent", own_sd=_degrees(6.6), stated_sd=_degrees(6.6), heading_sigma=0.0),
            Row("scattered", own_sd=_degrees(6.6)),
            Row("bias5", bias_sd=_degrees(5.3)),
            Row("bias10", bias_sd=_degrees(10.0)),
            Row("bias5_outliers8", bias_sd=_degrees(5.3), outliers=0.08),
            Row("bias5_outliers20", bias_sd=_degrees(5.3), outliers=0.2),
            Row("bias10_outliers8", bias_sd=_degrees(10.0), outliers=0.08),
            Row("right", own_sd=_degrees(1.2), stated_sd=_degrees(2.5)),
            Row("walls", own_sd=_degrees(2.5), walls=6),
            Row("walls_bias5", bias_sd=_degrees(5.3), own_sd=_degrees(2.5), walls=6),
        )
    }
)
