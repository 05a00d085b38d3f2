"""The joint belief: place x bias x scale x outlier rate of each source of bearings, marginalized exactly.

What is common to a source's bearings counts once. Given the place the sources are independent, so the belief over
places is prior(x) prod_s p(bearings of s | x), each factor summed over its source's errors (planner.belief.evidence).
Nothing but the grid's geometry is carried on from bearing to bearing: all of them are weighed again on the cells of the
grid as it stands, so that a refined grid knows what a coarse one could not.

A joint belief is a `GridBelief`: planner, forecast and page take its mass over places as they take any other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np

from planner.belief import compiled_evidence, evidence
from planner.belief.blocks import FEW_CELLS, FEW_DEAR_CELLS, PartsOfCells, Places, weighed_in_blocks
from planner.belief.evidence import SMALLEST_SIGMA, sightings
from planner.belief.grid import (
    COARSE_CELLS,
    MOST_CELLS,
    NEGLIGIBLE_MASS,
    GridBelief,
    aligned_range,
    extent_of,
    prior_belief,
    smallest_set,
)
from planner.belief.sharp import Crossings, crossings
from planner.belief.source_errors import EVEN_STEP, ErrorPrior, Nodes, SourceErrors, nodes
from planner.detection import DetectionModel, Silence, silence_log_likelihood
from planner.observation import validate_bearing
from planner.on_the_way import Stretch
from planner.types import Bearing, FloatArray, Problem

UNKNOWN_SOURCE = ErrorPrior()
"""What is assumed of a source of which nothing is known."""

UNKNOWN_EMITTER = DetectionModel(margin_db=10.0)
"""Of an emitter of which nothing is known but that it can be heard at all: in the median from 215 m, in one of six from
less than 100."""

MANY_CELLS = 128 * 128
"""A larger grid is refined only where COARSEST_CELLS are too few: every bearing is weighed on every cell."""
COARSEST_CELLS = 12
"""Cells along the longer side of the 95 % region that any grid must have."""
FEWEST_DEAR_CELLS = COARSE_CELLS // 2
"""The same where stretches of way make each cell tens of times as dear: the estimate moves by 0.3 % of its error."""
DEEPEST_REFINEMENT = 16
MOST_SHARP_CELLS = 512 * 512
"""Of a grid that must be fine since its bearings cross sharply; most of its cells are weighed in blocks."""
NO_MASS = 1e-16
"""Of a block: all that hold less hold nothing that a sum over the places would show."""
LEAST_DENSITY = 1e-7
"""Of a cell or a value of the bias, beside the likeliest, 16 nats: what a leg says is two or three."""
MOST_AT_AN_END = 1e-5
"""Mass of the outermost values of the bias that were kept, relative to the likeliest. In 194 flights whose compass
changed by up to 20 degrees on the way, leaving out the rest never mattered by 1e-6 while they held less."""


@dataclass(frozen=True, slots=True, eq=False)
class JointBelief(GridBelief):
    """prior: (ny, nx) mass of the cells before any bearing. folded: all bearings so far. priors: what was known of a
    source's errors before the flight, by source; otherwise: of a source that is not named there. errors: what is known
    now of the errors of each source that took a bearing. silences: turns in which the emitter was not heard, and by
    what model of detection they count. stretches: of way on which it was heard. narrowed: the errors of sources of
    which bearings of other emitters tell, too, on the grid on which they do (planner.belief.shared_source). parts: in
    which cells were weighed whose bearings cross within them.
    """

    prior: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    folded: tuple[Bearing, ...] = ()
    priors: Mapping[str, ErrorPrior] = field(default_factory=dict[str, ErrorPrior])
    otherwise: ErrorPrior = UNKNOWN_SOURCE
    errors: tuple[SourceErrors, ...] = ()
    silences: tuple[Silence, ...] = ()
    detection: DetectionModel = UNKNOWN_EMITTER
    stretches: tuple[Stretch, ...] = ()
    narrowed: Mapping[str, Nodes] = field(default_factory=dict[str, Nodes])
    parts: PartsOfCells | None = None

    def errors_of(self, source: str) -> SourceErrors | None:
        """None for a source that took no bearing."""
        return next((one for one in self.errors if one.source == source), None)

    def prior_of(self, source: str) -> ErrorPrior:
        """What was known of a source's errors before the flight."""
        return self.priors.get(source, self.otherwise)

    def stretches_of(self, source: str) -> tuple[Stretch, ...]:
        """What it heard in flight."""
        return tuple(one for one in self.stretches if one.source == source)


