"""The audit log: a chain that shows every change, and a writer that never waits and loses nothing silently."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from backend.auth import audit
from backend.auth.audit import AuditLog
from backend.auth.audit_chain import Head, digest_of, linked, verify


def chain(length: int) -> list[bytes]:
    head, lines = Head(), list[bytes]()
    for number in range(length):
        line, head = linked(head, {"call": f"call {number}", "who": "Ada \u00e9"})
        lines.append(line)
    return lines


def test_a_whole_chain_is_whole() -> None:
    assert verify([]).head == Head()
    verdict = verify(chain(5))
    assert (verdict.fault, verdict.head.number) == (None, 5)


def changed(line: bytes, **more: object) -> bytes:
    entry = json.loads(line) | more
    entry["digest"] = digest_of(entry)
    return json.dumps(entry).encode() + b"\n"


LINES = chain(5)
BROKEN = {
    "a letter": ([*LINES[:2], LINES[2].replace(b"call 2", b"call 9"), *LINES[3:]], "changed", 3),
    "an entry with its digest": ([*LINES[:2], changed(LINES[2], who="Eve"), *LINES[3:]], "out_of_order", 4),
    "one taken out": ([*LINES[:2], *LINES[3:]], "out_of_order", 3),
    "one put in twice": ([*LINES[:3], LINES[2], *LINES[3:]], "out_of_order", 4),
    "two exchanged": ([LINES[1], LINES[0], *LINES[2:]], "out_of_order", 1),
    "the beginning cut off": (LINES[1:], "out_of_order", 1),
    "no entry": ([*LINES[:3], b"[]\n", *LINES[3:]], "unreadable", 4),
    "torn": ([*LINES[:4], LINES[4][:20]], "torn", 5),
}


@pytest.mark.parametrize("what", BROKEN)
def test_whatever_was_changed_is_found_where_it_is(what: str) -> None:
    lines, fault, line = BROKEN[what]
    verdict = verify(lines)
    assert (verdict.fault, verdict.line) == (fault, line)


def test_an_end_that_was_cut_off_is_found_by_a_head_that_was_noted_elsewhere() -> None:
    noted = verify(LINES).head
    assert verify(LINES[:4]).fault is None, "the chain alone cannot show it"
    assert verify(LINES[:4], noted).fault == "noted_missing"
    assert verify(chain(7), noted).fault is None


async def test_the_chain_goes_on_after_a_restart_and_a_torn_line(tmp_path: Path) -> None:
    path = tmp_path / "audit.jsonl"
    for number in range(3):
        log = AuditLog(path, lambda: 1_700_000_000.0)
        log.note(call="start", number_of_start=number)
        log.note(call="more")
        await log.close()
        with path.open("ab") as file:
            file.write(b'{"number": 99, "torn')
    log = AuditLog(path, lambda: 1_700_000_000.0)
    log.note(call="last")
    await log.close()
    verdict = verify(path.read_bytes().splitlines(keepends=True))
    assert (verdict.fault, verdict.head.number) == (None, 7)
    assert path.stat().st_mode & 0o077 == 0, "nobody else reads it"


async def test_a_full_disk_loses_nothing_that_fits_and_counts_the_rest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, full = tmp_path / "audit.jsonl", [True]
    pwrite = audit.os.pwrite

    def failing(handle: int, text: bytes, at: int) -> int:
        if full[0]:
            pwrite(handle, text[:10], at)
            raise OSError(28, "No space left on device")
        return pwrite(handle, text, at)

    monkeypatch.setattr(audit.os, "pwrite", failing)
    monkeypatch.setattr(audit, "WAITING", 5)
    monkeypatch.setattr(audit, "RETRY_S", 0.01)
    log = AuditLog(path, lambda: 1_700_000_000.0)
    for number in range(8):
        log.note(call=f"call {number}")
    full[0] = False
    await log.flushed()
    await log.close()
    entries = [json.loads(line) for line in path.read_bytes().splitlines()]
    assert verify(path.read_bytes().splitlines(keepends=True)).fault is None
    assert [entry["call"] for entry in entries] == [*(f"call {n}" for n in range(5)), "audit"]
    assert entries[-1]["entries"] == 3
