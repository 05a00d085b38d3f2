"""Makes docs/measurements.md and the tables of the pages from docs/measurements/*.json (`make figures`).

python -m tests.benchmarks.figures             writes what has changed
python -m tests.benchmarks.figures --check     writes nothing; status 1 when something would change
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

from tests.benchmarks.figures.circumstances import ROOT
from tests.benchmarks.figures.overview import FOLDER, overview
from tests.benchmarks.figures.pages import with_tables
from tests.benchmarks.figures.reader import BrokenRecord, read_all


def made(docs: Path) -> dict[Path, str]:
    """Every page that holds figures, and what must stand in it. Raises BrokenRecord."""
    records = read_all(docs / FOLDER)
    for record in records:
        if record.page is not None and not leads_somewhere(docs, record.page):
            raise BrokenRecord(f"{record.name}.json: there is no {record.page} in docs")
    whole = docs / f"{FOLDER}.md"
    pages = {whole: overview(records)}
    for path in sorted(docs.rglob("*.md")):
        if path != whole:
            pages[path] = with_tables(str(path.relative_to(docs)), path.read_text(encoding="utf-8"), records)
    return pages


def leads_somewhere(docs: Path, link: str) -> bool:
    """Whether the page is there and, behind a "#", its heading as GitHub writes it in addresses."""
    name, _, anchor = link.partition("#")
    if not (docs / name).is_file():
        return False
    headings = re.findall(r"^#+ (.*)$", (docs / name).read_text(encoding="utf-8"), re.MULTILINE)
    return not anchor or anchor in [re.sub(r"[^\w -]", "", heading).lower().replace(" ", "-") for heading in headings]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="say which pages are not current; write nothing")
    parser.add_argument("--docs", type=Path, default=ROOT / "docs", help=argparse.SUPPRESS)
    given = parser.parse_args()
    try:
        pages = made(given.docs)
    except BrokenRecord as error:
        sys.exit(str(error))
    old = [path for path, text in pages.items() if not path.exists() or path.read_text(encoding="utf-8") != text]
    if given.check and old:
        names = ", ".join(str(path.relative_to(given.docs)) for path in old)
        sys.exit(f"not current: {names}. Run `make figures` and commit what it changes.")
    if not given.check:
        for path in old:
            path.write_text(pages[path], encoding="utf-8")


if __name__ == "__main__":
    main()
