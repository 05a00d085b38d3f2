"""The vehicle's own nets: what its owner had set, that the mission's hang, and that it was put back."""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.spec import Id
from hardware.fence import Nets


class NetsNoted(Fact):
    """Before anything was set: the fence and its parameters as the owner had them in the autopilot (`before`), and as
    the mission is about to set them (`after`)."""

    kind: Literal["nets_noted"] = "nets_noted"
    craft_id: Id
    before: Nets
    after: Nets


class NetsHung(Fact):
    """In flight, after the search area changed: the autopilot has the mission's nets again, read back."""

    kind: Literal["nets_hung"] = "nets_hung"
    craft_id: Id


class NetsPutBack(Fact):
    """whole: nothing had been changed by somebody else since; what had is left as it was found."""

    kind: Literal["nets_put_back"] = "nets_put_back"
    craft_id: Id
    whole: bool
