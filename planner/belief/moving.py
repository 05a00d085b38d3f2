"""The belief about an emitter that moves: where it is at one moment, from all bearings so far.

Like the joint belief, all bearings are weighed again on the cells of a grid (planner.belief.moving_evidence); what is
common to a source's bearings counts once. The moment is that of the newest bearing, or any later one (`predicted`): a
bearing tells less of the place the older it is, and along the way that the emitter may have gone.

A moving belief is a `GridBelief`: planner, forecast and page take its mass over places as they take any other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np

from planner.belief.grid import (
    COARSE_CELLS,
    FIRST_CELLS,
    NEGLIGIBLE_MASS,
    GridBelief,
    aligned_range,
    extent_of,
    prior_belief,
    smallest_set,
)
from planner.belief.moving_evidence import Sighted, moving_evidence
from planner.belief.source_errors import ErrorPrior
from planner.geometry import bounds
from planner.movement import Movement
from planner.observation import validate_bearing
from planner.types import Bearing, FloatArray, IntArray, Problem, Region

MOST_CELLS = 96 * 96
"""The grid is refined where it stays below this: every bearing is weighed on every cell, several times over."""
EDGE_SIGMAS = 3.0
"""So many standard deviations of its way beyond the area are looked at: nothing keeps the emitter inside."""
FORGOTTEN = 3.0
"""Standard deviations of the way; further than that a grid is too coarse to find where bearings cross."""
WIDEST_CELLS = 8 * FIRST_CELLS
"""Along a side, area and ways out of it, while the prior is spread out: how old a bearing is may be anything."""
DEEPEST_REFINEMENT = 12
SMALLEST_SIGMA = np.deg2rad(1.0)
LEAST_RATE = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Assumed:
    """What a moving belief assumes. movement: of the emitter. priors: of the errors of each source that is known,
    otherwise: of any other; None: every bearing's errors are its own and its outlier probability counts."""

    movement: Movement
    priors: Mapping[str, ErrorPrior] = field(default_factory=dict[str, ErrorPrior])
    otherwise: ErrorPrior | None = None

    def of(self, source: str) -> ErrorPrior | None:
        """None when the source's bearings have nothing in common."""
        return self.priors.get(source, self.otherwise)


@dataclass(frozen=True, slots=True, eq=False)
class SourceBias:
    """bias, bias_sd: rad. scale: on the stated sigmas, as assumed. outlier_rate: as assumed."""

    source: str
    bearings: int
    bias: float
    bias_sd: float
    scale: float
    outlier_rate: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MovingBelief(GridBelief):
    """before: where the emitter was supposed before any bearing. folded: all bearings so far. now: the moment it is
    about, s on the bearings' clock. errors: of each source that took a bearing, if they have something in common."""

    before: GridBelief
    assumed: Assumed
    folded: tuple[Bearing, ...] = ()
    now: float = 0.0
    errors: tuple[SourceBias, ...] = ()

    def errors_of(self, source: str) -> SourceBias | None:
        """None for a source that took no bearing, or whose bearings have nothing in common."""
        return next((one for one in self.errors if one.source == source), None)


def moving_prior(problem: Problem, assumed: Assumed) -> MovingBelief:
    """The belief before any bearing. PlannerError when area or prior is unusable."""
    before = prior_belief(problem)
    return _as_moving(before, before, assumed)


def update_moving(belief: MovingBelief, bearing: Bearing, now: float | None = None) -> MovingBelief:
    """With one bearing more, at the moment `now`, s; None or what lies before it: that of the newest bearing."""
    validate_bearing(bearing)
    folded = (*belief.folded, bearing)
    newest = max(one.taken_at for one in folded)
    return _weighed_at(belief, folded, newest if now is None else max(now, newest))


def predicted(belief: MovingBelief, seconds: float) -> MovingBelief:
    """The same knowledge, that much later. seconds: >= 0."""
    if not belief.folded or seconds <= 0.0:
        return belief
    return _weighed_at(belief, belief.folded, belief.now + seconds)


