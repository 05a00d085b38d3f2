"""Whose bearings or readings the rows of a table are: by a column that names tags, collars or animals, or by their
frequencies."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

from hardware.direction_finding.table_file import Row, column_of, number_of, plain_name

TAGS = ("tag", "tag_id", "tagid")
OTHERS = tuple(f"{name}{number}" for name in ("transmitter", "collar", "animal") for number in ("", "_id", "id"))
_FREQUENCIES = ("frequency", "freq", "frequenz", "fréquence", "center_frequency", "core:frequency")
FREQUENCIES = tuple(f"{name}{unit}" for name in _FREQUENCIES for unit in ("", "_hz", "_khz", "_mhz", "_ghz"))
_NO_NAMES = frozenset({"", "-", "--", "?", "na", "n/a", "nan", "none", "null"})
_EVERY_TAG = frozenset({"999", "vhf"})
"""What receivers of coded tags write for every tag that sends no code."""
_UNIT = re.compile(r" ?([kMG]?)Hz$", re.IGNORECASE)
_HZ = {"": 1.0, "k": 1e3, "m": 1e6, "g": 1e9}
_MOST_MHZ = 30e3
"""A number without a unit is no more than this in MHz: nobody listens below 30 kHz."""
_DRIFT, _MOST_DRIFT_HZ = 1e-5, 4e3
"""How far apart neighbouring frequencies of one tag may lie: this share of the frequency, and never more than this many
hertz, since channels are 5 kHz apart. All of them together span no more than the larger of the two."""


@dataclass(frozen=True, slots=True)
class Naming:
    """What a column names. names: by its cells, of those that name something. complete: each row has one. of_tags: the
    column is named for them. hertz: by name; empty: these are no frequencies."""

    column: int
    names: Mapping[str, str]
    complete: bool
    of_tags: bool = False
    hertz: Mapping[str, float] = field(default_factory=dict[str, float])

    @property
    def frequencies(self) -> bool:
        """Whether the names are."""
        return bool(self.hertz)

    @property
    def several(self) -> int:
        """How many it names."""
        return len(set(self.names.values()))

    @property
    def of_every_tag(self) -> bool:
        """Whether it may be written for tags that only another column tells apart."""
        return {name.casefold() for name in self.names.values()} <= _EVERY_TAG

    def of(self, row: Row) -> str:
        """Empty where the row names none."""
        return self.names.get(_cell(row, self.column), "")


def namings(names: tuple[str, ...], rows: Sequence[Row]) -> list[Naming]:
    """Of each column that names something: tags first, frequencies last."""
    found: list[Naming] = []
    for name in (*TAGS, *OTHERS, *FREQUENCIES):
        column = column_of(names, name)
        if column is None:
            continue
        if name not in FREQUENCIES:
            found.append(replace(as_written(column, rows), of_tags=name in TAGS))
            continue
        cells = Counter(_cell(row, column) for row in rows)
        told, hertz = _frequencies(name, cells)
        found.append(Naming(column, told, len(told) == len(cells), hertz=hertz))
    return [one for one in found if one.names]


def as_written(column: int, rows: Sequence[Row]) -> Naming:
    """Each cell is a name, but for those that say there is none; large and small letters and blanks do not count,
    and 07 and 7.0 are 7."""
    cells = Counter(_cell(row, column) for row in rows)
    written: dict[str, str] = {}
    for cell in sorted(cells, key=lambda cell: -cells[cell]):
        written.setdefault(_alike(cell), cell)
    names = {cell: written[_alike(cell)] for cell in cells if _plain(cell) not in _NO_NAMES}
    return Naming(column, names, len(names) == len(cells))


def tags_in(names: tuple[str, ...], rows: Sequence[Row]) -> Naming | None:
    """That of a list of bearings: the column of tags if it names one in each row, else the one that names most. A
    single frequency names none."""
    found = namings(names, rows)
    if any(one.several > 1 for one in found):
        found = [one for one in found if not one.of_every_tag]
    best: Naming | None = None
    for one in found:
        if one.complete and one.of_tags:
            return one
        if one.several > max(0 if best is None else best.several, one.frequencies):
            best = one
    return best


def meant(asked: str, names: Collection[str]) -> str:
    """Which of the names is asked for, else the only one that is the same in other letters or digits (150.100 is
    150.1); empty: none, or several."""
    if asked in names:
        return asked
    wanted = _alike(asked), _digits(asked)
    fitting = {name for name in names if _alike(name) == wanted[0] or _digits(name) == wanted[1] != ""}
    return fitting.pop() if len(fitting) == 1 else ""


def near(asked: str, column: str, hertz: Mapping[str, float]) -> str:
    """Which of the frequencies is asked for, if it drifted no farther from there; empty: none. hertz: by name."""
    wanted = frequency_hz(column, asked) if hertz else None
    if wanted is None:
        return ""
    nearest = min(hertz, key=lambda name: abs(hertz[name] - wanted))
    return nearest if abs(hertz[nearest] - wanted) <= _DRIFT * wanted else ""


def frequency_hz(name: str, cell: str) -> float | None:
    """What a cell of the column `name` says, in the unit behind it or the one that the column names; None: nothing."""
    value = number_of(_UNIT.sub("", cell))
    if value is None or not 0.0 < value < math.inf:
        return None
    unit = _UNIT.search(cell)
    factor = _unit_of(name) if unit is None else _HZ[unit[1].lower()]
    return value * (factor or (_HZ["m"] if value < _MOST_MHZ else 1.0))


@lru_cache
def _unit_of(column: str) -> float | None:
    unit = _UNIT.search(plain_name(column).replace("_", " "))
    return None if unit is None else _HZ[unit[1].lower()]


def _cell(row: Row, column: int) -> str:
    return row.cells[column] if column < len(row.cells) else ""


def _plain(name: str) -> str:
    return " ".join(name.split()).casefold()


def _alike(name: str) -> str:
    """The same for names that are one."""
    digits = _digits(name)
    return digits if digits.endswith(".") else _plain(name)


def _digits(name: str) -> str:
    """Of a number without a sign, with a point and without zeros that say nothing; empty: it is none."""
    whole, _, rest = name.replace(",", ".").partition(".")
    if not (whole + rest).isdecimal() or not whole:
        return ""
    return f"{whole.lstrip('0')}.{rest.rstrip('0')}"


def _frequencies(column: str, cells: Counter[str]) -> tuple[dict[str, str], dict[str, float]]:
    """(those that are one tag's, measured or written otherwise, by the one that is written most; hertz by name)."""
    told = sorted((hertz, cell) for cell in cells if (hertz := frequency_hz(column, cell)) is not None)
    names: dict[str, str] = {}
    of_name: dict[str, float] = {}
    begin = 0
    for end in range(1, len(told) + 1):
        if end < len(told) and _is_drift(told[begin][0], told[end - 1][0], told[end][0]):
            continue
        hertz, most = max(told[begin:end], key=lambda one: cells[one[1]])
        name = f"{number_of(_UNIT.sub('', most)):.12g}"
        names |= {cell: name for _, cell in told[begin:end]}
        of_name[name], begin = hertz, end
    return names, of_name


def _is_drift(first_hz: float, before_hz: float, hertz: float) -> bool:
    drift = _DRIFT * hertz
    return hertz - before_hz <= min(drift, _MOST_DRIFT_HZ) and hertz - first_hz <= max(drift, _MOST_DRIFT_HZ)
