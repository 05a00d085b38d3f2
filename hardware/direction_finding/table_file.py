"""Text tables from the field: comma, semicolon or tab separated, `#` or `%` comments, any line ends, lines numbered;
between semicolons or tabs a decimal comma, as spreadsheets write it in half of the world. Numbers may carry their
unit."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

from hardware.reasons.table import (
    CellUnusable,
    ColumnsUnknown,
    FileUnreadable,
    FileUnusable,
    Quantity,
    RemarksNotListed,
)
from hardware.reasons.union import RecordingReason
from planner.reason import ReasonedError

_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+(?:[eE][+-]?\d+)?")
_MINUTES_COMMA = re.compile(r"\d{1,3}[°º: ] ?(?:\d{1,2}['′’: ] ?)?\d{1,2},\d+['′’″”\"]{0,2}")
"""The same in minutes or seconds of a place."""
_TIME_COMMA = re.compile(r"(?:[\d.\-/]{6,10}[T ])?\d{1,2}:\d\d:\d\d,\d{1,9}(?: ?Z|[+-]\d\d:?\d\d)?")
"""The same in seconds of a time, with or without a date."""
_BETWEEN_WORDS = re.compile(r"[\s_\-/()\[\].]+")
_WHOLE = re.compile(r"[+-]?\d+")
_DEGREES = re.compile(r"(?<=[\d.])\s*(?:Â?[°º]|deg|degrees|Grad)$", re.IGNORECASE)
_DECIBELS = re.compile(r"(?<=[\d.])\s*dB(?:m|W|FS|i|d|[µu]V)?$", re.IGNORECASE)
_HEMISPHERES = "NSEWOnsewo "
_BEGINS_AS_NUMBER = re.compile(r"[NSEW]? ?[+\-\u2212]?\.?\d")
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")
_SEPARATOR_TOLD = re.compile(r"\"?sep=.\"?", re.IGNORECASE)
"""First line of what Excel writes; which one it is shows in the others."""
_LINES = re.compile(r"[^\r\n]+")
_BEYOND_ASCII = bytes(range(0x80, 0x100))
_ESCAPED = re.compile("[\udc80-\udcff]+")
"""What bytes stand for that are no UTF-8."""
_MINUS = str.maketrans("\u2212\u2013", "--")
"""As typesetters write it."""

LARGEST = 1e100
"""Of any number: its square is finite, too."""
LONGEST_CELL, MOST_NAMED = 60, 20
"""Characters of a cell that a reason shows, and how many tags it names."""
MOST_REMARKS = 50
"""Of one file, one by one: those of an imported one are a fact of the mission, which every page that shows it loads."""
MOST_TITLES = 20
"""Lines above a table, and its header."""


class RecordingError(ReasonedError):
    """A recording that cannot be used."""

    def __init__(self, reason: RecordingReason) -> None:
        super().__init__(reason)
        self._recording_reason: RecordingReason = reason

    @property
    def reason(self) -> RecordingReason:
        """Which line or column cannot be used, and why."""
        return self._recording_reason


@dataclass(frozen=True, slots=True)
class Row:
    """One line that is neither empty nor a comment: its number (from 1) and its cells, stripped."""

    line: int
    cells: tuple[str, ...]

    def number(self, column: int) -> float | None:
        """The cell as a float, None when it is missing, empty, no number (of degrees, if it has a unit) or one that
        cannot be reckoned with."""
        return self._float(column, _DEGREES)

    def decibels(self, column: int) -> float | None:
        """The same, in decibels if it has a unit."""
        return self._float(column, _DECIBELS)

    def _float(self, column: int, unit: re.Pattern[str]) -> float | None:
        number = _number(self.cells[column], unit) if column < len(self.cells) else None
        return None if number is None or abs(number) > LARGEST else number

    def numbers_beyond(self, width: int) -> bool:
        """Whether a cell after the first `width` holds a number: notes there do no harm."""
        return any(number_of(cell) is not None for cell in self.cells[width:])


@dataclass(frozen=True, slots=True)
class Table:
    """rows: data lines. comments: `#` lines without the mark. path: for reasons."""

    path: Path
    rows: tuple[Row, ...]
    comments: tuple[Row, ...]

    @property
    def heads(self) -> tuple[Row, ...]:
        """What may be a header: the first row and, below titles, others that are no data; and comments."""
        return (*(tuple(takewhile(_is_no_data, self.rows[:MOST_TITLES])) or self.rows[:1]), *self.comments)

    def below(self, header: Row) -> tuple[Row, ...]:
        """The data rows below one of its heads; all of them below a comment."""
        return self.rows if header in self.comments else tuple(row for row in self.rows if row.line > header.line)

    def cell_unusable(self, row: Row, column: int, quantity: Quantity) -> CellUnusable:
        """Why a row is left out; `column` from 0."""
        cell = row.cells[column][:LONGEST_CELL] if column < len(row.cells) else ""
        return CellUnusable(str(self.path), row.line, column + 1, cell, quantity)

    def columns_unknown(self, row: Row, *expected: str) -> RecordingError:
        """row: the header, or the first one."""
        return RecordingError(ColumnsUnknown(str(self.path), row.line, len(row.cells), expected))


def _is_no_data(row: Row) -> bool:
    """A title may hold a date or a number."""
    return sum(_BEGINS_AS_NUMBER.match(cell) is not None for cell in row.cells) < 2


def read_table(path: Path | str) -> Table:
    """Raises RecordingError when the file is missing, a directory, binary or has no data line."""
    path = Path(path)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise RecordingError(FileUnreadable(str(path), error.strerror or str(error))) from error
    text = decoded(raw)
    del raw
    if "\0" in text[:4096]:
        raise RecordingError(FileUnusable(str(path), "not_text"))
    rows: list[Row] = []
    comments: list[Row] = []
    for number, line in lines_of(text):
        stripped = line.rstrip().strip(" ") if "\t" in line.strip() else line.strip()
        try:
            if line.lstrip().startswith(("#", "%")):
                comments.append(Row(number, cells_of(stripped.lstrip().lstrip("#%"))))
            elif number == 1 and _SEPARATOR_TOLD.fullmatch(line.strip(" ")):
                continue
            elif line.strip().strip(",;"):
                cells = cells_of(stripped)
                rows.append(Row(number, _shared(cells, rows[-1].cells) if rows else cells))
        except csv.Error as error:  # a cell of more than 128 kB, for one
            raise RecordingError(FileUnusable(str(path), "not_text")) from error
    if not rows:
        raise RecordingError(FileUnusable(str(path), "empty"))
    between_blanks = [len(_words(row)) for row in rows if _has_numbers_between_blanks(row)]
    if 2 * len(between_blanks) > len(rows):
        width = max(between_blanks)
        rows, comments = ([_parted_at_blanks(row, width) for row in some] for some in (rows, comments))
    return Table(path, tuple(rows), tuple(comments))


def _shared(cells: tuple[str, ...], before: tuple[str, ...]) -> tuple[str, ...]:
    """The same cells; what says what the row before says takes no memory."""
    if len(cells) != len(before):
        return cells
    return tuple(old if old == new else new for old, new in zip(before, cells, strict=True))


def _has_numbers_between_blanks(row: Row) -> bool:
    """And nothing else separates them."""
    cells = _words(row)
    return len(row.cells) == 1 < len(cells) and all(number_of(cell) is not None for cell in cells)


def _parted_at_blanks(row: Row, width: int) -> Row:
    """A row of numbers, or a header that has a word for each column: "Heading (deg)" is one name of two words."""
    cells = _words(row)
    begins_with_number = bool(cells) and number_of(cells[0]) is not None
    return Row(row.line, cells) if len(cells) == width or begins_with_number else row


def _words(row: Row) -> tuple[str, ...]:
    return tuple(row.cells[0].split()) if len(row.cells) == 1 else row.cells


def decoded(raw: bytes) -> str:
    """A file's text: UTF-16 where it says so, as spreadsheets export it; UTF-8, but for a few bytes of Latin-1; or
    Latin-1."""
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return raw.decode("utf-16", errors="replace")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("utf-8-sig", errors="surrogateescape")
    escaped = sum(map(len, _ESCAPED.findall(text)))
    beyond_ascii = len(text) - len(raw.translate(None, _BEYOND_ASCII))
    if raw.startswith(codecs.BOM_UTF8) or beyond_ascii > 2 * escaped:
        return _ESCAPED.sub(lambda found: found[0].encode("utf-8", "surrogateescape").decode("latin-1"), text)
    return raw.decode("latin-1")


def lines_of(text: str) -> Iterator[tuple[int, str]]:
    """Those that are not empty, by their numbers from 1 on. They end as editors end them: a letter of some old code
    page that `str.splitlines` takes for an end is none."""
    number, read = 1, 0
    for line in _LINES.finditer(text):
        ends = text[read : line.start()]
        number += ends.count("\n") + ends.count("\r") - ends.count("\r\n")
        read = line.end()
        yield number, line.group()


def number_of(cell: str) -> float | None:
    """The cell as a float, with a decimal point or a decimal comma, with or without degrees or decibels behind it; None
    when it is no number."""
    return _number(cell, _DEGREES, _DECIBELS)


def _number(cell: str, *units: re.Pattern[str]) -> float | None:
    """With one of these units behind it or none."""
    try:
        return float(cell)
    except ValueError:
        plain = _bare(cell, *units)
    try:
        return float(plain.replace(",", ".") if _DECIMAL_COMMA.fullmatch(plain) else plain)
    except ValueError:
        return None


def _bare(cell: str, *units: re.Pattern[str]) -> str:
    for unit in units:
        cell = unit.sub("", cell)
    return cell.translate(_MINUS)


def cells_of(line: str) -> tuple[str, ...]:
    """Split at semicolons or tabs when every comma between them is a decimal one, or a note's, at commas else."""
    for delimiter in (";", "\t"):
        if delimiter not in line:
            continue
        cells = _split(line, delimiter)
        whole = ["," not in cell or _is_decimal(cell.strip(_HEMISPHERES)) for cell in cells]
        notes = [cell for cell, is_whole in zip(cells, whole, strict=True) if not is_whole]
        if len(cells) > 1 and all(whole[:2]) and all(map(_is_note, notes)):
            return cells
    return _split(line, ",")