def corrected_moving(belief: MovingBelief, bearings: Sequence[Bearing], x: float, y: float) -> tuple[Bearing, ...]:
    """The bearings as the belief reads them about an emitter at (x, y) now: freed of their source's bias, each sigma
    with the scale, the bias' spread and the way that the emitter may have gone across the line of sight since."""
    return tuple(_corrected(belief, bearing, x, y) for bearing in bearings)


def _corrected(belief: MovingBelief, bearing: Bearing, x: float, y: float) -> Bearing:
    errors = belief.errors_of(bearing.source)
    bias, bias_sd, scale = (0.0, 0.0, 1.0) if errors is None else (errors.bias, errors.bias_sd, errors.scale)
    distance = max(float(np.hypot(x - bearing.x, y - bearing.y)), 1.0)
    way = float(np.sqrt(belief.assumed.movement.variance(belief.now - bearing.taken_at)))
    sigma = float(np.hypot(np.hypot(scale * bearing.sigma, bias_sd), way / distance))
    peaks = tuple(replace(peak, angle=peak.angle - bias) for peak in bearing.peaks)
    return replace(bearing, angle=bearing.angle - bias, sigma=sigma, peaks=peaks)


def where_it_may_be(belief: MovingBelief) -> Region:
    """A rectangle around the area and the ways out of it, m ENU."""
    began = min((one.taken_at for one in belief.folded), default=belief.now)
    reach = 2.0 * EDGE_SIGMAS * float(np.sqrt(belief.assumed.movement.variance(belief.now - began)))
    x_min, y_min, x_max, y_max = bounds(belief.before.area)
    corners = [(x_min - reach, y_min - reach), (x_max + reach, y_min - reach)]
    return (np.array([*corners, (x_max + reach, y_max + reach), (x_min - reach, y_max + reach)]),)


def _as_moving(grid: GridBelief, before: GridBelief, assumed: Assumed, **more: object) -> MovingBelief:
    same = {one.name: getattr(grid, one.name) for one in fields(GridBelief)}
    return MovingBelief(**same, before=before, assumed=assumed, **more)  # type: ignore[arg-type]


def _weighed_at(belief: MovingBelief, folded: tuple[Bearing, ...], now: float) -> MovingBelief:
    recent = _since_last_pause(folded, belief.assumed.movement, belief.before)
    began = min(one.taken_at for one in recent)
    grid, prior = _spread_out(belief.before, belief.assumed.movement, now - began)
    weighing = _Weighing.of(recent, belief.assumed, now)
    density, errors = weighing.mass(grid, prior)
    for _ in range(DEEPEST_REFINEMENT):
        grid, prior, density = _cropped(replace(grid, density=density), prior)
        if not _coarse(grid):
            break
        grid, prior = _refined(grid, prior)
        density, errors = weighing.mass(grid, prior)
    x_min, y_min, x_max, y_max = grid.bounds
    rectangle = np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
    found = replace(grid, density=density, possible=(rectangle,), bearings=len(folded), copies=1)
    return _as_moving(found, belief.before, belief.assumed, folded=folded, now=now, errors=errors)


def _since_last_pause(folded: Sequence[Bearing], movement: Movement, before: GridBelief) -> tuple[Bearing, ...]:
    """What was taken before a pause in which the emitter may have gone FORGOTTEN times as far as the area is long, or
    nobody knows when, tells nothing of the place; and the area is not about that time."""
    length = max(before.nx, before.ny) * before.h
    times = sorted(one.taken_at for one in folded)
    gone = np.sqrt(movement.variance(np.diff(times))) > FORGOTTEN * length
    since = times[int(np.flatnonzero(gone)[-1]) + 1] if gone.any() else times[0]
    return tuple(one for one in folded if one.taken_at >= since)


