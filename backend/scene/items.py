"""What a 3D scene is made of: plain lines, surfaces and labels with explicit coordinates. No viewer is named here.

Frame: local east-north-up metres, the ground plane at z = 0 is the height of the vehicle's home.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from backend.wire.scene import SceneLayer

Points = NDArray[np.float32]
"""(n, 3) metres ENU."""

Colours = NDArray[np.uint8]
"""(n, 4) red, green, blue, alpha."""

Anchor = Literal["top-center", "bottom-center", "center-center", "center-left", "center-right"]


@dataclass(frozen=True, eq=False, slots=True)
class Lines:
    """segments: (n, 2, 3) metres ENU. colours: (n, 2, 3) uint8, one a point. width_px: on the screen."""

    name: str
    layer: SceneLayer
    segments: Points
    colours: NDArray[np.uint8]
    width_px: float


@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """A mesh in the colours it says, not shaded by lamps. vertices: (n, 3). faces: (m, 3) indices. colours: (n, 4).

    Drawn turned clockwise by `heading_deg` (the mesh's own front is north) and then moved to `position`.
    """

    name: str
    layer: SceneLayer
    vertices: Points
    faces: NDArray[np.uint32]
    colours: Colours
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heading_deg: float = 0.0


@dataclass(frozen=True, eq=False, slots=True)
class Label:
    """Text that always faces the viewer. size: 1 is the normal height of text."""

    name: str
    layer: SceneLayer
    text: str
    position: tuple[float, float, float]
    anchor: Anchor = "bottom-center"
    size: float = 1.0


Item = Lines | Surface | Label


@dataclass(frozen=True, slots=True)
class Scene:
    """centre: m ENU, what the camera looks at. extent_m: size of what there is to see. background: the sky's colour."""

    mission_id: str
    items: tuple[Item, ...]
    centre: tuple[float, float, float]
    extent_m: float
    background: tuple[int, int, int]

    def layer(self, layer: SceneLayer) -> tuple[Item, ...]:
        """In the order in which they were composed."""
        return tuple(item for item in self.items if item.layer == layer)


def same(one: Item, other: Item) -> bool:
    """Whether drawing `other` over `one` would change nothing."""
    if type(one) is not type(other):
        return False
    return all(_equal(getattr(one, name), getattr(other, name)) for name in one.__slots__)


def same_but_moved(one: Item, other: Item) -> bool:
    """Whether `other` is the same surface elsewhere: the mesh need not be sent again."""
    if not (isinstance(one, Surface) and isinstance(other, Surface)):
        return False
    kept = ("name", "layer", "vertices", "faces", "colours")
    return all(_equal(getattr(one, name), getattr(other, name)) for name in kept)


def _equal(one: object, other: object) -> bool:
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return one is other or np.array_equal(cast(ArrayLike, one), cast(ArrayLike, other))
    return one == other
