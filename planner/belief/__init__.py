"""What is known of the emitter's place: the adaptive grid filter, its estimates, and when to say localized."""

from planner.belief.estimate import confidence_region, estimate, geometric_median, mass_within
from planner.belief.grid import GridBelief, digest, fold, prior_belief, smallest_set, update
from planner.belief.verdict import verdict, wedges_meet

__all__ = [
    "GridBelief",
    "confidence_region",
    "digest",
    "estimate",
    "fold",
    "geometric_median",
    "mass_within",
    "prior_belief",
    "smallest_set",
    "update",
    "verdict",
    "wedges_meet",
]
