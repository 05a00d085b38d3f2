"""Every decision has a date and a status, and the table lists them all."""

from __future__ import annotations

import re
from datetime import date
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent.parent / "docs" / "decisions"
PAGES = sorted(FOLDER.glob("[0-9]*.md"))
HEAD = re.compile(
    r"# (?P<number>\d+)\. (?P<title>.+)\n\n"
    r"Date: (?P<made>\d{4}-\d\d-\d\d)(?:, revised (?P<revised>\d{4}-\d\d-\d\d))?\. "
    r"Status: (?P<status>accepted|superseded by \[ADR \d+\]\((?P<successor>\S+\.md)\))\.\n\n"
)


def head(page: Path) -> re.Match[str]:
    found = HEAD.match(page.read_text())
    assert found is not None, f"{page.name} does not begin with number, title, date and status; see decisions/README.md"
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name[:4])
def test_a_decision_has_number_date_and_status(page: Path):
    found = head(page)
    assert int(found["number"]) == int(page.name[:4])
    made, last = (date.fromisoformat(day) for day in (found["made"], found["revised"] or found["made"]))
    assert made <= last
    assert found["successor"] is None or (FOLDER / found["successor"]).exists()


def test_numbers_follow_one_another():
    assert [int(head(page)["number"]) for page in PAGES] == list(range(1, len(PAGES) + 1))


def test_the_table_lists_every_decision():
    rows = []
    for page, found in zip(PAGES, map(head, PAGES), strict=True):
        day = found["revised"] or found["made"]
        rows.append(f"| {found['number']} | [{found['title']}]({page.name}) | {day} | {found['status']} |")
    assert [line for line in (FOLDER / "README.md").read_text().splitlines() if re.match(r"\| \d", line)] == rows
