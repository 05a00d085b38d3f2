"""Pure vetoes between the planner, the operator and the vehicle.

Every rule answers with reasons. They are asked before the start, on every chosen place, and again right before every
command that moves the vehicle. Order: the first veto is the one to show.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Literal

from shapely import LineString, Point, unary_union
from shapely.geometry.base import BaseGeometry

from backend.craft.endurance import Endurance, landing_s, unknown
from backend.craft.way_home import legs_home, way_home
from backend.reasons import Reason, safety
from backend.reasons.safety import Over, What
from backend.search.altitude import level_altitude
from backend.search.area import EDGE_TOLERANCE_M, FAR_M
from backend.search.ground import VERTICAL_TOLERANCE_M, Ground, Way
from backend.search.task import SearchTask
from backend.search.turn_schedule import turn_s
from backend.spec import FlightSpec
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry
from hardware.reasons.vehicle_news import ClockRateOdd, SwitchUndone
from planner.types import Problem

POSITION_STALE_S = 3.0
BATTERY_STALE_S = 30.0
ALTITUDE_TOLERANCE_M = 0.5
"""Of an altitude that went to AMSL and back."""
ROUNDING_M = 0.01


BatteryStage = Literal["return", "last", "land"]
"""It should return; it must return now; it must land where it is."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What the mission allows. Geometries in metres ENU of `frame`, whose origin is the vehicle's home at the start.

    fence: the platform stays inside. no_fly: it neither enters nor crosses these. problem: the planner's, whose ways
    keep clear of what may not be flown. ground: below it all. flight: how high above it, and above home.
    """

    frame: LocalFrame
    fence: BaseGeometry
    no_fly: tuple[BaseGeometry, ...]
    problem: Problem
    ground: Ground
    flight: FlightSpec
    reserve_percent: float
    battery_telemetry: bool
    speed_m_s: float
    measurement_time_s: float

    @property
    def altitude_relative_m(self) -> float:
        """The one to take off to, m above home."""
        return self.flight.altitude_relative_m

    @property
    def minimum_altitude_relative_m(self) -> float:
        """Metres above home."""
        return self.flight.minimum_altitude_relative_m

    @property
    def maximum_altitude_relative_m(self) -> float:
        """Metres above home."""
        return self.flight.maximum_altitude_relative_m

    @property
    def home_amsl_m(self) -> float:
        """As the autopilot says."""
        return self.ground.home_amsl_m


@dataclass(frozen=True, slots=True)
class Situation:
    """The vehicle as last heard, and what flying takes of its battery.

    heard_since_s: when it was heard again after its link had been lost.
    """

    telemetry: Telemetry
    now_s: float
    endurance: Endurance = field(default_factory=unknown)
    heard_since_s: float = -math.inf

    @property
    def position_age_s(self) -> float:
        """Infinite while no position was heard."""
        at = self.telemetry.position_at_s
        return math.inf if at is None else self.now_s - at

    @property
    def battery_unreported_s(self) -> float:
        """How long the vehicle was heard without its battery's charge; the silence of a lost link is not counted."""
        heard, battery = self.telemetry.heard_at_s, self.telemetry.battery_at_s
        return 0.0 if heard is None or battery is None else heard - max(battery, self.heard_since_s)


def battery_to_return_percent(
    limits: Limits, position: Place, endurance: Endurance, altitude_relative_m: float | None = None
) -> float:
    """Charge that the way home from `position` takes, around what may not be flown over, and the landing. The reserve
    is not included. altitude_relative_m: of the vehicle there, None: the one that the way home is flown at."""
    at = limits.frame.to_enu(position)
    legs = legs_home(limits.problem, at)
    returning = _return_altitude_relative_m(limits, at, legs)
    height = returning if altitude_relative_m is None else altitude_relative_m
    climb = returning - height if legs else 0.0
    return endurance.way_percent(legs, limits.speed_m_s, landing_s(height + max(climb, 0.0)), climb)


def _return_altitude_relative_m(limits: Limits, at: tuple[float, float], legs: Way) -> float:
    """The mission's, or as high as the ground of the way home asks."""
    if limits.ground.terrain is None:
        return limits.altitude_relative_m
    way = [at]
    for east, north in legs:
        way.append((way[-1][0] + east, way[-1][1] + north))
    return level_altitude(way, limits.ground, limits.flight) - limits.home_amsl_m


