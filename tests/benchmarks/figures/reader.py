"""Reads all records of a folder; whatever is wrong with one is said with its file and field."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from tests.benchmarks.figures.record import Record
from tests.benchmarks.figures.wanted import BY_KEY


class BrokenRecord(ValueError):
    """The file and what is wrong in it, a line each."""


def read_all(folder: Path) -> tuple[Record, ...]:
    """By name. Raises BrokenRecord."""
    return tuple(read(path) for path in sorted(folder.glob("*.json")))


def read(path: Path) -> Record:
    try:
        record = Record.model_validate_json(path.read_bytes())
    except ValidationError as error:
        wrong = [f"{path.name}: {'.'.join(map(str, e['loc'])) or 'the file'}: {e['msg']}" for e in error.errors()]
        raise BrokenRecord("\n".join(wrong)) from error
    if record.name != path.stem:
        raise BrokenRecord(f"{path.name}: its name is {record.name}, so the file must be {record.name}.json")
    for figure in record.figures:
        if figure.wanted is None:
            continue
        want = BY_KEY.get(figure.wanted.key)
        if want is None:
            raise BrokenRecord(f'{path.name}: "{figure.name}": nothing is wanted under "{figure.wanted.key}"')
        if figure.wanted != want.bound() or figure.unit != want.unit:
            raise BrokenRecord(
                f'{path.name}: "{figure.name}": bound or unit is not that of "{want.key}" in figures/wanted.py'
            )
    return record
