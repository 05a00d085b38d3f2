"""What the way home was promised to take of the battery, and what it took: simulated flights in wind.

    python -m tests.benchmarks.battery_home --flights 1000 --out docs/measurements        (or: make battery-home)

Each flight goes to measurement places around a no-fly area, turns at each, and begins to return at a moment of its own.
The body, its battery and the wind (with gusts; it turns during the flight) are the simulated vehicle's; the promise is
made by what the server flies with, from whole percents of charge, attitude and speed over the ground.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

import numpy as np
from shapely import Point, box, unary_union

from backend.craft.endurance import landing_s
from backend.craft.watch.consumption import Consumption
from backend.craft.way_home import ABOVE_HOME_M, legs_home, way_home
from backend.search.area import region
from backend.search.problem import KEEP_OFF_M
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry
from hardware.sim.autopilot.copter import Airframe, Copter, Wind
from hardware.sim.autopilot.flight import Flight
from hardware.sim.autopilot.sensors import Navigation
from planner.travel import travel_path
from planner.types import LinearMotion, Problem
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

DT = 0.05
SPEED, HEIGHT = 7.0, 40.0
FIELD = box(-250, -100, 250, 500)
WALL = box(-120, 120, 120, 160)
FRAME = LocalFrame(Place(47.0, 8.0))
WINDS = (0.0, 2.0, 4.0, 6.0, 8.0)


def airspace() -> Problem:
    return Problem(
        area=region(FIELD),
        sigma=0.1,
        threshold=10.0,
        measurement_time=30.0,
        motion=LinearMotion(SPEED),
        flight_area=region(FIELD),
        no_fly=region(unary_union([WALL]).buffer(KEEP_OFF_M, join_style="mitre")),
    )


@dataclass(frozen=True, slots=True)
class Return:
    """Percents of the battery. by_distance: what the straight way at the mean consumption so far would have been."""

    wind_m_s: float
    promised: float
    by_distance: float
    took: float


class Vehicle:
    """The simulated body with its wind, watched as the server watches it."""

    def __init__(self, wind_m_s: float, rng: Random) -> None:
        airframe = Airframe(
            hover_power=rng.uniform(180.0, 260.0),
            drag_power=rng.uniform(0.1, 0.3),
            rotor_drag=rng.uniform(0.06, 0.2),
            body_drag=rng.uniform(0.006, 0.02),
        )
        self._from_deg = rng.uniform(0.0, 360.0)
        self._turns_deg_s = rng.uniform(-60.0, 60.0) / 600.0
        wind = Wind(wind_m_s, self._from_deg, 0.15 * wind_m_s)
        self.copter = Copter(airframe, wind, rng)
        self.copter.energy *= rng.uniform(0.7, 1.0)
        self.began_with = self.copter.energy
        self.flight = Flight(self.copter, Navigation(self.copter, rng, 0.5, 0.0, 0.0))
        self.flight.arm()
        self.consumption = Consumption()
        self.time_s = 0.0
        self._heard_s = 0.0

    def step(self) -> None:
        self.copter.turn_wind(self._from_deg + self._turns_deg_s * self.time_s)
        self.flight.step(DT)
        self.time_s += DT
        if self.time_s - self._heard_s >= 0.2:
            self._heard_s = self.time_s
            self.consumption.update(self.telemetry())

    def telemetry(self) -> Telemetry:
        copter = self.copter
        return Telemetry(
            connected=True,
            at_s=self.time_s,
            position=FRAME.to_geo(copter.east, copter.north),
            position_at_s=self.time_s,
            altitude_relative_m=copter.up,
            velocity_north_m_s=round(copter.v_north, 2),
            velocity_east_m_s=round(copter.v_east, 2),
            push_north_m_s2=copter.push_north,
            push_east_m_s2=copter.push_east,
            battery_percent=float(round(copter.battery_percent)),
            battery_at_s=self.time_s,
            in_air=self.flight.in_air,
        )

    def fly(self, north: float, east: float, up: float = HEIGHT) -> Iterator[None]:
        """Until arrived and settled, as the link judges it."""
        self.flight.fly_to(north, east, up, SPEED)
        settled = 0.0
        while settled < 1.0:
            self.step()
            off = math.hypot(self.copter.north - north, self.copter.east - east)
            slow = math.hypot(self.copter.v_north, self.copter.v_east) < 1.0
            settled = settled + DT if off < 2.0 and slow else 0.0
            yield

    def wait(self, seconds: float) -> Iterator[None]:
        self.flight.turn_by(360.0, 30.0)
        end = self.time_s + seconds
        while self.time_s < end:
            self.step()
            yield


def mission(vehicle: Vehicle, problem: Problem, rng: Random) -> Iterator[None]:
    vehicle.flight.take_off(HEIGHT)
    while vehicle.copter.up < HEIGHT - 1.0:
        vehicle.step()
        yield
    while True:
        place = np.array([rng.uniform(-240, 240), rng.uniform(0, 490)])
        if WALL.distance(Point(place)) < 10.0:
            continue
        way = travel_path(problem, np.array([vehicle.copter.east, vehicle.copter.north]), place)[1:]
        for east, north in way:
            yield from vehicle.fly(float(north), float(east))
        yield from vehicle.wait(16.0)


def fly(seed: int, problem: Problem) -> Return:
    """Out, and home again from a moment of its own."""
    rng = Random(seed)
    vehicle = Vehicle(WINDS[seed % len(WINDS)], rng)
    copter, begins = vehicle.copter, rng.uniform(30.0, 420.0)
    for _ in mission(vehicle, problem, rng):
        if vehicle.time_s >= begins:
            break
    at, flown_s, before = (copter.east, copter.north), vehicle.time_s, copter.energy
    promised = vehicle.consumption.endurance.way_percent(legs_home(problem, at), SPEED, landing_s(copter.up))
    percent = 100.0 / copter.airframe.capacity
    nominal = percent * (vehicle.began_with - before) / flown_s * (math.hypot(*at) / SPEED + 60.0)
    if math.hypot(*at) > ABOVE_HOME_M:
        for east, north in way_home(problem, at) or ():
            for _ in vehicle.fly(north, east):
                pass
    vehicle.flight.land()
    while vehicle.flight.in_air:
        vehicle.step()
    return Return(copter.wind.speed, promised, nominal, percent * (before - copter.energy))


COLUMNS = (
    Column(name="wind, m/s", decimals=0),
    Column(name="returns"),
    Column(name="took: median, %", decimals=1),
    Column(name="promise kept, %", decimals=1),
    Column(name="promised too much: median, %", decimals=1),
    Column(name="90 %", decimals=1),
    Column(name="fell short: most, %", decimals=1),
    Column(name="kept by distance alone, %", decimals=1),
)


def row(wind_m_s: float, returns: Sequence[Return]) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`. All are percents of the battery, but for the shares of returns."""
    over = np.array([r.promised - r.took for r in returns])
    return (
        wind_m_s,
        len(returns),
        float(np.median([r.took for r in returns])),
        kept_percent(returns),
        float(np.median(over)),
        float(np.quantile(over, 0.9)),
        float(max(-over.min(), 0.0)),
        100.0 * float(np.mean([r.by_distance >= r.took for r in returns])),
    )


