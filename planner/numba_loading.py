"""numba without the libraries that it only looks for, and that no kernel here needs (docs/decisions/0015)."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from types import ModuleType
from typing import Any, cast

from planner.loading import load

BLAS = "scipy.linalg.cython_blas"
LOOKED_FOR = ("cffi", "coverage", "yaml")
"""What numba does without where they are not installed: C functions in kernels, kernels' lines in a report on coverage,
settings in a file of its own."""


@contextmanager
def _standing_in(modules: Mapping[str, ModuleType | None]) -> Generator[None]:
    """Who imports one of these finds the stand-in, None: nothing. One that was imported before stays as it is."""
    given = {name: module for name, module in modules.items() if name not in sys.modules}
    known = cast(dict[str, ModuleType | None], sys.modules)
    known.update(given)
    try:
        yield
    finally:
        for name in given:
            del known[name]


def _loaded() -> Any:
    with _standing_in(dict.fromkeys(LOOKED_FOR)):
        numba = load("numba")
        importlib.import_module("numba.core.typing.cffi_utils")
    if "numba.np.arraymath" not in sys.modules:
        with _standing_in({BLAS: ModuleType(BLAS)}):
            importlib.import_module("numba.np.arraymath")
    return numba


numba = _loaded()
"""Before its first call numba imports all of scipy.linalg, a quarter of a start, to see whether there is a BLAS: an
empty module answers for that moment. What does need BLAS imports it when it is compiled and when it is called."""