def limits_of(task: SearchTask) -> Limits:
    """From the specification and the home at the start; geometry in the task's own frame."""
    flight = task.mission.flight
    return Limits(
        frame=task.frame,
        fence=task.fence,
        no_fly=task.no_fly,
        problem=task.first.problem,
        ground=task.ground,
        flight=flight,
        reserve_percent=flight.reserve_battery_percent,
        battery_telemetry=flight.battery_telemetry,
        speed_m_s=flight.speed_m_s,
        measurement_time_s=turn_s(task.mission),
    )


def vehicle_vetoes(situation: Situation) -> tuple[Reason, ...]:
    """Is there a vehicle that may be commanded at all?"""
    telemetry, age = situation.telemetry, situation.position_age_s
    authority = telemetry.authority
    found: list[Reason] = []
    if authority.who == "failsafe":
        found.append(safety.FailsafeActs(telemetry.mode or ""))
    elif authority.who == "pilot":
        found.append(safety.PilotControls())
    if not telemetry.connected:
        found.append(safety.NoLink())
    if telemetry.position is None or math.isinf(age) or telemetry.position_lost_since_s is not None:
        found.append(safety.NoPosition())
    elif age > POSITION_STALE_S:
        found.append(safety.PositionOld(age))
    return tuple(found)


def resume_vetoes(telemetry: Telemetry) -> tuple[Reason, ...]:
    """May an operator resume? Not before a pilot has given the vehicle back: any command would take it from them. Where
    one of our orders undid the pilot's switch, the vehicle is in a mode that we chose: selecting that mode again
    reports no change, so the pilot is asked to select their own."""
    authority = telemetry.authority
    if authority.who != "pilot" or authority.given_back:
        return ()
    mode = telemetry.mode or authority.mode or ""
    return (SwitchUndone(mode) if authority.undone else safety.NotGivenBack(mode),)


def battery_vetoes(
    limits: Limits,
    situation: Situation,
    hover_s: float = 0.0,
    legs: Sequence[tuple[float, float]] = (),
    end: Place | None = None,
) -> tuple[Reason, ...]:
    """Would the battery still reach home with the reserve after these legs (east, north m) to `end`, and after so much
    hovering?

    A charge that is not known is no charge, unless the mission says that the vehicle has no battery telemetry.
    """
    telemetry = situation.telemetry
    altitude = telemetry.altitude_relative_m if end is None else None
    end = end or telemetry.position
    if telemetry.battery_percent is None:
        return (safety.BatteryUnknown(),) if limits.battery_telemetry else ()
    if end is None:
        return ()
    if situation.battery_unreported_s > BATTERY_STALE_S:
        return (safety.BatterySilent(),)
    endurance = situation.endurance
    takes = endurance.way_percent(legs, limits.speed_m_s, hover_s) if legs or hover_s else 0.0
    left = telemetry.battery_percent - takes
    needed = battery_to_return_percent(limits, end, endurance, altitude)
    if left - needed >= limits.reserve_percent:
        return ()
    return (safety.BatteryShort(telemetry.battery_percent, left, needed, limits.reserve_percent),)


def take_off_battery_vetoes(limits: Limits, situation: Situation) -> tuple[Reason, ...]:
    """Would a battery on the ground last for one turn and the way home? If not even a full one would, that is said:
    another battery mends nothing then."""
    found = battery_vetoes(limits, situation, limits.measurement_time_s)
    match found:
        case (safety.BatteryShort(charge, left, needed, reserve),) if charge - left + needed + reserve > 100.0:
            return (safety.TurnBeyondBattery(limits.measurement_time_s, charge - left, needed, reserve),)
        case _:
            return found


def start_vetoes(limits: Limits, situation: Situation) -> tuple[Reason, ...]:
    """May a mission take off from where the vehicle stands? Who flew it before is no matter once it is disarmed."""
    telemetry = situation.telemetry
    by_hand = telemetry.armed is False
    found = [v for v in vehicle_vetoes(situation) if not (by_hand and isinstance(v, safety.PilotControls))]
    found += take_off_battery_vetoes(limits, situation)
    if telemetry.in_air:
        found.append(safety.AlreadyInAir())
    found += _altitude_vetoes(limits, limits.altitude_relative_m)
    if telemetry.position is not None:
        at = limits.frame.to_enu(telemetry.position)
        found += _area_vetoes(limits, at, "vehicle_stands") or _enclosed_vetoes(limits, at)
        found += ground_vetoes(limits, [at], level_altitude([at], limits.ground, limits.flight), "take_off")
    return tuple(found)


