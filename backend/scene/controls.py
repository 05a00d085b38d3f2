"""The small panel in a 3D window: which layers are seen, and where the camera stands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from backend.scene.words import say
from backend.wire.scene import SceneLanguage, SceneLayer

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


def add_controls(
    gui: Any, show: Callable[[frozenset[SceneLayer]], None], look: Look, language: SceneLanguage = "en"
) -> None:
    """`show` is told the layers switched off; `look` where to stand: True from above, False at the first place.

    Both are called in viser's threads.
    """
    gui.set_panel_label(say("3D view", language))
    gui.main_panel.minimize()
    boxes = [(gui.add_checkbox(say(words, language), True), layers) for words, layers in GROUPS]

    def switched(_: object) -> None:
        show(frozenset(layer for box, layers in boxes if not box.value for layer in layers))

    for box, _ in boxes:
        box.on_update(switched)
    gui.add_button(say("From above", language)).on_click(lambda _: look(True))
    gui.add_button(say("From the side", language)).on_click(lambda _: look(False))
