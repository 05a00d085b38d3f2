"""Every reason of the product says whole English sentences, whatever its values; no two share a code."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType

import pytest

import backend.reasons
import hardware.reasons
import planner.reasons
from backend.reasons import ToldBefore
from backend.reasons.catalogue import code_of, english_table, reason_classes
from planner.reason import Reason
from tests.reasons import assert_codes_differ, assert_well_said, examples


@pytest.mark.parametrize("reason", reason_classes(), ids=code_of)
def test_says_whole_sentences(reason: type[Reason]) -> None:
    """But for sentences out of old journals, which stand as they were written."""
    for one in examples(reason):
        if ToldBefore.__name__ not in repr(one):
            assert_well_said(one)


@pytest.mark.parametrize("room", [planner.reasons, hardware.reasons, backend.reasons], ids=lambda room: room.__name__)
def test_every_class_that_a_room_declares_is_in_the_union(room: ModuleType) -> None:
    modules = [room, *(import_module(one.name) for one in iter_modules(room.__path__, f"{room.__name__}."))]
    declared = {one for module in modules for one in vars(module).values() if isinstance(one, type)}
    assert len(modules) > 1
    assert {one for one in declared if hasattr(one, "english")} - {Reason} <= set(reason_classes())


def test_no_two_reasons_share_a_code() -> None:
    assert_codes_differ(reason_classes())


def test_the_page_has_the_words_of_every_reason() -> None:
    table = english_table()
    for reason in reason_classes():
        assert f"\n  {code_of(reason)}: [" in table


def test_words_with_quotes_are_escaped_once() -> None:
    table = english_table()
    assert """'The receiver "{device}" """ in table
    assert """"The vehicle's headings are not numbers.\"""" in table
