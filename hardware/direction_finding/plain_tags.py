"""Which readings of a turn are of which tag: by what a column names, or by frequencies that were heard beside each
other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from hardware.direction_finding.heard_at import HeardAt
from hardware.direction_finding.plain_columns import ROUND_DEG, turned_deg
from hardware.direction_finding.table_file import plain_name
from hardware.direction_finding.table_tags import Naming, meant, namings, near

Tags = Mapping[int, str]
"""By the line of a reading; empty: none is named."""

FEWEST_HEADINGS = 8
"""With fewer nobody can say which headings were left out."""
HOPS_FROM_HZ = 300e6
"""Tags below stay on their frequency; transmitters above may change it from pulse to pulse."""
_CHANNELS_APART_HZ = 10e3
"""On nearer channels a strong tag is heard, too, and a receiver may be tuned to one of them."""
_FEWEST_TOLD = 3
"""Rows: a name in fewer of them may be a misreading, or a note."""
_NAMED, _OFTEN = 0.2, 16
"""A column names tags where names that recur fill this share of its rows, or one of them fills this many rows."""
_STEPS = 1.5
"""Times a tag's usual step from heading to heading: in a wider gap the tag was not read."""


def tags_of_turns(names: tuple[str, ...], turns: Sequence[Sequence[HeardAt]]) -> Tags | None:
    """By the first column that names several tags, else one of tags that names the same one everywhere, else
    frequencies that are several tags', else the first that names a single tag; None: by none. names: of the columns."""
    found = namings(names, [one.row for turn in turns for one in turn])
    named = [one for one in found if not one.frequencies]
    frequencies = [one for one in found if one.frequencies and one.several > 1]
    for one in named:
        if one.several > 1 and (tags := _filled_down(one, turns) or _told(one, turns)) is not None:
            return _coded(tags, frequencies, turns)
    for one in named:
        if one.of_tags and one.complete and one.several == 1 and not one.of_every_tag:
            return _coded(_tags(one, turns), frequencies, turns)
    for one in frequencies:
        tags = _filled_down(one, turns)
        if tags is not None or _are_several(one, turns):
            return tags or _tags(one, turns)
    single = next((one for one in named if one.several == 1 and not _is_note(one, turns)), None)
    return None if single is None else _filled_down(single, turns) or _tags(single, turns)


def as_asked(
    tag: str, names: tuple[str, ...], turns: Sequence[Sequence[HeardAt]], tags: Tags | None
) -> tuple[Tags | None, str]:
    """Whose readings they are where that tag is asked for, by another column if that one names it, too; and its name.
    Several animals of one species are not one of them. As it is written it counts before any other spelling."""
    told = set[str]() if tags is None else {*tags.values()} - {""}
    found = namings(names, [one.row for turn in turns for one in turn])
    columns = [one for one in found if not (tags is None and one.frequencies)]
    written = [one for one in columns if tag in one.names.values()]
    name = "" if written and tag not in told else meant(tag, told)
    if name:
        return tags, name
    for one in written or columns:
        name = meant(tag, {*one.names.values()}) or near(tag, names[one.column], one.hertz)
        if not name:
            continue
        by_line = _tags(one, turns)
        others = set[str]() if tags is None else {tags[line] for line, own in by_line.items() if own == name} - {""}
        if len(others) < 2 or not plain_name(names[one.column]).startswith("animal"):
            return by_line, name
    return tags, tag


def turn_of(tag: str, turn: Sequence[HeardAt], tags: Tags) -> list[HeardAt]:
    """Its readings, and those without a name at headings where the tag itself was not read."""
    parted = _parted(turn, tags)
    own, unnamed = parted.get(tag, []), parted.get("", [])
    if not unnamed or not _owns(own, unnamed, alone=len(parted) == 2):
        return own
    return [one for one in turn if tags[one.row.line] in ("", tag)]


def _owns(own: Sequence[HeardAt], unnamed: Sequence[HeardAt], *, alone: bool) -> bool:
    """Whether readings without a name belong to a tag. alone: no other tag is named in that turn."""
    if len(own) == 1:
        return alone
    return (alone or len(own) >= FEWEST_HEADINGS) and _are_its_own(own, unnamed)


def _told(naming: Naming, turns: Sequence[Sequence[HeardAt]]) -> dict[int, str] | None:
    """None where names that recur fill too few rows."""
    tags = _tags(naming, turns)
    told = Counter(name for name in tags.values() if name)
    often = sum(count for count in told.values() if count >= _FEWEST_TOLD)
    return tags if often >= _NAMED * len(tags) or max(told.values()) >= _OFTEN else None


