"""Text tables from the field: comma, semicolon or tab separated, `#` comments, any line ends, lines numbered."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path


class RecordingError(ValueError):
    """A recording that cannot be used; the message names file, line, what is wrong and how to mend it."""


@dataclass(frozen=True, slots=True)
class Row:
    """One line that is neither empty nor a comment: its number (from 1) and its cells, stripped."""

    line: int
    cells: tuple[str, ...]

    def number(self, column: int) -> float | None:
        """The cell as a float, None when it is missing, empty or no number."""
        if column >= len(self.cells):
            return None
        try:
            return float(self.cells[column])
        except ValueError:
            return None


@dataclass(frozen=True, slots=True)
class Table:
    """rows: data lines. comments: `#` lines without the mark. path: for messages."""

    path: Path
    rows: tuple[Row, ...]
    comments: tuple[Row, ...]

    def where(self, row: Row) -> str:
        return f"{self.path}:{row.line}"


def read_table(path: Path | str) -> Table:
    """Raises RecordingError when the file is missing, a directory, binary or has no data line."""
    path = Path(path)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read ({error.strerror}); check the path") from error
    if b"\0" in raw[:4096]:
        raise RecordingError(f"{path}: is not a text file; export the recording as CSV")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    rows: list[Row] = []
    comments: list[Row] = []
    for number, line in enumerate(text.splitlines(), start=1):
        stripped = line.strip()
        if stripped.startswith("#"):
            comments.append(Row(number, _cells(stripped.lstrip("#"))))
        elif stripped.strip(",;"):
            rows.append(Row(number, _cells(stripped)))
    if not rows:
        raise RecordingError(f"{path}: holds no data (only empty lines and comments); is it the right file?")
    return Table(path, tuple(rows), tuple(comments))


def _cells(line: str) -> tuple[str, ...]:
    """Split at commas; at semicolons or tabs when there is no comma."""
    delimiter = next((d for d in (",", ";", "\t") if d in line), ",")
    return tuple(cell.strip().strip("'\"") for cell in next(csv.reader([line], delimiter=delimiter)))


def column_of(names: tuple[str, ...], *aliases: str) -> int | None:
    """Index of the first header cell that is one of the aliases (lower case, blanks as underscores)."""
    normal = [name.lower().replace(" ", "_").replace("-", "_") for name in names]
    return next((normal.index(alias) for alias in aliases if alias in normal), None)
