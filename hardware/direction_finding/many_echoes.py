"""A wave among many echoes: what a turn tells of its direction where no single echo explains what was heard.

With g the antenna's field gain against x = bearing - heading, and echoes from anywhere of total power v times the
direct wave's, the field at heading h is g(x) plus a sum of many waves of no known phase: complex Gaussian, with the
correlation of the antenna with itself,

    R(d) = mean over y of g(y) g(y + d),     k(x) = v R(0) / g(x)^2

k: the echoes' power over the direct wave's at that heading. The power is then Rice's, and in decibels

    mean  10 log10 g^2 + (10 / ln 10) E1(1 / k)                                 E1: exponential integral
    sd    (10 / ln 10) sqrt(1 / (1 / 2k + 6 / pi^2))                            between its limits for small and large k
    correlation between headings d apart  R(d) / R(0)

so that a lobe is bent smoothly, and its sides and back more than its top: a Gaussian process on the mean
(bent_lobes.py), v one of five.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bent_lobes import BentLobes, waves_of
from hardware.direction_finding.sweep import BIN_DEG

ECHO_POWERS = (0.03, 0.08, 0.2, 0.5, 1.2)
"""v: of all echoes together, over the direct wave's."""
_LEAST_GAIN = 1e-4
_DB = 10.0 / math.log(10.0)


def echo_field(pattern: AntennaPattern) -> BentLobes:
    """What echoes make of one antenna, for each of their powers; the antenna's strongest gain counts as 1."""
    from scipy.special import exp1  # as in refine.py: only sweeps need it

    x: NDArray[np.float64] = np.arange(0.0, 360.0, BIN_DEG)
    gain = np.maximum(10.0 ** ((pattern.gain_at(x) - float(pattern.gain_db.max())) / 10.0), _LEAST_GAIN)
    k = np.array(ECHO_POWERS)[:, None] * gain.mean() / gain
    return BentLobes(
        _DB * (np.log(gain) + np.asarray(exp1(1.0 / k), dtype=np.float64)),
        _DB * np.sqrt(1.0 / (1.0 / (2.0 * k) + 6.0 / math.pi**2)),
        waves_of(np.abs(np.fft.rfft(np.sqrt(gain))) ** 2),
    )