def staying_vetoes(limits: Limits, situation: Situation) -> tuple[Reason, ...]:
    """May a vehicle in the air go on within these limits from where it is, and come home?"""
    found = _area_vetoes(limits, (0.0, 0.0), "home")
    if situation.telemetry.position is not None:
        at = limits.frame.to_enu(situation.telemetry.position)
        found += _area_vetoes(limits, at, "vehicle")
        if not found and way_home(limits.problem, at) is None:
            found.append(safety.NoWayHome(math.hypot(*at)))
    return tuple(found)


def turn_vetoes(limits: Limits, situation: Situation) -> tuple[Reason, ...]:
    """May the vehicle turn on the spot for one measurement?"""
    rate = situation.telemetry.odd_clock_rate
    undated = () if rate is None else (ClockRateOdd(rate),)
    return (*vehicle_vetoes(situation), *undated, *battery_vetoes(limits, situation, limits.measurement_time_s))


def standing_vetoes(limits: Limits, place: Place, altitude_amsl_m: float) -> tuple[Reason, ...]:
    """May anything fly at `place` at all, wherever the vehicle is?"""
    found = _altitude_vetoes(limits, altitude_amsl_m - limits.home_amsl_m)
    at = limits.frame.to_enu(place)
    if math.hypot(*at) > FAR_M:
        return (*found, safety.TooFarFromHome(math.hypot(*at), FAR_M))
    found += _area_vetoes(limits, at, "place")
    near = min((zone.distance(Point(at)) for zone in limits.no_fly), default=math.inf)
    if near < EDGE_TOLERANCE_M and not any(isinstance(veto, safety.InsideNoFly) for veto in found):
        found.append(safety.NearNoFly(near, EDGE_TOLERANCE_M))
    if not found:
        found += ground_vetoes(limits, [at], altitude_amsl_m, "way_there") or _way_home_vetoes(limits, at)
    return tuple(found)


def place_vetoes(
    limits: Limits,
    situation: Situation,
    place: Place,
    altitude_amsl_m: float,
    way: Sequence[tuple[float, float]] = (),
) -> tuple[Reason, ...]:
    """May the vehicle fly to `place` and measure there? `way`: points in between, m ENU; straight without them."""
    standing = standing_vetoes(limits, place, altitude_amsl_m)
    found: list[Reason] = [*vehicle_vetoes(situation), *standing]
    position = situation.telemetry.position
    if position is not None and not any(isinstance(veto, safety.TooFarFromHome) for veto in standing):
        points = [limits.frame.to_enu(position), *way, limits.frame.to_enu(place)]
        path = LineString(points)
        if not found:
            found += _path_vetoes(limits, path) or ground_vetoes(limits, points, altitude_amsl_m, "way_there")
        legs = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
        found += battery_vetoes(limits, situation, limits.measurement_time_s, legs, place)
    return tuple(found)


def return_vetoes(
    limits: Limits, situation: Situation, way: Sequence[tuple[float, float]], altitude_amsl_m: float
) -> tuple[Reason, ...]:
    """May the vehicle fly home along `way` (m ENU, home last)? Battery is no reason against it, the ground is asked of
    with `ground_return_vetoes`.

    A vehicle that is where it may not be may leave: its first leg is held against the other zones only.
    """
    found = [*vehicle_vetoes(situation), *_altitude_vetoes(limits, altitude_amsl_m - limits.home_amsl_m)]
    position = situation.telemetry.position
    if found or position is None or not way:
        return tuple(found)
    here = limits.frame.to_enu(position)
    outside = limits.fence.distance(Point(here)) > EDGE_TOLERANCE_M
    inside = [zone.contains(Point(here)) for zone in limits.no_fly]
    if not (outside or any(inside)):
        return tuple(_path_vetoes(limits, LineString([here, *way])))
    leaving = LineString([here, way[0]])
    out = replace(
        limits,
        fence=unary_union([limits.fence, leaving.buffer(EDGE_TOLERANCE_M)]) if outside else limits.fence,
        no_fly=tuple(zone for zone, within in zip(limits.no_fly, inside, strict=True) if not within),
    )
    found += _path_vetoes(out, leaving)
    if len(way) > 1:
        found += _path_vetoes(limits, LineString(way))
    return tuple(found)


