"""A file that is made from the code: written, or held against what the code says now."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path


def write_or_check(text: str, what: str) -> None:
    """What the command line asks for: FILE gets `text`; with --check nothing is written, and the exit status is 1 when
    FILE holds anything else. what: for the help, "the wire schema"."""
    parser = argparse.ArgumentParser(description=f"Write {what}, or check that a file is up to date.")
    parser.add_argument("file", type=Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    if not arguments.check:
        arguments.file.write_text(text)
    elif not arguments.file.exists() or arguments.file.read_text() != text:
        sys.exit(f"{arguments.file} is not what the code says: run `make codegen` and commit the result")
