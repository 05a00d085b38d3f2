"""Pure vetoes between the planner, the operator and the vehicle.

Every rule answers with what is wrong and how to mend it. They are asked before the start, on every chosen place, and
again right before every command that moves the vehicle. Order: the first veto is the one to show.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from hardware.frame import LocalFrame
from hardware.readings import GeoPoint, Telemetry

POSITION_STALE_S = 3.0
BATTERY_STALE_S = 30.0
EDGE_TOLERANCE_M = 2.0
"""A hovering vehicle wanders about so much: its own place is judged with this much mercy at the edges of fence and
no-fly zones, and no place to measure at is nearer to a zone."""

FAR_M = 5_000.0
"""Beyond this the local tangent plane is no longer true to a metre, and a place is more likely a mistake."""

LANDING_S = 60.0
NOMINAL_DRAIN_PERCENT_S = 100.0 / 1_200.0
"""Battery a second in the air until it has been measured: twenty minutes from full to empty."""


@dataclass(frozen=True, slots=True)
class Veto:
    rule: str
    detail: str
    remedy: str


@dataclass(frozen=True, slots=True)
class Limits:
    """What the mission allows. Geometries in metres ENU of `frame`, whose origin is the vehicle's home at the start.

    fence: the platform stays inside. no_fly: it neither enters nor crosses these. Altitudes relative to home, m.
    """

    frame: LocalFrame
    fence: BaseGeometry
    no_fly: tuple[BaseGeometry, ...]
    minimum_altitude_relative_m: float
    maximum_altitude_relative_m: float
    home_amsl_m: float
    reserve_percent: float
    battery_telemetry: bool
    speed_m_s: float
    measurement_time_s: float


@dataclass(frozen=True, slots=True)
class Situation:
    """The vehicle as last heard, and how fast its battery drains (percent a second of flight).

    heard_since_s: when it was heard again after its link had been lost. failsafe_flies: the autopilot acts by itself;
    no pilot does.
    """

    telemetry: Telemetry
    now_s: float
    drain_percent_s: float = NOMINAL_DRAIN_PERCENT_S
    heard_since_s: float = -math.inf
    failsafe_flies: bool = False

    @property
    def position_age_s(self) -> float:
        """Infinite while no position was heard."""
        at = self.telemetry.position_at_s
        return math.inf if at is None else self.now_s - at

    @property
    def battery_unreported_s(self) -> float:
        """So long the vehicle was heard without its battery's charge; the silence of a lost link is not counted."""
        heard, battery = self.telemetry.heard_at_s, self.telemetry.battery_at_s
        return 0.0 if heard is None or battery is None else heard - max(battery, self.heard_since_s)


def battery_to_return_percent(limits: Limits, position: GeoPoint, drain_percent_s: float) -> float:
    """Charge that the flight home from `position` and the landing take, reserve not included."""
    east, north = limits.frame.to_enu(position)
    return drain_percent_s * (math.hypot(east, north) / limits.speed_m_s + LANDING_S)


def vehicle_vetoes(situation: Situation) -> tuple[Veto, ...]:
    """Is there a vehicle that may be commanded at all?"""
    telemetry, age = situation.telemetry, situation.position_age_s
    found = []
    if situation.failsafe_flies:
        detail = f"the autopilot acts by itself: {telemetry.mode}"
        found.append(Veto("failsafe", detail, "hold or resume first"))
    elif telemetry.controller == "pilot":
        found.append(
            Veto("pilot", "the pilot has control of the vehicle", "resume when the pilot has given control back")
        )
    if not telemetry.connected:
        found.append(
            Veto("link", "the link to the vehicle is lost", "restore the link; the autopilot's failsafe acts meanwhile")
        )
    if telemetry.position is None or math.isinf(age):
        found.append(Veto("position", "the vehicle has no position", "wait for a GPS fix"))
    elif age > POSITION_STALE_S:
        found.append(
            Veto("position", f"the vehicle's position is {age:.1f} s old", "wait until telemetry arrives again")
        )
    return tuple(found)


def resume_vetoes(telemetry: Telemetry, tolerated_mode: str | None = None) -> tuple[Veto, ...]:
    """May an operator resume? Not before a pilot has given the vehicle back: any command would take it from him.

    tolerated_mode: the autopilot's own return or landing that began while nobody listened; no pilot's.
    """
    if not telemetry.held_by_pilot or (tolerated_mode is not None and telemetry.mode == tolerated_mode):
        return ()
    detail = f"the pilot has not given control back: the vehicle is still in {telemetry.mode or 'a mode of his'}"
    remedy = "the pilot selects HOLD (PX4) or BRAKE or GUIDED (ArduPilot) on his transmitter, then resume"
    return (Veto("pilot", detail, remedy),)


def battery_vetoes(
    limits: Limits, situation: Situation, flight_s: float = 0.0, end: GeoPoint | None = None
) -> tuple[Veto, ...]:
    """Would the battery still reach home with the reserve after `flight_s` more seconds that end at `end`?

    A charge that is not known is no charge, unless the mission says that the vehicle has no battery telemetry.
    """
    telemetry = situation.telemetry
    end = end or telemetry.position
    if telemetry.battery_percent is None:
        if not limits.battery_telemetry:
            return ()
        remedy = "set up the battery monitor; or say in the mission that this vehicle reports no battery"
        return (Veto("battery_unknown", "the vehicle does not report its battery", remedy),)
    if end is None:
        return ()
    if situation.battery_unreported_s > BATTERY_STALE_S:
        return (Veto("battery_stale", "the battery's charge is no longer reported", "check the battery monitor"),)
    left = telemetry.battery_percent - situation.drain_percent_s * flight_s
    needed = battery_to_return_percent(limits, end, situation.drain_percent_s)
    if left - needed >= limits.reserve_percent:
        return ()
    return (
        Veto(
            "battery",
            f"{telemetry.battery_percent:.0f} % battery: {left:.0f} % would be left, the way home takes {needed:.0f} %,"
            f" the reserve is {limits.reserve_percent:.0f} %",
            "return home and change the battery",
        ),
    )


