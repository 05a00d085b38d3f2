"""Every reason of the product says whole English sentences, whatever its values; no two share a code."""

from __future__ import annotations

import pytest

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


def test_no_two_reasons_share_a_code() -> None:
    assert_codes_differ(reason_classes())


def test_the_page_has_the_words_of_every_reason() -> None:
    table = english_table()
    for reason in reason_classes():
        assert f"\n  {code_of(reason)}: {{\n" in table


def test_words_with_quotes_are_escaped_once() -> None:
    table = english_table()
    assert """'The receiver "{device}" """ in table
    assert """"The vehicle's headings are not numbers.\"""" in table
