"""What a piece of fuzzing found, kept as a row of its record as soon as the piece has ended, well or badly.

CROSSFIX_FUZZ_OUT names the folder; CROSSFIX_FUZZ_SEED the seed of the first piece, each further one has the next;
CROSSFIX_FUZZ_ADD=1 adds to the record that is there, which takes no seed twice.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.figures.circumstances import Begun
from tests.benchmarks.figures.pieces import SEED as SEED_COLUMN
from tests.benchmarks.figures.pieces import count, numbers, rows_kept
from tests.benchmarks.figures.record import Column, Table
from tests.benchmarks.figures.writer import plain, wanted, write

SEED = int(os.environ.get("CROSSFIX_FUZZ_SEED", "1"))
OUT = Path(given) if (given := os.environ.get("CROSSFIX_FUZZ_OUT")) else None
ADD = bool(os.environ.get("CROSSFIX_FUZZ_ADD"))
PAGE = "faults-in-flight.md#fuzzing"


@dataclass(frozen=True, slots=True)
class Fuzzing:
    """One record. sent: what its pieces count, "requests" or "messages"; key: of the wanted figure for that. of: what
    is fuzzed, as the figures name it. sums, most: what else is counted, added up or the largest of all pieces, with
    its unit."""

    name: str
    title: str
    key: str
    sent: str
    of: str
    sums: tuple[str, ...] = ()
    most: Mapping[str, str] | None = None

    def begin_anew(self) -> None:
        """What was recorded before makes room, unless pieces are added to it."""
        if OUT is not None and not ADD:
            (OUT / f"{self.name}.json").unlink(missing_ok=True)

    def keep(self, begun: Begun, seed: int, sent: int, failures: int, more: Mapping[str, float]) -> None:
        """more: by the names of `sums` and `most`."""
        if OUT is None:
            return
        OUT.mkdir(parents=True, exist_ok=True)
        folder = os.open(OUT, os.O_RDONLY)
        try:
            fcntl.flock(folder, fcntl.LOCK_EX)  # pieces may run beside one another
            self._add(OUT, begun, (f"{begun.date}, load {begun.load:.1f}", begun.commit, seed, sent, failures), more)
        finally:
            os.close(folder)

    def _add(
        self, out: Path, begun: Begun, piece: tuple[str, str | None, int, int, int], more: Mapping[str, float]
    ) -> None:
        most = self.most or {}
        names = ("run", "commit", SEED_COLUMN, self.sent, "failures", *self.sums, *most)
        own = Table(
            name="pieces",
            columns=tuple(Column(name=name) for name in names),
            rows=((*piece, *(more[name] for name in (*self.sums, *most))),),
        )
        table = rows_kept(out, self.name, own)
        pieces = len(table.rows)
        figures = [
            wanted(self.key, count(table, self.sent), of=self.of, note=f"pieces: {pieces}, each with its own seed"),
            wanted("fuzz_failures", count(table, "failures"), of=self.of),
            *(plain(name, count(table, name), "") for name in self.sums),
            *(plain(name, max(numbers(table, name)), unit) for name, unit in most.items()),
        ]
        remark = "commit, date and load: of the last piece; each has its own in the table"
        write(out, self.name, self.title, begun, figures, tables=[table], page=PAGE, remark=remark)
