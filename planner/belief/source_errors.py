"""What the bearings of one source are wrong by together: a bias, a scale of their sigmas, a rate of outliers.

A source is whoever took the bearings: a craft's antenna, a person, another receiver. Its bearing i from place x_i is

    z_i = atan2(y - y_i, x - x_i) + b + w_i,    w_i ~ (1 - e) N(0, (s sigma_i)^2) + e / (2 pi)

with one bias b, scale s and outlier rate e for all its bearings of a flight. Before the flight b ~ N(0, tau^2) with tau
one of several standard deviations: how good the compass is, is not known either. Angles: rad ccw from east, so a
compass that reads too large has a negative b.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import erf, sqrt

import numpy as np

from planner.types import BoolArray, FloatArray

LARGEST_BIAS = np.deg2rad(27.0)
"""A bias beyond this is not looked for: 2.7 standard deviations of the worst compass."""
NODE_SIGMAS = 1.0
"""Spacing of the bias' nodes, in standard errors of the mean of the bearings at the smallest scale: a sum over nodes
one standard deviation apart is good to 2 exp(-2 pi^2), 5e-9, of a Gaussian's integral."""
NARROWEST_SCALE = 0.7
FINEST_SPACING = np.deg2rad(0.25)
COARSEST_SPACING = np.deg2rad(2.5)
EVEN_STEP = np.deg2rad(1.0)
"""Of the bias, at which stretches of way are weighed; a power of two of nodes lies in it where a source heard any."""
FIELDED_BIAS = np.deg2rad(5.3)
"""Standard deviation, from flight to flight, of what compasses in the field were off by."""
NEGLIGIBLE_WEIGHT = 1e-7
"""Nodes at the ends of the range that are less probable than this are left out."""


def _degrees(*values: float) -> FloatArray:
    return np.deg2rad(np.array(values))


@dataclass(frozen=True, slots=True, eq=False)
class ErrorPrior:
    """What is known of a source's errors before the flight, as discrete distributions.

    spread: (t,) rad, standard deviations tau that the bias may have. scale: (k,) of the stated sigmas. rate: (e,) of
    outliers, in (0, 1). Each with weights that sum to 1. The defaults know nothing of the compass.
    """

    spread: FloatArray = field(default_factory=lambda: _degrees(0.5, 1.0, 2.0, 3.5, 6.0, 10.0))
    spread_weight: FloatArray = field(default_factory=lambda: np.full(6, 1.0 / 6.0))
    scale: FloatArray = field(default_factory=lambda: np.array([0.7, 1.0, 1.45]))
    scale_weight: FloatArray = field(default_factory=lambda: np.array([0.25, 0.5, 0.25]))
    rate: FloatArray = field(default_factory=lambda: np.array([0.05, 0.2]))
    rate_weight: FloatArray = field(default_factory=lambda: np.array([0.6, 0.4]))

    @property
    def bias_sd(self) -> float:
        """rad, of the bias before any bearing."""
        return float(np.sqrt(self.spread_weight @ self.spread**2))


def evenly_spread(prior: ErrorPrior) -> ErrorPrior:
    """The prior with each standard deviation of the bias weighed by the range that it stands for, to its neighbours'
    middles.

    Weights that are equal for values which stand twice as far apart each time are even in log tau and pile up at a
    right compass; even in tau is what is recommended where few groups tell of tau (Gelman 2006). What was learned of
    tau stays: its evidence is multiplied by the other weights.
    """
    middles = 0.5 * (prior.spread[1:] + prior.spread[:-1])
    top = 2.0 * prior.spread[-1] - middles[-1] if len(middles) else 2.0 * prior.spread[-1]
    weight = prior.spread_weight * np.diff(np.concatenate([[0.0], middles, [top]]))
    return replace(prior, spread_weight=weight / weight.sum())


def fielded_spread(prior: ErrorPrior) -> ErrorPrior:
    """The prior with each standard deviation tau of the bias weighed by exp(-tau^2 / (2 FIELDED_BIAS^2)), which makes
    an even prior of tau a half-normal one with the scale of compasses in the field (Gelman 2006)."""
    weight = prior.spread_weight * np.exp(-0.5 * (prior.spread / FIELDED_BIAS) ** 2)
    return replace(prior, spread_weight=weight / weight.sum())


