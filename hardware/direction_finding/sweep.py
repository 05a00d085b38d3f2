"""From power samples and headings, each at its own time, to a sweep; from a sweep to 180 bins of 2 degrees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pymap3d
from numpy.typing import NDArray

from hardware.frame import middle_of
from hardware.readings import HeadingSample, Place, PowerSample, Sweep
from hardware.reasons.receiver import NothingHeardInTurn
from hardware.reasons.sweep import (
    ClocksApart,
    HeadingsInterrupted,
    HeadingsNotNumbers,
    NoHeadingHeard,
    NoPositionHeard,
    SweepReason,
)
from planner.reason import ReasonedError

BINS = 180
BIN_DEG = 360.0 / BINS
MAXIMUM_HEADING_GAP_S = 1.0
"""Between headings further apart than this the nose's direction is not known, so power heard there is left out."""
MAXIMUM_HEADING_STEP_DEG = 20.0
"""Nor between headings that differ by more: at 30 degrees a second they are 0.7 s apart."""

IMPLAUSIBLE_DB = 400.0
"""No receiver delivers a power of this many decibels either way: such values are left out like NaN."""


class SweepError(ReasonedError):
    """Powers and headings that cannot be made into a sweep."""

    def __init__(self, reason: SweepReason) -> None:
        super().__init__(reason)
        self._sweep_reason: SweepReason = reason

    @property
    def reason(self) -> SweepReason:
        """What is missing of the sweep, or does not fit."""
        return self._sweep_reason


def assemble_sweep(
    samples: Sequence[PowerSample],
    headings: Sequence[HeadingSample],
    *,
    frequency_hz: float,
    altitude_amsl_m: float,
    position: Place | None = None,
    tag: str | None = None,
    clock_offset_s: float = 0.0,
) -> Sweep:
    """A sweep in which every power sample carries the heading of its own time.

    samples, headings: any order; headings are interpolated linearly the short way round. Headings further apart than
    MAXIMUM_HEADING_GAP_S or MAXIMUM_HEADING_STEP_DEG are not bridged: the samples between are left out and counted.
    Samples outside the headings' time span are left out.
    position: where the sweep was taken; None: the mean of the headings' positions. clock_offset_s: the receiver's clock
    minus the vehicle's, subtracted from the samples' times. Raises SweepError when nothing is left.
    """
    if not samples:
        raise SweepError(NothingHeardInTurn())
    if len(headings) < 2:
        raise SweepError(NoHeadingHeard())
    track = sorted(headings, key=lambda h: h.at_s)
    heading_s = np.array([h.at_s for h in track])
    turned = np.unwrap(np.array([h.heading_deg for h in track]), period=360.0)
    known = np.isfinite(turned) & np.isfinite(heading_s)
    heard = sorted(samples, key=lambda s: s.at_s)
    heard_s = np.array([s.at_s for s in heard]) - clock_offset_s
    power_db = np.array([s.power_db for s in heard])
    clipped = np.array([s.clipped for s in heard])
    if not known.all():
        heading_s, turned = heading_s[known], np.unwrap(turned[known], period=360.0)
    if heading_s.size < 2:
        raise SweepError(HeadingsNotNumbers())

    after = np.clip(np.searchsorted(heading_s, heard_s), 1, heading_s.size - 1)
    usable = (heard_s >= heading_s[0]) & (heard_s <= heading_s[-1])
    known_there = heading_s[after] - heading_s[after - 1] <= MAXIMUM_HEADING_GAP_S
    known_there &= np.abs(turned[after] - turned[after - 1]) <= MAXIMUM_HEADING_STEP_DEG
    without_heading = int((usable & ~known_there).sum())
    usable &= known_there
    if not usable.any():
        apart_s = max(float(heard_s[0] - heading_s[-1]), float(heading_s[0] - heard_s[-1]))
        raise SweepError(ClocksApart(apart_s) if apart_s > 0.0 else HeadingsInterrupted(MAXIMUM_HEADING_GAP_S))
    nose = np.interp(heard_s[usable], heading_s, turned) % 360.0
    floors = [s.noise_floor_db for s in heard if s.noise_floor_db is not None]
    if position is None and any(h.position is None for h in track if heard_s[0] <= h.at_s <= heard_s[-1]):
        raise SweepError(NoPositionHeard())  # where the position was lost, the vehicle may have been anywhere
    place, drift_m = _place_and_drift(track, position)
    return Sweep(
        at_s=heard_s[usable],
        heading_deg=nose,
        power_db=power_db[usable],
        frequency_hz=frequency_hz,
        position=place,
        altitude_amsl_m=altitude_amsl_m,
        drift_m=drift_m,
        clipped_samples=int(clipped[usable].sum()),
        samples_without_heading=without_heading,
        noise_floor_db=float(np.median(floors)) if floors else None,
        tag=tag,
    )


