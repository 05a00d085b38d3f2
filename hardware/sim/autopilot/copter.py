"""The flying body: a multicopter that follows a demand as fast as its accelerations, rates and battery allow.

Pure: `step(dt, demand)` advances it, nothing reads a clock. Frame: north, east, up in metres from home; heading in
degrees clockwise from true north, unwrapped (it counts turns), so that a whole turn is a demand like any other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from random import Random


@dataclass(frozen=True, slots=True)
class Airframe:
    """What the vehicle can do. Speeds m/s, accelerations m/s^2, yaw deg/s and deg/s^2, power W, energy Wh."""

    acceleration: float = 2.5
    climb_acceleration: float = 2.0
    yaw_acceleration: float = 90.0
    hover_power: float = 220.0
    drag_power: float = 0.25  # W per (m/s)^3 of airspeed
    idle_power: float = 8.0
    capacity: float = 89.0
    velocity_time: float = 0.4  # s, time constant of the velocity controller
    gust_response: float = 0.3  # m/s^2 of push from one m/s of gust
    airspeed: float = 14.0  # m/s, as fast as it leans for
    rotor_drag: float = 0.12  # m/s^2 per m/s of airspeed
    body_drag: float = 0.012  # m/s^2 per (m/s)^2


@dataclass(frozen=True, slots=True)
class Wind:
    """Steady wind (blowing *from* `from_deg`) and gusts, an Ornstein-Uhlenbeck process a horizontal axis."""

    speed: float = 0.0
    from_deg: float = 0.0
    gust_sigma: float = 0.0
    gust_time: float = 4.0


@dataclass(slots=True)
class Demand:
    """Where to be. Either a place (north, east, up) with speed limits, or `velocity` when a pilot holds the sticks.

    heading: unwrapped degrees to turn to at no more than `yaw_rate_limit` deg/s; `yaw_rate` overrides it (sticks).
    creeps_m: nearer than this to the place it only creeps.
    """

    north: float
    east: float
    up: float
    heading: float
    speed: float = 5.0
    climb: float = 3.0
    descend: float = 1.5
    yaw_rate_limit: float = 45.0
    velocity: tuple[float, float, float] | None = None
    yaw_rate: float | None = None
    creeps_m: float = 0.0


CREEP_M_S = 0.25


class Copter:
    """State of the body. Everything public is truth, not what its sensors say."""

    def __init__(self, airframe: Airframe, wind: Wind, rng: Random, heading_deg: float = 0.0) -> None:
        self.airframe = airframe
        self.wind = wind
        self.north = self.east = self.up = 0.0
        self.v_north = self.v_east = self.v_up = 0.0
        self.heading = heading_deg
        self.yaw_rate = 0.0
        self.energy = airframe.capacity
        self.power = airframe.idle_power
        self.push_north = self.push_east = 0.0
        """m/s^2, what of the thrust is horizontal: it speeds the body up and overcomes the drag."""
        self._rng = rng
        self._gust_north = self._gust_east = 0.0
        self._wind_north = self._wind_east = 0.0
        self.turn_wind(wind.from_deg)

    def turn_wind(self, from_deg: float) -> None:
        """It blows from elsewhere now, as fast as before."""
        blows_to = math.radians(from_deg + 180.0)
        self._wind_north = self.wind.speed * math.cos(blows_to)
        self._wind_east = self.wind.speed * math.sin(blows_to)

    @property
    def on_ground(self) -> bool:
        """The ground is flat, at home's height."""
        return self.up <= 0.0

    @property
    def battery_percent(self) -> float:
        """Of the energy left, not of a voltage."""
        return 100.0 * max(0.0, self.energy) / self.airframe.capacity

    def step(self, dt: float, demand: Demand | None, error: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """Advance by dt seconds. demand None: motors off. error: what the navigation errs by (estimate - truth, m)."""
        if demand is None:
            self.push_north = self.push_east = 0.0
            self._fall(dt)
            self._drain(dt, self.airframe.idle_power)
            return
        self._blow(dt)
        self._yaw(dt, demand)
        before_n, before_e = self.v_north, self.v_east
        self._translate(dt, demand, error)
        air_n, air_e = self.v_north - self._wind_north, self.v_east - self._wind_east
        airspeed = math.sqrt(air_n * air_n + air_e * air_e)
        drag = self.airframe.rotor_drag + self.airframe.body_drag * airspeed
        self.push_north = (self.v_north - before_n) / dt + drag * air_n if self.up > 0.0 else 0.0
        self.push_east = (self.v_east - before_e) / dt + drag * air_e if self.up > 0.0 else 0.0
        lift = 1.0 + 0.06 * self.v_up if self.up > 0.0 else 0.3
        self._drain(dt, self.airframe.hover_power * lift + self.airframe.drag_power * airspeed**3)

    def _drain(self, dt: float, power: float) -> None:
        self.power = power
        self.energy -= power * dt / 3600.0

    def _fall(self, dt: float) -> None:
        self.yaw_rate = 0.0
        if self.up <= 0.0:
            self.up = self.v_north = self.v_east = self.v_up = 0.0
            return
        self.v_up -= 9.81 * dt
        self.up = max(0.0, self.up + self.v_up * dt)

    def _blow(self, dt: float) -> None:
        sigma, tau = self.wind.gust_sigma, self.wind.gust_time
        if sigma > 0.0:
            kick = sigma * math.sqrt(2.0 * dt / tau)  # dg = -g dt / tau + sigma sqrt(2 dt / tau) w
            self._gust_north += -self._gust_north * dt / tau + kick * self._rng.gauss(0.0, 1.0)
            self._gust_east += -self._gust_east * dt / tau + kick * self._rng.gauss(0.0, 1.0)

    def _yaw(self, dt: float, demand: Demand) -> None:
        accel = self.airframe.yaw_acceleration
        if demand.yaw_rate is not None:
            wanted = demand.yaw_rate
        else:
            left = demand.heading - self.heading
            fastest = min(demand.yaw_rate_limit, math.sqrt(1.6 * accel * abs(left)), 4.0 * abs(left))
            wanted = math.copysign(fastest, left)
        change = max(-accel * dt, min(accel * dt, wanted - self.yaw_rate))
        self.yaw_rate += change
        self.heading += self.yaw_rate * dt

    def _translate(self, dt: float, demand: Demand, error: tuple[float, float, float]) -> None:
        if demand.velocity is not None:
            want_n, want_e, want_u = demand.velocity
        else:
            d_n = demand.north - error[0] - self.north
            d_e = demand.east - error[1] - self.east
            d_u = demand.up - error[2] - self.up
            distance = math.sqrt(d_n * d_n + d_e * d_e)
            # v = sqrt(2 a d) brakes in time; linear near the target so that it settles
            before = max(0.0, distance - demand.creeps_m)
            speed = min(demand.speed, math.sqrt(1.4 * self.airframe.acceleration * before), 0.9 * before)
            speed = max(speed, min(CREEP_M_S, 0.9 * distance))
            scale = speed / distance if distance > 1e-6 else 0.0
            want_n, want_e = d_n * scale, d_e * scale
            climb = min(math.sqrt(1.4 * self.airframe.climb_acceleration * abs(d_u)), 0.9 * abs(d_u))
            want_u = min(climb, demand.climb) if d_u >= 0 else -min(climb, demand.descend)
        want_n, want_e = self._within_airspeed(want_n, want_e)
        push = self.airframe.gust_response
        share = min(1.0, dt / self.airframe.velocity_time)
        a_n, a_e = (want_n - self.v_north) * share, (want_e - self.v_east) * share
        size, most = math.sqrt(a_n * a_n + a_e * a_e), self.airframe.acceleration * dt
        if size > most:
            a_n, a_e = a_n * most / size, a_e * most / size
        a_u = max(
            -self.airframe.climb_acceleration * dt, min(self.airframe.climb_acceleration * dt, want_u - self.v_up)
        )
        if self.up <= 0.0 and want_u <= 0.0:
            self.v_north = self.v_east = self.v_up = 0.0
            self.up = 0.0
            return
        self.v_north += a_n + push * self._gust_north * dt
        self.v_east += a_e + push * self._gust_east * dt
        self.v_up += a_u
        self.north += self.v_north * dt
        self.east += self.v_east * dt
        self.up += self.v_up * dt
        if self.up <= 0.0:
            self.up = 0.0
            self.v_north = self.v_east = self.v_up = 0.0

    def _within_airspeed(self, want_n: float, want_e: float) -> tuple[float, float]:
        """The velocity over the ground nearest to the wanted one that its airspeed allows: more wind carries it off."""
        air_n, air_e = want_n - self._wind_north, want_e - self._wind_east
        airspeed = math.sqrt(air_n * air_n + air_e * air_e)
        if airspeed <= self.airframe.airspeed:
            return want_n, want_e
        share = self.airframe.airspeed / airspeed
        return self._wind_north + share * air_n, self._wind_east + share * air_e
