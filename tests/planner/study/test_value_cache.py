"""Tables on disk: computed once, the same from memory, disk and afresh, and made again when a file is not whole."""

import threading
from dataclasses import replace

import numpy as np
import pytest

from planner.kernels.value.model import NODES, RATIOS, SCALES
from planner.policy import value_table
from planner.policy.value_table import ProgramTable, key_of, program_for
from planner.study import value_cache
from planner.study.scenarios import scenario

PROBLEM = scenario("2").problem


@pytest.fixture(autouse=True)
def empty(monkeypatch, tmp_path):
    monkeypatch.setenv("CROSSFIX_CACHE_DIR", str(tmp_path / "kept"))
    monkeypatch.setattr(value_table, "_kept", {})


class Maker:
    def __init__(self):
        self.made = []

    def __call__(self, key):
        self.made.append(key)
        after = np.random.default_rng(len(key.name)).uniform(1, 99, (SCALES, RATIOS, NODES**2))
        return ProgramTable(key, after.astype(np.float32).astype(np.float64))


def finished(worker: threading.Thread | None) -> None:
    assert worker is not None
    worker.join(60)


def forget():
    value_table._kept.clear()


def test_a_table_is_made_once_and_read_back_bit_for_bit():
    make = Maker()
    fresh = value_cache.ensure(PROBLEM, make)
    assert value_cache.ensure(PROBLEM, make) is fresh
    forget()
    again = value_cache.ensure(PROBLEM, make)
    assert (again.after == fresh.after).all()
    assert make.made == [key_of(PROBLEM)]
    assert program_for(PROBLEM) is again


def test_a_table_that_only_serves_is_not_what_was_asked_for():
    make, near = Maker(), replace(PROBLEM, sigma=1.1 * PROBLEM.sigma)
    value_cache.ensure(PROBLEM, make)
    assert value_cache.ensure(near, make).key == key_of(near)


@pytest.mark.parametrize("damage", [b"", b"not numbers", None])
def test_a_damaged_file_counts_as_missing(damage, tmp_path):
    make = Maker()
    value_cache.ensure(PROBLEM, make)
    (file,) = (tmp_path / "kept").iterdir()
    file.write_bytes(file.read_bytes()[:5000] if damage is None else damage)
    forget()
    value_cache.ensure(PROBLEM, make)
    assert len(make.made) == 2


def test_a_table_of_another_shape_counts_as_missing(tmp_path):
    make = Maker()
    value_cache.ensure(PROBLEM, make)
    (file,) = (tmp_path / "kept").iterdir()
    np.save(file, np.zeros((2, 2, 2), np.float32))
    assert value_cache.load(key_of(PROBLEM)) is None


def test_a_disk_that_cannot_be_written_to_costs_nothing_but_time(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("CROSSFIX_CACHE_DIR", str(tmp_path / "file" / "below"))
    make = Maker()
    assert value_cache.ensure(PROBLEM, make).key == key_of(PROBLEM)


def test_preparing_waits_for_nobody_and_ends_with_the_table_kept():
    make = Maker()
    finished(value_cache.prepare(PROBLEM, make))
    assert program_for(PROBLEM) is not None
    assert make.made == [key_of(PROBLEM)]
    assert value_cache.prepare(PROBLEM, make) is None


def test_a_table_on_the_disk_is_at_hand_as_soon_as_it_is_asked_for():
    kept = value_cache.ensure(PROBLEM, Maker())
    forget()
    assert value_cache.prepare(PROBLEM, Maker()) is None
    found = program_for(PROBLEM)
    assert found is not None
    assert (found.after == kept.after).all()


def test_of_many_drafts_only_the_first_and_the_last_are_computed():
    begun, go_on, make = threading.Event(), threading.Event(), Maker()

    def slow(key):
        begun.set()
        go_on.wait(60)
        return make(key)

    drafts = [replace(PROBLEM, threshold=threshold) for threshold in (4.0, 5.0, 6.0, 7.0)]
    worker = value_cache.prepare(drafts[0], slow)
    assert begun.wait(60)
    for draft in drafts[1:]:
        assert value_cache.prepare(draft, slow) is worker
    go_on.set()
    finished(worker)
    assert make.made == [key_of(drafts[0]), key_of(drafts[-1])]


def test_a_table_that_cannot_be_computed_does_not_stop_the_next():
    def broken(key):
        raise MemoryError

    make = Maker()
    finished(value_cache.prepare(PROBLEM, broken))
    finished(value_cache.prepare(PROBLEM, make))
    assert make.made == [key_of(PROBLEM)]
