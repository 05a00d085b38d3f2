"""Tables of records inside pages, and `--check`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.benchmarks.figures.circumstances import ROOT, begin
from tests.benchmarks.figures.pages import markdown, shown, with_tables
from tests.benchmarks.figures.reader import BrokenRecord
from tests.benchmarks.figures.record import Column, Table
from tests.benchmarks.figures.writer import plain, wanted, write

TABLE = Table(
    name="cells",
    columns=(Column(name="planner"), Column(name="mean, s", decimals=2), Column(name="runs")),
    rows=(("base", (53.5, 0.1), 5000), ("entpp", 44.0, None)),
)
PAGE = "# Study\n\n<!-- figures: study/cells -->\nold\n<!-- end of figures -->\n\nafter\n"
SHOWN = "| planner | mean, s | runs |\n|---|---|---|\n| base | 53.50 ± 0.10 | 5,000 |\n| entpp | 44.00 |  |"


def folder(docs: Path, page: str | None = "study.md#study") -> Path:
    """docs with one page and one record."""
    docs.mkdir(exist_ok=True)
    (docs / "study.md").write_text(PAGE)
    write(docs / "measurements", "study", "Study", begin(__file__), [wanted("study", 11.2)], tables=[TABLE], page=page)
    return docs


def figures(docs: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tests.benchmarks.figures", "--docs", str(docs), *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_a_table_is_shown_with_its_decimals_and_intervals() -> None:
    assert markdown(TABLE) == SHOWN


def test_what_rounds_to_nothing_has_no_sign() -> None:
    assert shown(-0.001, 2) == "0.00"
    assert shown(-0.006, 2) == "-0.01"


def test_a_table_nobody_has_is_an_error_that_names_the_page() -> None:
    with pytest.raises(BrokenRecord, match=r"study\.md: no record has the table study/cells"):
        with_tables("study.md", PAGE, [])


def test_pages_are_made_and_then_they_are_current(tmp_path: Path) -> None:
    docs = folder(tmp_path / "docs")
    before = figures(docs, "--check")
    assert before.returncode == 1
    assert "not current: measurements.md, study.md. Run `make figures`" in before.stderr
    assert (docs / "study.md").read_text() == PAGE, "--check writes nothing"
    assert figures(docs).returncode == 0
    assert (docs / "study.md").read_text() == PAGE.replace("old", SHOWN)
    assert "[study](measurements/study.json)" in (docs / "measurements.md").read_text()
    assert figures(docs, "--check").returncode == 0


def test_a_new_figure_makes_the_page_old(tmp_path: Path) -> None:
    docs = folder(tmp_path / "docs")
    figures(docs)
    write(docs / "measurements", "other", "Other", begin(__file__), [plain("a", 1, "s")])
    after = figures(docs, "--check")
    assert after.returncode == 1
    assert "not current: measurements.md." in after.stderr


def test_a_broken_record_or_a_missing_page_ends_with_one_clear_error(tmp_path: Path) -> None:
    for page in ("elsewhere.md", "study.md#there"):
        docs = folder(tmp_path / "docs", page=page)
        missing = figures(docs)
        assert missing.returncode == 1
        assert missing.stderr == f"study.json: there is no {page} in docs\n"
    (docs / "measurements" / "study.json").write_text("{}")
    broken = figures(docs, "--check")
    assert broken.returncode == 1
    assert "study.json: command: Field required" in broken.stderr
    assert "Traceback" not in broken.stderr
