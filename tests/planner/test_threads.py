"""Linear algebra uses one thread, whichever part of the program is loaded first."""

import os
import subprocess
import sys

import pytest

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
