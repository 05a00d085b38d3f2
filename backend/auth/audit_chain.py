"""The chain of the audit log: each entry holds the digest of the one before. Pure.

An entry that was changed, put in, taken out or moved breaks the chain from there on. What the chain alone cannot show
is that the end was cut off, or all of it written again: note a number with its digest elsewhere now and then, and give
it to `verify`.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast

BEGINNING = "0" * 64
Fault = Literal["unreadable", "changed", "out_of_order", "torn", "noted_missing"]


@dataclass(frozen=True, slots=True)
class Head:
    """The last entry: its number, counted from 1, and its digest."""

    number: int = 0
    digest: str = BEGINNING


@dataclass(frozen=True, slots=True)
class Verdict:
    """fault None: the chain is whole up to `head`. line: where it is broken, counted from 1."""

    head: Head
    fault: Fault | None = None
    line: int | None = None


def digest_of(entry: Mapping[str, Any]) -> str:
    """Of everything in an entry but its own digest."""
    kept = {key: value for key, value in entry.items() if key != "digest"}
    return hashlib.sha256(json.dumps(kept, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def linked(head: Head, content: Mapping[str, Any]) -> tuple[bytes, Head]:
    """The next line of the log, and the head after it."""
    entry = {"number": head.number + 1, "before": head.digest, **content}
    entry["digest"] = digest_of(entry)
    return json.dumps(entry, separators=(",", ":")).encode() + b"\n", Head(head.number + 1, entry["digest"])


def read(line: bytes) -> dict[str, Any] | None:
    """None: this is no entry."""
    try:
        entry = json.loads(line)
    except (ValueError, RecursionError):
        return None
    if not isinstance(entry, dict):
        return None
    fields = cast("dict[str, Any]", entry)
    whole = isinstance(fields.get("number"), int) and isinstance(fields.get("digest"), str)
    return fields if whole else None


def verify(lines: Iterable[bytes], noted: Head | None = None) -> Verdict:
    """noted: an entry that was written down elsewhere, which must still be there."""
    head, seen = Head(), noted is None or noted == Head()
    for number, line in enumerate(lines, 1):
        if not line.endswith(b"\n"):
            return Verdict(head, "torn", number)
        entry = read(line)
        if entry is None:
            return Verdict(head, "unreadable", number)
        if digest_of(entry) != entry["digest"]:
            return Verdict(head, "changed", number)
        if (entry["number"], entry.get("before")) != (head.number + 1, head.digest):
            return Verdict(head, "out_of_order", number)
        head = Head(entry["number"], entry["digest"])
        seen = seen or head == noted
    return Verdict(head) if seen else Verdict(head, "noted_missing")
