"""The antenna as a fact: a mission keeps what its bearings were found with, whatever the server is given later."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from backend.events import (
    AntennaFact,
    BearingSource,
    CraftSource,
    ImportSource,
    MissionDrafted,
    MissionEdited,
    MissionStarted,
    Recorded,
    RecordingImported,
)
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


def pattern_of(fact: AntennaFact) -> AntennaPattern:
    """What `antenna_fact` was made of."""
    return AntennaPattern(
        fact.name,
        np.array(fact.relative_bearing_deg),
        np.array(fact.gain_db),
        fact.offset_to_nose_deg,
        fact.frequency_hz,
        pointing_sigma_deg=fact.pointing_sigma_deg,
        borrowed=fact.borrowed,
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
    known = list(antennas(recorded).values())
    return known[-1] if known else None


def antennas(recorded: Sequence[Recorded]) -> dict[BearingSource, AntennaPattern]:
    """By source, the last that each was heard with, the newest at the end; without those of which nobody kept it."""
    found: dict[BearingSource, AntennaPattern] = {}
    for record in recorded:
        match record.event:
            case MissionStarted(craft_id=craft_id, antenna=AntennaFact() as fact):
                source = CraftSource(craft_id=craft_id)
            case RecordingImported(recording_id=recording_id, antenna=AntennaFact() as fact):
                source = ImportSource(recording_id=recording_id)
            case _:
                continue
        found.pop(source, None)
        found[source] = pattern_of(fact)
    return found


def same_pattern(one: AntennaPattern, other: AntennaPattern) -> bool:
    """However they are mounted."""
    angles = np.array_equal(one.relative_bearing_deg, other.relative_bearing_deg)
    return angles and np.array_equal(one.gain_db, other.gain_db)
