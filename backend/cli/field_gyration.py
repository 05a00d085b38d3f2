"""What others fly who never stop: the nose goes round in flight, and once around is a bearing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from backend.cli.field_legs import LISTENED_HZ, leaning, speeds
from backend.simulation.field_world import FREQUENCY_HZ, HEIGHT_M, Field, Way
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.sweep import assemble_sweep
from hardware.readings import BearingReading, Sweep
from planner.types import FullMotion

GYRATION = "gyration"
"""As a planner: Fisher's places, asked for again after each circle."""


def circling(here: tuple[float, float], place: tuple[float, float], nose_deg: float, circle_s: float) -> Way:
    """One turn of the nose clockwise on the way to a place, both m ENU: as far as a flight from hover to hover comes
    meanwhile; who is there before goes on turning."""
    motion, way = FullMotion(), np.array(place) - np.array(here)
    fastest = min(motion.speed, 0.5 * motion.acceleration * circle_s)
    reach = fastest * (circle_s - fastest / motion.acceleration)
    whole = float(np.hypot(*way))
    at = np.arange(0.0, circle_s, 1.0 / LISTENED_HZ)
    if whole == 0.0:
        speed, to = np.zeros(at.size), np.zeros(2)
    else:
        speed, to = speeds(min(whole, reach), at), way / whole
    gone = np.cumsum(speed) / LISTENED_HZ
    nose = nose_deg + 360.0 / circle_s * at
    return Way(here[0] + gone * to[0], here[1] + gone * to[1], nose, np.outer(leaning(speed), to))


def heard_circling(
    field: Field, way: Way, number: int, finder: SparseDirectionFinder, pattern: AntennaPattern
) -> tuple[Sweep, BearingReading]:
    """The circle as a sweep, taken where the antenna pointed to where the bearing then says. number: of the circle."""
    samples, headings = field.along(way, LISTENED_HZ, number)
    heard = assemble_sweep(samples, headings, frequency_hz=FREQUENCY_HZ, altitude_amsl_m=HEIGHT_M)
    sweep = replace(heard, drift_m=0.0)
    reading = finder.estimate(sweep, pattern)
    if not math.isfinite(reading.bearing_deg):
        return sweep, reading
    front = np.array([told.heading_deg for told in headings]) + pattern.offset_to_nose_deg
    off = np.abs((front - reading.bearing_deg + 180.0) % 360.0 - 180.0)
    return replace(sweep, position=headings[int(off.argmin())].position or sweep.position), reading
