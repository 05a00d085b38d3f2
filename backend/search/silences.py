"""Turns that heard nothing, as the planner takes them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from backend.events import SweepRejected
from hardware.frame import LocalFrame
from planner.detection import Silence

EAST_DEG = 90
"""Clockwise from north."""


def silences_of(facts: Sequence[SweepRejected], frame: LocalFrame) -> tuple[Silence, ...]:
    """Of those that say what they listened to. Sectors and pattern turn the other way round in the planner's frame."""
    found: list[Silence] = []
    for fact in facts:
        if (said := fact.silence) is None:
            continue
        east, north = frame.to_enu(fact.place)
        count = len(said.chances)
        sectors = (round(count * EAST_DEG / 360.0) - np.arange(count)) % count
        gain = np.array(said.gain_db)[-np.arange(len(said.gain_db)) % len(said.gain_db)]
        found.append(Silence(east, north, tuple(np.array(said.chances)[sectors].tolist()), tuple(gain.tolist())))
    return tuple(found)
