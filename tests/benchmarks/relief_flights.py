"""Wanted figure 26: missions over real relief, each metre of their flight held against clearance and ceiling.

    python -m tests.benchmarks.relief_flights [--missions 1000] [--out FOLDER]

The product's own work flies a made-up vehicle: planner, ways, altitudes, vetoes, take-off, legs, the climb before the
return. The vehicle wanders beside its way and above and below its altitude within what the product allows for. The
relief is SRTM's of the Jacksboro fault in Tennessee, which matplotlib ships (a height every 90 m), and the same with
finer, steeper ground laid over it.
"""

from __future__ import annotations

import argparse
import asyncio
import math
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from matplotlib import cbook
from numpy.typing import NDArray

from backend.craft import effects, inputs
from backend.craft.endurance import Endurance
from backend.craft.safety import Situation, limits_of
from backend.craft.work import Work
from backend.events import BearingMeasured, CraftSource, MissionDrafted, MissionStarted, PlanChosen
from backend.search.errors import MissionInputError
from backend.search.ground import LATERAL_TOLERANCE_M, VERTICAL_TOLERANCE_M
from backend.search.planning import lay_out_ways
from backend.search.state import SearchState, evolve
from backend.search.task import SearchTask, search_task
from backend.spec import FIRST_EMITTER, FlightSpec, MissionSpec, PlannerSpec, Polygon
from backend.terrain import Terrain
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry
from planner.types import PlannerError
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

PLACES = 4
STEP_M = 2.0
CLIMB_M_S = 3.0
CRAFT = "craft-1"
FRUGAL = Endurance(np.zeros(1), np.zeros(1), np.ones(1), np.array([[0.01, 0.0]]), np.zeros((1, 2, 2)))
"""A hundredth of a percent of the battery a second, without wind: the ground alone decides."""


def real_relief() -> Terrain:
    """Heights of 236 to 1076 m over 30 x 32 km."""
    found = np.load(cbook.get_sample_data("jacksboro_fault_dem.npz", asfileobj=False))
    north = max(float(found["ymin"]), float(found["ymax"]))
    heights = found["elevation"].astype(np.float32)
    return Terrain(north, float(found["xmin"]), float(found["dy"]), float(found["dx"]), heights, ("SRTM, Jacksboro",))


def finer(terrain: Terrain, random: np.random.Generator) -> Terrain:
    """Three times as many heights, with rough ground of up to some ten metres laid over them."""
    rows, columns = terrain.heights.shape
    lat = terrain.north_deg - np.arange(3 * rows - 2) * terrain.lat_step_deg / 3
    lon = terrain.west_deg + np.arange(3 * columns - 2) * terrain.lon_step_deg / 3
    smooth = terrain.at(*(axis.ravel() for axis in np.meshgrid(lat, lon, indexing="ij"))).reshape(len(lat), len(lon))
    rough = np.fft.irfft2(_pink(smooth.shape, random), smooth.shape)
    heights = smooth + 8.0 * rough / rough.std()
    return Terrain(
        terrain.north_deg,
        terrain.west_deg,
        terrain.lat_step_deg / 3,
        terrain.lon_step_deg / 3,
        heights.astype(np.float32),
        ("made finer",),
    )


def _pink(shape: tuple[int, ...], random: np.random.Generator) -> NDArray[np.complex128]:
    """Noise whose amplitude falls with the 1.2th power of its frequency; waves longer than 16 nodes are left out."""
    frequency = np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :])
    amplitude = np.where(frequency > 1 / 16, np.maximum(frequency, 1e-9) ** -1.2, 0.0)
    return amplitude * np.exp(2j * math.pi * random.random(frequency.shape))


