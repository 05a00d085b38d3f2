"""What the nose did after a hold, an abort or a pilot's takeover met it in a turn, judged at the vehicle's end."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from hardware.autopilot.messages import CONDITION_YAW, REPOSITION, SET_MODE
from tests.strikes.missions import turned_deg
from tests.strikes.proxy import ATTITUDE, COMMAND_INT, COMMAND_LONG, Passed

Deed = Literal["pilot", "hold", "abort"]
While = Literal["swing", "turn back", "sector", "extension"]
"""turn back: in a swing, from one side to the other. extension: of a sector, beyond what was planned."""
STILL_DEG_S = 5.0
"""Below, a nose that hovers corrects its heading."""


@dataclass(frozen=True, slots=True)
class Struck:
    """One strike. rate_deg_s: of the nose as it was struck. took_s: from the deed until the autopilot obeyed its pilot,
    or our first order to stop reached it; None: neither came about.

    shown_s: until the console showed it; None: it did not. still_s: from `took_s` on, until the nose turned no more, or
    the way home of an abort began; None: it went on. turned_deg: of the nose meanwhile, to and fro. steered: our orders
    of a place or of the nose that reached the vehicle from then on, but for those that were under way to a pilot.
    undone: the autopilot left the pilot's mode. went_on: the search, when it was asked to.
    """

    during: While
    deed: Deed
    means: str
    delay_s: float
    rate_deg_s: float
    took_s: float | None
    shown_s: float | None
    still_s: float | None
    turned_deg: float
    steered: int
    undone: bool = False
    went_on: bool | None = None
    story: tuple[str, ...] = ()

    @property
    def wrong(self) -> bool:
        """Undone, never shown, never still, or steered on."""
        late = None in (self.shown_s, self.still_s)
        return self.took_s is not None and (self.undone or late or self.steered > 0 or self.went_on is False)


def rate_deg_s(record: Sequence[Passed]) -> float:
    """Of the nose as told last, clockwise; 0 when nothing was told."""
    told = (passed for passed in reversed(record) if passed.number == ATTITUDE and passed.way == "from")
    last = next(told, None)
    return 0.0 if last is None else math.degrees(last.fields["yawspeed"])


def stop_ordered(record: Sequence[Passed]) -> float | None:
    """When the first order to stay, or of a mode, reached the vehicle."""
    return next((passed.at_s for passed in record if _command(passed) and not steers(passed)), None)


def way_home(record: Sequence[Passed]) -> float | None:
    """When the first order of a place alone, as a flight home is, reached the vehicle."""
    return next((p.at_s for p in record if steers(p) and math.isnan(p.fields.get("param4", 0.0))), None)


def mode_ordered(record: Sequence[Passed], custom: tuple[float, float]) -> float | None:
    """When the first order of this mode reached the vehicle."""
    orders = (passed for passed in record if _command(passed) == SET_MODE)
    asked = (one.at_s for one in orders if (one.fields["param2"], one.fields["param3"]) == custom)
    return next(asked, None)


def steers(passed: Passed) -> bool:
    """An order of the nose, or of a place with or without it."""
    number = _command(passed)
    return number == CONDITION_YAW or (number == REPOSITION and passed.number == COMMAND_INT)


def _command(passed: Passed) -> int:
    """Of the program: what stops, turns or sends the vehicle; 0: nothing of that."""
    if passed.way != "to" or passed.number not in (COMMAND_INT, COMMAND_LONG):
        return 0
    number = int(passed.fields["command"])
    return number if number in (CONDITION_YAW, REPOSITION, SET_MODE) else 0


def steered_after(record: Sequence[Passed], at_s: float) -> int:
    return sum(steers(passed) for passed in record if passed.at_s > at_s)


def came_to_rest(record: Sequence[Passed], from_s: float, to_s: float) -> tuple[float | None, float]:
    """(seconds from `from_s` until the nose turned no more, None: it still turned at `to_s`; degrees until then)."""
    within = [p for p in record if from_s <= p.at_s <= to_s and p.number == ATTITUDE and p.way == "from"]
    turning = [passed.at_s for passed in within if abs(math.degrees(passed.fields["yawspeed"])) > STILL_DEG_S]
    turned = turned_deg(within)
    if not turning:
        return 0.0, turned
    after = next((later.at_s for before, later in pairwise(within) if before.at_s == turning[-1]), None)
    return None if after is None else after - from_s, turned
