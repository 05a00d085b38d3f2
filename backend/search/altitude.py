"""The altitude of a place: the one function that says how high a craft flies and measures there."""

from __future__ import annotations

from backend.search.ground import LATERAL_TOLERANCE_M, VERTICAL_TOLERANCE_M, Below, Ground, Way
from backend.spec import FlightSpec, Place

DRIFT_M = 5.0
"""A vehicle drifts by a metre or two while it hovers, and the way from there may lie over other ground: an altitude is
chosen for ground this much further aside than the vetoes look, where the band leaves that."""


def altitude_at(place: Place, ground: Ground, flight: FlightSpec) -> float:
    """Metres AMSL at which a craft hovers at a place, wherever it comes from."""
    return level_altitude([ground.frame.to_enu(place)], ground, flight)


def level_altitude(way: Way, ground: Ground, flight: FlightSpec, wanted_amsl_m: float | None = None) -> float:
    """The one altitude, m AMSL, at which a way (m ENU) is flown: the wanted one where the ground allows it, else the
    nearest that keeps clearance and ceiling. wanted_amsl_m None: the mission's, above home.

    Where none keeps both, or the ground is not known, it is one that the vetoes refuse.
    """
    wanted = ground.home_amsl_m + flight.altitude_relative_m if wanted_amsl_m is None else wanted_amsl_m
    below = ground.below(way)
    if ground.terrain is None or below is None:
        return wanted
    least, most = _between(below, flight)
    careful_least, careful_most = _between(ground.below(way, LATERAL_TOLERANCE_M + DRIFT_M) or below, flight)
    lowest = max(least, ground.home_amsl_m + flight.minimum_altitude_relative_m)
    room = max(0.0, min(most, ground.home_amsl_m + flight.maximum_altitude_relative_m) - lowest)
    up, down = max(0.0, careful_least - least), max(0.0, most - careful_most)
    share = 1.0 if up + down <= room else room / (up + down)
    return max(least + share * up, min(wanted, most - share * down))


def _between(below: Below, flight: FlightSpec) -> tuple[float, float]:
    """The lowest and the highest altitude, m AMSL, that keeps clearance and ceiling over it."""
    return (
        below.highest_m + flight.minimum_clearance_m + VERTICAL_TOLERANCE_M,
        below.lowest_m + flight.maximum_above_ground_m - VERTICAL_TOLERANCE_M,
    )