@dataclass
class WanderingVehicle:
    """Flies at once; `lowest`, `highest`: of its height above the ground so far. measuring: past the take-off."""

    terrain: Terrain
    frame: LocalFrame
    flight: FlightSpec
    random: np.random.Generator
    state: Telemetry
    measuring: bool = False
    lowest_m: float = math.inf
    highest_m: float = -math.inf
    flown_m: float = 0.0
    points: int = 0
    violations: Counter[str] = field(default_factory=Counter[str])

    def telemetry(self) -> Telemetry:
        return self.state

    async def take_off(self, altitude_relative_m: float) -> None:
        home = self.state.home_amsl_m or 0.0
        self.state = replace(
            self.state,
            in_air=True,
            armed=True,
            altitude_amsl_m=home + altitude_relative_m,
            altitude_relative_m=altitude_relative_m,
        )
        self.measuring = True
        self._held(*self.frame.to_enu(self._here()), home + altitude_relative_m)

    async def goto(
        self, place: Place, altitude_amsl_m: float, speed_m_s: float, heading_deg: float | None = None
    ) -> None:
        """Sideways and upwards at once, each at its own speed, as autopilots do."""
        (x0, y0), (x1, y1) = self.frame.to_enu(self._here()), self.frame.to_enu(place)
        length, before = math.hypot(x1 - x0, y1 - y0), self.state.altitude_amsl_m or 0.0
        seconds = max(length / speed_m_s, abs(altitude_amsl_m - before) / CLIMB_M_S)
        count = max(2, math.ceil(max(length, abs(altitude_amsl_m - before)) / STEP_M))
        t = np.linspace(0.0, max(seconds, 1e-6), count)
        share = np.minimum(1.0, t * speed_m_s / max(length, 1e-6))
        climbed = np.clip(t * CLIMB_M_S, 0.0, abs(altitude_amsl_m - before))
        altitude = before + math.copysign(1.0, altitude_amsl_m - before) * climbed
        side = self._wander(count, 0.9 * LATERAL_TOLERANCE_M)
        ahead = np.array([x1 - x0, y1 - y0]) / max(length, 1e-6)
        x = x0 + share * (x1 - x0) - side * ahead[1]
        y = y0 + share * (y1 - y0) + side * ahead[0]
        self._held(x, y, altitude + self._wander(count, 0.6 * VERTICAL_TOLERANCE_M))
        self.flown_m += length
        self.state = replace(
            self.state,
            position=place,
            altitude_amsl_m=altitude_amsl_m,
            altitude_relative_m=altitude_amsl_m - (self.state.home_amsl_m or 0.0),
        )

    def _here(self) -> Place:
        assert self.state.position is not None
        return self.state.position

    def _wander(self, count: int, most: float) -> NDArray[np.float64]:
        phase, waves = self.random.uniform(0.0, 2 * math.pi), self.random.uniform(0.5, 6.0)
        return most * np.sin(phase + np.linspace(0.0, waves * 2 * math.pi, count))

    def _held(self, x: Any, y: Any, altitude: Any) -> None:
        """Against the ground as it is, not as the product reckons with it."""
        east, north = np.atleast_1d(x), np.atleast_1d(y)
        lon_lat = np.array(self.frame.to_lon_lat(np.column_stack((east, north))))
        above = np.atleast_1d(altitude) - self.terrain.at(lon_lat[:, 1], lon_lat[:, 0])
        self.points += len(above)
        self.violations["unknown"] += int(np.isnan(above).any())
        self.violations["clearance"] += int((above < self.flight.minimum_clearance_m).any())
        self.violations["ceiling"] += int((above > self.flight.maximum_above_ground_m).any())
        self.lowest_m = min(self.lowest_m, float(np.nanmin(above)))
        self.highest_m = max(self.highest_m, float(np.nanmax(above)))


class _Clock:
    def now(self) -> float:
        return 1000.0


@dataclass(frozen=True)
class _Equipment:
    vehicle: WanderingVehicle
    clock: _Clock = field(default_factory=_Clock)
    threads: int = 1
    craft_id: str = CRAFT


def mission_at(frame: LocalFrame, random: np.random.Generator) -> MissionSpec:
    """An area of 300 to 1200 m beside home, turned any way."""
    width, height = random.uniform(300.0, 1200.0, 2)
    turn, away = random.uniform(0.0, 2 * math.pi), random.uniform(-0.5, 0.9)
    corners = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)]) * (width, height)
    corners += (away * width / 2, 0.0)
    turned = corners @ np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    return MissionSpec(
        name="relief",
        area=Polygon(coordinates=[frame.to_lon_lat(turned)]),
        planner=PlannerSpec(method="base_policy", standoff_m=20.0, action_spacing_m=30.0),
        flight=FlightSpec(
            altitude_relative_m=float(random.uniform(30.0, 60.0)), fence_margin_m=float(random.uniform(60.0, 300.0))
        ),
    )


@dataclass
class Flown:
    """How one mission went. ended: why no further place was flown to."""

    ended: str = ""
    legs: int = 0
    raised: int = 0
    vehicle: WanderingVehicle | None = None


