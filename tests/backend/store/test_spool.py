"""What the spool took is there after any crash; what it did not take leaves no trace."""

from __future__ import annotations

import os
import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from backend.store.spool import HEADER, Spool, SpoolForeign, SpoolFull, SpoolTaken

RESERVE = 64 * 1024


def test_entries_survive_a_restart_in_order(tmp_path):
    spool = Spool(tmp_path / "s", RESERVE)
    for payload in (b"one", b"two" * 100, b"three"):
        spool.append(payload)
    spool.close()
    assert Spool(tmp_path / "s", RESERVE).entries() == [b"one", b"two" * 100, b"three"]


def test_cleared_entries_never_come_back(tmp_path):
    spool = Spool(tmp_path / "s", RESERVE)
    for n in range(20):
        spool.append(b"x" * 50 + str(n).encode())
    spool.clear()
    spool.append(b"x" * 50 + b"0")
    spool.close()
    assert Spool(tmp_path / "s", RESERVE).entries() == [b"x" * 50 + b"0"]


@given(cut=st.integers(0, 300), garbage=st.binary(max_size=40))
def test_a_torn_write_costs_only_itself(tmp_path_factory, cut, garbage):
    path = tmp_path_factory.mktemp("spool") / "s"
    spool = Spool(path, 4096)
    payloads = [bytes([65 + n]) * 60 for n in range(4)]
    for payload in payloads:
        spool.append(payload)
    spool.close()
    at = HEADER.size + cut
    with path.open("r+b") as file:
        file.seek(at)
        file.write(garbage + bytes(4096 - at - len(garbage)))
    kept = Spool(path, 4096).entries()
    whole = cut // 68
    assert kept[:whole] == payloads[:whole]
    assert kept == payloads[: len(kept)]


def test_the_reserve_is_real_blocks(tmp_path):
    Spool(tmp_path / "s", RESERVE).close()
    assert os.stat(tmp_path / "s").st_blocks * 512 >= RESERVE


def test_a_full_disk_takes_what_the_reserve_holds_and_then_says_so(tmp_path, monkeypatch):
    spool = Spool(tmp_path / "s", RESERVE)
    write = os.pwrite

    def full_disk(fd: int, data: bytes, offset: int) -> int:
        if offset >= RESERVE:
            raise OSError(28, "No space left on device")
        return write(fd, data[: RESERVE - offset], offset)

    monkeypatch.setattr(os, "pwrite", full_disk)
    taken = (RESERVE - HEADER.size) // 1008
    for _ in range(taken):
        spool.append(b"y" * 1000)
    with pytest.raises(SpoolFull, match="No space left"):
        spool.append(b"y" * 1000)
    spool.close()
    assert len(Spool(tmp_path / "s", RESERVE).entries()) == taken


def test_a_foreign_file_is_not_overwritten(tmp_path):
    (tmp_path / "s").write_bytes(b"my thesis" * 100)
    with pytest.raises(SpoolForeign, match="not a journal spool"):
        Spool(tmp_path / "s", RESERVE)
    assert (tmp_path / "s").read_bytes().startswith(b"my thesis")


def test_one_process_owns_it_and_the_next_waits_a_moment(tmp_path):
    first = Spool(tmp_path / "s", RESERVE)
    with pytest.raises(SpoolTaken):
        Spool(tmp_path / "s", RESERVE)
    threading.Timer(0.2, first.close).start()
    Spool(tmp_path / "s", RESERVE, patience_s=20.0).close()
