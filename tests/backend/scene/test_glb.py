"""The binary glTF is read back by an independent reader."""

from __future__ import annotations

import io

import numpy as np
import trimesh
from narrowing import a

from backend.scene.glb import glb
from backend.scene.shapes import ball


def test_a_mesh_comes_back() -> None:
    vertices, faces = ball(3.0)
    colours = np.random.default_rng(1).uniform(0, 1, (len(vertices), 4)).astype(np.float32)
    content = glb(vertices, faces, colours)
    assert len(content) % 4 == 0
    scene = a(trimesh.Scene, trimesh.load(io.BytesIO(content), file_type="glb", process=False))
    (mesh,) = scene.geometry.values()
    assert np.allclose(mesh.vertices, vertices)
    assert (mesh.faces == faces).all()


def test_only_what_is_see_through_is_blended() -> None:
    vertices, faces = ball(1.0)
    opaque = np.ones((len(vertices), 4), np.float32)
    thin = opaque * np.array([1, 1, 1, 0.5], np.float32)
    assert b"BLEND" not in glb(vertices, faces, opaque)
    assert b"BLEND" in glb(vertices, faces, thin)
