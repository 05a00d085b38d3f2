"""Which planner flew a mission: a fingerprint of the sources that decide it."""

from __future__ import annotations

from functools import cache

from planner.sources import digest

DECIDING = ("*.py", "belief/*", "kernels/**/*.py", "policy/*", "selection/*", "study/mission.py", "study/scenarios.py")


@cache
def fingerprint() -> str:
    """Twelve hex digits; changes with any file that may change a mission."""
    return digest(DECIDING)[:12]