async def fly(terrain: Terrain, random: np.random.Generator) -> Flown:
    """One mission, from the take-off to above home."""
    rows, columns = terrain.heights.shape
    home = Place(
        terrain.north_deg - random.uniform(0.1, 0.9) * (rows - 1) * terrain.lat_step_deg,
        terrain.west_deg + random.uniform(0.1, 0.9) * (columns - 1) * terrain.lon_step_deg,
    )
    frame, found = LocalFrame(home), Flown()
    mission = mission_at(frame, random)
    ground_m = float(terrain.at(np.array([home.lat]), np.array([home.lon]))[0])
    amsl = ground_m + float(random.normal(0.0, 3.0))  # what the autopilot takes it for
    try:
        task = search_task(mission, home, amsl, terrain)
        lay_out_ways(task.first)
    except (MissionInputError, PlannerError) as error:
        found.ended = type(error).__name__
        return found
    heard = Telemetry(
        connected=True, at_s=1000.0, position=home, position_at_s=1000.0, altitude_amsl_m=amsl, altitude_relative_m=0.0,
        battery_percent=100.0, battery_at_s=1000.0, armed=False, in_air=False, home=home, home_amsl_m=amsl,
    )  # fmt: skip
    vehicle = found.vehicle = WanderingVehicle(terrain, frame, mission.flight, random, heard)
    search = evolve(SearchState(), MissionDrafted(spec=mission), 0.0)
    search = evolve(search, MissionStarted(craft_id=CRAFT, by="", home=home, home_amsl_m=amsl, software=""), 0.0)
    work = Work(
        _Equipment(vehicle), task, limits_of(task), "m", None,  # type: ignore[arg-type]
        lambda: Situation(vehicle.telemetry(), 1000.0, FRUGAL), lambda: search, lambda *_: None,
    )  # fmt: skip
    emitter = random.uniform(-150.0, 150.0, 2)
    up = await work.take_off(effects.TakeOff(mission.flight.altitude_relative_m))
    if isinstance(up, inputs.WorkVetoed):
        found.ended = f"take-off: {up.vetoes[0].code}"
        return found
    avoid: tuple[Place, ...] = ()
    for number in range(1, PLACES + 1):
        planned = await work.plan(effects.PlanNext(number, avoid))
        if not isinstance(planned, inputs.Planned):
            found.ended = "no place"
            break
        if planned.vetoes:
            found.ended = f"plan: {planned.vetoes[0].code}"
            break
        arrived = await work.fly(effects.FlyTo(number, planned.choice.place))
        if not isinstance(arrived, inputs.Arrived):
            found.ended = "flight vetoed"
            break
        found.legs += 1
        found.raised += abs((planned.choice.altitude_amsl_m or 0.0) - amsl - mission.flight.altitude_relative_m) > 0.5
        search = evolve(search, _bearing(task, planned.choice, emitter, random, number), 0.0)
    await work.level_off_for_home()
    await vehicle.goto(home, vehicle.state.altitude_amsl_m or 0.0, mission.flight.speed_m_s)
    return found


def _bearing(
    task: SearchTask, plan: PlanChosen, emitter: NDArray[np.float64], random: np.random.Generator, number: int
) -> BearingMeasured:
    x, y = task.frame.to_enu(plan.place)
    compass = (math.degrees(math.atan2(emitter[0] - x, emitter[1] - y)) + random.normal(0.0, 5.0)) % 360.0
    return BearingMeasured(
        emitter_id=FIRST_EMITTER, source=CraftSource(craft_id=CRAFT), bearing_id=str(number), sweep_id=None,
        place_number=number, place=plan.place, altitude_amsl_m=plan.altitude_amsl_m or 0.0, bearing_deg=compass,
        sigma_deg=7.0, quality=0.9, peaks=[], snr_db=None, drift_m=0.0, binned_db=[], fitted_db=[],
    )  # fmt: skip


def flights(missions: int, seed: int) -> list[Flown]:
    random = np.random.default_rng(seed)
    real = real_relief()
    grounds = (real, finer(real, random))
    found: list[Flown] = []
    for number in range(missions):
        found.append(asyncio.run(fly(grounds[number % 2], random)))
        if (number + 1) % 50 == 0:
            told = sum(sum(one.vehicle.violations.values()) for one in found if one.vehicle)
            print(f"{number + 1} missions, {sum(one.legs for one in found)} legs, {told} violations", flush=True)
    return found


def figures(found: list[Flown]) -> list[Figure]:
    vehicles = [one.vehicle for one in found if one.vehicle is not None and one.vehicle.measuring]
    violated = sum(1 for vehicle in vehicles if sum(vehicle.violations.values()))
    legs = sum(one.legs for one in found)
    return [
        wanted("terrain", violated, note=f"{len(found)} missions, {len(vehicles)} of them took off"),
        plain("legs flown to places", legs, ""),
        plain("of these at another altitude than the mission's", sum(one.raised for one in found), ""),
        plain("missions that ended before their last place", sum(1 for one in found if one.ended), ""),
        plain("flown", round(sum(vehicle.flown_m for vehicle in vehicles) / 1e3), "km"),
        plain("points held against the ground", sum(vehicle.points for vehicle in vehicles), ""),
        plain("least height above ground", round(min(vehicle.lowest_m for vehicle in vehicles), 1), "m"),
        plain("most height above ground", round(max(vehicle.highest_m for vehicle in vehicles), 1), "m"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    found = flights(given.missions, given.seed)
    print(Counter(one.ended or "all places" for one in found))
    made = figures(found)
    for figure in made:
        print(f"{figure.name}: {figure.value} {figure.unit} {figure.note}")
    write(given.out, "relief_flights", "Clearance and ceiling over real relief", begun, made)


if __name__ == "__main__":
    main()