def kept_percent(returns: Sequence[Return]) -> float:
    return 100.0 * float(np.mean([r.promised >= r.took for r in returns]))


def main() -> None:
    parser = argparse.ArgumentParser(description="Fly home in wind and hold the promise against what it took.")
    parser.add_argument("--flights", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=1)
    add_out(parser)
    arguments = parser.parse_args()
    begun, problem = begin(__file__), airspace()
    first = arguments.first_seed
    returns = [fly(seed, problem) for seed in range(first, first + arguments.flights)]
    by_wind = {wind: [r for r in returns if r.wind_m_s == wind] for wind in WINDS}
    rows = tuple(row(wind, found) for wind, found in by_wind.items() if found)
    table = Table(name="winds", columns=COLUMNS, rows=rows)
    print(markdown(table))
    over = np.array([r.promised - r.took for r in returns])
    made = [
        wanted("battery_home", round(kept_percent(returns), 1), note=f"{len(returns)} returns, winds 0 to 8 m/s"),
        plain("promised too much, median", round(float(np.median(over)), 2), "%", note="of the battery"),
        plain("promised too much, 90 %", round(float(np.quantile(over, 0.9)), 2), "%", note="of the battery"),
    ]
    write(arguments.out, "battery_home", "The way home in wind", begun, made, tables=[table], page="battery.md")


if __name__ == "__main__":
    main()
