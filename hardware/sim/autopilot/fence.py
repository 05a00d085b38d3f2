"""The fence that an autopilot holds: its items as the wire has them, and where they let the vehicle be. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hardware.sim.autopilot.geodesy import HomeFrame

RETURN_POINT, POLYGON_IN, POLYGON_OUT, CIRCLE_IN, CIRCLE_OUT = 5000, 5001, 5002, 5003, 5004
"""MAV_CMD_NAV_FENCE_*."""
ACCEPTED, ERROR, UNSUPPORTED, NO_SPACE, INVALID_PARAM1, INVALID_SEQUENCE = 0, 1, 3, 4, 6, 13
"""MAV_MISSION_RESULT."""
MOST_ITEMS = 64


@dataclass(frozen=True, slots=True)
class Item:
    """number: MAV_CMD; first: a polygon's number of corners or a circle's radius m; degrees times 1e7."""

    number: int
    first: float
    lat_e7: int
    lon_e7: int


def judged(items: Sequence[Item]) -> int:
    """Whether these are a fence; MAV_MISSION_RESULT."""
    if len(items) > MOST_ITEMS:
        return NO_SPACE
    at = 0
    while at < len(items):
        item = items[at]
        if item.number in (POLYGON_IN, POLYGON_OUT):
            count = int(item.first) if math.isfinite(item.first) else 0
            if count < 3 or len(items) < at + count or any(i.number != item.number for i in items[at : at + count]):
                return INVALID_PARAM1
            at += count
        elif item.number in (CIRCLE_IN, CIRCLE_OUT, RETURN_POINT):
            at += 1
        else:
            return UNSUPPORTED
    return ACCEPTED


class Fence:
    """any_inclusion: inside one inclusion is enough (ArduPilot by an option), else inside all."""

    def __init__(self, home: HomeFrame, any_inclusion: bool) -> None:
        self.items: tuple[Item, ...] = ()
        self._home = home
        self._any_inclusion = any_inclusion

    def allows(self, north: float, east: float) -> bool:
        """Metres from home."""
        inside: list[bool] = []
        at = 0
        while at < len(self.items):
            item = self.items[at]
            if item.number in (POLYGON_IN, POLYGON_OUT):
                corners = [self._local(corner) for corner in self.items[at : at + int(item.first)]]
                within = _within(north, east, corners)
                at += len(corners)
            else:
                centre = self._local(item)
                within = math.dist(centre, (north, east)) <= item.first
                at += 1
            if item.number in (POLYGON_OUT, CIRCLE_OUT) and within:
                return False
            if item.number in (POLYGON_IN, CIRCLE_IN):
                inside.append(within)
        return not inside or (any(inside) if self._any_inclusion else all(inside))

    def _local(self, item: Item) -> tuple[float, float]:
        return self._home.to_local(item.lat_e7 / 1e7, item.lon_e7 / 1e7)


def _within(north: float, east: float, corners: Sequence[tuple[float, float]]) -> bool:
    """The crossing rule: an odd number of edges to the east."""
    odd = False
    for (n1, e1), (n2, e2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if (n1 > north) != (n2 > north) and east < e1 + (north - n1) / (n2 - n1) * (e2 - e1):
            odd = not odd
    return odd
