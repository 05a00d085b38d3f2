"""The binary frame of one belief: 4-byte little-endian header length, JSON header, body.

Header: {"type": "belief", "mission_id", "emitter_id", "seq", "bearings", "nx", "ny", "bounds": [[lon, lat] x 4: SW, SE,
NE, NW], "encoding": "f32-shuffle-zlib" | "u8-log-zlib", "peak": float}. Body: ny rows of nx cells, south to north, west
to east, probability a cell divided by `peak`. f32-shuffle-zlib: float32 little-endian, bytes shuffled (all first bytes,
then all second ...), zlib level 1. u8-log-zlib: 0 = zero, else round(255 * (1 + log10(p) / 6)) clipped to 1..255.

`seq`: number of the BeliefUpdated event that told of it; 0: of no event (a prior, or a belief that is only supposed).
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Encoding = Literal["f32-shuffle-zlib", "u8-log-zlib"]

DECADES = 6.0
"""What the 8-bit logarithm spans below the peak."""


def encode_belief(
    mission_id: str,
    emitter_id: str,
    seq: int,
    bearings: int,
    density: NDArray[np.float64],
    corners_lon_lat: Sequence[tuple[float, float]],
    *,
    lite: bool,
) -> bytes:
    """density: (ny, nx) mass a cell, row 0 southernmost. ValueError when it is no density."""
    peak = float(density.max(initial=0.0))
    if not (np.isfinite(density).all() and peak > 0 and density.min() >= 0):
        raise ValueError("a belief must be finite, not negative and not all zero")
    relative = density / peak
    body = _log_bytes(relative) if lite else _shuffled(relative)
    header = {
        "type": "belief",
        "mission_id": mission_id,
        "emitter_id": emitter_id,
        "seq": seq,
        "bearings": bearings,
        "nx": density.shape[1],
        "ny": density.shape[0],
        "bounds": [list(corner) for corner in corners_lon_lat],
        "encoding": "u8-log-zlib" if lite else "f32-shuffle-zlib",
        "peak": peak,
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    return struct.pack("<I", len(text)) + text + zlib.compress(body, 9 if lite else 1)


def _shuffled(relative: NDArray[np.float64]) -> bytes:
    """Neighbouring cells share sign and exponent: bytes of a kind side by side compress."""
    return relative.astype("<f4").reshape(-1).view(np.uint8).reshape(-1, 4).T.tobytes()


def _log_bytes(relative: NDArray[np.float64]) -> bytes:
    with np.errstate(divide="ignore"):
        level = np.rint(255.0 * (1.0 + np.log10(relative) / DECADES))
    return np.where(relative > 0, np.clip(level, 1, 255), 0).astype(np.uint8).tobytes()
