"""What the planner's own source files say, as one number: what is stored about them is stale when they change."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

PLANNER = Path(__file__).resolve().parent


def digest(patterns: Sequence[str], root: Path = PLANNER) -> str:
    """Hex digits that change with the name or the content of any file that matches one of the glob patterns."""
    answer = hashlib.sha256()
    for path in sorted({path for pattern in patterns for path in root.glob(pattern) if path.is_file()}):
        answer.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return answer.hexdigest()