def ground_vetoes(limits: Limits, way: Way, altitude_amsl_m: float, where: Over) -> tuple[Reason, ...]:
    """Does a way (m ENU) flown level keep clearance and ceiling above the ground, at worst within tolerance?

    Without terrain nothing is known against it: the band above home holds.
    """
    if limits.ground.terrain is None:
        return ()
    below = limits.ground.below(way)
    if below is None:
        return (safety.GroundUnknown(where),)
    flight, relative = limits.flight, altitude_amsl_m - limits.home_amsl_m
    clearance = altitude_amsl_m - VERTICAL_TOLERANCE_M - below.highest_m
    height = altitude_amsl_m + VERTICAL_TOLERANCE_M - below.lowest_m
    found: list[Reason] = []
    if clearance < flight.minimum_clearance_m - ROUNDING_M:
        found.append(safety.ClearanceShort(where, relative, clearance, flight.minimum_clearance_m))
    if height > flight.maximum_above_ground_m + ROUNDING_M:
        found.append(safety.TooHighAboveGround(where, relative, height, flight.maximum_above_ground_m))
    return tuple(found)


def ground_return_vetoes(limits: Limits, way: Way, altitude_amsl_m: float) -> tuple[Reason, ...]:
    """Does a level way home (m ENU, from the vehicle on) keep its clearance?

    The ceiling above ground is no reason against it. No place is chosen from which the straight way home breaks it
    (`standing_vetoes`); a vehicle that is at one all the same, a pilot's doing or a detour around a no-fly area, must
    come home, and `level_altitude` gives the lowest way that clears the ground. Were that refused, the autopilot would
    fly its own return: straight, no lower than it is, around nothing.
    """
    found = ground_vetoes(limits, way, altitude_amsl_m, "way_home")
    return tuple(veto for veto in found if not isinstance(veto, safety.TooHighAboveGround))


def _way_home_vetoes(limits: Limits, at: tuple[float, float]) -> tuple[Reason, ...]:
    """From a place that is left for home there is one level way, around no-fly areas, that may be flown. Where no way
    leads around, the autopilot returns straight."""
    if limits.ground.terrain is None:
        return ()
    way = [at, *(way_home(limits.problem, at) or ((0.0, 0.0),))]
    altitude = level_altitude(way, limits.ground, limits.flight)
    highest = limits.home_amsl_m + limits.flight.maximum_altitude_relative_m
    found = ground_vetoes(limits, way, altitude, "way_home")
    if found or altitude <= highest + ALTITUDE_TOLERANCE_M:
        return found
    clearance = limits.flight.minimum_clearance_m - (altitude - highest)
    relative = highest - limits.home_amsl_m
    return (safety.ClearanceShort("way_home", relative, clearance, limits.flight.minimum_clearance_m),)


def _altitude_vetoes(limits: Limits, relative_m: float) -> list[Reason]:
    low, high = limits.minimum_altitude_relative_m, limits.maximum_altitude_relative_m
    if low - ALTITUDE_TOLERANCE_M <= relative_m <= high + ALTITUDE_TOLERANCE_M:
        return []
    return [safety.AltitudeOutside(relative_m, low, high)]


def _area_vetoes(limits: Limits, at: tuple[float, float], what: What) -> list[Reason]:
    point = Point(at)
    found: list[Reason] = []
    beyond = limits.fence.distance(point)
    if beyond > EDGE_TOLERANCE_M:
        found.append(safety.OutsideFence(what, beyond))
    if any(zone.contains(point) for zone in limits.no_fly):
        found.append(safety.InsideNoFly(what))
    return found


def _enclosed_vetoes(limits: Limits, at: tuple[float, float]) -> list[Reason]:
    """No-fly zones that enclose the vehicle, a ring of walls or a zone with a hole, let it take off and go nowhere."""
    return [] if way_home(limits.problem, at) is not None else [safety.InsideNoFly("vehicle_stands")]


def _path_vetoes(limits: Limits, path: LineString) -> list[Reason]:
    found: list[Reason] = []
    if not limits.fence.buffer(EDGE_TOLERANCE_M).covers(path):
        found.append(safety.WayLeavesFence())
    flown = path.difference(Point(path.coords[0]).buffer(EDGE_TOLERANCE_M))
    if any(flown.intersection(zone).length > 0.0 for zone in limits.no_fly):
        found.append(safety.WayCrossesNoFly())
    return found
