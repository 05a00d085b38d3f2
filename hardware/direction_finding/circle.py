"""A sweep's likelihood over direction: what it says of every bearing, where a main peak and a sigma say it of one.

    p(m | b) = (1 - sum_k q_k) p_pattern(b) + sum_k q_k p_k(b)

with p_pattern the density over all shapes that the pattern's antenna may show (refine.py), q_k the probability of
another explanation (explained.py), and p_k the density with that. Several peaks, a skew and flat stretches are kept.
What all bearings of a flight share (compass, mounting) is not in it: whoever uses it adds it.
"""

from __future__ import annotations

import base64
import binascii
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.refine import CircleDensity

DIRECTIONS = 360
FLOOR = -12.7
"""Natural log below the likeliest direction: no sweep excludes one further."""
_STEP = 0.05
_FINEST_DEG = 0.25


class LikelihoodError(ValueError):
    """A packed likelihood that cannot be unpacked; the message says why."""


@dataclass(frozen=True, slots=True)
class SweepLikelihood:
    """log_likelihood: (360,) natural log at 0, 1, .. 359 degrees from north; 0 at the likeliest, at least FLOOR."""

    log_likelihood: NDArray[np.float64]

    @classmethod
    def of(cls, log_density: NDArray[np.float64]) -> SweepLikelihood:
        """Any (360,) log density, scaled to a maximum of 0 and cut at FLOOR."""
        return cls(np.maximum(log_density - np.max(log_density), FLOOR))

    @classmethod
    def normal(cls, bearing_deg: float, sigma_deg: float) -> SweepLikelihood:
        """exp(-(b - bearing)^2 / (2 sigma^2)), the difference taken the short way round."""
        off = (np.arange(DIRECTIONS) - bearing_deg + 180.0) % 360.0 - 180.0
        return cls.of(np.asarray(-0.5 * (off / sigma_deg) ** 2, dtype=np.float64))

    def blurred(self, sigma_deg: float) -> SweepLikelihood:
        """Convolved with a normal density of `sigma_deg`, around the circle: for what bearings share besides."""
        kernel = np.exp(SweepLikelihood.normal(0.0, max(sigma_deg, 1e-3)).log_likelihood)
        mass = np.fft.irfft(np.fft.rfft(np.exp(self.log_likelihood)) * np.fft.rfft(kernel / kernel.sum()), DIRECTIONS)
        return SweepLikelihood.of(np.log(np.maximum(mass, np.exp(FLOOR))))

    def spread_deg(self, bearing_deg: float) -> float:
        """Standard deviation about `bearing_deg`, all directions equally likely before."""
        mass = np.exp(self.log_likelihood)
        off = (np.arange(DIRECTIONS) - bearing_deg + 180.0) % 360.0 - 180.0
        return float(np.sqrt(mass @ off**2 / mass.sum()))

    def packed(self) -> str:
        """One byte a direction in steps of 0.05, deflated, base64: at most 480 characters."""
        steps = np.rint(-self.log_likelihood / _STEP).astype(np.uint8)
        return base64.b64encode(zlib.compress(steps.tobytes(), 9)).decode("ascii")

    @classmethod
    def unpacked(cls, text: str) -> SweepLikelihood:
        """What `packed` made. Raises LikelihoodError."""
        try:
            unpack = zlib.decompressobj()
            raw = unpack.decompress(base64.b64decode(text, validate=True), DIRECTIONS + 1)
            whole = unpack.eof
        except (binascii.Error, zlib.error, ValueError) as error:
            raise LikelihoodError(f"a sweep's likelihood is damaged ({error}); take the bearing as it is") from error
        if len(raw) != DIRECTIONS or not whole:
            raise LikelihoodError(f"a sweep's likelihood has {len(raw)} directions; {DIRECTIONS} were packed")
        return cls(-_STEP * np.frombuffer(raw, dtype=np.uint8).astype(np.float64))


@dataclass(frozen=True, slots=True)
class Besides:
    """Another explanation of a sweep: its probability, and at (j,) ascending degrees its log density, unnormalized."""

    probability: float
    at_deg: NDArray[np.float64]
    log_density: NDArray[np.float64]


def sweep_likelihood(circle: CircleDensity, besides: Sequence[Besides] = ()) -> SweepLikelihood:
    """The mixture above: the pattern's antenna has what probability the others leave."""
    known = _each_degree(circle)
    left = 1.0 - sum(other.probability for other in besides)
    parts = [np.log(min(max(left, 1e-9), 1.0)) + known - _log_total(known)]
    for other in besides:
        placed = _placed(other)
        parts.append(np.log(max(other.probability, 1e-9)) + placed - _log_total(placed))
    return SweepLikelihood.of(np.logaddexp.reduce(parts))


def _placed(other: Besides) -> NDArray[np.float64]:
    """(360,) far below the rest where it says nothing."""
    at = other.at_deg
    placed = np.full(DIRECTIONS, float(np.min(other.log_density)) + FLOOR)
    turned: NDArray[np.float64] = (np.arange(DIRECTIONS) - at[0]) % 360.0 + at[0]
    inside = turned <= at[-1]
    placed[inside] = np.interp(turned[inside], at, other.log_density)
    return placed


def _each_degree(circle: CircleDensity) -> NDArray[np.float64]:
    """(360,) the coarse density interpolated, and the mean of the fine one within each degree where it reaches."""
    direction = np.arange(DIRECTIONS, dtype=np.float64)
    log_density = np.interp(direction, circle.coarse_deg, circle.coarse_log, period=360.0)
    degree = np.rint(circle.fine_deg).astype(np.int64)
    first = degree[0]
    top = float(circle.fine_log.max())
    count = np.bincount(degree - first)
    mean = np.bincount(degree - first, np.exp(circle.fine_log - top)) / count
    full = count >= round(0.5 / _FINEST_DEG)
    log_density[(first + np.flatnonzero(full)) % DIRECTIONS] = np.log(np.maximum(mean[full], 1e-300)) + top
    return log_density


def _log_total(log_density: NDArray[np.float64]) -> float:
    top = float(np.max(log_density))
    return top + float(np.log(np.sum(np.exp(log_density - top))))
