"""`python -m docs.drawing [--check]`: draw docs/images/architecture.svg, or say that it is out of date."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from docs.drawing.layout import lay_out
from docs.drawing.rooms import read_rooms
from docs.drawing.svg import draw

PICTURE = Path(__file__).parent.parent / "images" / "architecture.svg"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m docs.drawing", description="Draws who imports whom.")
    parser.add_argument("--check", action="store_true", help="change nothing; fail when the picture is out of date")
    check: bool = parser.parse_args().check
    house = read_rooms()
    drawn = draw(house, lay_out(house))
    if not check:
        PICTURE.write_text(drawn)
    elif not PICTURE.exists() or PICTURE.read_text() != drawn:
        print("docs/images/architecture.svg is out of date: run `make architecture`.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
