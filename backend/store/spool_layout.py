"""How the spool's file is laid out; imports nothing, so that the first second of a server can look into it."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress
from pathlib import Path

MAGIC = b"CFSPOOL1"
HEADER = struct.Struct("<8sQ")
"""Magic, generation."""
RECORD = struct.Struct("<II")
"""Length and CRC of a payload that follows."""


def crc_of(generation: int, payload: bytes) -> int:
    """Of a payload of that generation: one of an older generation does not pass."""
    return zlib.crc32(payload, zlib.crc32(generation.to_bytes(8, "little")))


def holds_entries(path: Path) -> bool:
    """Something in it waits for the database. False where there is no such file."""
    with suppress(OSError, struct.error), path.open("rb") as spool:
        _, generation = HEADER.unpack(spool.read(HEADER.size))
        length, crc = RECORD.unpack(spool.read(RECORD.size))
        return length > 0 and crc == crc_of(generation, spool.read(length))
    return False
