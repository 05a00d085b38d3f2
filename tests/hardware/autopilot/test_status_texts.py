from __future__ import annotations

from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.autopilot.status_texts import GAP, MOST_WAITING, WAIT_S, StatusText, StatusTexts
from hardware.autopilot.words import MOST_CHARACTERS

LONG = "Preflight Fail: the compass needs calibration, and then some more words until it takes three chunks to say."
CHUNKS = [LONG[i : i + 50] for i in range(0, len(LONG), 50)]
assert len(CHUNKS) == 3


def said(texts: StatusTexts, chunks: dict[int, str], text_id: int = 7, at_s: float = 0.0) -> list[str]:
    return [text.text for seq, chunk in chunks.items() for text in texts.take(3, chunk, text_id, seq, at_s)]


def test_a_short_text_is_given_at_once_with_its_severity() -> None:
    given = [StatusTexts().take(severity, "x", 0, 0, 0.0)[0].severity for severity in range(8)]
    assert given == ["critical"] * 3 + ["error", "warning"] + ["information"] * 3
    assert StatusTexts().take(2, "Reposition is outside geofence\t", 0, 0, 0.0) == [
        StatusText("critical", "Reposition is outside geofence")
    ]


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_chunks_are_joined_in_any_order_and_twice_does_no_harm(order: tuple[int, ...]) -> None:
    texts = StatusTexts()
    assert said(texts, {seq: CHUNKS[seq] for seq in order}) == [LONG]
    assert said(texts, dict(enumerate(CHUNKS))) == []  # late and duplicated


@pytest.mark.parametrize(
    ("lost", "shown"),
    [(0, GAP + LONG[50:]), (1, LONG[:50] + GAP + LONG[100:]), (2, LONG[:100] + GAP)],
)
def test_a_chunk_that_does_not_come_is_a_gap(lost: int, shown: str) -> None:
    texts = StatusTexts()
    assert said(texts, {seq: chunk for seq, chunk in enumerate(CHUNKS) if seq != lost}) == []
    assert texts.overdue(WAIT_S / 2) == []
    assert [text.text for text in texts.overdue(WAIT_S * 1.1)] == [shown]
    assert said(texts, {lost: CHUNKS[lost]}, at_s=WAIT_S * 1.2) == []


def test_the_first_text_of_a_started_px4_is_joined_though_its_id_is_0() -> None:
    """As its own simulator said it."""
    texts = StatusTexts()
    first = {0: "Preflight Fail: No connection to the ground contro", 1: "l station\t"}
    assert said(texts, first, text_id=0) == ["Preflight Fail: No connection to the ground control station"]
    assert said(texts, {0: "Takeoff detected"}, text_id=0) == ["Takeoff detected"]
    assert said(texts, first, text_id=0) == ["Preflight Fail: No connection to the ground control station"]


def test_a_whole_text_of_id_0_that_fills_its_bytes_is_given_without_a_gap() -> None:
    texts = StatusTexts()
    assert said(texts, {0: "x" * 50}, text_id=0) == []
    assert [text.text for text in texts.overdue(WAIT_S * 1.1)] == ["x" * 50]
    assert said(texts, {0: "y" * 50}, text_id=0, at_s=2.0) == []
    assert said(texts, {0: "z"}, text_id=0, at_s=2.1) == ["y" * 50, "z"]


def test_a_text_that_fills_its_chunks_ends_with_an_empty_one() -> None:
    assert said(StatusTexts(), {0: "x" * 50, 1: ""}) == ["x" * 50]


def test_texts_that_come_at_once_are_not_mixed() -> None:
    texts = StatusTexts()
    assert said(texts, {0: CHUNKS[0]}, 1) + said(texts, {0: "y" * 50}, 2) == []
    assert said(texts, {1: "the end of y"}, 2) == ["y" * 50 + "the end of y"]
    assert said(texts, {1: CHUNKS[1], 2: CHUNKS[2]}, 1) == [LONG]


def test_an_id_that_is_used_again_later_is_another_text() -> None:
    texts = StatusTexts()
    assert said(texts, dict(enumerate(CHUNKS))) == [LONG]
    assert said(texts, dict(enumerate(CHUNKS)), at_s=60.0) == [LONG]


message = st.tuples(
    st.integers(0, 255), st.text(max_size=50), st.integers(0, 4), st.integers(0, 255), st.floats(-5.0, 30.0)
)


@given(st.lists(message, max_size=60))
def test_whatever_comes_is_bounded_and_can_be_shown(messages: list[tuple[int, str, int, int, float]]) -> None:
    texts = StatusTexts()
    for one in messages:
        for text in texts.take(*one):
            assert 0 < len(text.text) <= MOST_CHARACTERS
            text.text.encode()
    assert len(texts._coming) <= MOST_WAITING
