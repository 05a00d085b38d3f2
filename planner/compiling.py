"""How the kernels are compiled: numba's flags, and a cache that sees every change."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar, cast

from planner.numba_loading import numba
from planner.sources import digest

Function = TypeVar("Function", bound=Callable[..., Any])


class Compiler(Protocol):
    """A decorator: what it returns is called as the function that it is given."""

    def __call__(self, function: Function, /) -> Function:
        """Compiles at the first call, not here."""
        ...


_FLAGS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
_FASTMATH = {"reassoc", "contract", "arcp", "nsz"}
# numba's types leave out _nrt and forceinline.

entry = cast(Compiler, numba.njit(fastmath=_FASTMATH, cache=True, **_FLAGS))
"""For what Python calls; nothing else is kept on disk, since the machine code of all it calls is part of its own."""
allocating = cast(Compiler, numba.njit(fastmath=_FASTMATH, **_FLAGS))
"""For what makes arrays."""
jit = cast(Compiler, numba.njit(fastmath=_FASTMATH, _nrt=False, **_FLAGS))  # pyright: ignore[reportCallIssue]
"""Counts no references to arrays: numba's atomic counters took a sixth of the time, and threads fought for them."""
inlined = cast(Compiler, numba.njit(fastmath=_FASTMATH, _nrt=False, forceinline=True, **_FLAGS))  # pyright: ignore[reportCallIssue]
"""For functions that take `rules` or `work`: these are passed by value, some hundred words a call."""

in_order = cast(Compiler, numba.njit(fastmath=False, _nrt=False, **_FLAGS))  # pyright: ignore[reportCallIssue]
"""As `jit`, in the order that is written: numbers of 32 bits that are the same on every processor. What is left out is
taken from whoever calls."""

exact = cast(Compiler, numba.njit(fastmath=False, nogil=True))
"""In the order that is written: geometry that a rounding could turn round."""
exact_entry = cast(Compiler, numba.njit(cache=True, nogil=True))
"""As `exact`, for what Python calls."""

COMPILED_IN = (
    "kernels/**/*.py",
    "belief/compiled_cell.py",
    "belief/compiled_evidence.py",
    "belief/compiled_on_the_way.py",
    "belief/compiled_rows.py",
    "belief/compiled_tables.py",
    "belief/compiled_way_tables.py",
    "belief/estimate.py",
    "belief/grid.py",
    "compiling.py",
    "observation.py",
    "on_the_way.py",
)
"""Code or constants of these files are in the machine code."""
SOURCES = int(digest(COMPILED_IN)[:15], 16)
"""For entry points to close over: numba's cache looks at their own file only, and at the values they close over."""
