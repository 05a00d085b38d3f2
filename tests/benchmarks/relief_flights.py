"""Wanted figure 26: missions over real relief, each metre of their flight held against clearance and ceiling.

    python -m tests.benchmarks.relief_flights [--missions 1000] [--results FILE] [--out FOLDER]

The product's own work flies a made-up vehicle: planner, ways, altitudes, vetoes, take-off, legs, the return around
no-fly areas. Every third mission is aborted on the way to its last place and returns from there. The vehicle wanders
beside its way and above and below its altitude within what the product allows for. With --results each mission is
kept as a line of that file, which several runs may share (--first begins further on): those in it are not flown again.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from backend.craft import effects, inputs
from backend.craft.endurance import Endurance
from backend.craft.fly_home import AT_HOME_M, fly_home
from backend.craft.safety import Situation, limits_of
from backend.craft.under_way import UnderWay
from backend.craft.work import Work
from backend.events import BearingMeasured, CraftSource, MissionDrafted, MissionStarted, PlanChosen
from backend.search.errors import MissionInputError
from backend.search.planning import lay_out_ways
from backend.search.state import SearchState, evolve
from backend.search.task import SearchTask, search_task
from backend.spec import FIRST_EMITTER, Area, FlightSpec, MissionSpec, PlannerSpec, Polygon
from backend.terrain import Terrain
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry
from planner.types import PlannerError
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.relief_world import CalledOff, WanderingVehicle, finer, real_relief

PLACES = 4
CRAFT = "craft-1"
ZONE = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
ZONE_FROM_HOME_M = 150.0
ABORTED = 3
"""Every third mission is aborted."""
FRUGAL = Endurance(np.zeros(1), np.zeros(1), np.ones(1), np.array([[0.01, 0.0]]), np.zeros((1, 2, 2)))
"""A hundredth of a percent of the battery a second, without wind: the ground alone decides."""


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
    """An area of 300 to 1200 m beside home, turned any way, with up to three no-fly areas in it."""
    width, height = random.uniform(300.0, 1200.0, 2)
    turn, away = random.uniform(0.0, 2 * math.pi), random.uniform(-0.5, 0.9)
    corners = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)]) * (width, height)
    corners += (away * width / 2, 0.0)
    turned = corners @ np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    inside = [turned[0] + random.random(2) @ np.array([turned[1] - turned[0], turned[3] - turned[0]]) for _ in range(3)]
    zones = [at + ZONE * random.uniform(15.0, 80.0, 2) for at in inside if math.hypot(*at) > ZONE_FROM_HOME_M]
    no_fly: list[Area] = [Polygon(coordinates=[frame.to_lon_lat(zone)]) for zone in zones[: int(random.integers(0, 4))]]
    return MissionSpec(
        name="relief",
        area=Polygon(coordinates=[frame.to_lon_lat(turned)]),
        planner=PlannerSpec(method="base_policy", standoff_m=20.0, action_spacing_m=30.0),
        flight=FlightSpec(
            altitude_relative_m=float(random.uniform(30.0, 60.0)),
            fence_margin_m=float(random.uniform(60.0, 300.0)),
            no_fly=no_fly,
        ),
    )


@dataclass
class Flown:
    """How one mission went. ended: why no further place was flown to. own_return: why the autopilot's own was flown.

    legs: to places; raised: of these at another altitude than the mission's. zones: no-fly areas. landed_m: from home.
    """

    number: int
    ended: str = ""
    own_return: str = ""
    legs: int = 0
    raised: int = 0
    took_off: bool = False
    zones: int = 0
    flown_m: float = 0.0
    points: int = 0
    lowest_m: float = math.inf
    highest_m: float = -math.inf
    landed_m: float = math.inf
    violations: dict[str, int] = field(default_factory=dict[str, int])

    @property
    def came_home(self) -> bool:
        """By the way of ours."""
        return not self.own_return and self.landed_m < AT_HOME_M

    def keep(self, vehicle: WanderingVehicle) -> None:
        """What was seen of its flight."""
        self.took_off, self.zones, self.flown_m = vehicle.measuring, len(vehicle.no_fly), vehicle.flown_m
        self.points, self.lowest_m, self.highest_m = vehicle.points, vehicle.lowest_m, vehicle.highest_m
        self.landed_m, self.violations = vehicle.landed_m, dict(+vehicle.violations)


async def fly(terrain: Terrain, random: np.random.Generator, number: int) -> Flown:
    """One mission, from the take-off to the landing."""
    aborted = number % ABORTED == 0
    rows, columns = terrain.heights.shape
    home = Place(
        terrain.north_deg - random.uniform(0.1, 0.9) * (rows - 1) * terrain.lat_step_deg,
        terrain.west_deg + random.uniform(0.1, 0.9) * (columns - 1) * terrain.lon_step_deg,
    )
    frame, found = LocalFrame(home), Flown(number)
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
    vehicle = WanderingVehicle(terrain, frame, mission.flight, task.no_fly, random, heard)
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
    for place in range(1, PLACES + 1):
        planned = await work.plan(effects.PlanNext(place, avoid))
        if not isinstance(planned, inputs.Planned):
            found.ended = "no place"
            break
        if planned.vetoes:
            found.ended = f"plan: {planned.vetoes[0].code}"
            break
        vehicle.ends_at = float(random.uniform(0.1, 0.9)) if aborted and place == PLACES else 1.0
        try:
            arrived = await work.fly(effects.FlyTo(place, planned.choice.place))
        except CalledOff:
            found.ended = "aborted"
            break
        if not isinstance(arrived, inputs.Arrived):
            found.ended = "flight vetoed"
            break
        found.legs += 1
        found.raised += abs((planned.choice.altitude_amsl_m or 0.0) - amsl - mission.flight.altitude_relative_m) > 0.5
        search = evolve(search, _bearing(task, planned.choice, emitter, random, place), 0.0)
    vehicle.ends_at = 1.0
    returned = await fly_home(work, UnderWay())
    found.own_return = "" if returned is None else returned.because.code
    found.keep(vehicle)
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


def flights(numbers: Sequence[int], seed: int, results: Path | None) -> list[Flown]:
    """Of missions by number, those among `results` unflown."""
    real = real_relief()
    grounds = (real, finer(real, np.random.default_rng(seed)))
    found = {one.number: one for one in _kept(results)}
    for number in numbers:
        if number in found:
            continue
        one = asyncio.run(fly(grounds[number % 2], np.random.default_rng((seed, number)), number))
        found[number] = one
        if results is not None:
            with results.open("a") as file:
                file.write(json.dumps(asdict(one)) + "\n")
        if one.violations:
            print(f"mission {number}: {one.violations}, {one.ended}, {one.own_return}", flush=True)
        if len(found) % 50 == 0:
            print(f"{len(found)} missions", flush=True)
    return list(found.values())


def _kept(results: Path | None) -> list[Flown]:
    lines = [] if results is None or not results.exists() else results.read_text().splitlines()
    return [Flown(**json.loads(line)) for line in lines]


def figures(found: Sequence[Flown]) -> list[Figure]:
    flown = [one for one in found if one.took_off]
    note = f"{len(found)} missions, {len(flown)} of them took off; a no-fly area entered counts too"
    home = sum(one.came_home for one in flown)
    return [
        wanted("terrain", sum(bool(one.violations) for one in flown), note=note),
        plain("legs flown to places", sum(one.legs for one in found), ""),
        plain("of these at another altitude than the mission's", sum(one.raised for one in found), ""),
        plain("missions that ended before their last place", sum(bool(one.ended) for one in found), ""),
        plain("of these aborted on the way to it", sum(one.ended == "aborted" for one in found), ""),
        plain("missions with no-fly areas", sum(one.zones > 0 for one in flown), ""),
        plain("landed at home by our own way", home, "", note=f"of {len(flown)}"),
        plain("returns by the autopilot's own way", sum(bool(one.own_return) for one in flown), ""),
        plain("flown", round(sum(one.flown_m for one in flown) / 1e3), "km"),
        plain("points held against the ground", sum(one.points for one in flown), ""),
        plain("least height above ground", round(min(one.lowest_m for one in flown), 1), "m"),
        plain("most height above ground", round(max(one.highest_m for one in flown), 1), "m"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="its number")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--results", type=Path, help="what is flown already, and is added to")
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    found = flights(range(given.first, given.first + given.missions), given.seed, given.results)
    print(Counter(one.ended or "all places" for one in found))
    print(Counter(one.own_return or "our own way home" for one in found))
    made = figures(found)
    for figure in made:
        print(f"{figure.name}: {figure.value} {figure.unit} {figure.note}")
    write(given.out, "relief_flights", "Clearance and ceiling over real relief", begun, made)


if __name__ == "__main__":
    main()
