"""MAVLink frames in a stream of bytes, and those messages in them that a takeover is judged by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pymavlink.dialects.v20 import development as mavlink

_V1, _V2 = 0xFE, 0xFD
_SIGNED = 0x01
_SIGNATURE_BYTES = 13


@dataclass(frozen=True, slots=True)
class Frame:
    """One MAVLink frame as it came. number: of its message."""

    raw: bytes
    number: int
    system: int

    def fields(self) -> dict[str, Any]:
        """The message's fields; empty when this dialect does not know the message or its checksum is wrong."""
        parser = mavlink.MAVLink(None)
        parser.robust_parsing = True
        messages = parser.parse_buffer(self.raw) or []
        if len(messages) != 1 or messages[0].get_type() == "BAD_DATA":
            return {}
        return messages[0].to_dict()


class Framer:
    """Cuts a stream, or datagrams of one, into frames; what is no MAVLink is left out."""

    def __init__(self) -> None:
        self._rest = b""

    def cut(self, data: bytes) -> list[Frame]:
        """The frames that are whole now; the beginning of the next one waits for more bytes."""
        stream, frames = self._rest + data, list[Frame]()
        while stream:
            if stream[0] not in (_V1, _V2):
                stream = stream[1:]
                continue
            length = _length(stream)
            if length is None or len(stream) < length:
                break
            frames.append(_frame(stream[:length]))
            stream = stream[length:]
        self._rest = stream
        return frames


def _length(stream: bytes) -> int | None:
    """Of the frame that begins here; None while its header is not whole."""
    if len(stream) < 3:
        return None
    if stream[0] == _V1:
        return stream[1] + 8
    return stream[1] + 12 + (_SIGNATURE_BYTES if stream[2] & _SIGNED else 0)


def _frame(raw: bytes) -> Frame:
    if raw[0] == _V1:
        return Frame(raw, raw[5], raw[3])
    return Frame(raw, int.from_bytes(raw[7:10], "little"), raw[5])
