"""Importing what stays until the end, with the garbage collector at rest."""

from __future__ import annotations

import gc
import importlib
from types import ModuleType

PATIENT = 1_000_000
"""New objects before the collector looks, instead of its 700."""


def load(module: str) -> ModuleType:
    """Import it. Meanwhile the collector would look hundreds of times through objects that are all still needed, a
    seventh of the time; from here on it leaves out what is there by now."""
    usual = gc.get_threshold()
    gc.set_threshold(PATIENT, *usual[1:])
    try:
        return importlib.import_module(module)
    finally:
        gc.set_threshold(*usual)
        gc.freeze()
