"""What the autopilot's own fence is to be for a mission: its fence and no-fly areas as few corners, a little outside.

The mission's vetoes hold the vehicle inside the fence; the autopilot's net hangs beyond them, so that a hovering
vehicle at the edge does not fall into it. No-fly areas are sent as they were drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

import numpy as np
from shapely import LinearRing, Point, Polygon
from shapely.geometry.base import BaseGeometry

from backend.craft.safety import Limits
from backend.events import CheckFact
from hardware.fence import FencePolygon, MissionNets, NetsPlan
from hardware.frame import LocalFrame
from hardware.ports import Vehicle, VehicleError
from hardware.readings import Place
from hardware.reasons.nets import NetsToSet, ParameterToSet

MARGIN_M = 5.0
FARTHEST_M = 20.0
"""From the fence to any point of a net that could be nearer."""
CEILING_MARGIN_M = 3.0
MOST_OUTLINE_CORNERS = 16
ROUGHNESS_M = (0.0, 0.5, 1.0, 2.0, 4.0, 8.0)
"""By how much the outline may be simplified, always outwards, until it has no more corners than that: each corner takes
two round trips over the link, and 28 took 45 s at 250 ms each way (PX4)."""


def mission_nets(limits: Limits) -> MissionNets:
    """The part of the fence that home lies in (or next to), with what may not be entered there."""
    home = Point(0.0, 0.0)
    outline = min(_polygons(limits.fence), key=lambda part: part.distance(home))
    room = _outwards(outline)
    frame = limits.frame
    no_fly = [part for zone in limits.no_fly for part in _polygons(zone) if part.intersects(room)]
    needed, net, kept_out = _rings(outline), _rings(room), [(part.exterior, False) for part in no_fly]
    zones = _zones([*needed, *net, *kept_out], frame)
    not_there = zones[len(needed) + len(net) :]
    ceiling_m = limits.maximum_altitude_relative_m
    return MissionNets(
        home=frame.origin,
        needed=(*zones[: len(needed)], *not_there),
        zones=zones[len(needed) :],
        ceiling_m=ceiling_m,
        net_ceiling_m=ceiling_m + CEILING_MARGIN_M,
    )


def _rings(shape: Polygon) -> list[tuple[LinearRing, bool]]:
    """Each with whether one stays inside it."""
    return [(shape.exterior, True), *((hole, False) for hole in shape.interiors)]


def _zones(rings: Sequence[tuple[LinearRing, bool]], frame: LocalFrame) -> tuple[FencePolygon, ...]:
    """All corners at once: one by one, those of 300 no-fly areas would hold up the event loop."""
    corners = [np.asarray(ring.coords)[:-1, :2] for ring, _ in rings]
    places = (Place(lat, lon) for lon, lat in frame.to_lon_lat(np.concatenate(corners)))
    return tuple(
        FencePolygon(tuple(islice(places, len(some))), inside) for some, (_, inside) in zip(corners, rings, strict=True)
    )


def _outwards(outline: Polygon) -> Polygon:
    """Contains the outline with its margin. The hull of a jagged one needs fewer corners, where it is not far off."""
    near = outline.buffer(FARTHEST_M)
    shapes = (outline,) if outline.interiors else (outline, outline.convex_hull)
    for roughness_m in ROUGHNESS_M:
        for shape in shapes:
            grown = _grown(shape, roughness_m)
            if len(grown.exterior.coords) - 1 <= MOST_OUTLINE_CORNERS and near.covers(grown):
                return grown
    return _grown(outline, ROUGHNESS_M[-1])


def _grown(shape: BaseGeometry, roughness_m: float) -> Polygon:
    wide = shape.buffer(MARGIN_M + roughness_m, join_style="mitre", mitre_limit=2.0)
    return max(_polygons(wide.simplify(roughness_m) if roughness_m else wide), key=lambda part: part.area)


def _polygons(shape: BaseGeometry) -> list[Polygon]:
    return [part for part in getattr(shape, "geoms", (shape,)) if isinstance(part, Polygon)]


async def nets_check(vehicle: Vehicle, limits: Limits) -> CheckFact:
    """The line of the checklist: what the start would set, or why it cannot. Sets nothing."""
    try:
        plan = await vehicle.plan_nets(mission_nets(limits))
    except VehicleError as error:
        return CheckFact(name="nets", ok=False, reason=error.reason, blocking=True)
    return CheckFact(name="nets", ok=True, reason=to_set(plan), blocking=True)


def to_set(plan: NetsPlan) -> NetsToSet:
    """What the start would set, in the words of the checklist's row."""
    polygons = [zone for zone in plan.after.zones if isinstance(zone, FencePolygon)]
    after = plan.after.values()
    changes = tuple(
        ParameterToSet(name, value, after[name]) for name, value in plan.before.values().items() if after[name] != value
    )
    return NetsToSet(
        corners=sum(len(zone.corners) for zone in polygons),
        no_fly=sum(not zone.inside for zone in polygons),
        own_zones=len(plan.before.zones),
        changes=changes,
    )
