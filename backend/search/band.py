"""The altitude band of a specification, and whether the altitude that is flown lies inside. Metres relative to home."""

from __future__ import annotations

from backend.reasons.safety import AltitudeOutside
from backend.search.errors import MissionInputError
from backend.spec import FlightSpec


def altitude_outside(flight: FlightSpec) -> AltitudeOutside | None:
    """What is wrong with the altitude that is flown; a band whose floor lies above its ceiling holds none."""
    low, high = flight.minimum_altitude_relative_m, flight.maximum_altitude_relative_m
    if low <= flight.altitude_relative_m <= high:
        return None
    return AltitudeOutside(flight.altitude_relative_m, low, high)


def check_band(flight: FlightSpec) -> None:
    """Raises MissionInputError. Not part of the specification's own validation: a mission that was flown before this
    was asked must still be read."""
    outside = altitude_outside(flight)
    if outside is not None:
        raise MissionInputError(outside, "flight.altitude_relative_m")
