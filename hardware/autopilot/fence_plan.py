"""What the autopilot's nets must become for a mission, from what its owner has set: never looser. Pure.

Where the owner's fence is in force, the mission must lie inside it; what is set then is the mission's, cut to the
owner's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from shapely import Point, Polygon, disjoint_subset_union_all
from shapely.geometry.base import BaseGeometry

from hardware.autopilot.dialect import Dialect, OwnFence
from hardware.fence import FenceCircle, FencePolygon, FenceZone, MissionNets, Nets, NetsPlan, ParameterValue
from hardware.frame import LocalFrame
from hardware.ports import VehicleError
from hardware.reasons.nets import FenceTooDetailed, OwnCeilingLower, OwnFenceTighter

SLACK_M = 0.05
"""Two fences that differ by less are the same: the wire's resolution is a centimetre."""


def plan_nets(dialect: Dialect, present: Nets, wanted: MissionNets) -> NetsPlan:
    """present: as the owner has them. Raises VehicleError when theirs is tighter than what the mission needs, or the
    fence has too many corners."""
    values = present.values()
    own = dialect.nets.own(values)
    if own.ceiling_m is not None and own.ceiling_m < wanted.ceiling_m:
        raise VehicleError(OwnCeilingLower(own.ceiling_parameter, own.ceiling_m, wanted.ceiling_m))
    zones = _within(own, present.zones if own.watched else (), wanted)
    corners = sum(len(zone.corners) for zone in zones)
    if corners > dialect.nets.most_corners:
        raise VehicleError(FenceTooDetailed(corners, dialect.nets.most_corners))
    ceiling_m = min(wanted.net_ceiling_m, math.inf if own.ceiling_m is None else own.ceiling_m)
    changed = dialect.nets.for_mission(values, ceiling_m)
    after = tuple(ParameterValue(name, changed.get(name, value)) for name, value in values.items())
    return NetsPlan(present, Nets(zones, after))


def _within(own: OwnFence, zones: Sequence[FenceZone], wanted: MissionNets) -> tuple[FencePolygon, ...]:
    """The mission's net, cut to the owner's fence. Raises VehicleError when that cuts into what the mission needs."""
    frame = LocalFrame(wanted.home)
    theirs = _room(zones, frame, own.any_inclusion)
    if own.radius_m is not None:
        circle = Point(0.0, 0.0).buffer(own.radius_m, quad_segs=64)
        theirs = circle if theirs is None else theirs.intersection(circle)
    if theirs is None:
        return wanted.zones
    needed, net = _room(wanted.needed, frame, False), _room(wanted.zones, frame, False)
    if needed is None or net is None:
        return wanted.zones
    if not theirs.buffer(SLACK_M).covers(needed):
        raise VehicleError(OwnFenceTighter(_reach(needed.difference(theirs), theirs)))
    if theirs.covers(net):
        return wanted.zones
    cut = max(_parts(net.intersection(theirs)), key=lambda part: part.area)
    return (
        _polygon(cut.exterior.coords[:-1], True, frame),
        *(_polygon(hole.coords[:-1], False, frame) for hole in cut.interiors),
    )


def _polygon(corners: Sequence[Sequence[float]], inside: bool, frame: LocalFrame) -> FencePolygon:
    return FencePolygon(tuple(frame.to_geo(corner[0], corner[1]) for corner in corners), inside)


def _reach(outside: BaseGeometry, theirs: BaseGeometry) -> float:
    """How far what lies outside reaches beyond; inside a no-fly area of theirs, too, it is more than nothing."""
    points = [Point(point) for part in _parts(outside) for point in part.exterior.coords]
    return max((point.distance(theirs) for point in points), default=0.0) or 1.0


def _room(zones: Sequence[FenceZone], frame: LocalFrame, any_inclusion: bool) -> BaseGeometry | None:
    """Where these zones let one fly, metres ENU; None: they bound nothing. any_inclusion: inside one is enough."""
    bounding = [zone for zone in zones if isinstance(zone, FencePolygon | FenceCircle)]
    inside = _shapes([zone for zone in bounding if zone.inside], frame)
    outside = _shapes([zone for zone in bounding if not zone.inside], frame)
    if not inside and not outside:
        return None
    room: BaseGeometry = Point(0.0, 0.0).buffer(_EVERYWHERE_M)
    if inside and any_inclusion:
        room = disjoint_subset_union_all(inside)
    else:
        for shape in inside:
            room = room.intersection(shape)
    return room.difference(disjoint_subset_union_all(outside)) if outside else room


_EVERYWHERE_M = 100_000.0


def _shapes(zones: Sequence[FencePolygon | FenceCircle], frame: LocalFrame) -> list[BaseGeometry]:
    """All corners at once: one by one, those of 300 no-fly areas would hold up the event loop."""
    circles = [zone for zone in zones if isinstance(zone, FenceCircle)]
    round_ones = [Point(frame.to_enu(zone.centre)).buffer(zone.radius_m, quad_segs=64) for zone in circles]
    drawn = [zone.corners for zone in zones if isinstance(zone, FencePolygon)]
    if not drawn:
        return [*round_ones]
    corners = frame.to_enu_points(np.array([(corner.lon, corner.lat) for ring in drawn for corner in ring]))
    rings = np.split(corners, np.cumsum([len(ring) for ring in drawn])[:-1])
    return [*round_ones, *(Polygon(ring).buffer(0.0) for ring in rings)]


def _parts(shape: BaseGeometry) -> list[Polygon]:
    several = getattr(shape, "geoms", (shape,))
    return [part for part in several if isinstance(part, Polygon) and not part.is_empty]
