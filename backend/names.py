"""Names that people give: what a list would show as nothing, or as something else than what it is, is refused."""

from __future__ import annotations

import unicodedata

NO_CHARACTERS = range(0xFDD0, 0xFDF0)
"""Nor are the last two code points of every plane (Unicode 23.7); XML cannot hold U+FFFE and U+FFFF."""
TURNS_WRITING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")

UNSEEN = frozenset("\u034f\u115f\u1160\u17b4\u17b5\u2800\u3164\uffa0").union(
    *(map(chr, span) for span in (range(0x180B, 0x1810), range(0xFE00, 0xFE10), range(0xE0000, 0xE1000)))
)
"""Nothing is drawn for them (Default_Ignorable_Code_Point), whatever category they have; and the empty Braille cell."""


def in_one_line(text: str) -> str:
    """Raises ValueError for control characters, those that turn the direction of writing, and what is no character."""
    if any(ord(letter) < 0x20 or letter in TURNS_WRITING or _is_none(ord(letter)) for letter in text):
        raise ValueError("write it in one line, without control characters")
    return text


def _is_none(code: int) -> bool:
    return code & 0xFFFE == 0xFFFE or code in NO_CHARACTERS


def seen(text: str) -> str:
    """In one line, and not empty to the eye. Raises ValueError."""
    if not any(letter.isprintable() and not letter.isspace() for letter in without_unseen(in_one_line(text))):
        raise ValueError("write at least one letter that can be seen")
    return text


def without_unseen(text: str) -> str:
    """What the eye has of it."""
    return "".join(letter for letter in text if letter not in UNSEEN and unicodedata.category(letter) != "Cf")
