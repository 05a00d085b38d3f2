"""A turn in which nothing was heard: how often there was something to hear, and where the antenna pointed then."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hardware.direction_finding.antenna import AntennaPattern
from hardware.readings import HeadingSample

SECTORS = 16
"""Of the antenna's heading."""
DIRECTIONS = 36
"""Of the pattern."""
MISSES_A_PULSE = 2
"""A search for pulses steps on by half a period where it found none."""


def chances_by_heading(
    at_s: Sequence[float], headings: Sequence[HeadingSample], offset_to_nose_deg: float, pulsed: bool
) -> list[float]:
    """(16,) chances to hear the emitter while the antenna pointed to 0, 22.5, .. degrees from north, clockwise.

    at_s: of the samples in which nothing was heard; those from before or after the headings do not count. A carrier
    gives one chance a sector, however many samples: its fading there is one.
    """
    if len(headings) < 2:
        return [0.0] * SECTORS
    heard_s = np.array([one.at_s for one in headings])
    nose = np.unwrap(np.array([one.heading_deg for one in headings]), period=360.0)
    at = np.array(at_s, dtype=np.float64)
    at = at[(at >= heard_s[0]) & (at <= heard_s[-1])]
    antenna = np.interp(at, heard_s, nose) + offset_to_nose_deg
    sector = np.rint(antenna * SECTORS / 360.0).astype(np.int64) % SECTORS
    count = np.bincount(sector, minlength=SECTORS)
    found = count / MISSES_A_PULSE if pulsed else np.minimum(count, 1)
    return [float(one) for one in found]


def relative_gain_db(pattern: AntennaPattern) -> list[float]:
    """(36,) gain below the pattern's maximum at 0, 10, .. degrees clockwise of the antenna's front; at most 0."""
    gain = pattern.gain_at(np.arange(DIRECTIONS) * 360.0 / DIRECTIONS)
    return [float(one) for one in gain - gain.max()]
