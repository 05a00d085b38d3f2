"""One source, several emitters: what the bearings of each tell of the source's errors counts for the others, too.

A craft's compass turns its bearings of all emitters alike. Given its errors n = (bias b, scale s, outlier rate e) the
emitters are independent, so that exactly

    P(x_1 .. x_m, n) = p(n) prod_i p(x_i) L_i(x_i, n),    P(x_i, n) = p(x_i) L_i(x_i, n) p(n) prod_{j != i} Z_j(n),
    Z_j(n) = sum_x p(x) L_j(x, n).

What an emitter gets leaves its own evidence out, so nothing counts twice. L holds the stretches of way on which the
source heard the emitter, too. Only one source is shared. Two that heard the same two emitters would hang together
through both places: then prod_j Z_j needs the grid of both errors at once, and taken one by one what either tells would
come back to it by way of the other. The errors of all other sources are estimated for each emitter by itself, within
Z_j too, and no less is known of them than before.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from planner.belief import compiled_evidence
from planner.belief.evidence import sightings
from planner.belief.joint import LEAST_DENSITY, JointBelief, by_source, error_nodes, places_besides, settled
from planner.belief.source_errors import NEGLIGIBLE_WEIGHT, Nodes, SourceErrors
from planner.types import Bearing, BoolArray, FloatArray

USED_UP = 2
"""Bearings that an emitter's place takes."""

SPARE = 7.0
"""Nats: an emitter's own nodes are wider apart than the common ones, and beliefs that agree differ."""


def with_shared_errors(beliefs: Sequence[JointBelief], threads: int = 1) -> tuple[JointBelief, ...]:
    """The beliefs about each emitter, in their order, with what the others tell of one source of bearings.

    beliefs: each with its own bearings alone, the same known before of a source's errors. One that the source did not
    hear stays as it is, and so do all when it heard one of them only. threads: emitters weighed at once.
    """
    source = common_source(beliefs)
    if source is None:
        return tuple(beliefs)
    heard = [i for i, belief in enumerate(beliefs) if any(b.source == source for b in belief.folded)]
    grid = common_nodes([beliefs[i] for i in heard], source)
    grid = grid.among(_in_question(grid, [beliefs[i].errors_of(source) for i in heard]))
    found = list(beliefs)

    def tells(i: int) -> FloatArray:
        return node_evidence(beliefs[i], source, grid)

    with ThreadPoolExecutor(threads) as pool:
        told = told_by_others(list(pool.map(tells, heard)))
        knowing = [
            replace(beliefs[i], narrowed={source: grid.knowing(said)}) for i, said in zip(heard, told, strict=True)
        ]
        for i, belief in zip(heard, pool.map(settled, knowing), strict=True):
            found[i] = belief
    return tuple(found)


def _in_question(grid: Nodes, known: Sequence[SourceErrors | None]) -> BoolArray:
    """(b,) the values of the bias that what the others tell may leave any emitter: those beside them hold so little
    that `Nodes.knowing` leaves them out.

    By each emitter's own belief, m of them: with p the least weight that a scale and a rate have together,
    sum_se p(s, e) prod_j Z_j(b, s, e) is at most p^(1 - m) times prod_j sum_se p(s, e) Z_j(b, s, e), which is known.
    A value that one of the others has left out counts as much as it may at most hold: where they contradict each other
    no value is left by all of them. It is out of the question where they agree: none has left out the likeliest one,
    which is next to what each of them by itself has for the likeliest.
    """
    log, left = np.zeros((len(known), len(grid.bias))), np.zeros((len(known), len(grid.bias)))
    for j, errors in enumerate(known):
        if errors is None:
            return np.ones(len(grid.bias), dtype=bool)
        own = errors.nodes
        tiny = np.finfo(float).tiny
        ratio = np.log(np.maximum(errors.bias_mass, tiny) / own.bias_weight)
        left_out = (grid.bias < own.bias[0]) | (grid.bias > own.bias[-1])
        most = np.log(LEAST_DENSITY * errors.bias_mass.max() / grid.bias_weight)
        log[j] = np.where(left_out, most, np.interp(grid.bias, own.bias, ratio))
        left[j, left_out] = -np.inf
    least = math.prod(float(weight[weight > 0.0].min()) for weight in (grid.scale_weight, grid.rate_weight))
    within = -math.log(NEGLIGIBLE_WEIGHT) - len(known) * math.log(least) + SPARE
    told, left, most = (np.stack(told_by_others(list(some))) for some in (log, left, log.max(axis=1, keepdims=True)))
    likeliest = (told + np.log(grid.bias_weight)).argmax(axis=1, keepdims=True)
    agreed = np.take_along_axis(told + left, likeliest, axis=1) > most - SPARE
    told = np.log(grid.bias_weight) + np.where(agreed, told + left, told)
    return (told > told.max(axis=1, keepdims=True) - within).any(axis=0)


def common_source(beliefs: Sequence[JointBelief]) -> str | None:
    """Of those who heard two emitters or more, whose bearings tell most of their errors. None: nobody did.

    Two bearings of an emitter are used up by its place, so the rest is counted: somebody who names every emitter once
    does not put a craft's compass aside. Of equal ones who heard most emitters, then who has more bearings, then the
    first by name.
    """
    emitters, taken, spare = Counter[str](), Counter[str](), Counter[str]()
    for belief in beliefs:
        of_it = Counter(bearing.source for bearing in belief.folded)
        emitters.update(of_it.keys())
        taken.update(of_it)
        spare.update({name: max(count - USED_UP, 0) for name, count in of_it.items()})
    several = [name for name, count in emitters.items() if count > 1]
    return min(several, key=lambda name: (-spare[name], -emitters[name], -taken[name], name), default=None)


def common_nodes(beliefs: Sequence[JointBelief], source: str) -> Nodes:
    """The errors' grid, as fine as all the source's bearings together ask for."""
    taken = [bearing for belief in beliefs for bearing in _of(belief, source)]
    stretches = [stretch for belief in beliefs for stretch in belief.stretches_of(source)]
    return error_nodes(beliefs[0].prior_of(source), taken, stretches)


def node_evidence(belief: JointBelief, source: str, grid: Nodes) -> FloatArray:
    """(k, e, b) log Z(n), up to a constant: what this emitter's bearings tell of the source's errors. belief: with its
    own bearings alone."""
    x, y, log = places_besides(belief, source)
    seen = sightings(_of(belief, source))
    return compiled_evidence.node_evidence(x, y, log, seen, grid, belief.stretches_of(source))


def told_by_others(evidence: Sequence[FloatArray]) -> tuple[FloatArray, ...]:
    """For each emitter the sum of the others' log evidence (k, e, b)."""
    stacked = np.stack(evidence)
    return tuple(np.delete(stacked, i, axis=0).sum(axis=0) for i in range(len(stacked)))


def _of(belief: JointBelief, source: str) -> list[Bearing]:
    return by_source(belief.folded)[source]
