"""What may explain a sweep besides one wave, heard with the pattern's antenna, and what all of it together says.

Another antenna (other_antenna.py), a wave among many echoes (many_echoes.py) and one that fades slowly, or a receiver
whose scale is compressed (slow_fading.py): each by its evidence and the odds that it has before the sweep is seen.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.alternatives import Alternatives
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bent import SPREAD_REACH_DEG, Bent, bent
from hardware.direction_finding.bent_lobes import BentLobes
from hardware.direction_finding.circle import Besides
from hardware.direction_finding.other_antenna import (
    KNOWN_REACH_DEG,
    OtherAntenna,
    known_antenna,
    left_over_db,
    other_antenna,
)
from hardware.direction_finding.refine import PatternCurve, Refined
from hardware.direction_finding.slices import slices_of
from hardware.direction_finding.slow_fading import slow_fading
from hardware.direction_finding.sweep import BinnedSweep

FEWEST_SLICES = 8
FITS_DB, MAY_FADE_DB = 0.8, 0.4
"""Where the pattern's likeliest shape leaves less than the first, neither another antenna nor many echoes are asked
about; where it leaves less than the second, fading is not either."""
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
    """What else may explain a sweep and was asked about, and how probable each is; the pattern's antenna has the rest.

    bent: by many echoes or slow fading; of_bent: in their order.
    """

    other: OtherAntenna | None = None
    of_other: float = 0.0
    bent: tuple[Bent, ...] = ()
    of_bent: tuple[float, ...] = ()

    def besides(self) -> tuple[Besides, ...]:
        """Their densities."""
        bent = (Besides(share, one.at_deg, one.log_density) for share, one in zip(self.of_bent, self.bent, strict=True))
        if self.other is None:
            return tuple(bent)
        return (Besides(self.of_other, self.other.bearing_deg + self.other.off_deg, self.other.log_density), *bent)


def explained_by(
    alternatives: Alternatives,
    echoes: BentLobes,
    curve: PatternCurve,
    pattern: AntennaPattern,
    binned: BinnedSweep,
    refined: Refined,
    noise_db: float | None,
) -> Explained:
    """Posterior by Bayes' rule. echoes: `echo_field` of the pattern. noise_db: the receiver's floor, None: unknown."""
    slices = slices_of(binned, binned.power_db)
    left_db = left_over_db(slices, binned, refined.fitted_db)
    if slices.heading_deg.size < FEWEST_SLICES or left_db < MAY_FADE_DB:
        return Explained()
    level_db = refined.peak_db
    known = known_antenna(alternatives, slices, refined.bearing_deg, level_db, noise_db)
    faded = slow_fading(curve, slices, level_db, noise_db, known, KNOWN_REACH_DEG)
    if left_db < FITS_DB:
        _, of_faded = _shares([(0.0, 1.0), (faded.log_odds, FADING_ODDS)])
        return Explained(bent=(faded,), of_bent=(of_faded,))
    other = other_antenna(slices, level_db, noise_db, known)
    echoed = bent(echoes, slices, level_db, noise_db, known, KNOWN_REACH_DEG)
    unchecked = OTHER_ODDS_BORROWED if pattern.borrowed else OTHER_ODDS
    other_odds = OTHER_ODDS_CHECKED if pattern.checked else unchecked
    _, of_other, of_echoed, of_faded = _shares(
        [(0.0, 1.0), (other.log_odds, other_odds), (echoed.log_odds, ECHO_ODDS), (faded.log_odds, FADING_ODDS)]
    )
    return Explained(other, of_other, (echoed, faded), (of_echoed, of_faded))


def _shares(explanations: Sequence[tuple[float, float]]) -> list[float]:
    """Posterior of explanations by their log evidence and the odds that they have before."""
    log = np.array([evidence + math.log(odds) for evidence, odds in explanations])
    probability = np.exp(log - log.max())
    return (probability / probability.sum()).tolist()


def of_all(refined: Refined, explained: Explained) -> tuple[float, float]:
    """(mean bearing of the explanations that agree with the likeliest, spread of all about it)."""
    other, of_bent = explained.other, np.array(explained.of_bent)
    sharp = [(1.0 - explained.of_other - float(of_bent.sum()), refined.bearing_deg, refined.sigma_deg)]
    if other is not None:
        sharp.append((explained.of_other, other.bearing_deg, other.sigma_deg))
    of_sharp, sharp_bearings, sharp_sigmas = np.array(sharp).T
    share = np.concatenate([of_sharp, of_bent])
    bearings = np.concatenate([sharp_bearings, [one.bearing_deg for one in explained.bent]])
    lead = float(bearings[int(np.argmax(share))])
    apart = _apart(bearings, lead)
    joined = share * (np.abs(apart) <= JOINED_DEG)
    bearing = (lead + float(joined @ apart) / float(joined.sum())) % 360.0
    apart = _apart(sharp_bearings, bearing)
    beyond = np.abs(apart) > SPREAD_REACH_DEG
    bent_beyond = np.array([one.beyond(bearing) for one in explained.bent])
    whole = float(of_sharp @ beyond) + float(of_bent @ bent_beyond) > AMBIGUOUS
    counted = np.where(beyond & (not whole), 0.0, apart)
    reach_deg = 180.0 if whole else SPREAD_REACH_DEG
    spread = np.array([one.spread_deg(bearing, reach_deg) for one in explained.bent])
    return bearing, math.sqrt(float(of_sharp @ (sharp_sigmas**2 + counted**2)) + float(of_bent @ spread**2))


def _apart(bearing_deg: NDArray[np.float64], from_deg: float) -> NDArray[np.float64]:
    return (bearing_deg - from_deg + 180.0) % 360.0 - 180.0
