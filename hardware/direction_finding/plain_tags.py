"""Which readings of a turn are of which tag: by what a column names, or by frequencies that were heard beside each
other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from hardware.direction_finding.heard_at import HeardAt
from hardware.direction_finding.plain_columns import ROUND_DEG, turned_deg
from hardware.direction_finding.table_file import column_of
from hardware.direction_finding.table_tags import TAGS, Naming, namings

Tags = Mapping[int, str]
"""By the line of a reading; empty: none is named."""

FEWEST_HEADINGS = 8
"""With fewer nobody can say which headings were left out."""
HOPS_FROM_HZ = 300e6
"""Tags below stay on their frequency; transmitters above may change it from pulse to pulse."""
_NAMED = 0.25
"""Of the rows have a name where a column says whose they are: a note stands in fewer."""
_STEPS = 1.5
"""As wide as a tag's usual one from heading to heading: in a wider one it was not read."""


def tags_of_turns(names: tuple[str, ...], turns: Sequence[Sequence[HeardAt]]) -> Tags | None:
    """By the first column that names several tags, else one that names the same tag everywhere, else frequencies that
    are several tags', else one that names a single tag somewhere; None: by none. names: of the columns."""
    rows = [one.row for turn in turns for one in turn]
    found = namings(names, rows)
    named = [one for one in found if not one.frequencies]
    frequencies = [one for one in found if one.frequencies and one.several > 1]
    for one in named:
        rows_named = sum(one.of(row) != "" for row in rows)
        if one.several > 1 and rows_named >= max(2 * one.several, _NAMED * len(rows)):
            return _coded(one, frequencies, turns)
    for one in named:
        if one.column == column_of(names, *TAGS) and one.complete and one.several == 1 and not one.of_every_tag:
            return _coded(one, frequencies, turns)
    for one in frequencies:
        if _are_several(one, turns):
            return _tags(one, turns)
    return next((_tags(one, turns) for one in named if one.several == 1), None)


def turn_of(tag: str, turn: Sequence[HeardAt], tags: Tags) -> list[HeardAt]:
    """Its readings, and those that name none where it would else be missing: whatever is heard there is no more."""
    parted = _parted(turn, tags)
    own, unnamed = parted[tag], parted.get("", [])
    if not unnamed or not (_are_its_own(own, unnamed) if len(own) >= FEWEST_HEADINGS else len(parted) == 2):
        return own
    return [one for one in turn if tags[one.row.line] in ("", tag)]


def _tags(naming: Naming, turns: Sequence[Sequence[HeardAt]]) -> dict[int, str]:
    return {one.row.line: naming.of(one.row) for turn in turns for one in turn}


def _parted(turn: Sequence[HeardAt], tags: Tags) -> dict[str, list[HeardAt]]:
    """By tag, each with at least one reading."""
    parted: dict[str, list[HeardAt]] = {}
    for one in turn:
        parted.setdefault(tags[one.row.line], []).append(one)
    return parted


def _coded(naming: Naming, frequencies: Sequence[Naming], turns: Sequence[Sequence[HeardAt]]) -> dict[int, str]:
    """A code that was heard on several frequencies beside each other is a tag's on each: codes are given again."""
    tags = _tags(naming, turns)
    named: dict[str, list[list[HeardAt]]] = {}
    for turn in turns:
        for name, of_one in _parted(turn, tags).items():
            named.setdefault(name, []).append(of_one)
    for frequency in (one for one in frequencies if one.highest_hz < HOPS_FROM_HZ):
        for name, of_one in named.items():
            on = {one.row.line: frequency.of(one.row) for turn in of_one for one in turn}
            if name and len(set(on.values()) - {""}) > 1 and _are_beside(of_one, on, steps=0.0):
                tags |= {line: f"{name} {channel}" for line, channel in on.items() if channel}
    return tags


def _are_its_own(own: Sequence[HeardAt], unnamed: Sequence[HeardAt]) -> bool:
    louder = max(one.power_db for one in unnamed) > max(one.power_db for one in own)
    return not louder and not _share_headings([(own, unnamed)])


def _are_several(frequency: Naming, turns: Sequence[Sequence[HeardAt]]) -> bool:
    """Whether two went round, or were heard beside each other."""
    tags = _tags(frequency, turns)
    whole = _parted([one for turn in turns for one in turn], tags)
    whole.pop("", None)
    went_round = sum(turned_deg([one.heading_deg for one in of_one]) >= ROUND_DEG for of_one in whole.values())
    return went_round > 1 or _are_beside(turns, tags)


def _are_beside(turns: Sequence[Sequence[HeardAt]], tags: Tags, steps: float = _STEPS) -> bool:
    """Whether others were read where the one that was heard most was, too, rather than instead of it: as a receiver
    does that writes what was loudest, or whose tag hops or drifts."""
    heard = Counter(tags[one.row.line] for turn in turns for one in turn)
    most = max(filter(None, heard), key=lambda name: heard[name])
    parted = [_parted(turn, tags) for turn in turns]
    return _share_headings(
        [
            (part.get(most, []), [one for name, of_one in part.items() if name not in ("", most) for one in of_one])
            for part in parted
        ],
        steps,
    )


def _share_headings(turns: Sequence[tuple[Sequence[HeardAt], Sequence[HeardAt]]], steps: float = _STEPS) -> bool:
    """Of turns, each parted in two: whether most readings of either part were made where the other was read, too."""
    return any(
        2 * sum(_beside(turn[k], turn[1 - k], steps) for turn in turns) > sum(len(turn[1 - k]) for turn in turns)
        for k in (0, 1)
    )


def _beside(own: Sequence[HeardAt], others: Sequence[HeardAt], steps: float) -> int:
    """How many of the others were read at a heading of their own, or between two that are no farther apart than so many
    usual steps; none where the own are too few."""
    at_deg, others_deg = (np.round([one.heading_deg for one in some], 1) % 360.0 for some in (own, others))
    around = np.unique(at_deg)
    if around.size < FEWEST_HEADINGS:
        return 0
    apart_deg = np.diff(around, append=around[0] + 360.0)
    here_deg = apart_deg[np.searchsorted(around, others_deg, side="right") - 1]
    return int(np.sum((here_deg <= steps * np.median(apart_deg)) | np.isin(others_deg, around)))