def start_vetoes(limits: Limits, situation: Situation) -> tuple[Veto, ...]:
    """May a mission take off from where the vehicle stands? Who flew it before is no matter once it is disarmed."""
    telemetry = situation.telemetry
    found = [veto for veto in vehicle_vetoes(situation) if veto.rule != "pilot" or telemetry.armed is not False]
    found += battery_vetoes(limits, situation, limits.measurement_time_s)
    if telemetry.in_air:
        found.append(Veto("ground", "the vehicle is already in the air", "land it; a mission starts on the ground"))
    if telemetry.position is not None:
        found += _area_vetoes(limits, limits.frame.to_enu(telemetry.position), "the vehicle stands")
    return tuple(found)


def staying_vetoes(limits: Limits, situation: Situation) -> tuple[Veto, ...]:
    """May a vehicle in the air go on within these limits from where it is, and come home?"""
    remedy = "draw the fence around the vehicle and its home, and the no-fly zones beside them"
    found = _area_vetoes(limits, (0.0, 0.0), "home is")
    if situation.telemetry.position is not None:
        found += _area_vetoes(limits, limits.frame.to_enu(situation.telemetry.position), "the vehicle is")
    return tuple(replace(veto, remedy=remedy) for veto in found)


def turn_vetoes(limits: Limits, situation: Situation) -> tuple[Veto, ...]:
    """May the vehicle turn on the spot for one measurement?"""
    return (*vehicle_vetoes(situation), *battery_vetoes(limits, situation, limits.measurement_time_s))


def standing_vetoes(limits: Limits, place: GeoPoint, altitude_amsl_m: float) -> tuple[Veto, ...]:
    """May anything fly at `place` at all, wherever the vehicle is?"""
    found = []
    relative = altitude_amsl_m - limits.home_amsl_m
    low, high = limits.minimum_altitude_relative_m, limits.maximum_altitude_relative_m
    if not low - 0.5 <= relative <= high + 0.5:
        found.append(
            Veto(
                "altitude",
                f"{relative:.0f} m above home is outside the allowed {low:.0f} to {high:.0f} m",
                "change the mission's altitude or its band",
            )
        )
    at = limits.frame.to_enu(place)
    if math.hypot(*at) > FAR_M:
        detail = f"the place is {math.hypot(*at) / 1000:.1f} km from home, more than {FAR_M / 1000:.0f} km"
        return (*found, Veto("distance", detail, "choose a place nearer to home"))
    found += _area_vetoes(limits, at, "the place is")
    near = min((zone.distance(Point(at)) for zone in limits.no_fly), default=math.inf)
    if near < EDGE_TOLERANCE_M and "no_fly" not in [veto.rule for veto in found]:
        detail = f"the place is {near:.1f} m from a no-fly zone, and a hovering vehicle wanders"
        found.append(Veto("no_fly", detail, f"choose a place {EDGE_TOLERANCE_M:.0f} m or more from the zone"))
    return tuple(found)


def place_vetoes(
    limits: Limits,
    situation: Situation,
    place: GeoPoint,
    altitude_amsl_m: float,
    way: Sequence[tuple[float, float]] = (),
) -> tuple[Veto, ...]:
    """May the vehicle fly to `place` and measure there? `way`: points in between, m ENU; straight without them."""
    standing = standing_vetoes(limits, place, altitude_amsl_m)
    found = [*vehicle_vetoes(situation), *standing]
    position = situation.telemetry.position
    if position is not None and "distance" not in [veto.rule for veto in standing]:
        path = LineString([limits.frame.to_enu(position), *way, limits.frame.to_enu(place)])
        if not found:
            found += _path_vetoes(limits, path)
        flight_s = path.length / limits.speed_m_s + limits.measurement_time_s
        found += battery_vetoes(limits, situation, flight_s, place)
    return tuple(found)


def _area_vetoes(limits: Limits, at: tuple[float, float], what: str) -> list[Veto]:
    point = Point(at)
    found = []
    beyond = limits.fence.distance(point)
    if beyond > EDGE_TOLERANCE_M:
        found.append(
            Veto("fence", f"{what} {beyond:.0f} m outside the fence", "choose a place inside, or widen the fence")
        )
    if any(zone.contains(point) for zone in limits.no_fly):
        found.append(Veto("no_fly", f"{what} inside a no-fly zone", "choose a place outside the zone"))
    return found


def _path_vetoes(limits: Limits, path: LineString) -> list[Veto]:
    found = []
    if not limits.fence.buffer(EDGE_TOLERANCE_M).covers(path):
        found.append(
            Veto(
                "fence",
                "the way there leaves the fence",
                "fly by way of a place in between",
            )
        )
    flown = path.difference(Point(path.coords[0]).buffer(EDGE_TOLERANCE_M))
    if any(flown.intersection(zone).length > 0.0 for zone in limits.no_fly):
        found.append(Veto("no_fly", "the way there crosses a no-fly zone", "fly by way of a place beside the zone"))
    return found
