"""Words that came over the radio: whatever bytes they are, what is left can be shown, stored and logged."""

from __future__ import annotations

import unicodedata

MOST_CHARACTERS = 400
"""Nine chunks of 50 bytes and the tail: longer than any autopilot's sentence."""


def sanitized(text: str, most: int = MOST_CHARACTERS) -> str:
    """One line of printable characters, at most `most` of them. Ends at the first NUL, as the wire's strings do.

    Control and format characters (line ends, escape sequences, right-to-left overrides) become spaces; those that
    are no character at all become U+FFFD.
    """
    shown = "".join(_printable(character) for character in text.split("\0", 1)[0])
    line = " ".join(shown.split())
    return line if len(line) <= most else line[: most - 1] + "…"


def _printable(character: str) -> str:
    kind = unicodedata.category(character)
    if kind in ("Cs", "Co", "Cn"):
        return "\ufffd"
    return " " if kind[0] in "CZ" else character
