"""Headings made true and in time: magnetic declination, and the clock offset between receiver and vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from pygeomag import GeoMag

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.refine import PatternCurve
from hardware.direction_finding.sweep import SweepError, assemble_sweep
from hardware.readings import HeadingSample, Place, PowerSample, Sweep
from hardware.reasons.antenna import NoMagneticModel
from hardware.reasons.sweep import PowerNotNumbers, SweepReason
from planner.reason import ReasonedError

FIRST_YEAR, LAST_YEAR = 2010.0, 2030.0
"""Of the World Magnetic Models that ship with pygeomag."""


class HeadingError(ReasonedError):
    """A heading that cannot be corrected."""

    def __init__(self, reason: NoMagneticModel) -> None:
        super().__init__(reason)


def declination_deg(place: Place, at_s: float, altitude_m: float = 0.0) -> float:
    """Degrees by which magnetic north lies east of true north, World Magnetic Model. Raises HeadingError."""
    moment = datetime.fromtimestamp(at_s, UTC)
    start = datetime(moment.year, 1, 1, tzinfo=UTC)
    length = (datetime(moment.year + 1, 1, 1, tzinfo=UTC) - start).total_seconds()
    year = moment.year + (moment - start).total_seconds() / length
    if not FIRST_YEAR <= year < LAST_YEAR:
        raise HeadingError(NoMagneticModel(moment.year))
    # each model holds for five years from 2010, 2015, 2020, 2025
    field = GeoMag(base_year=moment).calculate(place.lat, place.lon, altitude_m / 1000.0, year)
    return float(field.d)


def made_true(sweep: Sweep, place: Place, at_s: float) -> Sweep:
    """The sweep whose headings were a magnetic compass's, taken at place and UTC epoch seconds. Raises HeadingError."""
    return replace(sweep, heading_deg=(sweep.heading_deg + declination_deg(place, at_s)) % 360.0)


@dataclass(frozen=True, slots=True)
class ClockOffset:
    """offset_s: receiver's clock minus vehicle's. identified: whether the turn could tell (it must change its rate or
    direction: at a constant rate an offset only shifts the bearing)."""

    offset_s: float
    identified: bool


def estimate_clock_offset(
    samples: Sequence[PowerSample],
    headings: Sequence[HeadingSample],
    pattern: AntennaPattern,
    limit_s: float = 1.5,
    step_s: float = 0.05,
) -> ClockOffset:
    """The offset at which the sweep fits the pattern best: turn to both sides over a steady emitter to measure it.

    Raises SweepError when samples and headings have nothing in common.
    """
    curve = PatternCurve(pattern)
    bearing = np.arange(0.0, 360.0, 2.0)
    offsets = np.arange(-limit_s, limit_s + step_s / 2.0, step_s)
    costs = np.full(offsets.size, np.inf)
    refusal: SweepReason = PowerNotNumbers()
    for k, offset in enumerate(offsets):
        try:
            sweep = assemble_sweep(
                samples, headings, frequency_hz=1.0, altitude_amsl_m=0.0, position=Place(0, 0), clock_offset_s=offset
            )
        except SweepError as error:
            refusal = error.reason
            continue
        front = sweep.heading_deg + pattern.offset_to_nose_deg
        residual = sweep.power_db - curve.gain_db(np.subtract.outer(bearing, front))
        costs[k] = float(np.min(np.var(residual, axis=1)))
    if not np.isfinite(costs).any():
        raise SweepError(refusal)
    best = int(np.argmin(costs))
    # a sharp minimum inside the range: half a second away the fit is clearly worse to both sides
    away = max(round(0.5 / step_s), 1)
    inside = away <= best < costs.size - away
    identified = inside and min(costs[best - away], costs[best + away]) > 1.5 * costs[best] + 0.05
    shift = 0.0
    if 0 < best < costs.size - 1 and np.isfinite(costs[best - 1 : best + 2]).all():
        left, middle, right = costs[best - 1 : best + 2]
        bend = left - 2.0 * middle + right
        shift = 0.5 * (left - right) / bend * step_s if bend > 0 else 0.0
    return ClockOffset(float(offsets[best] + shift), bool(identified))