def _is_note(naming: Naming, turns: Sequence[Sequence[HeardAt]]) -> bool:
    """Whether it has names in a few rows only, none of them the first row of a turn."""
    told = sum(naming.of(one.row) != "" for turn in turns for one in turn)
    return told < _FEWEST_TOLD and not any(naming.of(turn[0].row) for turn in turns)


def _filled_down(naming: Naming, turns: Sequence[Sequence[HeardAt]]) -> dict[int, str] | None:
    """Each name for the rows and turns below it, too, as in cells that were merged; None where a name has other rows as
    well, or the turn is parted where nothing went round."""
    if naming.complete:
        return None
    tags: dict[int, str] = {}
    last = ""
    for turn in turns:
        begins = [k for k, one in enumerate(turn) if naming.of(one.row)]
        runs = [turn[begin:end] for begin, end in pairwise([*begins, len(turn)])]
        named = [naming.of(run[0].row) for run in runs]
        if last and not named:
            runs, named = [turn], [last]
        elif begins[:1] != [0] or len({*named}) < len(named):
            return None
        if len(runs) > 1 and not all(turned_deg([one.heading_deg for one in run]) >= ROUND_DEG for run in runs):
            return None
        tags |= {one.row.line: name for name, run in zip(named, runs, strict=True) for one in run}
        last = named[-1]
    return tags


def _tags(naming: Naming, turns: Sequence[Sequence[HeardAt]]) -> dict[int, str]:
    return {one.row.line: naming.of(one.row) for turn in turns for one in turn}


def _parted(turn: Sequence[HeardAt], tags: Tags) -> dict[str, list[HeardAt]]:
    """By tag, each with at least one reading."""
    parted: dict[str, list[HeardAt]] = {}
    for one in turn:
        parted.setdefault(tags[one.row.line], []).append(one)
    return parted


def _coded(tags: dict[int, str], frequencies: Sequence[Naming], turns: Sequence[Sequence[HeardAt]]) -> dict[int, str]:
    """A code that was heard at the same headings on several frequencies is a tag's on each: codes are reused."""
    named: dict[str, list[list[HeardAt]]] = {}
    for turn in turns:
        for name, of_one in _parted(turn, tags).items():
            named.setdefault(name, []).append(of_one)
    for frequency in frequencies:
        for name, of_one in named.items():
            on = {one.row.line: frequency.of(one.row) for turn in of_one for one in turn}
            channels = sorted(frequency.hertz[channel] for channel in set(on.values()) - {""})
            apart = len(channels) > 1 and min(b - a for a, b in pairwise(channels)) >= _CHANNELS_APART_HZ
            if name and apart and channels[-1] < HOPS_FROM_HZ and _are_beside(of_one, on, steps=0.0):
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
    if len({round(one.heading_deg, 1) for part in parted for one in part.get(most, [])}) < FEWEST_HEADINGS:
        return False
    return _share_headings(
        [
            (part.get(most, []), [one for name, of_one in part.items() if name not in ("", most) for one in of_one])
            for part in parted
        ],
        steps,
    )


def _share_headings(turns: Sequence[tuple[Sequence[HeardAt], Sequence[HeardAt]]], steps: float = _STEPS) -> bool:
    """Of turns, each parted in two: whether most readings of either part were made where the other was read, too."""

    def mostly(pairs: Sequence[tuple[Sequence[HeardAt], Sequence[HeardAt]]]) -> bool:
        return 2 * sum(_beside(own, others, steps) for own, others in pairs) > sum(len(others) for _, others in pairs)

    return mostly(turns) or mostly([(others, own) for own, others in turns])


def _beside(own: Sequence[HeardAt], others: Sequence[HeardAt], steps: float) -> int:
    """How many of the others were read at a heading of their own, or between two that are at most `steps` usual
    steps apart (0: at no other headings); none where the own are too few."""
    at_deg, others_deg = (np.round([one.heading_deg for one in some], 1) % 360.0 for some in (own, others))
    around = np.unique(at_deg)
    if around.size < FEWEST_HEADINGS:
        return 0
    apart_deg = np.diff(around, append=around[0] + 360.0)
    here_deg = apart_deg[np.searchsorted(around, others_deg, side="right") - 1]
    return int(np.sum((here_deg <= steps * np.median(apart_deg)) | np.isin(others_deg, around)))
