"""What viser's page sends to its server, and what it gets."""

from __future__ import annotations

import msgspec
import zstandard
from viser import _messages


def camera_message() -> bytes:
    """What the page sends first."""
    message = _messages.ViewerCameraMessage(
        wxyz=(1, 0, 0, 0),
        position=(0, 0, 0),
        fov=1.0,
        near=0.1,
        far=10.0,
        image_height=10,
        image_width=10,
        look_at=(1, 0, 0),
        up_direction=(0, 0, 1),
    )
    return msgspec.msgpack.encode(message.as_serializable_dict([]))


def unpacked(frame: str | bytes) -> bytes:
    """A frame is two lengths, then messages packed by zstd, then arrays."""
    assert isinstance(frame, bytes)
    length = int.from_bytes(frame[8:16], "little")
    return zstandard.decompress(frame[16 : 16 + length])
