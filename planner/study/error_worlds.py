"""Sensors with errors as they happen outside: what the rows of the truth study measure with.

Nothing here knows how a belief accounts for errors. A row says how the compass of a flight is wrong (by one angle for
all its bearings), how single bearings are wrong, how often one is wrong altogether, whether walls reflect and whether
the antenna is the one that was measured: then every bearing is read off a simulated sweep of the direct wave and its
echoes. And it says how the places are wrong from which bearings are reported, and who takes every other one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from planner.study.errors import StudyError
from planner.types import FloatArray

OWN_SD = float(np.deg2rad(5.3))
"""Of a fielded system's single bearings, and what its direction finder states of them."""
HEADING_SIGMA = float(np.deg2rad(4.0))
"""What a vehicle states of its heading."""

ECHO_LOSS_DB = 6.0
"""A wall returns a quarter of the power."""
BEAM_DEG = 60.0
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


Antenna = Literal["measured", "squinted", "uneven", "foreign"]
"""Beside the pattern that bearings are found with: that one; pointing 10 degrees beside where it should; with flanks of
0.75 and 1.25 times the width; a wide lobe with side lobes to both sides."""
Placing = Literal["right", "creeping", "jumping"]
"""Of the reported places: a random walk of 3 m a bearing; every fifth is 15 m beside the true one."""
CREEP_M = 3.0
JUMP_M, JUMPS = 15.0, 0.2


@dataclass(slots=True)
class Sensor:
    """One flight's sensor. bias: rad ccw, what all its bearings are turned by. off: (2,) m, where the vehicle is beside
    its reported place. other: whoever takes every second bearing with a bias of their own, None: nobody."""

    target: FloatArray
    bias: float
    own_sd: float
    stated_sd: float
    outliers: float
    walls: tuple[Wall, ...]
    rng: np.random.Generator
    antenna: Antenna = "measured"
    placing: Placing = "right"
    other: Sensor | None = None
    off: FloatArray = field(default_factory=lambda: np.zeros(2))

    def taker(self, number: int) -> Sensor:
        """Who takes bearing `number`, counted from 0."""
        return self if self.other is None or number % 2 == 0 else self.other

    def bearing(self, place: FloatArray, number: int) -> tuple[float, float]:
        """(direction measured at the reported `place`, its stated own standard deviation), rad."""
        taker = self.taker(number)
        if taker is not self:
            return taker.bearing(place, 0)
        place = self._true_place(place)
        wrong, noise = self.rng.uniform() < self.outliers, self.own_sd * self.rng.standard_normal()
        if wrong:
            return float(self.rng.uniform(-np.pi, np.pi)), self.stated_sd
        by_sweep = self.walls or self.antenna != "measured"
        heard = self._heard(place) if by_sweep else _direction(self.target - place)
        return float(np.arctan2(np.sin(heard + self.bias + noise), np.cos(heard + self.bias + noise))), self.stated_sd

    def _true_place(self, reported: FloatArray) -> FloatArray:
        match self.placing:
            case "right":
                return reported
            case "creeping":
                self.off = self.off + CREEP_M * self.rng.standard_normal(2)
            case "jumping":
                angle = self.rng.uniform(0.0, 2.0 * np.pi)
                far = JUMP_M if self.rng.uniform() < JUMPS else 0.0
                self.off = far * np.array([np.cos(angle), np.sin(angle)])
        return reported + self.off

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
        gain = np.sqrt(_gain(headings[:, None] - np.array(directions), self.antenna))
        power = np.abs(gain @ (np.array(amplitudes) * np.exp(1j * phases))) ** 2
        fit = np.fft.ifft(np.fft.fft(power) * np.conj(np.fft.fft(_pattern(headings)))).real
        best = int(np.argmax(fit))
        left, middle, right = fit[best - 1], fit[best], fit[(best + 1) % HEADINGS]
        beside = 0.5 * (left - right) / (left - 2.0 * middle + right)  # the top of a parabola through three values
        return float(headings[best] + beside * (headings[1] - headings[0]))


