from __future__ import annotations

import pytest

from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.dialect import Dialect
from hardware.autopilot.fence_plan import plan_nets
from hardware.autopilot.px4 import PX4
from hardware.fence import FenceCircle, FencePolygon, FenceZone, MissionNets, Nets, ParameterValue
from hardware.frame import LocalFrame
from hardware.ports import VehicleError
from hardware.readings import Place
from hardware.reasons.nets import FenceTooDetailed, OwnCeilingLower, OwnFenceTighter

HOME = Place(47.0, 8.0)
FRAME = LocalFrame(HOME)
PX4_OPEN = {"GF_ACTION": 3.0, "GF_MAX_HOR_DIST": 0.0, "GF_MAX_VER_DIST": 0.0}
SHIPPED = {"FENCE_TYPE": 7.0, "FENCE_ALT_MAX": 100.0, "FENCE_RADIUS": 300.0, "FENCE_OPTIONS": 1.0, "FENCE_ENABLE": 0.0}
ENABLED = SHIPPED | {"FENCE_ENABLE": 1.0}


def square(half_m: float, inside: bool = True, east: float = 0.0) -> FencePolygon:
    corners = ((-half_m, -half_m), (half_m, -half_m), (half_m, half_m), (-half_m, half_m))
    return FencePolygon(tuple(FRAME.to_geo(east + x, y) for x, y in corners), inside)


def nets(values: dict[str, float], *zones: FenceZone) -> Nets:
    return Nets(zones, tuple(ParameterValue(name, value) for name, value in values.items()))


def mission(half_m: float = 100.0, ceiling_m: float = 43.0, *more: FencePolygon) -> MissionNets:
    return MissionNets(HOME, (square(half_m), *more), (square(half_m + 5.0), *more), ceiling_m, ceiling_m + 3.0)


def refusal(dialect: Dialect, present: Nets, wanted: MissionNets) -> object:
    with pytest.raises(VehicleError) as refused:
        plan_nets(dialect, present, wanted)
    return refused.value.reason


def test_what_the_mission_needs_is_put_in_force_and_nothing_else_is_touched() -> None:
    plan = plan_nets(PX4, nets(PX4_OPEN), mission())
    assert plan.after.values() == PX4_OPEN | {"GF_MAX_VER_DIST": 46.0}
    plan = plan_nets(ARDUPILOT, nets(SHIPPED), mission())
    assert plan.after.values() == SHIPPED | {"FENCE_TYPE": 5.0, "FENCE_ALT_MAX": 46.0, "FENCE_ENABLE": 1.0}
    plan = plan_nets(ARDUPILOT, nets(ENABLED), mission())
    assert plan.after.values() == ENABLED | {"FENCE_TYPE": 7.0, "FENCE_ALT_MAX": 46.0}


def test_a_ceiling_of_the_owner_below_the_missions_refuses() -> None:
    """A mission at 40 m with GF_MAX_VER_DIST 30 used to pass."""
    low = nets(PX4_OPEN | {"GF_MAX_VER_DIST": 30.0})
    assert refusal(PX4, low, mission()) == OwnCeilingLower("GF_MAX_VER_DIST", 30.0, 43.0)
    assert refusal(ARDUPILOT, nets(ENABLED), mission(ceiling_m=123.0)) == OwnCeilingLower("FENCE_ALT_MAX", 100.0, 123.0)
    plan_nets(ARDUPILOT, nets(SHIPPED), mission(ceiling_m=123.0))  # not enabled: no limit of the owner's


@pytest.mark.parametrize("dialect", [PX4, ARDUPILOT])
@pytest.mark.parametrize(
    ("own", "tighter"),
    [
        ((square(90.0),), True),
        ((square(110.0),), False),
        ((square(100.0),), False),
        ((square(200.0), square(10.0, inside=False)), True),
        ((square(10.0, inside=False, east=300.0),), False),
        ((FenceCircle(HOME, 120.0, True),), True),
        ((FenceCircle(HOME, 150.0, True),), False),
        ((FenceCircle(FRAME.to_geo(0.0, 120.0), 30.0, False),), True),
    ],
)
def test_the_missions_fence_must_lie_inside_the_owners(
    dialect: Dialect, own: tuple[FenceZone, ...], tighter: bool
) -> None:
    present = nets(PX4_OPEN if dialect is PX4 else ENABLED, *own)
    if tighter:
        assert isinstance(refusal(dialect, present, mission()), OwnFenceTighter)
    else:
        assert plan_nets(dialect, present, mission()).before == present


def test_the_net_is_cut_to_the_owners_fence_and_never_loosens_it() -> None:
    own = nets(PX4_OPEN | {"GF_MAX_VER_DIST": 44.0}, square(102.0))
    plan = plan_nets(PX4, own, mission())
    (zone,) = plan.after.zones
    assert isinstance(zone, FencePolygon)
    reach = [abs(metres) for corner in zone.corners for metres in FRAME.to_enu(corner)]
    assert reach == pytest.approx([102.0] * 8, abs=0.05)
    assert plan.after.values()["GF_MAX_VER_DIST"] == 44.0


def test_a_vehicle_stays_inside_all_zones_unless_one_is_said_to_be_enough() -> None:
    both = (square(200.0), square(50.0))
    assert isinstance(refusal(PX4, nets(PX4_OPEN, *both), mission()), OwnFenceTighter)
    assert isinstance(refusal(ARDUPILOT, nets(ENABLED, *both), mission()), OwnFenceTighter)
    plan_nets(ARDUPILOT, nets(ENABLED | {"FENCE_OPTIONS": 3.0}, *both), mission())


def test_the_owners_circle_around_home_bounds_the_mission() -> None:
    far = mission(half_m=250.0)
    assert isinstance(refusal(ARDUPILOT, nets(ENABLED), far), OwnFenceTighter)
    plan_nets(ARDUPILOT, nets(SHIPPED), far)
    assert isinstance(refusal(PX4, nets(PX4_OPEN | {"GF_MAX_HOR_DIST": 200.0}), far), OwnFenceTighter)


def test_a_fence_that_nobody_watches_is_no_limit() -> None:
    for dialect, unwatched in (
        (PX4, nets(PX4_OPEN | {"GF_ACTION": 0.0}, square(10.0))),
        (ARDUPILOT, nets(ENABLED | {"FENCE_TYPE": 3.0}, square(10.0))),
    ):
        planned = plan_nets(dialect, unwatched, mission())
        assert planned.before == unwatched
        assert square(10.0) not in planned.after.zones


def test_more_corners_than_the_autopilot_holds_are_refused() -> None:
    many = mission(100.0, 43.0, *(square(1.0, inside=False, east=float(x)) for x in range(-60, 60, 6)))
    assert refusal(PX4, nets(PX4_OPEN), many) == FenceTooDetailed(84, 60)