def _spread_out(before: GridBelief, movement: Movement, seconds: float) -> tuple[GridBelief, FloatArray]:
    """The prior after that time, on a grid that holds where the emitter may have gone."""
    from scipy.ndimage import gaussian_filter  # loaded by the first emitter that moves, not by every start

    sd = float(np.sqrt(movement.variance(seconds)))
    before = _coarser(before, (max(before.nx, before.ny) + 2.0 * EDGE_SIGMAS * sd / before.h) / WIDEST_CELLS)
    cells = int(np.ceil(EDGE_SIGMAS * sd / before.h))
    step = max(1, int(np.ceil((max(before.nx, before.ny) + 2 * cells) / (2 * FIRST_CELLS))))
    padded = np.pad(before.density, ((cells, cells + (-(before.ny + 2 * cells)) % step),
                                     (cells, cells + (-(before.nx + 2 * cells)) % step)))  # fmt: skip
    blurred = np.maximum(gaussian_filter(padded, sd / before.h, mode="constant"), 0.0) if sd > 0.0 else padded
    ny, nx = (side // step for side in blurred.shape)
    coarse = blurred.reshape(ny, step, nx, step).sum(axis=(1, 3))
    coarse /= coarse.sum()
    x0, y0 = before.x0 - cells * before.h, before.y0 - cells * before.h
    return replace(before, density=coarse, x0=x0, y0=y0, h=step * before.h, copies=1), coarse


def _coarser(grid: GridBelief, times: float) -> GridBelief:
    """The same mass in larger cells. times: how much larger, rounded up; beyond the whole grid, one cell is left."""
    step = int(np.ceil(times))
    if step <= 1:
        return grid
    padded = np.pad(grid.density, ((0, -grid.ny % step), (0, -grid.nx % step)))
    ny, nx = (side // step for side in padded.shape)
    return replace(grid, density=padded.reshape(ny, step, nx, step).sum(axis=(1, 3)), h=step * grid.h)


def _cropped(grid: GridBelief, prior: FloatArray) -> tuple[GridBelief, FloatArray, FloatArray]:
    x_min, y_min, x_max, y_max = extent_of(grid, smallest_set(grid, 1.0 - NEGLIGIBLE_MASS))
    i0, i1 = aligned_range(x_min - grid.x0, x_max - grid.x0, grid.h, grid.nx)
    j0, j1 = aligned_range(y_min - grid.y0, y_max - grid.y0, grid.h, grid.ny)
    density = np.ascontiguousarray(grid.density[j0:j1, i0:i1])
    density = density / density.sum()
    cut = replace(grid, density=density, x0=grid.x0 + i0 * grid.h, y0=grid.y0 + j0 * grid.h)
    return cut, np.ascontiguousarray(prior[j0:j1, i0:i1]), density


def _coarse(grid: GridBelief) -> bool:
    x_min, y_min, x_max, y_max = extent_of(grid, smallest_set(grid, 0.95))
    across = max(x_max - x_min, y_max - y_min) / grid.h
    few = COARSE_CELLS if 4 * grid.density.size <= MOST_CELLS else COARSE_CELLS / 4
    return across < few - 0.5 and grid.density.size <= MOST_CELLS


def _refined(grid: GridBelief, prior: FloatArray) -> tuple[GridBelief, FloatArray]:
    """Both resolutions doubled; the four children share their parent's prior mass."""
    finer = 0.25 * prior.repeat(2, axis=0).repeat(2, axis=1)
    return replace(grid, density=finer, h=grid.h / 2.0), finer


@dataclass(frozen=True, slots=True, eq=False)
class _Weighing:
    """The bearings as arrays, and what is common to those of each source."""

    seen: Sighted
    movement: Movement
    sources: tuple[str, ...]
    counts: tuple[int, ...]
    joint: bool
    scale: FloatArray
    scale_weight: FloatArray
    bias_sd: FloatArray
    bias_weight: FloatArray
    rates: tuple[float, ...]

    @classmethod
    def of(cls, folded: Sequence[Bearing], assumed: Assumed, now: float) -> _Weighing:
        newest_first = sorted(folded, key=lambda one: -one.taken_at)
        sources = tuple(dict.fromkeys(one.source for one in folded))
        priors = [assumed.of(source) for source in sources]
        rates = tuple(LEAST_RATE if prior is None else float(prior.rate @ prior.rate_weight) for prior in priors)
        alone = [assumed.of(one.source) is None for one in newest_first]
        rate = np.array(
            [
                max(one.outlier_probability, LEAST_RATE) if by_itself else rates[sources.index(one.source)]
                for one, by_itself in zip(newest_first, alone, strict=True)
            ]
        )
        known = next((prior for prior in priors if prior is not None), None)
        one = np.ones(1)
        scale, scale_weight = (one, one) if known is None else (known.scale, known.scale_weight)
        bias_sd, bias_weight = (np.zeros(1), one) if known is None else _two_spreads(known)
        return cls(
            _sighted(newest_first, sources, rate, now), assumed.movement, sources,
            tuple(sum(b.source == source for b in folded) for source in sources), known is not None,
            scale, scale_weight, bias_sd, bias_weight, rates,
        )  # fmt: skip

    def mass(self, grid: GridBelief, prior: FloatArray) -> tuple[FloatArray, tuple[SourceBias, ...]]:
        """(ny, nx) of the cells of `grid`, and the errors of each source."""
        rows, columns = np.nonzero(prior)
        x, y = (along[index] for along, index in zip(grid.centres(), (columns, rows), strict=True))
        log, bias, square = moving_evidence(
            x, y, self.seen, self.movement.speed, self.movement.persistence, len(self.sources),
            self.scale, self.scale_weight, self.bias_sd, self.bias_weight,
        )  # fmt: skip
        log += np.log(prior[rows, columns])
        mass = np.exp(log - log.max())
        mass /= mass.sum()
        density = np.zeros_like(prior)
        density[rows, columns] = mass
        return density, self._errors(mass @ bias, mass @ square) if self.joint else ()

    def _errors(self, bias: FloatArray, square: FloatArray) -> tuple[SourceBias, ...]:
        scale = float(np.sqrt(self.scale_weight @ self.scale**2))
        spread = np.sqrt(np.maximum(square - bias**2, 0.0))
        return tuple(
            SourceBias(*found)
            for found in zip(
                self.sources, self.counts, bias.tolist(), spread.tolist(), [scale] * len(bias), self.rates, strict=True
            )
        )


def _sighted(newest_first: Sequence[Bearing], sources: Sequence[str], rate: FloatArray, now: float) -> Sighted:
    peaks = [[(b.angle, 1.0), *((peak.angle, peak.weight) for peak in b.peaks)] for b in newest_first]
    first: IntArray = np.concatenate([[0], np.cumsum([len(some) for some in peaks])]).astype(np.int64)
    return Sighted(
        np.array([b.x for b in newest_first], dtype=float),
        np.array([b.y for b in newest_first], dtype=float),
        np.array([max(b.sigma, SMALLEST_SIGMA) for b in newest_first], dtype=float),
        np.array([now - b.taken_at for b in newest_first], dtype=float),
        np.array([sources.index(b.source) for b in newest_first], dtype=np.int64),
        rate,
        first,
        np.array([angle for some in peaks for angle, _ in some], dtype=float),
        np.array([w / sum(v for _, v in some) for some in peaks for _, w in some], dtype=float),
    )


def _two_spreads(prior: ErrorPrior) -> tuple[FloatArray, FloatArray]:
    """A good compass and a bad one stand for all standard deviations that the bias may have."""
    middle = len(prior.spread) // 2
    if middle == 0:
        return prior.spread, prior.spread_weight
    found = [(prior.spread[part], prior.spread_weight[part]) for part in (slice(None, middle), slice(middle, None))]
    weight = np.array([w.sum() for _, w in found])
    kept = weight > 0.0
    sd = np.array([np.sqrt(w @ s**2 / max(w.sum(), 1e-12)) for s, w in found])
    return sd[kept], weight[kept]