@dataclass(frozen=True, slots=True)
class Row:
    """bias_sd: of the flights' compass errors, rad. own_sd: of single bearings, stated_sd: what is stated of them, rad.
    outliers: share of bearings from anywhere. walls: how many stand around. sources: 2 with somebody else at every
    second place, whose compass is wrong as much and by another angle."""

    name: str
    bias_sd: float = 0.0
    own_sd: float = OWN_SD
    stated_sd: float = OWN_SD
    heading_sigma: float = HEADING_SIGMA
    outliers: float = 0.0
    walls: int = 0
    antenna: Antenna = "measured"
    placing: Placing = "right"
    sources: int = 1

    def sensor(self, target: FloatArray, rng: np.random.Generator) -> Sensor:
        """Of one flight with the emitter at target (2,), m."""
        walls = tuple(_wall(rng) for _ in range(self.walls))
        first, *others = (
            Sensor(
                target,
                self.bias_sd * rng.standard_normal(),
                self.own_sd,
                self.stated_sd,
                self.outliers,
                walls,
                rng,
                self.antenna,
                self.placing,
            )
            for _ in range(self.sources)
        )
        first.other = others[0] if others else None
        return first


WALLS_AROUND = ((-260.0, -60.0), (260.0, 260.0))
"""South-west and north-east corner of where walls stand, m ENU."""


def _wall(rng: np.random.Generator) -> Wall:
    middle, angle = rng.uniform(*WALLS_AROUND), rng.uniform(0.0, np.pi)
    half = 0.5 * rng.uniform(30.0, 80.0) * np.array([np.cos(angle), np.sin(angle)])
    return Wall(middle - half, middle + half)


def _direction(way: FloatArray) -> float:
    return float(np.arctan2(way[1], way[0]))


def _gain(off: FloatArray, antenna: Antenna) -> FloatArray:
    """Power gain of the antenna that is flown, `off` rad from where its front should be."""
    match antenna:
        case "measured":
            return _pattern(off)
        case "squinted":
            return _pattern(off - np.deg2rad(10.0))
        case "uneven":
            wrapped = np.arctan2(np.sin(off), np.cos(off))
            return _pattern(np.clip(wrapped / np.where(wrapped < 0.0, 0.75, 1.25), -np.pi, np.pi))
        case "foreign":
            return np.asarray(sum(10.0 ** (-db / 10.0) * _lobe(off - np.deg2rad(at), width) for at, db, width in LOBES))


LOBES = ((0.0, 0.0, 80.0), (96.0, 7.5, 56.0), (-104.0, 6.5, 47.0), (-62.0, 8.0, 33.0))
"""Of a small loop or whip beside an airframe: direction, dB below the largest, width at half power, degrees."""


def _lobe(off: FloatArray, width_deg: float) -> FloatArray:
    wrapped = np.arctan2(np.sin(off), np.cos(off))
    return np.asarray(np.exp(-4.0 * np.log(2.0) * (wrapped / np.deg2rad(width_deg)) ** 2))


def _pattern(off: FloatArray) -> FloatArray:
    """Power gain of the antenna that was measured, `off` rad from its front."""
    return np.maximum(_lobe(off, BEAM_DEG), 10.0 ** (-FRONT_TO_BACK_DB / 10.0))


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
            Row("squinted", own_sd=_degrees(2.5), antenna="squinted"),
            Row("uneven", own_sd=_degrees(2.5), antenna="uneven"),
            Row("foreign", own_sd=_degrees(2.5), antenna="foreign"),
            Row("creeping", bias_sd=_degrees(5.3), placing="creeping"),
            Row("jumping", bias_sd=_degrees(5.3), placing="jumping"),
            Row("two_sources", bias_sd=_degrees(5.3), sources=2),
        )
    }
)