@dataclass(frozen=True, slots=True, eq=False)
class Nodes:
    """The grid on which a source's errors are marginalized: values and weights of bias (b,), scale (k,), rate (e,).

    The bias' values are equally spaced; spacing: rad, of one that stands alone, too. together: (k, e, b) weights of
    which the three are the sums where the errors hang together, None where they do not.
    """

    bias: FloatArray
    bias_weight: FloatArray
    scale: FloatArray
    scale_weight: FloatArray
    rate: FloatArray
    rate_weight: FloatArray
    spacing: float
    together: FloatArray | None = None

    @property
    def weight(self) -> FloatArray:
        """(k, e, b) of each combination."""
        if self.together is not None:
            return self.together
        return self.scale_weight[:, None, None] * self.rate_weight[:, None] * self.bias_weight

    def among(self, which: BoolArray) -> Nodes:
        """From the first of these values of the bias (b,) to the last, their weights as they were."""
        if self.together is not None:
            raise ValueError("the errors hang together already")
        kept = np.flatnonzero(which)
        where = slice(int(kept[0]), int(kept[-1]) + 1)
        return replace(self, bias=self.bias[where], bias_weight=self.bias_weight[where])

    def knowing(self, log_evidence: FloatArray) -> Nodes:
        """Weighed with further evidence (k, e, b) of the errors; values of the bias that it leaves no mass at the ends
        of the range are left out."""
        log = np.log(np.maximum(self.weight, np.finfo(float).tiny)) + log_evidence
        weight = np.exp(log - log.max())
        weight /= weight.sum()
        kept = np.flatnonzero(weight.sum(axis=(0, 1)) > NEGLIGIBLE_WEIGHT)
        where = slice(int(kept[0]), int(kept[-1]) + 1)
        weight = np.ascontiguousarray(weight[:, :, where] / weight[:, :, where].sum())
        return replace(
            self,
            bias=self.bias[where],
            bias_weight=weight.sum(axis=(0, 1)),
            scale_weight=weight.sum(axis=(1, 2)),
            rate_weight=weight.sum(axis=(0, 2)),
            together=weight,
        )


def nodes(prior: ErrorPrior, sigma: float, bearings: int, *, even: bool = False) -> Nodes:
    """The grid for this many bearings of about `sigma` rad: fine enough for the bias that they leave. even: spaced by
    EVEN_STEP over a power of two.

    The weight of a node is the prior's mass between its neighbours' middles, so a tau smaller than the spacing counts.
    """
    error = NARROWEST_SCALE * sigma / np.sqrt(max(bearings, 1))
    spacing = float(np.clip(NODE_SIGMAS * error, FINEST_SPACING, COARSEST_SPACING))
    if even:
        spacing = float(EVEN_STEP / 2.0 ** max(np.ceil(np.log2(EVEN_STEP / spacing) - 1e-9), 0.0))
    side = int(np.ceil(LARGEST_BIAS / spacing))
    bias = np.asarray(spacing * np.arange(-side, side + 1), dtype=np.float64)
    weight = bias_weights(bias, spacing, prior.spread) @ prior.spread_weight
    weight = weight / weight.sum()
    kept = np.flatnonzero(weight > NEGLIGIBLE_WEIGHT)
    where = slice(int(kept[0]), int(kept[-1]) + 1)
    return Nodes(
        bias[where],
        weight[where] / weight[where].sum(),
        prior.scale,
        prior.scale_weight,
        prior.rate,
        prior.rate_weight,
        spacing,
    )


def bias_weights(bias: FloatArray, spacing: float, spread: FloatArray) -> FloatArray:
    """(b, t) probability of the surroundings of each node, half a spacing to each side, under N(0, spread^2)."""
    edges = np.append(bias - 0.5 * spacing, bias[-1] + 0.5 * spacing)
    widths = [sqrt(2.0) * tau for tau in spread]
    below = 0.5 * (1.0 + np.array([[erf(edge / width) for width in widths] for edge in edges]))
    return np.diff(below, axis=0)


@dataclass(frozen=True, slots=True, eq=False)
class SourceErrors:
    """What the bearings say of their source: masses over the nodes, and how bias and place hang together.

    bias_mass (b,), scale_mass (k,), rate_mass (e,) sum to 1. covariance_with_place: (2,) m rad, of (x, y) and the bias.
    """

    source: str
    bearings: int
    prior: ErrorPrior
    nodes: Nodes
    bias_mass: FloatArray
    scale_mass: FloatArray
    rate_mass: FloatArray
    covariance_with_place: FloatArray

    @property
    def bias(self) -> float:
        """rad, its expected value."""
        return float(self.bias_mass @ self.nodes.bias)

    @property
    def bias_sd(self) -> float:
        """rad, its standard deviation."""
        return float(np.sqrt(max(self.bias_mass @ (self.nodes.bias - self.bias) ** 2, 0.0)))

    @property
    def scale(self) -> float:
        """Root mean square of the factor on the stated sigmas."""
        return float(np.sqrt(self.scale_mass @ self.nodes.scale**2))

    @property
    def outlier_rate(self) -> float:
        """Its expected value."""
        return float(self.rate_mass @ self.nodes.rate)
