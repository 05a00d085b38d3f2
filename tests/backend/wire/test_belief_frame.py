"""The frame is read here as its description says, independently of the encoder."""

from __future__ import annotations

import json
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from backend.wire.belief_frame import encode_belief

CORNERS = [(7.2, 50.6), (7.3, 50.6), (7.3, 50.7), (7.2, 50.7)]

densities = arrays(
    np.float64, st.tuples(st.integers(1, 30), st.integers(1, 30)), elements=st.floats(0, 1, allow_subnormal=False)
).filter(lambda density: density.max() > 1e-300)


def read(frame: bytes) -> tuple[dict, np.ndarray]:
    (length,) = struct.unpack_from("<I", frame)
    header = json.loads(frame[4 : 4 + length])
    body = zlib.decompress(frame[4 + length :])
    cells = header["nx"] * header["ny"]
    if header["encoding"] == "f32-shuffle-zlib":
        values = bytes(body[part * cells + cell] for cell in range(cells) for part in range(4))
        flat = np.array(struct.unpack(f"<{cells}f", values))
    else:
        levels = np.frombuffer(body, np.uint8).astype(float)
        flat = np.where(levels == 0, 0.0, 10 ** (6 * (levels / 255 - 1)))
    return header, flat.reshape(header["ny"], header["nx"])


@given(densities)
def test_the_full_frame_is_the_density_in_single_precision(density):
    header, relative = read(encode_belief("m", "tag", 17, 3, density, CORNERS, lite=False))
    assert (header["type"], header["mission_id"], header["emitter_id"]) == ("belief", "m", "tag")
    assert (header["seq"], header["bearings"]) == (17, 3)
    assert header["bounds"] == [list(corner) for corner in CORNERS]
    np.testing.assert_allclose(relative * header["peak"], density, rtol=1e-6, atol=1e-37 * header["peak"] + 1e-320)


@given(densities)
def test_the_lite_frame_keeps_six_decades_within_three_percent(density):
    header, relative = read(encode_belief("m", "tag", 17, 3, density, CORNERS, lite=True))
    true = density / header["peak"]
    assert ((relative == 0) == (true == 0)).all()
    seen = true > 1.1e-6
    np.testing.assert_allclose(relative[seen], true[seen], rtol=0.03)


def test_rows_go_north_and_columns_east():
    density = np.zeros((2, 3))
    density[1, 2] = 1.0
    for lite in (False, True):
        header, relative = read(encode_belief("m", "tag", 0, 0, density, CORNERS, lite=lite))
        assert (header["ny"], header["nx"]) == (2, 3)
        assert relative.argmax() == 5


def test_a_thin_link_gets_a_small_frame():
    y, x = np.mgrid[0:100, 0:100]
    density = np.exp(-((x - 30) ** 2 + (y - 60) ** 2) / 400.0)
    density /= density.sum()
    full = encode_belief("m", "tag", 17, 3, density, CORNERS, lite=False)
    lite = encode_belief("m", "tag", 17, 3, density, CORNERS, lite=True)
    assert len(lite) < len(full) / 4 < 10_000


@pytest.mark.parametrize("density", [np.zeros((2, 2)), np.array([[np.nan, 1.0]]), np.array([[-1.0, 2.0]])])
def test_what_is_no_density_is_refused(density):
    with pytest.raises(ValueError, match="belief"):
        encode_belief("m", "tag", 0, 0, density, CORNERS, lite=False)
