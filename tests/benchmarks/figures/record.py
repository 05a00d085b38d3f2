"""What one run of a benchmark found: figures with their units, and the circumstances they were taken under.

A record is one JSON file, `docs/measurements/<name>.json`. It is checked whenever it is written or read: a field too
many, a wrong unit or a `met` that its own numbers contradict is an error.
"""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

Words = Annotated[str, Field(min_length=1)]


class Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Bound(Part):
    """What a figure should be; `key` names it in `wanted.WANTED`. Both limits: between them, limits included."""

    key: Words
    at_least: FiniteFloat | None = None
    at_most: FiniteFloat | None = None

    @model_validator(mode="after")
    def _limits_something(self) -> Bound:
        if self.at_least is None and self.at_most is None:
            raise ValueError("at_least or at_most is needed")
        return self

    def met_by(self, value: float) -> bool:
        low = -math.inf if self.at_least is None else self.at_least
        high = math.inf if self.at_most is None else self.at_most
        return low <= value <= high


class Figure(Part):
    """ci95: half width of the 95 % interval, in the same unit. note: the condition that a reader must know.

    met is judged by the value alone: an interval that reaches over the bound does not make it met.
    """

    name: Words
    value: FiniteFloat | int
    unit: str
    ci95: FiniteFloat | None = None
    note: str = ""
    wanted: Bound | None = None
    met: bool | None = None

    @model_validator(mode="after")
    def _met_follows_from_the_value(self) -> Figure:
        right = None if self.wanted is None else self.wanted.met_by(self.value)
        if self.met is not right:
            raise ValueError(f'"{self.name}" is {self.value:g}, so met must be {right}, not {self.met}')
        return self


class Load(Part):
    """Least and most of the one-minute load averages while the figures were taken."""

    least: FiniteFloat
    most: FiniteFloat


Cell = str | int | FiniteFloat | tuple[FiniteFloat, FiniteFloat] | None
"""(value, ±): the column's name says what ± is, if not half the 95 % interval. null stays empty."""


class Column(Part):
    """decimals: how many are shown; null: the number as it is."""

    name: str
    decimals: int | None = None


class Table(Part):
    """Rows behind the figures. The page that explains them shows the table under its name (`pages.py`)."""

    name: Words
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]

    @model_validator(mode="after")
    def _rows_fit(self) -> Table:
        for number, row in enumerate(self.rows, 1):
            if len(row) != len(self.columns):
                raise ValueError(f'row {number} of table "{self.name}" has {len(row)} cells, not {len(self.columns)}')
        return self


class Record(Part):
    """commit: of the code that was measured; "-dirty" when files differed from it. date: UTC, to the day or the minute.

    command, commit, machine, load: null when nobody wrote them down. page: what explains the figures, from `docs/` on.
    remark: anything else that a reader of the figures should know.
    """

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]+$")]
    title: Words
    command: Words | None
    commit: Annotated[str, Field(pattern=r"^[0-9a-f]{7,40}(-dirty)?$")] | None
    date: Annotated[str, Field(pattern=r"^\d{4}-\d\d-\d\d(T\d\d:\d\dZ)?$")]
    machine: Words | None
    load: Load | None
    page: Words | None = None
    remark: str = ""
    figures: Annotated[tuple[Figure, ...], Field(min_length=1)]
    tables: tuple[Table, ...] = ()

    @model_validator(mode="after")
    def _names_are_unique(self) -> Record:
        for kind, names in (("figure", [f.name for f in self.figures]), ("table", [t.name for t in self.tables])):
            twice = sorted({name for name in names if names.count(name) > 1})
            if twice:
                raise ValueError(f"more than one {kind} is named {', '.join(twice)}")
        return self
