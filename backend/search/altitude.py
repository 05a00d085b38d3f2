"""The altitude of a place: the one function that says how high a craft flies and measures there."""

from __future__ import annotations

from backend.search.ground import VERTICAL_TOLERANCE_M, Ground, Way
from backend.spec import FlightSpec, Place


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
    least = below.highest_m + flight.minimum_clearance_m + VERTICAL_TOLERANCE_M
    most = below.lowest_m + flight.maximum_above_ground_m - VERTICAL_TOLERANCE_M
    return max(least, min(wanted, most))
