"""How the search bears a bad sensor: whole missions without sockets, simulated sweeps through finder and localizer.

    python -m tests.benchmarks.sensor_faults --missions 1000 --out docs/measurements        (or: make sensor-faults)

Every mission has an emitter somewhere in the suggested area and the field system's specification; the base policy
chooses the places, the direction finder reads every sweep of the simulated world, a rejected sweep is taken again as
often as the specification allows, and the mission ends when the verdict says "localized" or after its last bearing.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely import Point, Polygon

from backend.api.suggestion import HEIGHT_M, WIDTH_M, suggested_mission
from backend.events import BearingMeasured, BeliefUpdated, CraftSource
from backend.search.localization import Localization, localization
from backend.search.planning import base_policy_decision
from backend.search.sweep_facts import Taken, sweep_fact
from backend.settings import Settings
from backend.simulation.walls import walls
from backend.spec import PlannerSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.frame import LocalFrame, angle_to_compass
from hardware.readings import Place, Sweep
from hardware.sim.turn import turn_once
from hardware.sim.turntable import simulated_antenna
from hardware.sim.world import Emitter, FrontEnd, RadioLink, World
from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief
from planner.belief.verdict import points_at
from planner.reasons import BearingsDisagree, EstimateContradicted
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

HOME = Place(50.6234, 7.2046)
FREQUENCY_HZ = 868_300_000.0
HEIGHT_ABOVE_M = 40.0
MOST_PLACES = 15
CRAFT = CraftSource(craft_id="craft-1")
HEADING_SIGMA_DEG = float(Settings.model_fields["heading_sigma_deg"].default)
WRONG_DEG = 30.0
CONTRADICTIONS = (EstimateContradicted, BearingsDisagree)
OVERDRIVEN = FrontEnd(clip_dbm=-95.0)


@dataclass(frozen=True, slots=True)
class Fault:
    """outliers: share of sweeps whose wave comes from anywhere but the emitter. heading_deg: what the compass is wrong
    by. nan: share of power samples that are no number. clipped: share of sweeps taken with too much gain. jumps: share
    of places reported `jump_m` beside the true one. seen: the position steps there, which the vehicle link notices;
    else it creeps. multipath: the demo's walls stand around."""

    name: str
    outliers: float = 0.0
    heading_deg: float = 0.0
    nan: float = 0.0
    clipped: float = 0.0
    jumps: float = 0.0
    jump_m: float = 30.0
    seen: bool = True
    multipath: bool = False


FAULTS = (
    Fault("none"),
    Fault("20 % outlier bearings", outliers=0.2),
    Fault("heading 5 degrees off", heading_deg=5.0),
    Fault("10 % NaN, 20 % of sweeps overdriven", nan=0.1, clipped=0.2),
    Fault("20 % of places 30 m off (GPS jump)", jumps=0.2),
    Fault("20 % of places 30 m off, unnoticed", jumps=0.2, seen=False),
    Fault("walls that reflect", multipath=True),
)
UNCOVERED = (Fault("heading 10 degrees off", heading_deg=10.0), Fault("heading 20 degrees off", heading_deg=20.0))
"""More than the stated sigma covers: it has to be found from the bearings."""
WANTED_FAULTS = (*(fault for fault in FAULTS if fault.name != "none" and not fault.multipath), *UNCOVERED)
"""Walls are the world's, no fault of the sensor."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """Of one mission. in_c95, error_m: of the last belief. faulty: accepted bearings with the fault. known: those of
    them that the localizer counts as contradicting its estimate at the end. doubted: it ever said "contradict".
    compass_deg: what the bearings are off by together, as the last belief estimates it; None without one."""

    localized: bool
    in_c95: bool
    error_m: float
    stated_m: float
    bearings: int
    rejected: int
    faulty: int
    known: int
    doubted: bool
    compass_deg: float | None


@dataclass(frozen=True, slots=True)
class Sky:
    """One mission's world and its faults; every turn is drawn from `rng`."""

    world: World
    frame: LocalFrame
    fault: Fault
    truth: tuple[float, float]
    rng: np.random.Generator

    def sweep(self, x: float, y: float) -> tuple[Sweep, bool]:
        """(sweep taken at (x, y), whether its fault bends the bearing)."""
        fault, rng, world = self.fault, self.rng, self.world
        wrong = rng.uniform() < fault.outliers
        if wrong:
            away, angle = math.dist((x, y), self.truth), rng.uniform(0.0, 2.0 * math.pi)
            elsewhere = self.frame.to_geo(x + away * math.cos(angle), y + away * math.sin(angle))
            world = dataclasses.replace(world, emitters=(dataclasses.replace(world.emitters[0], place=elsewhere),))
        if rng.uniform() < fault.clipped:
            world = dataclasses.replace(world, front_end=OVERDRIVEN)
        world = dataclasses.replace(world, seed=int(rng.integers(2**31)))
        link = RadioLink(world, FREQUENCY_HZ)
        sweep = turn_once(link, self.frame.to_geo(x, y), HEIGHT_ABOVE_M, start_deg=rng.uniform(0.0, 360.0))
        if fault.nan:
            heard = np.where(rng.uniform(size=sweep.power_db.size) < fault.nan, np.nan, sweep.power_db)
            sweep = dataclasses.replace(sweep, power_db=heard)
        return sweep, wrong

    def reported(self, x: float, y: float) -> tuple[float, float, bool]:
        """Where the vehicle believes to be, and whether that is wrong."""
        if self.rng.uniform() >= self.fault.jumps:
            return x, y, False
        angle = self.rng.uniform(0.0, 2.0 * math.pi)
        return x + self.fault.jump_m * math.cos(angle), y + self.fault.jump_m * math.sin(angle), True


