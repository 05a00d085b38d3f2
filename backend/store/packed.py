"""Long JSON texts as the database keeps them: compressed.

A fact about a decision names a hundred candidates, one about a bearing 360 powers: most of what a season takes on the
disk. The words that such facts have in common lie in a dictionary beside this file. What was stored as plain text, or
packed without the dictionary, stays so and is read as before.
"""

from __future__ import annotations

import base64
import zlib
from pathlib import Path
from typing import Any

from sqlalchemy import Dialect, Text, TypeDecorator

LONG = 768
"""Characters from which a text is packed. Shorter ones can be read by whoever looks into the file, and the first look
at a start in flight (first_hold) reads such kinds only."""
LEVEL, MEMORY = 6, 9
DICTIONARY = Path(__file__).with_name("facts.dictionary").read_bytes()
"""Facts without their numbers, what is commonest last (zlib's deflateSetDictionary). What is packed cannot be read
without it, so it never changes: a better one would be a second file, told apart by the checksum in each text (RFC 1950,
DICTID)."""
MARK = "zlib:"
"""No JSON begins like this."""
MOST_BYTES = 64 * 2**20
"""Of one text; the longest honest one is a mission's draft with all its areas, of some hundred kilobytes."""


def packed(text: str, as_bytes: bool) -> str | bytes:
    """A long one as zlib of its UTF-8; as_bytes False: in base64 behind MARK."""
    if len(text) < LONG:
        return text
    packing = zlib.compressobj(LEVEL, zlib.DEFLATED, zlib.MAX_WBITS, MEMORY, zdict=DICTIONARY)
    small = packing.compress(text.encode()) + packing.flush()
    return small if as_bytes else MARK + base64.b64encode(small).decode()


def unpacked(value: str | bytes) -> str:
    """What `packed` was given. Raises ValueError for what it never made, and for more than MOST_BYTES."""
    if isinstance(value, str) and not value.startswith(MARK):
        return value
    small = value if isinstance(value, bytes) else base64.b64decode(value.removeprefix(MARK))
    unpacking = zlib.decompressobj(zdict=DICTIONARY)
    try:
        whole = unpacking.decompress(small, MOST_BYTES)
    except zlib.error as error:
        raise ValueError(f"a stored text cannot be unpacked: {error}") from error
    if not unpacking.eof:
        raise ValueError(f"a stored text is cut off, or longer than {MOST_BYTES} bytes")
    return whole.decode()


class PackedText(TypeDecorator[str]):
    """A text column; every reader and writer of it has the whole text, byte for byte."""

    impl = Text
    cache_ok = True

    def process_bind_param(self, value: str | None, dialect: Dialect) -> Any:
        """SQLite's columns take bytes whatever their type; PostgreSQL's text takes text."""
        return None if value is None else packed(value, as_bytes=dialect.name == "sqlite")

    def process_result_value(self, value: Any | None, dialect: Dialect) -> str | None:
        """Of a row of today or of before."""
        return None if value is None else unpacked(value)
