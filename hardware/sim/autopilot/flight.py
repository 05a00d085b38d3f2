"""Flight tasks: take off, fly to a place, return, land, follow the pilot's sticks. The same for every firmware."""

from __future__ import annotations

import math
from typing import Literal

from hardware.sim.autopilot.copter import Copter, Demand
from hardware.sim.autopilot.sensors import Navigation

Task = Literal["idle", "take_off", "fly", "return", "land", "sticks"]
MOVES_M_S = 1.0


class Flight:
    """Turns a task into demands. Places are in the navigation's estimate, as an autopilot knows no truth."""

    def __init__(self, copter: Copter, navigation: Navigation) -> None:
        self.copter = copter
        self.navigation = navigation
        self.armed = False
        self.task: Task = "idle"
        self.grounded_for = 0.0
        self.demand = Demand(0.0, 0.0, 0.0, copter.heading)
        self._return_up = 0.0
        self._return_leg: Literal["climb", "home", "loiter", "land"] = "climb"
        self._loiter_up = math.inf
        self._loiter_left = 0.0

    @property
    def in_air(self) -> bool:
        """In truth, not by the estimate."""
        return not self.copter.on_ground

    def arm(self) -> None:
        """The motors turn and the copter stays on the ground."""
        self.armed = True
        self.task = "idle"
        self.grounded_for = 0.0

    def disarm(self) -> None:
        """At once, in the air too: who may do so is the firmware's matter."""
        self.armed = False
        self.task = "idle"
        self.copter.yaw_rate = 0.0

    def _here(self) -> Demand:
        nav, demand = self.navigation, self.demand
        return Demand(
            nav.north,
            nav.east,
            nav.up,
            self.copter.heading,
            demand.speed,
            demand.climb,
            demand.descend,
            demand.yaw_rate_limit,
        )

    def take_off(self, up: float) -> None:
        """Straight up to `up` metres above home, on the heading it has."""
        self.demand = self._here()
        self.demand.up = up
        self.task = "take_off"

    def fly_to(self, north: float, east: float, up: float, speed: float) -> None:
        """Keeps the heading demand when it was flying already, so that a turn goes on."""
        if self.task != "fly":
            self.demand = self._here()
        self.demand.north, self.demand.east, self.demand.up, self.demand.speed = north, east, up, speed
        self.demand.creeps_m = 0.0
        self.task = "fly"

    def stop(self, reach: float = 1.0, creeps_m: float = 0.0) -> None:
        """Brake and hover: the target is where braking ends; with a reach below 1 before that, and it turns back.

        creeps_m: of a copter that moves; the last metres to the target it only creeps.
        """
        self.demand = self._here()
        copter = self.copter
        braking = reach / (1.4 * copter.airframe.acceleration)
        speed = math.hypot(copter.v_north, copter.v_east)
        self.demand.north += copter.v_north * speed * braking
        self.demand.east += copter.v_east * speed * braking
        self.demand.creeps_m = creeps_m if speed > MOVES_M_S else 0.0
        self.task = "fly" if self.in_air else "idle"

    def return_home(self, minimum_up: float, speed: float, loiter_up: float, loiter: float) -> None:
        """Climb, go home, descend to `loiter_up` m, wait there for `loiter` s (for ever when negative), land."""
        self.demand = self._here()
        self._loiter_up = loiter_up
        self._loiter_left = math.inf if loiter < 0.0 else loiter
        self._return_up = max(minimum_up, self.navigation.up)
        self.demand.up, self.demand.speed = self._return_up, speed
        self._return_leg = "climb"
        self.task = "return"

    def land(self) -> None:
        """Straight down from where braking ends, at 1 m/s, more slowly below 8 m."""
        self.stop()
        self.task = "land"
        self.demand.descend = 1.0

    def sticks(self, velocity: tuple[float, float, float], yaw_rate: float) -> None:
        """(north, east, up) m/s and deg/s."""
        self.demand = self._here()
        self.demand.velocity, self.demand.yaw_rate = velocity, yaw_rate
        self.task = "sticks"

    def turn_to(self, heading_deg: float, rate_limit: float, direction: int = 0) -> None:
        """Turn to a compass heading: 0 the shorter way, 1 clockwise, -1 counter-clockwise."""
        now = self.copter.heading + self.navigation.heading_error
        left = math.remainder(heading_deg - now, 360.0)
        if direction > 0 and left < 0.0:
            left += 360.0
        if direction < 0 and left > 0.0:
            left -= 360.0
        self.demand.heading = self.copter.heading + left
        self.demand.yaw_rate_limit = rate_limit

    def turn_by(self, degrees: float, rate_limit: float) -> None:
        """Turn by `degrees` (clockwise positive) from where the nose is now."""
        self.demand.heading = self.copter.heading + degrees
        self.demand.yaw_rate_limit = rate_limit

    def step(self, dt: float) -> None:
        """Advance by dt seconds: navigation first, so that the task acts on the newest estimate."""
        self.navigation.step(dt)
        if self.armed and self.task == "return":
            self._advance_return(dt)
        if self.armed and self.task == "land":
            self.demand.up = self.navigation.up - 5.0
            self.demand.descend = 1.0 if self.copter.up > 8.0 else 0.6
        self.copter.step(dt, self.demand if self.armed and self.task != "idle" else None, self.navigation.error)
        self.grounded_for = self.grounded_for + dt if self.copter.on_ground else 0.0

    def _advance_return(self, dt: float) -> None:
        nav, demand = self.navigation, self.demand
        if self._return_leg == "climb" and nav.up > self._return_up - 1.0:
            self._return_leg = "home"
            demand.north = demand.east = 0.0
        elif self._return_leg == "home" and math.hypot(nav.north, nav.east) < 1.0:
            self._return_leg = "loiter"
            demand.up, demand.descend = min(self._loiter_up, nav.up), 1.5
        elif self._return_leg == "loiter" and nav.up < demand.up + 0.5:
            self._loiter_left -= dt
            if self._loiter_left <= 0.0:
                self._return_leg = "land"
        elif self._return_leg == "land":
            demand.up, demand.descend = nav.up - 5.0, 1.5 if self.copter.up > 10.0 else 0.7
