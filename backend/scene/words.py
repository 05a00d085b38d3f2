"""The few words of a scene in the viewer's language: labels in space, and the panel of its window."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from backend.scene.items import Item, Label
from backend.wire.scene import SceneLanguage

GERMAN: dict[str, str] = {
    "home": "Start",
    "next": "nächster Ort",
    "localized": "gefunden",
    "not yet": "noch nicht",
    "heading unknown": "Richtung unbekannt",
    "3D view": "3D-Ansicht",
    "Belief": "Wahrscheinlichkeit",
    "Bearings": "Peilungen",
    "Sweeps": "Drehungen",
    "Next places": "Nächste Orte",
    "Flight path": "Flugweg",
    "Fence": "Zaun",
    "Labels": "Beschriftung",
    "From above": "Von oben",
    "From the side": "Von der Seite",
}


def say(words: str, language: SceneLanguage) -> str:
    """A label's or control's English words in the language; numbers between them stay."""
    if language == "en":
        return words
    if words in GERMAN:
        return GERMAN[words]
    for english in ("not yet", "localized", "next", "heading unknown"):
        if english in words:
            return words.replace(english, GERMAN[english]).replace(".", ",")
    return words


def in_language(items: Iterable[Item], language: SceneLanguage) -> Iterator[Item]:
    for item in items:
        yield replace(item, text=say(item.text, language)) if isinstance(item, Label) else item
