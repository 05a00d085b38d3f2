"""What files of SigMF are called."""

from __future__ import annotations

from pathlib import Path

META, DATA, ARCHIVE = ".sigmf-meta", ".sigmf-data", ".sigmf"


def is_sigmf(path: Path | str) -> bool:
    """Whether the name is that of a SigMF file (meta, data or archive)."""
    return Path(path).suffix.lower() in (META, DATA, ARCHIVE)
