# pyright: standard
"""How well each place explains bearings of an emitter that moves, if it is there now: compiled by numba.

Given that the emitter is at x now, its way back in time is a Gaussian process (planner.movement), and so is the bias of
each source. For each place a Kalman filter runs from now into the past, over the state (d, u, b): d the way back to
where the emitter was, u its velocity backwards, b the biases. d = 0 now. A bearing taken the time t ago,

    z = dir(x + d(t)) + b + w,    w ~ (1 - e) sum_j w_j N(z_j; ., (s sigma)^2) + e / (2 pi),

is read with the direction linearized at the mean of d, and its outliers by probabilistic data association (Bar-Shalom
and Tse 1975): what is left after it is one Gaussian with the mixture's mean and covariance. The logarithm of
p(bearings | x) is the sum over the bearings' predictive densities.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from planner.compiling import allocating, entry, jit
from planner.types import FloatArray, IntArray

NEAREST_M = 5.0
"""A direction is never linearized from nearer than this."""


class Sighted(NamedTuple):
    """Bearings, the newest first. x, y: (n,) m. sigma: (n,) rad. age: (n,) s before now, ascending. source: (n,) index.
    rate: (n,) of outliers. first: (n + 1,) where the peaks of each begin in angle (p,) rad and weight (p,), whose sum
    is 1 for each bearing."""

    x: FloatArray
    y: FloatArray
    sigma: FloatArray
    age: FloatArray
    source: IntArray
    rate: FloatArray
    first: IntArray
    angle: FloatArray
    weight: FloatArray


@jit
def _back(mean, cov, seconds, speed, persistence):
    """The state that much earlier: d' = d + tau (1 - f) u + ..., u' = f u + ..., f = exp(-t / tau)."""
    f = np.exp(-seconds / persistence)
    g = persistence * (1.0 - f)
    s2 = 0.5 * speed * speed
    qdd = s2 * persistence**2 * (2.0 * seconds / persistence - 3.0 + 4.0 * f - f * f)
    qdu = s2 * persistence * (1.0 - f) ** 2
    quu = s2 * (1.0 - f * f)
    n = len(mean)
    for a in range(2):
        mean[a] += g * mean[2 + a]
        mean[2 + a] *= f
        for k in range(n):
            cov[a, k] += g * cov[2 + a, k]
            cov[2 + a, k] *= f
        for k in range(n):
            cov[k, a] += g * cov[k, 2 + a]
            cov[k, 2 + a] *= f
        cov[a, a] += qdd
        cov[a, 2 + a] += qdu
        cov[2 + a, a] += qdu
        cov[2 + a, 2 + a] += quu


@jit
def _read(mean, cov, ph, x, y, seen, i, scale):
    """Takes bearing i in; returns the logarithm of its predictive density. ph: (n,) scratch."""
    n, source = len(mean), 4 + seen.source[i]
    px, py = x + mean[0] - seen.x[i], y + mean[1] - seen.y[i]
    r2 = max(px * px + py * py, NEAREST_M * NEAREST_M)
    gx, gy = -py / r2, px / r2
    for k in range(n):
        ph[k] = gx * cov[k, 0] + gy * cov[k, 1] + cov[k, source]
    own = scale * seen.sigma[i]
    spread = gx * ph[0] + gy * ph[1] + ph[source] + own * own
    towards = np.arctan2(py, px) + mean[source]
    density = seen.rate[i] / (2.0 * np.pi)
    first_moment = second_moment = honest = 0.0
    for j in range(seen.first[i], seen.first[i + 1]):
        off = seen.angle[j] - towards
        off -= 2.0 * np.pi * np.floor(off / (2.0 * np.pi) + 0.5)
        share = (1.0 - seen.rate[i]) * seen.weight[j] * np.exp(-0.5 * off * off / spread)
        share /= np.sqrt(2.0 * np.pi * spread)
        density += share
        honest += share
        first_moment += share * off
        second_moment += share * off * off
    honest /= density
    first_moment /= density
    second_moment /= density
    shrink = (honest * spread - second_moment + first_moment * first_moment) / (spread * spread)
    for k in range(n):
        mean[k] += ph[k] * first_moment / spread
    for k in range(n):
        for m in range(n):
            cov[k, m] -= shrink * ph[k] * ph[m]
    return np.log(density)


@jit
def _start(mean, cov, speed, bias_sd):
    mean[:] = 0.0
    cov[:] = 0.0
    cov[2, 2] = cov[3, 3] = 0.5 * speed * speed
    for k in range(4, len(mean)):
        cov[k, k] = bias_sd * bias_sd


@allocating
def _weigh(x, y, seen, speed, persistence, sources, scale, scale_weight, bias_sd, bias_weight, log, bias, bias_square):
    n = 4 + sources
    mean, cov, ph = np.empty(n), np.empty((n, n)), np.empty(n)
    cases = len(scale) * len(bias_sd)
    found, of_case = np.empty(cases), np.empty((cases, 2, sources))
    for c in range(len(x)):
        for case in range(cases):
            k, t = case // len(bias_sd), case % len(bias_sd)
            _start(mean, cov, speed, bias_sd[t])
            total, at = np.log(scale_weight[k] * bias_weight[t]), 0.0
            for i in range(len(seen.x)):
                _back(mean, cov, seen.age[i] - at, speed, persistence)
                at = seen.age[i]
                total += _read(mean, cov, ph, x[c], y[c], seen, i, scale[k])
            found[case] = total
            for s in range(sources):
                of_case[case, 0, s] = mean[4 + s]
                of_case[case, 1, s] = cov[4 + s, 4 + s] + mean[4 + s] ** 2
        top = found.max()
        whole = 0.0
        bias[c, :] = 0.0
        bias_square[c, :] = 0.0
        for case in range(cases):
            share = np.exp(found[case] - top)
            whole += share
            for s in range(sources):
                bias[c, s] += share * of_case[case, 0, s]
                bias_square[c, s] += share * of_case[case, 1, s]
        log[c] = top + np.log(whole)
        for s in range(sources):
            bias[c, s] /= whole
            bias_square[c, s] /= whole


def moving_evidence(
    x: FloatArray,
    y: FloatArray,
    seen: Sighted,
    speed: float,
    persistence: float,
    sources: int,
    scale: FloatArray,
    scale_weight: FloatArray,
    bias_sd: FloatArray,
    bias_weight: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of places x, y (c,) m: log (c,), and of each source the bias' first moments (c, sources), rad and rad^2.

    scale, scale_weight (k,): factors on the stated sigmas. bias_sd, bias_weight (t,): standard deviations, rad, that
    the sources' biases may have; all have the same.
    """
    log, bias, square = np.empty(len(x)), np.empty((len(x), sources)), np.empty((len(x), sources))
    _evidence(
        np.ascontiguousarray(x), np.ascontiguousarray(y), seen, speed, persistence, sources,
        scale, scale_weight, bias_sd, bias_weight, log, bias, square,
    )  # fmt: skip
    return log, bias, square


@entry
def _evidence(
    x, y, seen, speed, persistence, sources, scale, scale_weight, bias_sd, bias_weight, log, bias, bias_square
):
    _weigh(x, y, seen, speed, persistence, sources, scale, scale_weight, bias_sd, bias_weight, log, bias, bias_square)
