"""A long run in pieces: each has a seed of its own and becomes a row of the record's table, and the figures are made
from all rows. A run that is broken off leaves the pieces it finished, and another day adds to them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.benchmarks.figures.reader import read
from tests.benchmarks.figures.record import Cell, Figure, Table

SEED = "seed"
"""The column that every such table has; empty in rows of before."""


def rows_kept(out: Path | None, name: str, table: Table) -> Table:
    """`table` (a new piece) below the rows that the record `name` in `out` has already, by the names of columns.

    Raises ValueError for a seed that is among them: the same piece again proves nothing more.
    """
    if out is None or not (path := out / f"{name}.json").exists():
        return table
    found = next((kept for kept in read(path).tables if kept.name == table.name), None)
    if found is None:
        return table
    wanted = [column.name for column in table.columns]
    if lost := {column.name for column in found.columns} - set(wanted):
        raise ValueError(f"{path.name} has columns that are not known any more: {', '.join(sorted(lost))}")
    kept = [dict(zip((column.name for column in found.columns), row, strict=True)) for row in found.rows]
    before = Table(
        name=table.name,
        columns=table.columns,
        rows=tuple(tuple(row.get(column) for column in wanted) for row in kept),
    )
    if again := set(cells(before, SEED)) & set(cells(table, SEED)):
        raise ValueError(f"{path.name} has the seed {', '.join(map(str, again))} already")
    return before.model_copy(update={"rows": (*before.rows, *table.rows)})


def figures_kept(out: Path | None, name: str, figures: Sequence[Figure]) -> list[Figure]:
    """`figures`, then those of the record `name` in `out` that have other names: of conditions that this run did not
    have."""
    if out is None or not (path := out / f"{name}.json").exists():
        return list(figures)
    made = {figure.name for figure in figures}
    return [*figures, *(figure for figure in read(path).figures if figure.name not in made)]


def cells(table: Table, column: str) -> list[Cell]:
    """From top to bottom, without the empty ones."""
    at = [each.name for each in table.columns].index(column)
    return [row[at] for row in table.rows if row[at] is not None]


def numbers(table: Table, column: str) -> list[float]:
    """As `cells`. Raises TypeError for words."""
    found: list[float] = []
    for cell in cells(table, column):
        if not isinstance(cell, int | float):
            raise TypeError(f'"{cell}" in column "{column}" is no number')
        found.append(cell)
    return found


def count(table: Table, column: str) -> int:
    """All of a column together."""
    return round(sum(numbers(table, column)))
