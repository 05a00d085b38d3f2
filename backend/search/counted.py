"""Which of a mission's bearings count in the end: those that were not left out, one by one or with their source."""

from __future__ import annotations

from collections.abc import Iterable

from backend.events import (
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BearingSource,
    Event,
    SourceMuteChanged,
)


def counted(events: Iterable[Event]) -> list[BearingMeasured]:
    """In the order they were taken. events: of the whole mission; others than these facts do not matter."""
    measured: list[BearingMeasured] = []
    excluded: set[str] = set()
    muted: set[BearingSource] = set()
    for event in events:
        match event:
            case BearingMeasured():
                measured.append(event)
            case BearingExcluded(bearing_id=bearing_id):
                excluded.add(bearing_id)
            case BearingIncluded(bearing_id=bearing_id):
                excluded.discard(bearing_id)
            case SourceMuteChanged(source=source, muted=True):
                muted.add(source)
            case SourceMuteChanged(source=source):
                muted.discard(source)
            case _:
                pass
    return [one for one in measured if one.bearing_id not in excluded and one.source not in muted]
