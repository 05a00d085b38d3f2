"""Frames are cut from streams and datagrams however the bytes come."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import development as mavlink

from tests.strikes.frames import Framer

HEARTBEAT = mavlink.MAVLink(None, 1, 1).heartbeat_encode(2, 12, 81, 50593792, 4)


def packed(v1: bool = False) -> bytes:
    return bytes(HEARTBEAT.pack(mavlink.MAVLink(None, 1, 1), force_mavlink1=v1))


@pytest.mark.parametrize("v1", [False, True])
@pytest.mark.parametrize("size", [1, 7, 1000])
def test_every_frame_comes_out_once_and_whole_however_the_stream_is_cut(v1: bool, size: int) -> None:
    stream, framer = b"noise" + 3 * packed(v1), Framer()

    frames = [frame for at in range(0, len(stream), size) for frame in framer.cut(stream[at : at + size])]

    assert [(frame.number, frame.system) for frame in frames] == 3 * [(0, 1)]
    assert {frame.raw for frame in frames} == {packed(v1)}
    assert frames[0].fields()["custom_mode"] == 50593792


def test_a_broken_frame_has_no_fields() -> None:
    raw = bytearray(packed())
    raw[-1] ^= 0xFF

    (frame,) = Framer().cut(bytes(raw))

    assert frame.fields() == {}
