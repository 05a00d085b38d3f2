"""Linear algebra uses one thread, whichever part of the program is loaded first; work is shared out to some."""

import os
import subprocess
import sys
import threading

import pytest

from planner.threads import in_parts

LOOK = """
import importlib, os, sys
class Look:
    @staticmethod
    def find_spec(name, *rest):
        if name == "numpy":
            raise SystemExit(os.environ.get("OPENBLAS_NUM_THREADS", "not set"))
sys.meta_path.insert(0, Look)
importlib.import_module(sys.argv[1])
"""


@pytest.mark.parametrize(
    "first",
    [
        "backend.cli.localize",
        "hardware.direction_finding.estimate",
        "planner.belief.grid",
        "tests.benchmarks.field_world",
        "tests.benchmarks.sensor_world",
    ],
)
def test_the_number_of_threads_is_set_before_numpy_is_loaded(first: str) -> None:
    clean = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    for given, wanted in ((clean, "1"), (clean | {"OPENBLAS_NUM_THREADS": "3"}, "3")):
        run = subprocess.run([sys.executable, "-c", LOOK, first], env=given, capture_output=True, text=True)
        assert run.stderr.strip() == wanted


@pytest.mark.parametrize("count", [0, 1, 7, 1000])
@pytest.mark.parametrize("parts", [0, 1, 2, 3])
def test_each_of_the_parts_is_worked_on_once(count: int, parts: int) -> None:
    worked = [0] * count

    def work(part: slice) -> None:
        worked[part] = [times + 1 for times in worked[part]]

    in_parts(count, parts, work)
    assert worked == [1] * count


@pytest.mark.parametrize("failing", [0, 5])
def test_what_a_part_raises_is_raised_once_all_have_ended(failing: int) -> None:
    other_began, failed = threading.Event(), threading.Event()
    ended: list[int] = []

    def work(part: slice) -> None:
        if part.start == failing:
            assert other_began.wait(10.0)
            failed.set()
            raise ArithmeticError(str(failing))
        other_began.set()
        assert failed.wait(10.0)
        ended.append(part.start)

    with pytest.raises(ArithmeticError, match=str(failing)):
        in_parts(10, 2, work)
    assert ended == [5 - failing]
