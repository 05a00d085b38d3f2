"""What all exports tell alike: a mission's state and name, how long a bearing's line is, which altitudes are known."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np
import pymap3d.vincenty
from numpy.typing import NDArray

from backend.events import (
    BearingMeasured,
    CraftSource,
    EstimateFact,
    MissionDrafted,
    MissionEdited,
    MissionLabelled,
    Recorded,
)
from backend.search.state import SearchState, evolve
from hardware.direction_finding.bearings_file import LATEST_S

RAY_M = 500.0
"""Length of a bearing line when there is no estimate to reach."""
NOT_IN_XML = re.compile("[^\t\n\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""XML 1.0 has no other characters, not even escaped; a return would be read as a line end."""


def folded(recorded: Sequence[Recorded]) -> SearchState:
    """After the last of them."""
    state = SearchState()
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
    return state


def mission_name(recorded: Sequence[Recorded]) -> str:
    """As the list calls it: by the last specification or label; empty before there is one."""
    name = ""
    for record in recorded:
        match record.event:
            case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
                name = spec.name
            case MissionLabelled(name=label):
                name = label
            case _:
                pass
    return name


def taken_utc(record: Recorded, fact: BearingMeasured) -> datetime:
    """When it was there; of one that no craft of the mission took, when it was taken, if somebody said when."""
    told_s = None if isinstance(fact.source, CraftSource) else fact.taken_at_s
    return datetime.fromtimestamp(told_s, UTC) if told_s is not None and 0.0 < told_s < LATEST_S else record.at_utc


def altitude_amsl_m(fact: BearingMeasured) -> float | None:
    """None: nobody knows. Without a sweep a bearing has its home's, and a file's sweep that tells none has 0."""
    told = isinstance(fact.source, CraftSource) or (fact.sweep_id is not None and fact.altitude_amsl_m != 0.0)
    return fact.altitude_amsl_m if told else None


def measured_quality(fact: BearingMeasured) -> float | None:
    """None: there was no sweep to measure it."""
    return None if fact.sweep_id is None else fact.quality


def ray_lengths_m(facts: Sequence[BearingMeasured], estimate: EstimateFact | None) -> NDArray[np.float64]:
    """(n,) Of their lines: as far as the estimate and a little more."""
    if estimate is None or not facts:
        return np.full(len(facts), RAY_M)
    places = np.array([(fact.place.lat, fact.place.lon) for fact in facts])
    away_m, _ = pymap3d.vincenty.vdist(places[:, 0], places[:, 1], estimate.lat, estimate.lon)
    return 1.2 * np.atleast_1d(away_m) + 20.0  # of one place it is a bare number


def xml_words(value: object) -> str:
    """Without the characters that XML does not have; to be escaped yet."""
    return NOT_IN_XML.sub("", str(value))
