"""What may explain a sweep besides one wave, heard with the pattern's antenna, and what all of it together says.

Another antenna (other_antenna.py), a wave among many echoes (many_echoes.py) and one that fades slowly, or a receiver
whose scale is compressed (slow_fading.py): each by its evidence and the odds that it has before the sweep is seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.alternatives import Alternatives
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bent import SPREAD_REACH_DEG, Bent, bent
from hardware.direction_finding.bent_lobes import BentLobes
from hardware.direction_finding.circle import Besides
from hardware.direction_finding.many_echoes import echo_field
from hardware.direction_finding.other_antenna import (
    KNOWN_REACH_DEG,
    OtherAntenna,
    doubtful,
    known_antenna,
    other_antenna,
)
from hardware.direction_finding.refine import Refined
from hardware.direction_finding.slow_fading import fading_field
from hardware.direction_finding.sweep import BinnedSweep

OTHER_ODDS = 3.0
"""Of another antenna to the pattern's before the sweep is seen, when nobody checked the pattern on the vehicle."""
OTHER_ODDS_BORROWED = 8.0
OTHER_ODDS_CHECKED = 0.05
ECHO_ODDS = 2.0
"""Of many echoes to the likeliest of one wave, one echo and a view from above, before the sweep is seen."""
FADING_ODDS = 0.1
"""Of slow fading, to the same."""
JOINED_DEG = 45.0
"""Bearings of different explanations that are no further apart mean the same direction, and are averaged."""
AMBIGUOUS = 0.25
"""Probability beyond 60 degrees of a bearing that is no outlier's any more: sigma is the whole circle's spread then."""


@dataclass(frozen=True, slots=True)
class Explained:
    """What else may explain a sweep, and how probable each is; the pattern's antenna has the rest.

    bent, of_bent: in the order of `bent_by_all`. Without `other` nothing else was asked about.
    """

    other: OtherAntenna | None = None
    of_other: float = 0.0
    bent: tuple[Bent, ...] = ()
    of_bent: tuple[float, ...] = ()

    def besides(self) -> tuple[Besides, ...]:
        """Their densities."""
        if self.other is None:
            return ()
        bent = (Besides(share, one.at_deg, one.log_density) for share, one in zip(self.of_bent, self.bent, strict=True))
        return (Besides(self.of_other, self.other.bearing_deg + self.other.off_deg, self.other.log_density), *bent)


def bent_by_all(pattern: AntennaPattern) -> tuple[BentLobes, ...]:
    """What bends an antenna's lobe: many echoes, slow fading."""
    return echo_field(pattern), fading_field(pattern)


def explained_by(
    alternatives: Alternatives,
    lobes: tuple[BentLobes, ...],
    pattern: AntennaPattern,
    binned: BinnedSweep,
    refined: Refined,
    noise_db: float | None,
) -> Explained:
    """Posterior by Bayes' rule. lobes: of `bent_by_all`. noise_db: the receiver's floor, None: unknown."""
    slices = doubtful(binned, refined.fitted_db)
    if slices is None:
        return Explained()
    level_db = refined.peak_db
    known = known_antenna(alternatives, slices, refined.bearing_deg, level_db, noise_db)
    other = other_antenna(slices, level_db, noise_db, known)
    disturbed = tuple(bent(one, slices, level_db, noise_db, known, KNOWN_REACH_DEG) for one in lobes)
    unchecked = OTHER_ODDS_BORROWED if pattern.borrowed else OTHER_ODDS
    odds = np.array([1.0, OTHER_ODDS_CHECKED if pattern.checked else unchecked, ECHO_ODDS, FADING_ODDS])
    log = np.log(odds) + np.array([0.0, other.log_odds, *(one.log_odds for one in disturbed)])
    probability = np.exp(log - log.max())
    probability /= probability.sum()
    return Explained(other, float(probability[1]), disturbed, tuple(probability[2:].tolist()))


def of_all(refined: Refined, explained: Explained) -> tuple[float, float]:
    """(mean bearing of the explanations that agree with the likeliest, spread of all about it)."""
    other = explained.other
    if other is None:
        return refined.bearing_deg, refined.sigma_deg
    of_bent = np.array(explained.of_bent)
    sharp = np.array([1.0 - explained.of_other - of_bent.sum(), explained.of_other])
    share = np.concatenate([sharp, of_bent])
    bearings = np.array([refined.bearing_deg, other.bearing_deg, *(one.bearing_deg for one in explained.bent)])
    lead = float(bearings[int(np.argmax(share))])
    apart = _apart(bearings, lead)
    joined = share * (np.abs(apart) <= JOINED_DEG)
    bearing = (lead + float(joined @ apart) / float(joined.sum())) % 360.0
    apart = _apart(bearings[:2], bearing)
    beyond = np.abs(apart) > SPREAD_REACH_DEG
    bent_beyond = np.array([one.beyond(bearing) for one in explained.bent])
    whole = float(sharp @ beyond) + float(of_bent @ bent_beyond) > AMBIGUOUS
    counted = np.where(beyond & (not whole), 0.0, apart)
    squares = np.array([refined.sigma_deg, other.sigma_deg]) ** 2 + counted**2
    reach_deg = 180.0 if whole else SPREAD_REACH_DEG
    spread = np.array([one.spread_deg(bearing, reach_deg) for one in explained.bent])
    return bearing, math.sqrt(float(sharp @ squares) + float(of_bent @ spread**2))


def _apart(bearing_deg: NDArray[np.float64], from_deg: float) -> NDArray[np.float64]:
    return (bearing_deg - from_deg + 180.0) % 360.0 - 180.0
