"""The direction finder: sparse reconstruction finds the directions, a pattern fit between the columns sharpens them.

Steps: bin (sweep.py) -> reject what no method can use -> sparse non-negative reconstruction on linear power (sparse.py)
-> components -> posterior around the strongest, in decibels, echoes and look-down considered (refine.py)
-> another antenna than the pattern's, many echoes and slow fading considered (explained.py)
-> likelihood all round (circle.py), quality.

Units of the sparse problem: linear power above the noise floor. Both the columns of A and m are scaled to unit norm
over a full turn, so lambda = 0.3 has one meaning whatever the signal level, pattern or number of empty bins: a
component that correlates with (what is left of) the sweep by less than lambda / 2 = 0.15 is not there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.alternatives import Alternatives
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bent_lobes import BentLobes
from hardware.direction_finding.beside_lobe import beside_lobe_sigma_deg
from hardware.direction_finding.circle import SweepLikelihood, sweep_likelihood
from hardware.direction_finding.explained import Explained, explained_by, of_all
from hardware.direction_finding.likely_too import likely_too, new_beside
from hardware.direction_finding.many_echoes import echo_field
from hardware.direction_finding.refine import PatternCurve, Refined, refine
from hardware.direction_finding.sparse import COLUMN_DEG, COLUMNS, PatternBank, solve_sparse
from hardware.direction_finding.sweep import BINS, IMPLAUSIBLE_DB, BinnedSweep, bin_sweep
from hardware.readings import BearingPeak, BearingReading, Sweep
from hardware.reasons.receiver import NothingHeardInTurn
from hardware.reasons.sweep import (
    ConstantPower,
    DirectionInGap,
    LikelyOtherAntenna,
    NoDirection,
    NothingAboveNoise,
    OtherDirectionLikely,
    Overdriven,
    PatternBorrowed,
    PowerNotNumbers,
    SweepReason,
    SweepRemark,
    TooFewDirections,
    TurnIncomplete,
    UnlikeAntenna,
)

PENALTY = 0.3
MINIMUM_QUALITY = 0.7
MINIMUM_BINS = 8
MAXIMUM_GAP_DEG = 120.0
"""Three quarters of a turn in slices of 22.5 degrees leave a gap of 112.5. Of a turn that was meant to be whole."""
LEAST_SECTOR_DEG = 80.0
"""Headings heard, of a turn that was meant to be partial: less than a beam and its flanks shows no maximum."""
MAXIMUM_GAP_SIGMA_DEG = 25.0
"""A bearing into a gap is used when what was heard beside the gap says it better than this."""
MAXIMUM_CLIPPED = 0.05
MAXIMUM_AT_TOP = 0.6
"""Of the directions, at the very largest power: a table says nothing of clipping. Where more of the lobe is left, or a
scale is coarse, sigma holds (tests/benchmarks/foreign_sweeps.py)."""
FLAT_DB = 1.0
"""Within this of its largest gain an antenna may be as flat as a receiver's coarse scale shows it."""
HEARD_DB = 3.0
"""Power over the noise, both together, that the strongest direction must have: 3 dB is wave and noise alike."""
MINIMUM_PEAK_WEIGHT = 0.05
MAXIMUM_SIGMA_DEG = 60.0
UNHEARD_BEAMS = 0.055
"""Of a whole circle unheard, in beam widths: what echoes from there bend the lobe by through the antenna's side lobes.
Likeliest for sectors of 120 to 300 degrees in the field world (docs/direction-finding.md)."""
EMITTER_AWAY_M = 100.0
"""How far away an emitter is taken to be when a place that is not sure is made an angle: the planner's places lie 50 to
150 m from where it looks."""


@dataclass(frozen=True, slots=True)
class Component:
    """A cluster of active columns. bearing_deg: its weighted mean direction; weight: sum of r."""

    bearing_deg: float
    weight: float


@dataclass(frozen=True, slots=True)
class _Prepared:
    """What is made of a pattern once."""

    bank: PatternBank
    curve: PatternCurve
    alternatives: Alternatives
    echoes: BentLobes


