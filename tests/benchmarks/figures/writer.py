"""How every benchmark writes its record: `--out FOLDER` makes FOLDER/<name>.json, without it nothing is written."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests.benchmarks.figures.circumstances import OUT, Begun, load_until_now
from tests.benchmarks.figures.record import Figure, Record, Table
from tests.benchmarks.figures.wanted import BY_KEY


def add_out(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        OUT, type=Path, metavar="FOLDER", help="write the record into this folder (docs/measurements to keep it)"
    )


def plain(name: str, value: float, unit: str, *, ci95: float | None = None, note: str = "") -> Figure:
    """A figure for which nothing is wanted."""
    return Figure(name=name, value=value, unit=unit, ci95=ci95, note=note)


def wanted(key: str, value: float, *, of: str = "", ci95: float | None = None, note: str = "") -> Figure:
    """A figure that `WANTED` names. of: which of several it is, for instance an autopilot."""
    want = BY_KEY[key]
    bound = want.bound()
    return Figure(
        name=f"{want.what}: {of}" if of else want.what,
        value=value,
        unit=want.unit,
        ci95=ci95,
        note=note,
        wanted=bound,
        met=bound.met_by(value),
    )


def write(
    out: Path | None,
    name: str,
    title: str,
    begun: Begun,
    figures: Sequence[Figure],
    *,
    tables: Sequence[Table] = (),
    page: str | None = None,
    remark: str = "",
) -> Path | None:
    """The file written, None without `out`. page, remark: as `Record` has them."""
    if out is None:
        return None
    record = Record(
        name=name,
        title=title,
        command=begun.command,
        commit=begun.commit,
        date=begun.date,
        machine=begun.machine,
        load=load_until_now(begun),
        page=page,
        remark=remark,
        figures=tuple(figures),
        tables=tuple(tables),
    )
    return save(record, out)


def save(record: Record, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{record.name}.json"
    path.write_text(text_of(record), encoding="utf-8")
    return path


def text_of(record: Record) -> str:
    """JSON with a line for each figure and each row of a table, so that differences can be read."""
    fields = record.model_dump(mode="json", exclude_defaults=True)
    figures, tables = fields.pop("figures"), fields.pop("tables", [])
    parts = [f"  {_json(key)}: {_json(value)}" for key, value in fields.items()]
    parts.append(f'  "figures": [\n{_lines(figures, 4)}\n  ]')
    if tables:
        parts.append('  "tables": [\n' + ",\n".join(_table_text(table) for table in tables) + "\n  ]")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _table_text(table: dict[str, Any]) -> str:
    head = f'      "name": {_json(table["name"])},\n      "columns": {_json(table["columns"])},\n'
    return f'    {{\n{head}      "rows": [\n{_lines(_short(table["rows"]), 8)}\n      ]\n    }}'


def _short(value: Any) -> Any:
    """Six digits that count are enough for a table."""
    if isinstance(value, list):
        return [_short(one) for one in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _lines(values: Sequence[object], indent: int) -> str:
    return ",\n".join(" " * indent + _json(value) for value in values)


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)
