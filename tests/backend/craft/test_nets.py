from __future__ import annotations

import math
from dataclasses import replace
from unittest.mock import Mock

import pymap3d
import pytest
from equipment import FRAME, FlatVehicle, spec
from shapely import MultiPolygon, Point, Polygon, box

from backend.craft.nets import CEILING_MARGIN_M, MARGIN_M, MOST_OUTLINE_CORNERS, mission_nets, nets_check
from backend.craft.safety import Limits, limits_of
from backend.search.task import search_task
from hardware.clock import ScaledClock
from hardware.fence import FencePolygon
from hardware.reasons.nets import NetsToSet, ParameterToSet

ANGLES = [turn / 20 for turn in range(125)]
JAGGED = Polygon([(math.cos(a) * (100 + 20 * (i % 2)), math.sin(a) * 100) for i, a in enumerate(ANGLES)])


def limits() -> Limits:
    home = FRAME.origin
    return limits_of(search_task(spec(), home, 100.0))


def shape(zone: FencePolygon) -> Polygon:
    return Polygon([FRAME.to_enu(corner) for corner in zone.corners])


@pytest.mark.parametrize(
    "fence",
    [
        box(-100.0, -100.0, 100.0, 100.0),
        box(-100.0, -100.0, 100.0, 100.0).buffer(60.0, quad_segs=64),
        Point(0.0, 0.0).buffer(300.0, quad_segs=128),
        JAGGED,
    ],
)
def test_the_net_hangs_outside_the_fence_with_few_corners(fence: Polygon) -> None:
    wanted = mission_nets(replace(limits(), fence=fence.buffer(0.0)))
    (zone,) = wanted.zones
    assert zone.inside
    assert len(zone.corners) <= MOST_OUTLINE_CORNERS
    assert shape(zone).buffer(0.01).covers(fence.buffer(0.0).buffer(MARGIN_M, quad_segs=64))
    assert fence.buffer(4.0 * MARGIN_M).covers(shape(zone))
    assert wanted.ceiling_m == limits().maximum_altitude_relative_m
    assert wanted.net_ceiling_m == wanted.ceiling_m + CEILING_MARGIN_M


def test_holes_and_no_fly_areas_are_to_be_kept_out_of_and_what_lies_elsewhere_is_left_away() -> None:
    fence = MultiPolygon(
        [box(-100, -100, 100, 100).difference(box(20, 20, 60, 60)), box(500, 500, 600, 600)]  # pyright: ignore
    )
    no_fly = (box(-50.0, -50.0, -30.0, -30.0), box(5_000.0, 0.0, 5_100.0, 50.0))
    wanted = mission_nets(replace(limits(), fence=fence, no_fly=no_fly))
    outline, hole, zone = wanted.zones
    assert (outline.inside, hole.inside, zone.inside) == (True, False, False)
    assert shape(hole).symmetric_difference(box(25, 25, 55, 55)).area < 1.0
    assert shape(zone).symmetric_difference(no_fly[0]).area < 0.1


def test_the_corners_of_hundreds_of_no_fly_areas_are_turned_into_degrees_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One by one they held up the event loop for a quarter of a second."""
    turned = Mock(side_effect=pymap3d.enu2geodetic)
    centres = [(x, y) for x in range(-95, 95, 11) for y in range(-95, 95, 11)]
    no_fly = tuple(Point(centre).buffer(4.0) for centre in centres)
    allowed = replace(limits(), fence=box(-100.0, -100.0, 100.0, 100.0), no_fly=no_fly)
    monkeypatch.setattr(pymap3d, "enu2geodetic", turned)
    wanted = mission_nets(allowed)
    assert turned.call_count == 1, "for what is needed and for the net"
    assert len(wanted.zones) == 1 + len(no_fly)
    assert wanted.needed[1:] == wanted.zones[1:]
    for zone, drawn in zip(wanted.zones[1:], no_fly, strict=True):
        assert len(zone.corners) == len(drawn.exterior.coords) - 1
        assert shape(zone).hausdorff_distance(drawn) < 1e-6


async def test_the_checklist_says_what_the_start_would_set() -> None:
    vehicle = FlatVehicle(ScaledClock(factor=50.0))
    check = await nets_check(vehicle, limits())
    assert check.ok
    assert isinstance(check.reason, NetsToSet)
    ceiling = limits().maximum_altitude_relative_m + CEILING_MARGIN_M
    assert check.reason.changes == (ParameterToSet("CEILING", 0.0, ceiling),)
    assert vehicle.nets_set == []