def joint_prior(
    problem: Problem, priors: Mapping[str, ErrorPrior] | None = None, otherwise: ErrorPrior = UNKNOWN_SOURCE
) -> JointBelief:
    """The belief before any bearing; priors and otherwise as in `JointBelief`.

    PlannerError when area or prior is unusable.
    """
    found = prior_belief(problem)
    same = {one.name: getattr(found, one.name) for one in fields(GridBelief)}
    return JointBelief(**same, prior=found.density, priors={} if priors is None else priors, otherwise=otherwise)


def unheard(
    belief: JointBelief, silences: Sequence[Silence], detection: DetectionModel = UNKNOWN_EMITTER
) -> JointBelief:
    """The belief, so far without bearings, with these silences instead of those that it had."""
    belief = replace(belief, silences=tuple(silences), detection=detection)
    return _weighed(belief, _sources(belief, compiled_evidence.Weigher))[0]


def heard_on_the_way(belief: JointBelief, stretches: Sequence[Stretch]) -> JointBelief:
    """The belief with these stretches instead of those that it had, cropped and refined as after a bearing.

    Last of all: cells and values of the bias that the bearings leave less than LEAST_DENSITY are not weighed, unless
    the result shows that the compass was off by something else on the way.
    """
    if not belief.folded:
        belief = replace(belief, stretches=tuple(stretches))
        return _weighed(belief, _sources(belief, compiled_evidence.Weigher))[0]
    prior = np.where(belief.density > LEAST_DENSITY * belief.density.max(), belief.prior, 0.0)
    found = settled(replace(belief, stretches=tuple(stretches), prior=prior))
    return settled(replace(belief, stretches=tuple(stretches), errors=())) if _held_back(found) else found


def _held_back(belief: JointBelief) -> bool:
    """Whether a source's bias may lie outside the values that were kept: mass has gathered at an end of them."""
    taken = told_by(belief)
    for one in belief.errors:
        whole = error_nodes(one.prior, taken[one.source], belief.stretches_of(one.source)).bias[[0, -1]]
        left_out = np.abs(whole - one.nodes.bias[[0, -1]]) > 0.5 * one.nodes.spacing
        if (left_out & (one.bias_mass[[0, -1]] > MOST_AT_AN_END * one.bias_mass.max())).any():
            return True
    return False


