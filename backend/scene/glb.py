"""A mesh with a colour a vertex as a binary glTF 2.0 file, unlit: no lamp changes its colours.

Layout: 12-byte header, JSON chunk, binary chunk (positions and colours float32, indices uint32), every part aligned to
4 bytes (glTF 2.0 specification, section 4.4). Unlit: extension KHR_materials_unlit.
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

FLOAT, UNSIGNED_INT = 5126, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def glb(vertices: NDArray[np.float32], faces: NDArray[np.uint32], colours: NDArray[np.float32]) -> bytes:
    """vertices (n, 3), faces (m, 3), colours (n, 4) in linear light; n, m > 0. Seen from both sides; see-through where
    alpha < 1."""
    parts = [
        np.ascontiguousarray(vertices, "<f4").tobytes(),
        np.ascontiguousarray(colours, "<f4").tobytes(),
        np.ascontiguousarray(faces, "<u4").tobytes(),
    ]
    views: list[dict[str, Any]] = []
    offset = 0
    for part, target in zip(parts, (ARRAY_BUFFER, ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER), strict=True):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part), "target": target})
        offset += len(part)
    material: dict[str, Any] = {
        "doubleSided": True,
        "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0},
        "extensions": {"KHR_materials_unlit": {}},
    }
    if (colours[:, 3] < 1).any():
        material["alphaMode"] = "BLEND"
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [material],
        "buffers": [{"byteLength": offset}],
        "bufferViews": views,
        "accessors": [
            {
                "bufferView": 0,
                "componentType": FLOAT,
                "count": len(vertices),
                "type": "VEC3",
                "min": vertices.min(axis=0).tolist(),
                "max": vertices.max(axis=0).tolist(),
            },
            {"bufferView": 1, "componentType": FLOAT, "count": len(vertices), "type": "VEC4"},
            {"bufferView": 2, "componentType": UNSIGNED_INT, "count": faces.size, "type": "SCALAR"},
        ],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(parts)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(body))
    return b"".join(
        (header, struct.pack("<II", len(text), JSON_CHUNK), text, struct.pack("<II", len(body), BINARY_CHUNK), body)
    )
