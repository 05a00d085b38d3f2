"""The antenna as a fact: a mission keeps what its bearings were found with, whatever the server is given later."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from backend.events import AntennaFact, MissionDrafted, MissionEdited, MissionStarted, Recorded, RecordingImported
from hardware.direction_finding.antenna import AntennaPattern


def antenna_fact(pattern: AntennaPattern) -> AntennaFact:
    """The whole pattern: a later change of its file does not change what a mission says of itself."""
    return AntennaFact(
        name=pattern.name,
        relative_bearing_deg=pattern.relative_bearing_deg.tolist(),
        gain_db=pattern.gain_db.tolist(),
        offset_to_nose_deg=pattern.offset_to_nose_deg,
        frequency_hz=pattern.frequency_hz,
        pointing_sigma_deg=pattern.pointing_sigma_deg,
        borrowed=pattern.borrowed,
    )


def corrected(pattern: AntennaPattern, offset_deg: float) -> AntennaPattern:
    """Turned so that bearings come out smaller by what they are known to read too large by, clockwise.

    Exactly the same pattern when that is nothing, so that journals fold to what they were.
    """
    if offset_deg == 0.0:
        return pattern
    return replace(pattern, offset_to_nose_deg=math.remainder(pattern.offset_to_nose_deg - offset_deg, 360.0))


def correction_flown(recorded: Sequence[Recorded]) -> float:
    """What `antenna_flown` takes off bearings beyond its file, clockwise: nothing when it came with a recording."""
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    brought = [r.event for r in recorded if isinstance(r.event, MissionStarted | RecordingImported) and r.event.antenna]
    flown = bool(specs) and not (brought and isinstance(brought[-1], RecordingImported))
    return specs[-1].sensor.bearing_offset_deg if flown else 0.0


def antenna_flown(recorded: Sequence[Recorded]) -> AntennaPattern | None:
    """The last one that was flown or imported with; None when nobody kept it (missions of before 2026-11-22)."""
    for record in reversed(recorded):
        if isinstance(record.event, MissionStarted | RecordingImported) and record.event.antenna is not None:
            fact = record.event.antenna
            angle, gain = np.array(fact.relative_bearing_deg), np.array(fact.gain_db)
            return AntennaPattern(
                fact.name,
                angle,
                gain,
                fact.offset_to_nose_deg,
                fact.frequency_hz,
                pointing_sigma_deg=fact.pointing_sigma_deg,
                borrowed=fact.borrowed,
            )
    return None