@dataclass(slots=True)
class SparseDirectionFinder:
    """Implements hardware.ports.DirectionFinder. Pure but for a cache of pattern matrices.

    Added in quadrature to the sweep's own sigma, since no sweep can show it: heading_sigma_deg, what the vehicle's
    heading is uncertain by, the pattern's mismatch_sigma_deg, what its antenna may point beside by,
    atan(drift / 100 m), what the uncertain place makes of it, what was not heard of the circle, and what echoes that no
    explanation shows bend (beside_lobe.py).
    """

    minimum_quality: float = MINIMUM_QUALITY
    penalty: float = PENALTY
    heading_sigma_deg: float = 0.0
    _prepared: dict[bytes, _Prepared] = field(default_factory=dict[bytes, _Prepared], repr=False)

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        """Bearing, sigma and quality of one sweep; one that cannot be used comes back not accepted, with the reason."""
        binned = bin_sweep(sweep.heading_deg, sweep.power_db, pattern.offset_to_nose_deg)
        refusal = unusable(sweep, binned) or cut_off(binned, pattern)
        if refusal is not None:
            return refused(binned, refusal)
        prepared = self._prepare(pattern)
        curve, alternatives = prepared.curve, prepared.alternatives
        noise_db = sweep.noise_floor_db
        power = linear_power(binned, noise_db)
        if noise_db is not None and np.nanmax(binned.power_db) < noise_db + HEARD_DB:
            return refused(binned, NothingAboveNoise(HEARD_DB))
        solution = solve_sparse(prepared.bank, power, self.penalty, binned.filled)
        parts = components(solution.r, curve.beam_deg / 2.0)  # closer ones no antenna resolves
        if not parts:
            return refused(binned, NoDirection())
        refined = refine(curve, alternatives, binned, parts[0].bearing_deg, noise_db)
        if noise_db is not None and np.max(refined.fitted_db) < noise_db + HEARD_DB:
            return refused(binned, NothingAboveNoise(HEARD_DB))
        explained = explained_by(alternatives, prepared.echoes, curve, pattern, binned, refined, noise_db)
        return self._reading(pattern, curve, binned, parts, refined, explained, noise_db, sweep.drift_m)

    def _prepare(self, pattern: AntennaPattern) -> _Prepared:
        key = pattern.relative_bearing_deg.tobytes() + pattern.gain_db.tobytes() + bytes([pattern.checked])
        if key not in self._prepared:
            if len(self._prepared) >= 16:
                self._prepared.clear()
            self._prepared[key] = _Prepared(
                PatternBank.of(pattern), PatternCurve(pattern), Alternatives.of(pattern), echo_field(pattern)
            )
        return self._prepared[key]

    def _reading(
        self,
        pattern: AntennaPattern,
        curve: PatternCurve,
        binned: BinnedSweep,
        parts: list[Component],
        refined: Refined,
        explained: Explained,
        noise_db: float | None,
        drift_m: float,
    ) -> BearingReading:
        place_sigma_deg = math.degrees(math.atan2(drift_m, EMITTER_AWAY_M))
        bearing, own_sigma = of_all(refined, explained)
        likelihood = sweep_likelihood(refined.circle, explained.besides())
        unheard = unheard_sigma_deg(binned.largest_gap_deg, curve.beam_deg)
        beyond = (bearing - binned.gap_start_deg) % 360.0
        in_gap = binned.largest_gap_deg > curve.beam_deg / 2.0 and 0.0 < beyond < binned.largest_gap_deg
        if in_gap:
            own_sigma = max(own_sigma, likelihood.spread_deg(bearing))
        gain_db = curve.gain_db(bearing - binned.heading_deg) - curve.peak_db
        beside = beside_lobe_sigma_deg(binned, refined.fitted_db, gain_db, bearing, curve.beam_deg)
        unshown = math.hypot(unheard, beside)
        own_sigma = math.hypot(own_sigma, unshown)
        sigma = math.hypot(own_sigma, self.heading_sigma_deg, pattern.mismatch_sigma_deg, place_sigma_deg)
        quality = cosine_quality(curve, binned, bearing, noise_db)
        sparse = tuple(
            BearingPeak(p.bearing_deg, min(p.weight / parts[0].weight, 1.0))
            for p in parts[1:]
            if p.weight >= MINIMUM_PEAK_WEIGHT * parts[0].weight
        )
        as_likely = likely_too(likelihood, bearing)
        reason: SweepReason | None = None
        if quality < self.minimum_quality:
            reason = UnlikeAntenna(quality, self.minimum_quality)
        elif in_gap and own_sigma > MAXIMUM_GAP_SIGMA_DEG:
            reason = DirectionInGap(binned.largest_gap_deg)
        elif sigma > MAXIMUM_SIGMA_DEG:
            reason = NoDirection()
        return BearingReading(
            bearing_deg=bearing % 360.0,
            sigma_deg=min(sigma, 180.0),
            heading_sigma_deg=self.heading_sigma_deg,
            pattern_sigma_deg=pattern.mismatch_sigma_deg,
            quality=quality,
            accepted=reason is None,
            reason=reason,
            peaks=(*as_likely, *(one for one in sparse if new_beside(one, as_likely))),
            binned_db=binned.power_db,
            fitted_db=refined.fitted_db,
            snr_db=None if noise_db is None else refined.peak_db - noise_db,
            remarks=remarks_on(pattern, explained.of_other, as_likely),
            likelihood=_widened(likelihood, math.hypot(place_sigma_deg, unshown)).packed(),
        )


def unheard_sigma_deg(gap_deg: float, beam_deg: float) -> float:
    """What echoes from directions that were not heard may bend a bearing by, s = c B sqrt(gap / 360).

    A gap of less than half a beam hides none.
    """
    return UNHEARD_BEAMS * beam_deg * math.sqrt(gap_deg / 360.0) if gap_deg > beam_deg / 2.0 else 0.0


