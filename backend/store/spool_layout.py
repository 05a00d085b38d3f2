"""How the spool's file is laid out; imports nothing, so that the first second of a server can look into it."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

MAGIC = b"CFSPOOL1"
HEADER = struct.Struct("<8sQ")
"""Magic, generation."""
RECORD = struct.Struct("<II")
"""Length and CRC of a payload that follows."""


def crc_of(generation: int, payload: bytes) -> int:
    """Of a payload of that generation: one of an older generation does not pass."""
    return zlib.crc32(payload, zlib.crc32(generation.to_bytes(8, "little")))


def records(fd: int, generation: int) -> Iterator[bytes]:
    """Payloads, oldest first, until one that is torn or of another generation."""
    end = HEADER.size
    while len(head := os.pread(fd, RECORD.size, end)) == RECORD.size:
        length, crc = RECORD.unpack(head)
        payload = os.pread(fd, length, end + RECORD.size)
        if length == 0 or len(payload) < length or crc != crc_of(generation, payload):
            return
        yield payload
        end += RECORD.size + length


def waiting(path: Path) -> list[bytes]:
    """What waits for the database, oldest first; nothing where there is no such file."""
    try:
        fd = os.open(path, os.O_RDONLY)
    except FileNotFoundError:
        return []
    try:
        header = os.pread(fd, HEADER.size, 0)
        magic, generation = HEADER.unpack(header) if len(header) == HEADER.size else (b"", 0)
        return list(records(fd, generation)) if magic == MAGIC else []
    finally:
        os.close(fd)
