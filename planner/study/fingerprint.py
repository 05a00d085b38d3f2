"""Which planner flew a mission: a fingerprint of the sources that decide it."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

PLANNER = Path(__file__).resolve().parent.parent
DECIDING = ("*.py", "belief/*", "kernels/*", "policy/*", "selection/*", "study/mission.py", "study/scenarios.py")


@cache
def fingerprint() -> str:
    """Twelve hex digits; changes with any file that may change a mission."""
    digest = hashlib.sha256()
    for path in sorted(path for pattern in DECIDING for path in PLANNER.glob(pattern) if path.is_file()):
        digest.update(path.relative_to(PLANNER).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:12]