def remarks_on(pattern: AntennaPattern, other: float, as_likely: Sequence[BearingPeak]) -> tuple[SweepRemark, ...]:
    """other: probability of another antenna. as_likely: directions that the sweep fits nearly as well."""
    remarks: list[SweepRemark] = []
    if pattern.borrowed:
        remarks.append(PatternBorrowed(pattern.name))
    if other > 0.5:
        remarks.append(LikelyOtherAntenna(pattern.name, other))
    return (*remarks, *(OtherDirectionLikely(one.bearing_deg) for one in as_likely))


def _widened(likelihood: SweepLikelihood, sigma_deg: float) -> SweepLikelihood:
    """Convolved with what the uncertain place, the unheard directions and echoes make of it."""
    return likelihood if sigma_deg < 0.5 else likelihood.blurred(sigma_deg)


def unusable(sweep: Sweep, binned: BinnedSweep) -> SweepReason | None:
    """Why no method can use this sweep; None when it can be used."""
    samples = sweep.power_db.size
    plausible = sweep.power_db[np.abs(sweep.power_db) < IMPLAUSIBLE_DB]
    if samples == 0:
        return NothingHeardInTurn()
    if plausible.size == 0:
        return PowerNotNumbers()
    if sweep.clipped_samples > MAXIMUM_CLIPPED * samples:
        return Overdriven(sweep.clipped_samples, samples)
    filled = int(binned.filled.sum())
    if filled < MINIMUM_BINS:
        return TooFewDirections(filled, MINIMUM_BINS)
    if binned.largest_gap_deg > (360.0 - LEAST_SECTOR_DEG if sweep.partial else MAXIMUM_GAP_DEG):
        return TurnIncomplete(360.0 - binned.largest_gap_deg)
    if np.ptp(binned.power_db[binned.filled]) < 1e-6:
        return ConstantPower()
    return None


def cut_off(binned: BinnedSweep, pattern: AntennaPattern) -> Overdriven | None:
    """Why too little of the lobe is left: most directions were heard at the very largest power. None: enough is."""
    level, count = binned.power_db[binned.filled], binned.count[binned.filled]
    at_top = level >= level.max() - 1e-9
    gain_db = pattern.gain_at(np.arange(360.0))
    flat = float((gain_db > gain_db.max() - FLAT_DB).sum()) / gain_db.size
    if at_top.mean() <= max(MAXIMUM_AT_TOP, flat + 0.2):
        return None
    return Overdriven(int(count[at_top].sum()), int(count.sum()))


def linear_power(binned: BinnedSweep, noise_db: float | None) -> NDArray[np.float64]:
    """(180,) power above the noise floor, of unit norm over a full turn; empty bins 0 (and not counted)."""
    db = np.where(binned.filled, binned.power_db, -np.inf)
    top = float(np.max(db))
    power = 10.0 ** ((db - top) / 10.0)
    if noise_db is not None:
        power = np.maximum(power - 10.0 ** ((noise_db - top) / 10.0), 0.0)
    norm = math.sqrt(float(np.sum(power**2)) * BINS / max(int(binned.filled.sum()), 1))
    return power / norm if norm > 0 else power


def components(r: NDArray[np.float64], reach_deg: float) -> list[Component]:
    """Clusters of active columns, strongest first; columns within `reach_deg` of a stronger cluster belong to it."""
    left = r.copy()
    found: list[Component] = []
    column = np.arange(COLUMNS)
    while left.max(initial=0.0) > 0.0:
        # the strongest neighbourhood, not the strongest column: one source may be split over close columns
        reach = max(round(reach_deg / COLUMN_DEG), 1)
        top = int(np.argmax(left))
        distance = (column - top + COLUMNS // 2) % COLUMNS - COLUMNS // 2
        near = np.abs(distance) <= reach
        weight = float(left[near].sum())
        centre = top + float(left[near] @ distance[near]) / weight
        found.append(Component(centre * COLUMN_DEG % 360.0, weight))
        left[near] = 0.0
    return sorted(found, key=lambda part: -part.weight)


def cosine_quality(curve: PatternCurve, binned: BinnedSweep, bearing_deg: float, noise_db: float | None) -> float:
    """Cosine similarity of the sweep and the pattern shifted to the bearing, linear power, over the filled bins."""
    measured = linear_power(binned, noise_db)[binned.filled]
    shifted = 10.0 ** ((curve.gain_db(bearing_deg - binned.heading_deg[binned.filled]) - curve.peak_db) / 10.0)
    norm = float(np.linalg.norm(measured) * np.linalg.norm(shifted))
    return min(max(float(measured @ shifted) / norm, 0.0), 1.0) if norm > 0 else 0.0


def refused(binned: BinnedSweep, reason: SweepReason) -> BearingReading:
    """Not accepted and without a bearing: 0 degrees with sigma 180 says "anywhere"."""
    return BearingReading(0.0, 180.0, 0.0, False, reason, (), binned.power_db, np.full(BINS, np.nan))
