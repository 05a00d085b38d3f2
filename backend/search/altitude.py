"""The altitude of a place: the one function that says how high a craft flies and measures there."""

from __future__ import annotations

from backend.spec import FlightSpec, Place


def altitude_at(place: Place, home_amsl_m: float, flight: FlightSpec) -> float:
    """Metres AMSL. The ground at `place` is taken to be level with the home."""
    return home_amsl_m + flight.altitude_relative_m
