"""The collector waits while a module is imported, and works as usual afterwards."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from pathlib import Path

import pytest

from planner.loading import PATIENT, load

USUAL = (700, 10, 10)


@pytest.fixture(autouse=True)
def collector() -> Iterator[None]:
    before = gc.get_threshold()
    gc.set_threshold(*USUAL)
    yield
    gc.set_threshold(*before)
    gc.unfreeze()


def test_the_collector_waits_while_a_module_is_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "module_that_looks.py").write_text("import gc\nseen = gc.get_threshold()\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert load("module_that_looks").seen == (PATIENT, 10, 10)
    assert gc.get_threshold() == USUAL
    assert gc.get_freeze_count() > 0


def test_it_works_as_before_when_the_import_fails() -> None:
    with pytest.raises(ModuleNotFoundError):
        load("no_such_module")
    assert gc.get_threshold() == USUAL
