"""What went wrong, and whether that is over."""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import Id

Link = Literal["vehicle", "receiver", "console", "payload", "gps"]

Topic = Literal[
    "vehicle",
    "receiver",
    "console",
    "payload",
    "gps",
    "pilot",
    "battery",
    "place",
    "heading",
    "failure",
    "safety",
    "ground",
    "order",
    "storage",
    "autopilot",
    "clock",
    "nets",
    "antenna",
]
"""What an alert is about: a later one on the same topic, of the same craft or emitter, takes its place.
Of "autopilot" a few stand side by side, one a text."""


Level = Literal["warning", "caution", "advisory"]


class SafetyVetoed(Fact):
    """A command was not sent, or a place not taken, and this rule is why."""

    kind: Literal["safety_vetoed"] = "safety_vetoed"
    craft_id: Id
    reason: Reason


class LinkLost(Fact):
    """link: to what; "console": to the last one that watched."""

    kind: Literal["link_lost"] = "link_lost"
    craft_id: Id
    link: Link
    reason: Reason


class LinkRestored(Fact):
    """outage_s: how long nothing came over it."""

    kind: Literal["link_restored"] = "link_restored"
    craft_id: Id
    link: Link
    outage_s: float


class AlertRaised(Fact):
    """craft_id, emitter_id: whom it concerns; None of both: the whole mission."""

    kind: Literal["alert_raised"] = "alert_raised"
    alert_id: str
    topic: Topic
    level: Level
    reason: Reason
    craft_id: Id | None = None
    emitter_id: Id | None = None


class AlertAcknowledged(Fact):
    """Somebody has seen it; it stays open until it is cleared."""

    kind: Literal["alert_acknowledged"] = "alert_acknowledged"
    alert_id: str
    by: str


class AlertCleared(Fact):
    """Its cause is gone, or a later alert on the same topic took its place."""

    kind: Literal["alert_cleared"] = "alert_cleared"
    alert_id: str