def log_prior(belief: JointBelief, mass: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """(c,) what is known of places besides the bearings: the prior's mass and what silence says."""
    log = np.log(mass)
    return log + silence_log_likelihood(belief.detection, belief.silences, x, y) if belief.silences else log


Weigher = compiled_evidence.Weigher | evidence.Weigher
Weighing = type[Weigher]


def update_joint(belief: JointBelief, bearing: Bearing, weighing: Weighing = compiled_evidence.Weigher) -> JointBelief:
    """Bayes' rule for one bearing more (3.26-3.28), then crop to what holds mass and refine where that is coarse."""
    return fold_joint(belief, (bearing,), weighing)


def fold_joint(
    belief: JointBelief, bearings: Sequence[Bearing], weighing: Weighing = compiled_evidence.Weigher
) -> JointBelief:
    """`update_joint` for these bearings together: as many weighings as for one."""
    for bearing in bearings:
        validate_bearing(bearing)
    folded = (*belief.folded, *bearings)
    return settled(replace(belief, folded=folded, bearings=len(folded), copies=1), weighing)


def settled(belief: JointBelief, weighing: Weighing = compiled_evidence.Weigher) -> JointBelief:
    """All that is known weighed again on the belief's cells, cropped and refined."""
    sources = _sources(belief, weighing)
    sharp = crossings(belief.folded)
    belief, places = _weighed(belief, sources, sharp)
    belief = _cropped(belief)
    for _ in range(DEEPEST_REFINEMENT):
        most = MOST_SHARP_CELLS if places.parts is not None else MOST_CELLS
        across = _across(belief)
        if not _coarse(belief, across, most):
            break
        belief = _refined(belief)
        while places.parts is not None and 4.0 * across < COARSEST_CELLS and 4 * belief.density.size <= most:
            across, belief = 2.0 * across, _refined(belief)
        belief, places = _weighed(belief, sources, sharp)
        belief = _cropped(belief)
    errors = tuple(_errors(one, places) for one in sources if one.bearings)
    return replace(belief, errors=errors, parts=places.parts)


def error_nodes(prior: ErrorPrior, taken: Sequence[Bearing], stretches: Sequence[Stretch]) -> Nodes:
    """Of a source that took these bearings and heard these stretches, at least one of either. A stretch tells of the
    bias at most what a bearing of its sigma does, and asks for nodes by that."""
    sharpest = float(min([*sightings(taken).sigma, *(one.sigma for one in stretches)]))
    as_bearings = sum((sharpest / one.sigma) ** 2 for one in stretches)
    return nodes(prior, sharpest, len(taken) + math.ceil(as_bearings), even=bool(stretches))


def by_source(bearings: Sequence[Bearing]) -> dict[str, list[Bearing]]:
    """In the order in which the sources first took one."""
    found: dict[str, list[Bearing]] = {}
    for bearing in bearings:
        found.setdefault(bearing.source, []).append(bearing)
    return found


def told_by(belief: JointBelief) -> dict[str, list[Bearing]]:
    """The bearings of each source that took one or heard a stretch."""
    unheard_of: dict[str, list[Bearing]] = {one.source: [] for one in belief.stretches}
    return {**unheard_of, **by_source(belief.folded)}


def places_besides(belief: JointBelief, source: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, y (c,) of the cells, or the parts in which they were weighed, m ENU, and the logarithm of their probability by
    all that is known but what this source told."""
    x, y, mass = _cells_and_parts(belief)
    log = log_prior(belief, mass, x, y)
    for other, taken in told_by(belief).items():
        if other != source:
            stretches = belief.stretches_of(other)
            grid = error_nodes(belief.prior_of(other), taken, stretches)
            log = log + compiled_evidence.evidence(x, y, sightings(taken), grid, stretches).log
    return x, y, log


def _cells_and_parts(belief: JointBelief) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, y (c,) m ENU and the prior's mass of each."""
    parts = belief.parts or PartsOfCells(*np.empty((3, 0)))
    row, column = ((at - start) // belief.h for at, start in ((parts.y, belief.y0), (parts.x, belief.x0)))
    inside = (row >= 0) & (row < belief.ny) & (column >= 0) & (column < belief.nx)
    whole = belief.prior > 0.0
    whole[row[inside].astype(int), column[inside].astype(int)] = False
    rows, columns = np.nonzero(whole)
    x, y = (along[index] for along, index in zip(belief.centres(), (columns, rows), strict=True))
    some = zip((x, y, belief.prior[rows, columns]), parts, strict=True)
    x, y, mass = (np.concatenate([of_cells, of_parts[inside]]) for of_cells, of_parts in some)
    return x, y, mass


@dataclass(frozen=True, slots=True, eq=False)
class _Source:
    """bearings: how many it took. nodes: on which its errors are summed. weigher: of all that it told."""

    name: str
    bearings: int
    prior: ErrorPrior
    nodes: Nodes
    weigher: Weigher


def _sources(belief: JointBelief, weighing: Weighing) -> list[_Source]:
    found: list[_Source] = []
    knew_all = sum(one.bearings for one in belief.errors) == len(belief.folded)
    for name, taken in told_by(belief).items():
        prior, stretches = belief.prior_of(name), belief.stretches_of(name)
        before = belief.errors_of(name) if stretches and knew_all else None
        grid = belief.narrowed.get(name) or _still_possible(error_nodes(prior, taken, stretches), before)
        found.append(_Source(name, len(taken), prior, grid, weighing(sightings(taken), grid, stretches)))
    return found


def _still_possible(grid: Nodes, before: SourceErrors | None) -> Nodes:
    """The grid, cut at both ends to the values of the bias that hold LEAST_DENSITY of the likeliest's mass or more.

    It is cut by whole EVEN_STEPs, so that stretches are weighed at the same values as before. before: the errors as all
    bearings tell them, since one more bearing could multiply the mass of a value by a million. None: nothing is cut.
    """
    if before is None:
        return grid
    left = before.nodes.bias[before.bias_mass > LEAST_DENSITY * before.bias_mass.max()]
    margin, steps = before.nodes.spacing + grid.spacing, (grid.bias - grid.bias[0]) / EVEN_STEP
    low, high = ((end - grid.bias[0]) / EVEN_STEP for end in (left[0] - margin, left[-1] + margin))
    return grid.among((steps > math.floor(low) - 1e-9) & (steps < math.ceil(high) + 1e-9))


def _weighed(
    belief: JointBelief, sources: Sequence[_Source], sharp: Crossings | None = None
) -> tuple[JointBelief, Places]:
    """The mass of each cell of the grid by all that is known, and the blocks of cells in which it was found."""

    def weigh(x: FloatArray, y: FloatArray) -> FloatArray:
        log = silence_log_likelihood(belief.detection, belief.silences, x, y) if belief.silences else np.zeros(len(x))
        return sum((one.weigher.log(x, y) for one in sources), start=log)

    few = FEW_DEAR_CELLS if belief.stretches else FEW_CELLS
    places = weighed_in_blocks(belief.prior, belief.x0, belief.y0, belief.h, weigh, few, sharp)
    return replace(belief, density=places.density), places


def _errors(source: _Source, places: Places) -> SourceErrors:
    """The errors' masses, summed over the places."""
    held = places.mass > NO_MASS
    x, y, mass = places.x[held], places.y[held], places.mass[held]
    found = source.weigher.shared_out(x, y, mass)
    off = mass * (found.mean - float(mass @ found.mean))
    with_place = np.array([off @ x, off @ y])
    return SourceErrors(
        source.name,
        source.bearings,
        source.prior,
        source.nodes,
        found.bias,
        found.scale,
        found.rate,
        with_place,
    )


def _cropped(belief: JointBelief) -> JointBelief:
    """The cells that hold all but a negligible share of the mass, normalized."""
    x_min, y_min, x_max, y_max = extent_of(belief, smallest_set(belief, 1.0 - NEGLIGIBLE_MASS))
    i0, i1 = aligned_range(x_min - belief.x0, x_max - belief.x0, belief.h, belief.nx)
    j0, j1 = aligned_range(y_min - belief.y0, y_max - belief.y0, belief.h, belief.ny)
    density = belief.density[j0:j1, i0:i1]
    return replace(
        belief,
        density=np.ascontiguousarray(density / density.sum()),
        prior=np.ascontiguousarray(belief.prior[j0:j1, i0:i1]),
        x0=belief.x0 + i0 * belief.h,
        y0=belief.y0 + j0 * belief.h,
    )


def _coarse(belief: JointBelief, across: float, most: int) -> bool:
    """across: cells along the 95 % region. most: cells that the refined grid may have."""
    refined = 4 * belief.density.size
    if refined <= MANY_CELLS:
        return across < (FEWEST_DEAR_CELLS if belief.stretches else COARSE_CELLS) - 0.5
    return across < COARSEST_CELLS - 0.5 and refined <= most


def _across(belief: JointBelief) -> float:
    """Cells along the longer side of the 95 % region."""
    x_min, y_min, x_max, y_max = extent_of(belief, smallest_set(belief, 0.95))
    return max(x_max - x_min, y_max - y_min) / belief.h


def _refined(belief: JointBelief) -> JointBelief:
    """Both resolutions doubled; the four children share their parent's prior mass."""
    prior = 0.25 * belief.prior.repeat(2, axis=0).repeat(2, axis=1)
    return replace(belief, prior=prior, density=prior, h=belief.h / 2.0)


def corrected(belief: GridBelief, bearings: Sequence[Bearing]) -> tuple[Bearing, ...]:
    """The bearings as the belief reads them: freed of their source's bias, sigma with its scale and the bias' spread.

    Those of a belief that knows no sources' errors stay as they are.
    """
    if not isinstance(belief, JointBelief):
        return tuple(bearings)
    return tuple(_corrected(belief.errors_of(b.source), b) for b in bearings)


def _corrected(errors: SourceErrors | None, bearing: Bearing) -> Bearing:
    if errors is None:
        return bearing
    peaks = tuple(replace(peak, angle=peak.angle - errors.bias) for peak in bearing.peaks)
    sigma = float(np.hypot(errors.scale * max(bearing.sigma, SMALLEST_SIGMA), errors.bias_sd))
    return replace(bearing, angle=bearing.angle - errors.bias, sigma=sigma, peaks=peaks, profile=())
