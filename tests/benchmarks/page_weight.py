"""What the page weighs: every file of the built page, gzipped one by one (`make build` first)."""

from __future__ import annotations

import argparse
import gzip
import re
from pathlib import Path

from tests.benchmarks.figures.circumstances import ROOT, begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

BUILT = ROOT / "frontend" / "dist"
LARGEST = 6


def weights(folder: Path = BUILT) -> dict[str, int]:
    """Bytes of each file after gzip, by its name, the largest first. Raises FileNotFoundError without a built page."""
    if not (folder / "index.html").exists():
        raise FileNotFoundError(f"there is no page in {folder}: make build")
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != ".built"]
    found = {path.name: len(gzip.compress(path.read_bytes())) for path in files}
    return dict(sorted(found.items(), key=lambda entry: -entry[1]))


def part(name: str) -> str:
    """What a built file is called before the build puts a hash of eight characters into its name."""
    return re.sub(r"-[\w-]{8}(?=\.\w+$)", "", name)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    found = weights()
    figures = [wanted("page_weight", round(sum(found.values()) / 1000, 1))]
    figures += [plain(part(name), round(size / 1000, 1), "kB") for name, size in list(found.items())[:LARGEST]]
    for figure in figures:
        print(figure.name, figure.value, figure.unit)
    page = "page-speed.md#what-the-page-weighs"
    write(arguments.out, "page_weight", "What the page weighs", begun, figures, page=page)


if __name__ == "__main__":
    main()
