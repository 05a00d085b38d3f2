"""The small panel in a 3D window: which layers are seen, and where the camera stands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from backend.wire.scene import SceneLayer

GROUPS: tuple[tuple[str, tuple[SceneLayer, ...]], ...] = (
    ("Belief", ("belief", "c95", "estimate")),
    ("Bearings", ("bearings",)),
    ("Sweeps", ("roses",)),
    ("Next places", ("candidates",)),
    ("Flight path", ("path",)),
    ("Fence", ("fence", "no_fly")),
    ("Labels", ("labels",)),
)

Look = Callable[[bool], None]


def add_controls(gui: Any, show: Callable[[frozenset[SceneLayer]], None], look: Look) -> None:
    """`show` takes the layers switched off; `look` where to stand: True from above, False at the first place.

    Both are called in viser's threads.
    """
    gui.set_panel_label("3D view")
    gui.main_panel.minimize()
    boxes = [(gui.add_checkbox(words, True), layers) for words, layers in GROUPS]

    def switched(_: object) -> None:
        show(frozenset(layer for box, layers in boxes if not box.value for layer in layers))

    for box, _ in boxes:
        box.on_update(switched)

    def from_above(_: object) -> None:
        look(True)

    def from_the_side(_: object) -> None:
        look(False)

    gui.add_button("From above").on_click(from_above)
    gui.add_button("From the side").on_click(from_the_side)
