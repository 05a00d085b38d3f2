from __future__ import annotations

from pathlib import Path

import pytest

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pieces import cells, count, figures_kept, numbers, rows_kept
from tests.benchmarks.figures.record import Cell, Column, Table
from tests.benchmarks.figures.writer import plain, wanted, write


def piece(*row: Cell, columns: tuple[str, ...] = ("seed", "sent")) -> Table:
    return Table(name="pieces", columns=tuple(Column(name=name) for name in columns), rows=(row,))


def kept(folder: Path, table: Table) -> None:
    write(folder, "fuzz_http", "Fuzzing", begin(__file__), [plain("a", 1, ""), plain("b", 2, "")], tables=[table])


def test_a_piece_stands_below_those_of_before_and_all_count(tmp_path: Path) -> None:
    for row in ((1, 2000), (2, 500)):
        table = rows_kept(tmp_path, "fuzz_http", piece(*row))
        kept(tmp_path, table)
    assert table.rows == ((1, 2000), (2, 500))
    assert count(table, "sent") == 2500


def test_the_same_seed_proves_nothing_twice(tmp_path: Path) -> None:
    kept(tmp_path, piece(1, 2000))
    with pytest.raises(ValueError, match="seed 1 already"):
        rows_kept(tmp_path, "fuzz_http", piece(1, 2000))


def test_rows_of_before_may_lack_a_column_but_none_of_theirs_is_lost(tmp_path: Path) -> None:
    kept(tmp_path, piece(2000, columns=("sent",)))
    table = rows_kept(tmp_path, "fuzz_http", piece(1, 10))
    assert table.rows == ((None, 2000), (1, 10))
    assert (cells(table, "seed"), numbers(table, "sent")) == ([1], [2000, 10])
    with pytest.raises(ValueError, match="columns that are not known any more: sent"):
        rows_kept(tmp_path, "fuzz_http", piece(3, columns=("seed",)))


def test_figures_of_other_conditions_stay(tmp_path: Path) -> None:
    kept(tmp_path, piece(1, 2000))
    made = figures_kept(tmp_path, "fuzz_http", [wanted("fuzz_requests", 7), plain("b", 3, "")])
    assert [(figure.name, figure.value) for figure in made] == [("odd HTTP requests made", 7), ("b", 3), ("a", 1)]


def test_without_a_record_a_piece_stands_alone(tmp_path: Path) -> None:
    alone, figures = piece(1, 2000), [plain("a", 1, "")]
    for out in (None, tmp_path):
        assert rows_kept(out, "fuzz_http", alone) == alone
        assert figures_kept(out, "fuzz_http", figures) == figures
