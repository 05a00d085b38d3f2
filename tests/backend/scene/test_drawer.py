"""Only what changed is sent to a window."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from backend.scene.drawer import Drawer, turned
from backend.scene.items import Label, Lines, Scene, Surface
from backend.scene.shapes import ball


class Node(SimpleNamespace):
    removed = False

    def remove(self) -> None:
        self.removed = True


class PaperScene:
    """Keeps what was added."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []

    def _add(self, kind: str, name: str, **properties: Any) -> Node:
        node = Node(kind=kind, name=name, **properties)
        self.nodes.append(node)
        return node

    def add_line_segments(self, name, points, colors, **properties):
        return self._add("lines", name, points=points, **properties)

    def add_glb(self, name, data, **properties):
        return self._add("surface", name, data=data, **properties)

    def add_label(self, name, text, **properties):
        return self._add("label", name, text=text, **properties)

    def set_up_direction(self, direction) -> None:
        self.up = direction

    def set_background_image(self, image, format) -> None:
        self.sky = tuple(image[0, 0].tolist())

    def seen(self) -> set[str]:
        return {node.name for node in self.nodes if not node.removed and node.visible}


class PaperGui:
    def __init__(self) -> None:
        self.boxes: dict[str, Any] = {}
        self.buttons: dict[str, Any] = {}
        self.main_panel = SimpleNamespace(minimize=lambda: None)

    def set_panel_label(self, label: str) -> None: ...

    def configure_theme(self, **options: Any) -> None: ...

    def add_checkbox(self, label: str, value: bool) -> Any:
        box = SimpleNamespace(value=value, callback=None)
        box.on_update = lambda function: setattr(box, "callback", function)
        self.boxes[label] = box
        return box

    def add_button(self, label: str) -> Any:
        return SimpleNamespace(on_click=lambda function: self.buttons.__setitem__(label, function))


class PaperWindow:
    def __init__(self) -> None:
        self.scene, self.gui = PaperScene(), PaperGui()
        self.camera = SimpleNamespace(position=None, look_at=None)

    def atomic(self):
        return contextlib.nullcontext()


def surface(name: str = "vehicle/body", **changes: Any) -> Surface:
    vertices, faces = ball(1.0)
    colours = np.full((len(vertices), 4), 200, np.uint8)
    return replace(Surface(name, "vehicle", vertices, faces, colours), **changes)


def lines(length: float = 1.0) -> Lines:
    points = np.array([[(0, 0, 0), (length, 0, 0)]], np.float32)
    return Lines("path/0", "path", points, np.zeros((1, 2, 3), np.uint8), 2.0)


def label(text: str = "home") -> Label:
    return Label("home/label", "labels", text, (0.0, 0.0, 1.0))


def scene(*items, mission_id: str = "m1", background=(10, 10, 10)) -> Scene:
    return Scene(mission_id, items, (1.0, 2.0, 0.0), 100.0, background)


@pytest.fixture
def window() -> PaperWindow:
    return PaperWindow()


@pytest.fixture
def drawer(window) -> Drawer:
    return Drawer(window)


def test_a_scene_is_drawn_once(window, drawer) -> None:
    assert drawer.draw(scene(surface(), lines(), label())) == 3
    assert drawer.draw(scene(surface(), lines(), label())) == 0
    assert window.scene.seen() == {"/vehicle/body", "/path/0", "/home/label"}


def test_what_changed_is_drawn_again_and_what_is_gone_is_removed(window, drawer) -> None:
    drawer.draw(scene(surface(), lines(), label()))
    assert drawer.draw(scene(lines(2.0), label())) == 1
    assert window.scene.seen() == {"/path/0", "/home/label"}
    assert sum(node.name == "/path/0" for node in window.scene.nodes) == 2


def test_what_only_moved_is_moved_and_not_sent_again(window, drawer) -> None:
    drawer.draw(scene(surface()))
    assert drawer.draw(scene(surface(position=(1.0, 2.0, 3.0), heading_deg=90.0))) == 0
    (node,) = window.scene.nodes
    assert node.position == (1.0, 2.0, 3.0)
    assert node.wxyz == turned(90.0)
    assert drawer.draw(scene(surface(position=(1.0, 2.0, 3.0), heading_deg=90.0))) == 0


def test_the_camera_is_moved_for_another_mission_only(window, drawer) -> None:
    drawer.draw(scene(label()))
    window.camera.position = "where the viewer put it"
    drawer.draw(scene(label("other"), background=(250, 250, 250)))
    assert window.camera.position == "where the viewer put it"
    assert window.scene.sky == (250, 250, 250)
    drawer.draw(scene(label(), mission_id="m2"))
    assert window.camera.position == pytest.approx((43.0, -98.0, 72.0))


def test_layers_that_the_viewer_switched_off_stay_off(window, drawer) -> None:
    drawer.draw(scene(lines(), label()))
    window.gui.boxes["Flight path"].value = False
    window.gui.boxes["Flight path"].callback(None)
    assert window.scene.seen() == {"/home/label"}
    drawer.draw(scene(lines(5.0), label()))
    assert window.scene.seen() == {"/home/label"}
    window.gui.boxes["Flight path"].value = True
    window.gui.boxes["Flight path"].callback(None)
    assert window.scene.seen() == {"/home/label", "/path/0"}


def test_from_above_looks_straight_down(window, drawer) -> None:
    window.gui.buttons["From above"](None)
    assert window.camera.position is None
    drawer.draw(scene(label()))
    window.gui.buttons["From above"](None)
    assert window.camera.position == pytest.approx((1.0, 0.0, 160.0))
    window.gui.buttons["From the side"](None)
    assert window.camera.position == pytest.approx((43.0, -98.0, 72.0))


def test_cleared_is_empty_and_can_be_drawn_again(window, drawer) -> None:
    drawer.draw(scene(surface()))
    drawer.clear()
    assert window.scene.seen() == set()
    assert drawer.draw(scene(surface())) == 1


def test_a_heading_turns_clockwise_seen_from_above() -> None:
    w, x, y, z = turned(90.0)
    north = np.array([0.0, 1.0])
    cos, sin = w * w - z * z, 2 * w * z
    assert (x, y) == (0.0, 0.0)
    assert np.array([[cos, -sin], [sin, cos]]) @ north == pytest.approx((1.0, 0.0))
