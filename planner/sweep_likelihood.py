"""What a sweep's whole likelihood over direction says of places: the update of a grid without main peak and sigma.

    log L(x) = log( (1 - eps) p(dir(x) - s)  +  eps / (2 pi) )

p is the sweep's likelihood as a density over direction, dir(x) = atan2(y - y_s, x - x_s) (4.2), eps the outlier rate.
What the bearings of a flight share (compass, mounting) is s: either known, or of standard deviation `common_sigma`, and
then p is convolved with its wrapped normal density (3.26 with the offset integrated out for this sweep alone).
"""

from __future__ import annotations

import math

import numpy as np

from planner.types import FloatArray

_LEAST = 1e-14


def direction_density(log_likelihood: FloatArray, common_sigma: float) -> FloatArray:
    """(m,) density a radian at the angles 2 pi k / m ccw from east, summing to m / (2 pi).

    log_likelihood: (m,) natural log there, any offset. common_sigma: rad, 0 for none.
    """
    count = log_likelihood.size
    mass = np.exp(log_likelihood - np.max(log_likelihood))
    if common_sigma > 0.0:
        # the wrapped normal's Fourier coefficients: exp(-(n sigma)^2 / 2)
        order = np.arange(count // 2 + 1)
        mass = np.fft.irfft(np.fft.rfft(mass) * np.exp(-0.5 * (order * common_sigma) ** 2), count)
    mass = np.maximum(mass, 0.0)
    return np.asarray(mass / mass.sum() * count / (2.0 * math.pi), dtype=np.float64)


def log_update(
    log_likelihood: FloatArray,
    sensor: tuple[float, float],
    x: FloatArray,
    y: FloatArray,
    *,
    outlier_probability: float,
    common_sigma: float = 0.0,
    offset: float = 0.0,
) -> FloatArray:
    """Natural log of the sweep's likelihood at the places (x, y), of their shape; add it to the belief's log density.

    log_likelihood: (m,) at the angles 2 pi k / m, rad ccw from east. sensor: m ENU. offset: rad ccw that the flight's
    bearings point beside the emitter, where that is known. A place at the sensor itself learns nothing.
    """
    density = direction_density(log_likelihood, common_sigma)
    count = density.size
    off_x, off_y = x - sensor[0], y - sensor[1]
    at = ((np.arctan2(off_y, off_x) + offset) / (2.0 * math.pi) % 1.0) * count
    low = np.floor(at).astype(np.int64) % count
    part = at - np.floor(at)
    log_density = np.log(np.maximum(density, _LEAST * density.max()))
    found = np.exp(log_density[low] * (1.0 - part) + log_density[(low + 1) % count] * part)
    uniform = 1.0 / (2.0 * math.pi)
    mixed = (1.0 - outlier_probability) * found + outlier_probability * uniform
    mixed = np.where((off_x == 0.0) & (off_y == 0.0), uniform, mixed)
    return np.asarray(np.log(np.maximum(mixed, 1e-300)), dtype=np.float64)
