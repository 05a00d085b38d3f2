"""What a viewer's 3D scene shows.

The page makes a random `view_id` (one a tab), says with PUT /api/scene/views/{view_id} what to show, and puts the page
`url` of the answer into a frame. Another PUT with the same id changes the scene in the open frame: scrubbing is a PUT a
step. A view that nobody watches is forgotten after a while; PUT brings it back.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from backend.spec import Model

SceneLayer = Literal[
    "area",
    "terrain",
    "fence",
    "no_fly",
    "path",
    "vehicle",
    "roses",
    "bearings",
    "belief",
    "c95",
    "candidates",
    "estimate",
    "labels",
]


class SceneRequest(Model):
    """mission_id None: the mission that flies now, and the next one after it. seq None: follow the live mission; a
    number: the mission as it was after that event. `hidden`: layers left out. `belief_height_m`: height of the belief's
    peak; None: chosen from the area."""

    mission_id: str | None = Field(default=None, pattern=r"^[A-Za-z0-9_-]{1,64}$")
    seq: int | None = Field(default=None, ge=1, le=2**31 - 1)
    hidden: list[SceneLayer] = Field(default_factory=list[SceneLayer], max_length=20)
    belief_height_m: float | None = Field(default=None, gt=0, le=10_000)
    theme: Literal["dark", "light"] = "dark"


class SceneView(Model):
    """`url`: the page to put into a frame. `mission_id`: what is shown, None while nothing flies. `shown_seq`: the last
    event in the scene. `watchers`: frames connected to this view."""

    view_id: str
    url: str
    mission_id: str | None
    seq: int | None
    shown_seq: int
    watchers: int