def _is_decimal(cell: str) -> bool:
    """Whether it has a decimal comma."""
    plain = _bare(cell, _DEGREES, _DECIBELS)
    return bool(_DECIMAL_COMMA.fullmatch(plain) or _MINUTES_COMMA.fullmatch(cell) or _TIME_COMMA.fullmatch(cell))


def _is_note(cell: str) -> bool:
    return any(letter.isalpha() for letter in cell)


def commas_in_numbers(rows: Sequence[Row]) -> bool:
    """Whether rows without a header look as if numbers with decimal commas had been split at them: whole numbers only,
    more than two in some rows, and unsigned where decimals would stand."""
    wide = [row.cells for row in rows if len(row.cells) > 2]
    whole = all(_WHOLE.fullmatch(cell) for row in rows for cell in row.cells)
    pairs = all(cell.isdigit() for cells in wide if len(cells) % 2 == 0 for cell in cells[1::2])
    return bool(wide) and whole and pairs and all(cells[-1].isdigit() and len(cells[-1]) < 3 for cells in wide)


def _split(line: str, delimiter: str) -> tuple[str, ...]:
    cells = next(csv.reader([line], delimiter=delimiter))
    stripped = (cell.strip().strip("'\"") for cell in cells)
    return tuple(cell if cell.isprintable() else _CONTROL.sub("", cell) for cell in stripped)


def some_of(names: Iterable[str]) -> tuple[str, ...]:
    """In their order, as many and as much of each as a reason shows."""
    shown = sorted(set(names))
    return (*(name[:LONGEST_CELL] for name in shown[:MOST_NAMED]), *(("...",) if len(shown) > MOST_NAMED else ()))


def listed(path: Path | str, remarks: Sequence[RecordingReason]) -> tuple[RecordingReason, ...]:
    """The first ones, and how many more there are."""
    more = len(remarks) - MOST_REMARKS
    return (*remarks[:MOST_REMARKS], *((RemarksNotListed(str(path), more),) if more > 0 else ()))


def plain_name(name: str) -> str:
    """A header cell in lower case, its words and its unit joined by underscores: "Heading [°]" and R's
    "Heading..deg." are heading_deg."""
    words = _BETWEEN_WORDS.sub("_", name.lower().replace("°", "_deg")).strip("_")
    return re.sub(r"_degrees?$", "_deg", words)


def column_of(names: tuple[str, ...], *aliases: str) -> int | None:
    """Index of the header cell that is the first of the aliases that any is (see plain_name)."""
    normal = [plain_name(name) for name in names]
    return next((normal.index(alias) for alias in aliases if alias in normal), None)
