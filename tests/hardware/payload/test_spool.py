"""The spool: numbered, in order, durable across reopening, forgetting only what was acknowledged."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.payload.spool import Spool, SpoolError
from hardware.readings import Channel, PowerSample, Pulses

CHANNELS = (Channel(433.92e6), Channel(150e6, Pulses(0.02, 1.3)))


def sample(k: int) -> PowerSample:
    return PowerSample(float(k), 868e6, -60.0 - k, -120.0 if k % 2 else None, k % 3 == 0, k % 4 > 0)


def test_reopening_keeps_everything_and_numbers_go_on(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "samples.sqlite")
    spool.append([sample(k) for k in range(5)])
    spool.channels = CHANNELS
    stream = spool.stream
    spool.close()
    again = Spool(tmp_path / "samples.sqlite")
    assert again.stream == stream
    assert again.channels == CHANNELS
    assert again.after(0, 10) == [(k + 1, sample(k)) for k in range(5)]
    again.forget(5)
    assert again.first_seq() == 6
    again.append([sample(9)])
    assert again.after(0, 10) == [(6, sample(9))]
    again.close()


def test_a_spool_of_an_older_agent_is_read_on(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "samples.sqlite") as older:
        older.execute(
            "CREATE TABLE sample (seq INTEGER PRIMARY KEY AUTOINCREMENT, at_s REAL NOT NULL,"
            " frequency_hz REAL NOT NULL, power_db REAL NOT NULL, noise_db REAL, clipped INTEGER NOT NULL)"
        )
        older.execute("INSERT INTO sample VALUES (7, 1.0, 868e6, -61.0, -120.0, 0)")
    spool = Spool(tmp_path / "samples.sqlite")
    spool.append([sample(4)])
    assert spool.after(0, 10) == [(7, PowerSample(1.0, 868e6, -61.0, -120.0)), (8, sample(4))]
    spool.close()


def test_a_full_spool_drops_the_oldest_and_counts_them(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "samples.sqlite", capacity=10)
    for k in range(0, 25, 5):
        spool.append([sample(j) for j in range(k, k + 5)])
    assert spool.waiting() == 10
    assert spool.first_seq() == 16
    assert spool.lost == 15


@settings(max_examples=20, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 12)), max_size=12))
def test_reading_after_any_number_gives_what_follows(
    tmp_path_factory: pytest.TempPathFactory, steps: list[tuple[int, int]]
) -> None:
    spool = Spool(tmp_path_factory.mktemp("spool") / "samples.sqlite")
    made = forgotten = 0
    for count, forget in steps:
        spool.append([sample(k) for k in range(count)])
        made += count
        forgotten = max(forgotten, min(forget, made))
        spool.forget(forgotten)
        assert [seq for seq, _ in spool.after(0, 1000)] == list(range(forgotten + 1, made + 1))
        assert spool.waiting() == made - forgotten
    spool.close()


def test_unusable_place_is_a_clear_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(SpoolError, match="cannot be used"):
        Spool(tmp_path / "file" / "samples.sqlite")
    (tmp_path / "foreign").write_bytes(b"not a database at all, but long enough to be looked at" * 20)
    with pytest.raises(SpoolError, match="cannot be used"):
        Spool(tmp_path / "foreign")
