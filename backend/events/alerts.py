"""What went wrong, and whether that is over."""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import Id

Link = Literal["vehicle", "receiver", "console", "payload"]

Topic = Literal[
    "vehicle",
    "receiver",
    "console",
    "payload",
    "pilot",
    "battery",
    "place",
    "heading",
    "failure",
    "safety",
    "ground",
    "storage",
]
"""What an alert is about: a later one on the same topic, of the same craft or emitter, takes its place."""


class SafetyVetoed(Fact):
    kind: Literal["safety_vetoed"] = "safety_vetoed"
    craft_id: Id
    reason: Reason


class LinkLost(Fact):
    kind: Literal["link_lost"] = "link_lost"
    craft_id: Id
    link: Link
    reason: Reason


class LinkRestored(Fact):
    kind: Literal["link_restored"] = "link_restored"
    craft_id: Id
    link: Link
    outage_s: float


class AlertRaised(Fact):
    """craft_id, emitter_id: whom it concerns; None of both: the whole mission."""

    kind: Literal["alert_raised"] = "alert_raised"
    alert_id: str
    topic: Topic
    level: Literal["warning", "caution", "advisory"]
    reason: Reason
    craft_id: Id | None = None
    emitter_id: Id | None = None


class AlertAcknowledged(Fact):
    kind: Literal["alert_acknowledged"] = "alert_acknowledged"
    alert_id: str
    by: str


class AlertCleared(Fact):
    kind: Literal["alert_cleared"] = "alert_cleared"
    alert_id: str
