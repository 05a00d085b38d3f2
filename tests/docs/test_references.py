"""What the pages name is there: links to files, and paths of the repository in backticks."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

HOUSE = Path(__file__).parent.parent.parent
GUIDES = [HOUSE / "README.md", HOUSE / "CONTRIBUTING.md", *sorted((HOUSE / "docs").glob("*.md"))]
PAGES = [*GUIDES, HOUSE / "CHANGELOG.md", *sorted((HOUSE / "docs" / "decisions").glob("*.md"))]
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)(?:#[^)]*)?\)")
PATH = re.compile(r"`((?:planner|hardware|backend|frontend|tests|docs|migrations)/[\w./*-]*)(?:::\w+)?`")
NOT_KEPT = {"hardware/autopilot/yours.py", "frontend/node_modules/"}
"""An example of a name, and what `make` creates."""


def name_of(page: Path) -> str:
    return str(page.relative_to(HOUSE))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page: Path):
    assert [link for link in LINK.findall(page.read_text()) if not (page.parent / link).exists()] == []


@pytest.mark.parametrize("page", GUIDES, ids=name_of)
def test_paths_in_a_guide_exist(page: Path):
    """A decision may name what is gone; a guide may not."""
    named = set(PATH.findall(page.read_text())) - NOT_KEPT
    assert sorted(path for path in named if not any(HOUSE.glob(path.rstrip("/")))) == []
