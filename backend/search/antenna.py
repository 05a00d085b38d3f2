"""The antenna as a fact: a mission keeps what its bearings were found with, whatever the server is given later."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from backend.events import AntennaFact, MissionStarted, Recorded, RecordingImported
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