def make_sky(seed: int, fault: Fault, frame: LocalFrame) -> Sky:
    rng = np.random.default_rng([seed, 14])
    truth = (rng.uniform(-WIDTH_M / 2 + 10.0, WIDTH_M / 2 - 10.0), rng.uniform(10.0, HEIGHT_M - 10.0))
    emitter = Emitter(frame.to_geo(*truth), FREQUENCY_HZ)
    reflectors = walls(seed, HOME) if fault.multipath else ()
    return Sky(World((emitter,), reflectors=reflectors, heading_error_deg=fault.heading_deg), frame, fault, truth, rng)


def measure(
    task: Localization,
    sky: Sky,
    pattern: AntennaPattern,
    finder: SparseDirectionFinder,
    place: tuple[float, float],
    number: int,
) -> tuple[BearingMeasured | None, bool, int]:
    """(bearing or None, faulty, rejected sweeps) at one place, retakes included."""
    sensor = task.mission.sensor
    for attempt in range(1, 2 + sensor.maximum_retakes):
        sweep, wrong = sky.sweep(*place)
        x, y, jumped = sky.reported(*place)
        if jumped:
            sweep = dataclasses.replace(sweep, position=sky.frame.to_geo(x, y))
            if sky.fault.seen:
                sweep = dataclasses.replace(sweep, drift_m=sky.fault.jump_m)
        taken = Taken(task.emitter_id, CRAFT, f"{number}.{attempt}", number, attempt)
        fact = sweep_fact(taken, sensor, sweep, finder.estimate(sweep, pattern), None)
        if isinstance(fact, BearingMeasured):
            direction = angle_to_compass(math.atan2(sky.truth[1] - place[1], sky.truth[0] - place[0]))
            off_deg = abs(math.remainder(fact.bearing_deg - direction, 360.0))
            return fact, wrong or jumped or off_deg > WRONG_DEG, attempt - 1
    return None, False, 1 + sensor.maximum_retakes


def fly(seed: int, fault: Fault, pattern: AntennaPattern, finder: SparseDirectionFinder) -> Outcome:
    """One mission of the suggested specification with the base policy; facts and beliefs are those of a flight."""
    home = HOME
    spec = suggested_mission(home)
    spec = spec.model_copy(update={"planner": PlannerSpec(method="base_policy")})
    task = localization(spec, home)
    sky = make_sky(seed, fault, task.frame)
    measured: list[BearingMeasured] = []
    faulty: list[bool] = []
    rejected, doubted = 0, False
    position, without = (0.0, 0.0), list[tuple[float, float]]()
    said, belief = task.belief_fact(measured)
    for number in range(1, MOST_PLACES + 1):
        decision = base_policy_decision(task, measured, belief, position, without)
        position = (decision.x, decision.y)
        bearing, wrong, refused = measure(task, sky, pattern, finder, position, number)
        rejected += refused
        if bearing is None:
            without.append(position)
            continue
        measured.append(bearing)
        faulty.append(wrong)
        said, belief = task.belief_fact(measured)
        doubted = doubted or not said.consistent or any(isinstance(reason, CONTRADICTIONS) for reason in said.not_yet)
        if said.localized:
            break
    return outcome(task, sky, belief, said, measured, faulty, rejected, doubted)


