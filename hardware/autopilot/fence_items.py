"""Fence zones as the items of MAVLink's mission protocol, and back. Numbers: common.xml. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hardware.fence import FenceCircle, FencePolygon, FenceReturnPoint, FenceZone
from hardware.readings import Place

RETURN_POINT = 5000
POLYGON = {True: 5001, False: 5002}
CIRCLE = {True: 5003, False: 5004}
"""MAV_CMD_NAV_FENCE_*, by whether the vehicle stays inside."""
_INSIDE_OF = {number: inside for table in (POLYGON, CIRCLE) for inside, number in table.items()}
_E7 = 1e7
WIRE_E7 = 1
"""An autopilot that keeps degrees as floating point may give a corner back one unit (1e-7 degrees, 1 cm) away."""
RADIUS_M = 0.01


@dataclass(frozen=True, slots=True)
class FenceItem:
    """number: MAV_CMD; first: a polygon's number of corners, a circle's radius in metres; lat_e7, lon_e7: 1e-7 deg."""

    number: int
    first: float
    lat_e7: int
    lon_e7: int


class FenceUnreadable(ValueError):
    """These items are no fence."""


def items_of(zones: Sequence[FenceZone]) -> list[FenceItem]:
    """As MAVLink's mission protocol carries them: an item a corner, in order."""
    found: list[FenceItem] = []
    for zone in zones:
        match zone:
            case FencePolygon(corners=corners, inside=inside):
                found += [_item(POLYGON[inside], float(len(corners)), corner) for corner in corners]
            case FenceCircle(centre=centre, radius_m=radius_m, inside=inside):
                found.append(_item(CIRCLE[inside], radius_m, centre))
            case FenceReturnPoint(place=place):
                found.append(_item(RETURN_POINT, 0.0, place))
    return found


def zones_of(items: Sequence[FenceItem]) -> tuple[FenceZone, ...]:
    """Raises FenceUnreadable."""
    found: list[FenceZone] = []
    at = 0
    while at < len(items):
        item = items[at]
        if item.number in POLYGON.values():
            count = int(item.first) if math.isfinite(item.first) else 0
            corners = items[at : at + count]
            if count < 3 or len(corners) < count or any(c.number != item.number for c in corners):
                raise FenceUnreadable(f"item {at}: no polygon of {item.first} corners")
            found.append(FencePolygon(tuple(_place(corner) for corner in corners), _INSIDE_OF[item.number]))
            at += count
        elif item.number in CIRCLE.values():
            if not 0.0 < item.first < 1e7:
                raise FenceUnreadable(f"item {at}: no circle of {item.first} m")
            found.append(FenceCircle(_place(item), item.first, _INSIDE_OF[item.number]))
            at += 1
        elif item.number == RETURN_POINT:
            found.append(FenceReturnPoint(_place(item)))
            at += 1
        else:
            raise FenceUnreadable(f"item {at}: command {item.number} is no part of a fence")
    return tuple(found)


def first_difference(sent: Sequence[FenceZone], back: Sequence[FenceZone]) -> int | None:
    """The first item that is not the same within the wire's resolution, counted from 0; None when all are."""
    ours, theirs = items_of(sent), items_of(back)
    for index, (one, other) in enumerate(zip(ours, theirs, strict=False)):
        if not _same(one, other):
            return index
    return None if len(ours) == len(theirs) else min(len(ours), len(theirs))


def _same(one: FenceItem, other: FenceItem) -> bool:
    near = abs(one.lat_e7 - other.lat_e7) <= WIRE_E7 and abs(one.lon_e7 - other.lon_e7) <= WIRE_E7
    return one.number == other.number and near and abs(one.first - other.first) <= RADIUS_M


def _item(number: int, first: float, place: Place) -> FenceItem:
    return FenceItem(number, first, round(place.lat * _E7), round(place.lon * _E7))


def _place(item: FenceItem) -> Place:
    if abs(item.lat_e7) > 90 * _E7 or abs(item.lon_e7) > 180 * _E7:
        raise FenceUnreadable(f"a corner at {item.lat_e7}, {item.lon_e7} is not on the earth")
    return Place(item.lat_e7 / _E7, item.lon_e7 / _E7)