def _place_and_drift(track: list[HeadingSample], position: Place | None) -> tuple[Place, float]:
    """(mean place, largest distance from it in metres) while turning; no nearer than jumps have displaced the place."""
    places = [h.position for h in track if h.position is not None]
    if not places:
        if position is None:
            raise SweepError(NoPositionHeard())
        return position, 0.0
    lat, lon = np.array([p.lat for p in places]), np.array([p.lon for p in places])
    mean = position or middle_of(lat.tolist(), lon.tolist(), lambda degrees: float(np.mean(degrees)))
    east, north, _ = pymap3d.geodetic2enu(lat, lon, 0.0, mean.lat, mean.lon, 0.0)
    return mean, max(float(np.hypot(east, north).max()), *(h.displaced_m for h in track))


def turned_deg(heading_deg: NDArray[np.float64]) -> float:
    """How far the nose has turned in all, in degrees, counted either way, from headings in time order."""
    if heading_deg.size < 2:
        return 0.0
    return float(np.ptp(np.unwrap(heading_deg, period=360.0)))


def first_part(sweep: Sweep, turned_deg: float) -> Sweep:
    """The part of a clockwise turn heard within `turned_deg` of its beginning, as a partial sweep."""
    turned = np.unwrap(sweep.heading_deg, period=360.0)
    heard = turned - turned[0] <= turned_deg
    return replace(
        sweep,
        at_s=sweep.at_s[heard],
        heading_deg=sweep.heading_deg[heard],
        power_db=sweep.power_db[heard],
        partial=True,
    )


@dataclass(frozen=True, slots=True)
class BinnedSweep:
    """A sweep in 180 bins of antenna heading; bin i is [2 i, 2 i + 2) degrees from true north.

    power_db: (180,) mean of the samples' dB, NaN where nothing was heard. count: (180,) samples.
    heading_deg: (180,) mean antenna heading of the samples in the bin (its centre where it is empty).
    largest_gap_deg: the widest arc without a sample, and gap_start_deg where it begins.
    """

    power_db: NDArray[np.float64]
    count: NDArray[np.int64]
    heading_deg: NDArray[np.float64]
    largest_gap_deg: float
    gap_start_deg: float

    @property
    def filled(self) -> NDArray[np.bool_]:
        """(180,) bins that heard something."""
        return self.count > 0


def bin_sweep(
    heading_deg: NDArray[np.float64], power_db: NDArray[np.float64], offset_to_nose_deg: float
) -> BinnedSweep:
    """Average samples into bins of antenna heading = nose heading + offset. Implausible samples are left out."""
    good = np.isfinite(heading_deg) & (np.abs(power_db) < IMPLAUSIBLE_DB)
    front = (heading_deg[good] + offset_to_nose_deg) % 360.0 % 360.0
    index = np.minimum((front / BIN_DEG).astype(np.int64), BINS - 1)
    count = np.bincount(index, minlength=BINS)
    with np.errstate(invalid="ignore"):
        mean_db = np.bincount(index, power_db[good], BINS) / count
        mean_heading = np.bincount(index, front, BINS) / count
    centre = (np.arange(BINS) + 0.5) * BIN_DEG
    gap, start = _largest_gap(np.sort(front))
    return BinnedSweep(mean_db, count, np.where(count > 0, mean_heading, centre), gap, start)


def _largest_gap(ascending_deg: NDArray[np.float64]) -> tuple[float, float]:
    if ascending_deg.size == 0:
        return 360.0, 0.0
    gaps = np.diff(ascending_deg, append=ascending_deg[0] + 360.0)
    widest = int(np.argmax(gaps))
    return float(gaps[widest]), float(ascending_deg[widest])
