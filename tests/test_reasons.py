"""The reasons' examples cover what the words choose by, and catch words that are not whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import pytest

from planner.reason import Words, text_of
from tests.reasons import assert_codes_differ, assert_well_said, classes_of, example, examples


@dataclass(frozen=True, slots=True)
class Windy:
    english: ClassVar[Words] = Words(
        "Wind of {speed_m_s} from the {side?n=north|s=south}{gusts?true= in gusts|false=}.{because?none=|*=}", "Wait."
    )
    speed_m_s: float
    side: Literal["n", "s"]
    gusts: bool
    because: Sunny | None
    code: Literal["windy"] = "windy"


@dataclass(frozen=True, slots=True)
class Sunny:
    english: ClassVar[Words] = Words("Sunny over {places}.")
    places: tuple[str, ...]
    code: Literal["sunny"] = "sunny"


@dataclass(frozen=True, slots=True)
class Lower:
    english: ClassVar[Words] = Words("not a whole sentence.")
    code: Literal["sunny"] = "sunny"


def test_examples_try_every_value_that_words_choose_by() -> None:
    windy = examples(Windy)
    assert {(w.side, w.gusts, w.because is None) for w in windy} == {  # type: ignore[attr-defined]
        ("n", True, False),
        ("s", True, False),
        ("n", False, False),
        ("n", True, True),
    }
    assert text_of(example(Windy)) == "Wind of 12.5 m/s from the north in gusts."
    assert [text_of(s) for s in examples(Sunny)] == ["Sunny over Example.", "Sunny over Example, Example."]


@pytest.mark.parametrize("reason", [Windy, Sunny])
def test_whole_sentences_pass(reason: type) -> None:
    for one in examples(reason):
        assert_well_said(one)


def test_what_is_no_whole_sentence_is_caught() -> None:
    with pytest.raises(AssertionError, match="no whole sentence"):
        assert_well_said(example(Lower))


def test_a_code_stands_for_one_class() -> None:
    assert classes_of(Windy | Sunny) == (Windy, Sunny)
    assert_codes_differ([Windy | Sunny])
    with pytest.raises(AssertionError, match="sunny"):
        assert_codes_differ([Windy | Sunny, Lower])