def outcome(
    task: Localization,
    sky: Sky,
    belief: GridBelief,
    said: BeliefUpdated,
    measured: Sequence[BearingMeasured],
    faulty: Sequence[bool],
    rejected: int,
    doubted: bool,
) -> Outcome:
    spread = estimate(belief, task.problem.estimator)
    bearings = task.planner_bearings(measured)
    known = sum(not points_at(b, spread.x, spread.y) for b, wrong in zip(bearings, faulty, strict=True) if wrong)
    return Outcome(
        localized=said.localized,
        in_c95=bool(Polygon(confidence_region(belief)).covers(Point(sky.truth))),
        error_m=math.dist((spread.x, spread.y), sky.truth),
        stated_m=spread.expected_rmse if said.estimate is None else said.estimate.expected_rmse_m,
        bearings=len(measured),
        rejected=rejected,
        faulty=sum(faulty),
        known=known,
        doubted=doubted,
        compass_deg=said.sources[0].bias_deg if said.sources else None,
    )


COLUMNS = (
    Column(name="fault"),
    Column(name="missions"),
    Column(name="localized, %", decimals=1),
    Column(name="truth in C95, %", decimals=1),
    Column(name="error: median, m", decimals=1),
    Column(name="90 %", decimals=1),
    Column(name="99 %", decimals=0),
    Column(name="stated, m", decimals=1),
    Column(name="beyond 3 x stated, %", decimals=1),
    Column(name="bearings", decimals=2),
    Column(name="rejected sweeps", decimals=2),
    Column(name="faulty bearings seen through"),
    Column(name="contradiction told, %", decimals=0),
    Column(name="compass said to be off, median, degrees", decimals=1),
)
CLAIM_COLUMNS = 6
"""From "truth in C95" on: of the missions that said "localized", empty when none did."""


def row(fault: Fault, outcomes: Sequence[Outcome]) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    claims = [o for o in outcomes if o.localized]
    bad, known = sum(o.faulty for o in outcomes), sum(o.known for o in outcomes)
    of_claims: tuple[Cell, ...] = (None,) * CLAIM_COLUMNS
    if claims:
        errors, stated = np.array([o.error_m for o in claims]), np.array([o.stated_m for o in claims])
        of_claims = (
            truth_percent(claims),
            *(float(value) for value in (np.median(errors), *np.quantile(errors, (0.9, 0.99)), np.mean(stated))),
            100.0 * float(np.mean(errors > 3.0 * stated)),
        )
    return (
        fault.name,
        len(outcomes),
        100.0 * len(claims) / len(outcomes),
        *of_claims,
        float(np.mean([o.bearings for o in outcomes])),
        float(np.mean([o.rejected for o in outcomes])),
        f"{known} of {bad}" if bad else None,
        100.0 * float(np.mean([o.doubted for o in outcomes])),
        float(np.median([o.compass_deg for o in outcomes if o.compass_deg is not None])),
    )


def truth_percent(claims: Sequence[Outcome]) -> tuple[float, float]:
    """(share of the claims with the truth in C95, half its 95 % interval), in %."""
    inside = float(np.mean([o.in_c95 for o in claims]))
    half = 1.96 * math.sqrt(max(inside * (1.0 - inside), 0.25 / len(claims)) / len(claims))
    return 100.0 * inside, 100.0 * half


def figures(outcomes: dict[Fault, list[Outcome]]) -> list[Figure]:
    """Something is wanted of the faults in `WANTED_FAULTS`; a mission that crashes ends the benchmark."""
    made = [wanted("fault_crashes", 0, note=f"{sum(map(len, outcomes.values()))} missions")]
    for fault, flown in outcomes.items():
        claims = [o for o in flown if o.localized]
        if claims:
            truth, half = (round(value, 1) for value in truth_percent(claims))
            note = f"{len(claims)} claims of {len(flown)} missions"
            if fault in WANTED_FAULTS:
                made.append(wanted("fault_truth", truth, of=fault.name, ci95=half, note=note))
            else:
                made.append(plain(f"truth in C95, {fault.name}", truth, "%", ci95=half, note=note))
    return made


def main() -> None:
    parser = argparse.ArgumentParser(description="Fly simulated missions with a bad sensor.")
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument(
        "--heading-sigma", type=float, default=HEADING_SIGMA_DEG, help="degrees; as the server's setting"
    )
    parser.add_argument("--only", default="", help="faults whose name contains this")
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    pattern, finder = simulated_antenna(), SparseDirectionFinder(heading_sigma_deg=arguments.heading_sigma)
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.missions)
    outcomes: dict[Fault, list[Outcome]] = {}
    for fault in (*FAULTS, *UNCOVERED):
        if arguments.only in fault.name:
            print(fault.name, file=sys.stderr, flush=True)
            outcomes[fault] = [fly(seed, fault, pattern, finder) for seed in seeds]
    table = Table(name="faults", columns=COLUMNS, rows=tuple(row(*flown) for flown in outcomes.items()))
    print(markdown(table))
    made, page = figures(outcomes), "sensor-faults.md"
    write(arguments.out, "sensor_faults", "Sensor faults", begun, made, tables=[table], page=page)


if __name__ == "__main__":
    main()
