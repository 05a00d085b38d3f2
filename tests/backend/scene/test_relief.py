from __future__ import annotations

import numpy as np
import pytest
from relief import HOME, hill, level, terrain

from backend.scene.colours import PALETTES
from backend.scene.relief import relief_around, relief_surface
from backend.search.ground import Ground
from hardware.frame import LocalFrame

FRAME = LocalFrame(HOME)


def test_a_hill_stands_where_it_is_and_as_high_above_home_as_it_is() -> None:
    relief = relief_around(Ground(FRAME, 100.0, terrain(hill(200.0, -100.0, 60.0))), (0.0, 0.0), 500.0)
    assert relief is not None
    mesh = relief_surface(relief, PALETTES["dark"])
    top = mesh.vertices[mesh.vertices[:, 2].argmax()]
    assert top == pytest.approx((200.0, -100.0, 60.0), abs=8.0)
    assert mesh.faces.max() < len(mesh.vertices) == len(mesh.colours)
    assert len(np.unique(mesh.colours[:, :3], axis=0)) > 10


def test_unknown_ground_is_a_hole_and_without_terrain_there_is_no_mesh() -> None:
    relief = relief_around(Ground(FRAME, 100.0, terrain(level(), reach_m=200.0)), (0.0, 0.0), 500.0)
    assert relief is not None
    mesh = relief_surface(relief, PALETTES["light"])
    assert np.abs(mesh.vertices[np.unique(mesh.faces), :2]).max() <= 216.0
    assert relief_around(Ground(FRAME, 100.0), (0.0, 0.0), 500.0) is None
