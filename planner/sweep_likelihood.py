"""A sweep's whole likelihood over direction, as a density that a belief weighs places with.

Where a bearing is a main peak and a sigma, a sweep says more: several peaks, a skew, directions of which it knows
nothing. A scale s of the sensor's sigma, which a joint belief estimates, makes of the density p

    p_s(d) = p(d) - l(d) + l(c + (d - c) / s) / s     for s < 1, l = (p - min p) w the highest lobe, c its middle
    p_s    = p * N(0, (s^2 - 1) sigma_p^2)            for s > 1, convolved; sigma_p the width of its highest peak

Both make N(., (s sigma)^2) of a normal p and leave a flat one flat. What lies beside the lobe keeps its share where
errors are smaller than stated, since echoes become no rarer: a power of p took it away, so that among echoes no flight
ever found its sweeps better than they say (decision 75).
"""

from __future__ import annotations

import math

import numpy as np

from planner.types import FloatArray

EXCLUDED = -12.65
"""Natural log below the likeliest: at that the direction finder cuts, so there is no telling how much lower it was."""
LOBE = math.radians(45.0)
"""To either side of the highest peak: so far its lobe is looked at for its middle and its standard deviation."""
MOST_BLURRED = LOBE / 3.0
"""When the highest lobe is looked for: two of one height that are farther apart than LOBE stay two."""
REACH = 3.5
"""Of these deviations a lobe reaches to either side of its middle: w = exp(-(off / reach)^8)."""


def density(log_likelihood: tuple[float, ...], least_sigma: float) -> FloatArray:
    """(m,) a radian at the angles 2 pi k / m ccw from east, summing to m / (2 pi).

    log_likelihood: (m,) natural log there, any offset. One that is sharper than N(0, least_sigma^2) is convolved with
    what it lacks of that; rad.
    """
    found = _normalized(_kept(log_likelihood))
    sharp = width(found)
    return _blurred(found, math.sqrt(least_sigma**2 - sharp**2)) if sharp < least_sigma else found


def width(density: FloatArray) -> float:
    """rad, the standard deviation of the normal density that is as high as the highest of (m,) `density`."""
    return 1.0 / (math.sqrt(2.0 * math.pi) * float(density.max()))


def scaled(density: FloatArray, scale: FloatArray) -> FloatArray:
    """(k, m): p_s for each of the (k,) scales, normalized like `density` (m,)."""
    sigma = width(density)
    return np.array(
        [_drawn_in(density, s) if s < 1.0 else _blurred(density, sigma * math.sqrt(s**2 - 1.0)) for s in scale]
    )


def at(density: FloatArray, angle: FloatArray) -> FloatArray:
    """The density at angles of any shape, rad ccw from east, linear between its directions."""
    count = density.shape[-1]
    place = (np.asarray(angle) / (2.0 * math.pi) % 1.0) * count
    low = np.floor(place).astype(np.int64) % count
    part = place - np.floor(place)
    return np.asarray(density[low] * (1.0 - part) + density[(low + 1) % count] * part)


def _kept(log_likelihood: tuple[float, ...]) -> FloatArray:
    log = np.array(log_likelihood, dtype=np.float64)
    log = log - log.max()
    return np.where(log > EXCLUDED, np.exp(log), 0.0)


def _normalized(mass: FloatArray) -> FloatArray:
    return np.asarray(mass / mass.sum() * len(mass) / (2.0 * math.pi), dtype=np.float64)


def _drawn_in(density: FloatArray, scale: float) -> FloatArray:
    """`scaled` for a scale below 1."""
    off, spread = _lobe(density)
    lobe = (density - density.min()) * np.exp(-((off / (REACH * spread)) ** 8))
    order = np.argsort(off)
    # what lies below the edge of each direction: so none of a lobe that is drawn in between two of them is lost
    edge = np.append(off[order][0], off[order] + 1.0) - 0.5
    below = np.append(0.0, np.cumsum(lobe[order]))
    drawn = np.interp((off + 0.5) / scale, edge, below) - np.interp((off - 0.5) / scale, edge, below)
    return _normalized(density - lobe + drawn)


def _lobe(density: FloatArray) -> tuple[FloatArray, float]:
    """(m,) directions off the middle of the highest lobe, within half a circle, and its standard deviation, one at
    least: both in steps between directions. Highest once blurred, since an echo's peak may be high and narrow."""
    count = len(density)
    top = int(np.argmax(_blurred(density, min(2.0 * width(density), MOST_BLURRED))))
    off = _off(count, float(top))
    near = np.where(np.abs(off) <= LOBE * count / (2.0 * math.pi), density, 0.0)
    mean = float(off @ near / near.sum())
    spread = math.sqrt(float((off - mean) ** 2 @ near / near.sum()))
    return _off(count, top + mean), max(spread, 1.0)


def _off(count: int, middle: float) -> FloatArray:
    return np.asarray((np.arange(count) - middle + 0.5 * count) % count - 0.5 * count, dtype=np.float64)


def _blurred(mass: FloatArray, sigma: float) -> FloatArray:
    if sigma == 0.0:
        return mass
    # the wrapped normal's Fourier coefficients: exp(-(n sigma)^2 / 2)
    order = np.arange(mass.size // 2 + 1)
    found = np.fft.irfft(np.fft.rfft(mass) * np.exp(-0.5 * (order * sigma) ** 2), mass.size)
    return _normalized(np.maximum(found, 0.0))
