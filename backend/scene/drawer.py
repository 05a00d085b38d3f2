"""Draws scenes into one viewer's window: only what changed is sent, what only moved is moved."""

from __future__ import annotations

import math
import threading
from collections.abc import Collection
from typing import Any, Protocol

import numpy as np

from backend.scene.controls import add_controls
from backend.scene.display import bytes_for, light_for
from backend.scene.glb import glb
from backend.scene.items import Item, Label, Lines, Scene, Surface, same, same_but_moved
from backend.wire.scene import SceneLayer

CAMERA_FROM, ABOVE, AIM = (0.42, -1.0, 0.72), (0.0, -0.02, 1.6), (0.0, 0.0, 0.04)
"""In extents from the middle: where the camera first stands (south-east and above), straight above, where it looks."""

FIELD_OF_VIEW_DEG = 42.0
NEAREST, FARTHEST = 0.001, 14.0
"""Clipping planes, in extents."""


class Window(Protocol):
    """What is used of `viser.ClientHandle`."""

    @property
    def scene(self) -> Any:
        """viser's SceneApi."""
        ...

    @property
    def camera(self) -> Any:
        """viser's CameraHandle."""
        ...

    @property
    def gui(self) -> Any:
        """viser's GuiApi."""
        ...

    def atomic(self) -> Any:
        """A context in which everything is sent as one."""
        ...


class Drawer:
    """One viewer's window. May be used by several threads, one at a time gets through."""

    def __init__(self, window: Window) -> None:
        self._window = window
        self._drawn: dict[str, tuple[Item, Any]] = {}
        self._hidden: frozenset[SceneLayer] = frozenset()
        self._scene: Scene | None = None
        self._lock = threading.RLock()
        add_controls(window.gui, self.hide, self.look)

    def draw(self, scene: Scene) -> int:
        """Make the window show the scene; how many items were sent again."""
        sent = 0
        with self._lock, self._window.atomic():
            self._set_up(scene)
            wanted = {item.name: item for item in scene.items}
            for name in [name for name in self._drawn if name not in wanted]:
                self._drawn.pop(name)[1].remove()
            for name, item in wanted.items():
                sent += self._show(name, item)
        return sent

    def clear(self) -> None:
        """An empty window: nothing is known that could be shown."""
        with self._lock, self._window.atomic():
            for _, handle in self._drawn.values():
                handle.remove()
            self._drawn.clear()
            self._scene = None

    def hide(self, layers: Collection[SceneLayer]) -> None:
        """Layers that this viewer switched off; they stay up to date unseen."""
        with self._lock, self._window.atomic():
            self._hidden = frozenset(layers)
            for item, handle in self._drawn.values():
                handle.visible = item.layer not in self._hidden

    def look(self, from_above: bool) -> None:
        """Move the camera back to where it first stood, or above the middle with north on top."""
        with self._lock, self._window.atomic():
            if self._scene is not None:
                self._stand(self._scene, ABOVE if from_above else CAMERA_FROM)

    def _show(self, name: str, item: Item) -> int:
        before = self._drawn.get(name)
        if before is not None and same(before[0], item):
            return 0
        if before is not None and same_but_moved(before[0], item) and isinstance(item, Surface):
            before[1].position = item.position
            before[1].wxyz = turned(item.heading_deg)
            self._drawn[name] = item, before[1]
            return 0
        if before is not None:
            before[1].remove()
        self._drawn[name] = item, self._add(item)
        return 1

    def _add(self, item: Item) -> Any:
        scene, name, visible = self._window.scene, f"/{item.name}", item.layer not in self._hidden
        match item:
            case Lines():
                return scene.add_line_segments(
                    name,
                    item.segments,
                    bytes_for(item.colours),
                    thickness=item.width_px,
                    thickness_units="screen",
                    visible=visible,
                )
            case Surface():
                alpha = item.colours[:, 3:].astype(np.float32) / 255.0
                return scene.add_glb(
                    name,
                    glb(item.vertices, item.faces, np.hstack((light_for(item.colours[:, :3]), alpha))),
                    position=item.position,
                    wxyz=turned(item.heading_deg),
                    cast_shadow=False,
                    receive_shadow=False,
                    visible=visible,
                )
            case Label():
                return scene.add_label(
                    name,
                    item.text,
                    position=item.position,
                    anchor=item.anchor,
                    font_screen_scale=item.size,
                    visible=visible,
                )

    def _set_up(self, scene: Scene) -> None:
        """Sky and lens; the camera moves only when another mission comes into view."""
        window, before = self._window, self._scene
        self._scene = scene
        if before is None or before.background != scene.background:
            dark = sum(scene.background) < 3 * 128
            window.gui.configure_theme(dark_mode=dark, show_logo=False, show_share_button=False, control_width="small")
            window.scene.set_background_image(np.full((2, 2, 3), scene.background, np.uint8), format="png")
        if before is None or before.mission_id != scene.mission_id:
            window.scene.set_up_direction("+z")
            window.camera.near = NEAREST * scene.extent_m
            window.camera.far = FARTHEST * scene.extent_m
            window.camera.fov = math.radians(FIELD_OF_VIEW_DEG)
            self._stand(scene, CAMERA_FROM)

    def _stand(self, scene: Scene, away: tuple[float, float, float]) -> None:
        camera, centre = self._window.camera, np.array(scene.centre)
        camera.position = centre + scene.extent_m * np.array(away)
        camera.look_at = centre + scene.extent_m * np.array(AIM)


def turned(heading_deg: float) -> tuple[float, float, float, float]:
    """Quaternion w, x, y, z of a clockwise turn around the vertical axis."""
    half = math.radians(-heading_deg) / 2
    return math.cos(half), 0.0, 0.0, math.sin(half)
