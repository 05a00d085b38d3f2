"""Tables of a record inside the page that explains them, between two marks:

    <!-- figures: NAME/TABLE -->
    <!-- end of figures -->

NAME is the record's, TABLE its table's. What stands between the marks is made and not written by hand.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from tests.benchmarks.figures.markdown import number, row, rule
from tests.benchmarks.figures.reader import BrokenRecord
from tests.benchmarks.figures.record import Cell, Record, Table

BLOCK = re.compile(r"(<!-- figures: (?P<source>[^\n]*?) -->\n).*?(<!-- end of figures -->)", re.DOTALL)


def with_tables(page: str, text: str, records: Sequence[Record]) -> str:
    """The page's text with its tables made from the records. page: its name, for errors."""
    tables = {f"{record.name}/{table.name}": table for record in records for table in record.tables}

    def put(found: re.Match[str]) -> str:
        source = found["source"]
        if source not in tables:
            raise BrokenRecord(f"{page}: no record has the table {source}")
        return f"{found[1]}{markdown(tables[source])}\n{found[3]}"

    return BLOCK.sub(put, text)


def markdown(table: Table) -> str:
    decimals = [column.decimals for column in table.columns]
    lines = [row([column.name for column in table.columns]), rule(len(table.columns))]
    lines += [row([shown(cell, places) for cell, places in zip(cells, decimals, strict=True)]) for cells in table.rows]
    return "\n".join(lines)


def shown(cell: Cell, decimals: int | None) -> str:
    if cell is None:
        return ""
    if isinstance(cell, str):
        return cell
    if isinstance(cell, tuple):
        return " ± ".join(number(value, decimals) for value in cell)
    return number(cell, decimals)
