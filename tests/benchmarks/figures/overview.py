"""The one table of all figures: what is not met first, then what nobody measured, what is met, and everything else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tests.benchmarks.figures.markdown import number, row, rule
from tests.benchmarks.figures.record import Figure, Record
from tests.benchmarks.figures.wanted import WANTED, Wanted

FOLDER = "measurements"
UP = "../"
STANDINGS = ("**not met**", "not measured", "met", "")
HEAD = """# Measurements

`make figures` makes this page from `docs/measurements/*.json`; a benchmark run with `--out docs/measurements` writes
such a file. Wanted: {wanted} figures. Of {measured} measurements of them {unmet} are **not met**; {missing} figures are
not measured. No.: the number in the list of wanted figures. ± is half the 95 % interval.

"""


@dataclass(frozen=True, slots=True)
class Line:
    """One row. record: None when nobody measured it."""

    standing: int
    figure: str
    measured: str
    wanted: str
    number: str
    record: Record | None

    def text(self) -> str:
        source = "" if self.record is None else f"[{self.record.name}]({FOLDER}/{self.record.name}.json)"
        return row((STANDINGS[self.standing], self.figure, self.measured, self.wanted, self.number, source))


def overview(records: Sequence[Record]) -> str:
    """The whole page; the same records give the same text."""
    lines = [*_wanted_lines(records), *_plain_lines(records)]
    lines.sort(key=lambda line: line.standing)
    counted = [sum(line.standing == standing for line in lines) for standing in range(len(STANDINGS))]
    head = HEAD.format(wanted=len(WANTED), unmet=counted[0], missing=counted[1], measured=_measured(records))
    table = [row(("", "figure", "measured", "wanted", "No.", "record")), rule(6), *(line.text() for line in lines)]
    return head + "\n".join(table) + "\n\n" + _runs(records)


def _measured(records: Sequence[Record]) -> int:
    return sum(figure.wanted is not None for record in records for figure in record.figures)


def _wanted_lines(records: Sequence[Record]) -> list[Line]:
    found: dict[str, list[tuple[Record, Figure]]] = {want.key: [] for want in WANTED}
    for record in records:
        for figure in record.figures:
            if figure.wanted is not None:
                found[figure.wanted.key].append((record, figure))
    lines = []
    for want in WANTED:
        number, words = str(want.number), _bound(want)
        if not found[want.key]:
            tested = f"[a test]({UP}{want.test.partition('::')[0]}) asserts it" if want.test else ""
            lines.append(Line(2 if want.test else 1, want.what, tested, words, number, None))
        for record, figure in found[want.key]:
            lines.append(Line(2 if figure.met else 0, figure.name, measured(figure), words, number, record))
    return lines


def _plain_lines(records: Sequence[Record]) -> list[Line]:
    return [
        Line(3, f"{record.title}: {figure.name}", measured(figure), "", "", record)
        for record in records
        for figure in record.figures
        if figure.wanted is None
    ]


def _runs(records: Sequence[Record]) -> str:
    lines = [
        "## How they were taken",
        "",
        row(("record", "command", "commit", "date, UTC", "machine", "load", "remark")),
    ]
    lines.append(rule(7))
    for record in records:
        load = "not noted"
        if record.load is not None:
            least, most = number(record.load.least), number(record.load.most)
            load = least if least == most else f"{least} to {most}"
        title = record.title if record.page is None else f"[{record.title}]({record.page})"
        date = record.date.replace("T", " ").removesuffix("Z")
        command = "not noted" if record.command is None else f"`{record.command}`"
        origin = (record.commit or "not noted", date, record.machine or "not noted", load, record.remark)
        lines.append(row((f"`{record.name}`: {title}", command, *origin)))
    return "\n".join(lines) + "\n"


def _bound(want: Wanted) -> str:
    unit = f" {want.unit}" if want.unit else ""
    if want.at_least is not None and want.at_most is not None:
        return f"{number(want.at_least)} to {number(want.at_most)}{unit}"
    if want.at_least is not None:
        return f"at least {number(want.at_least)}{unit}"
    assert want.at_most is not None, f"{want.key} limits nothing"
    return f"at most {number(want.at_most)}{unit}" if want.at_most or unit else "0"


def measured(figure: Figure) -> str:
    interval = "" if figure.ci95 is None else f" ± {number(figure.ci95)}"
    unit = f" {figure.unit}" if figure.unit else ""
    return f"{number(figure.value)}{interval}{unit}" + (f" ({figure.note})" if figure.note else "")
