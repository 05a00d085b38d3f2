"""How the search bears a bad sensor: whole missions without sockets, simulated sweeps through finder and localizer.

    python -m tests.benchmarks.sensor_faults --missions 1000        (or: make sensor-faults)

Every mission has an emitter somewhere in the suggested area and the field system's specification; the base policy
chooses the places, the direction finder reads every sweep of the simulated world, a rejected sweep is taken again as
often as the specification allows, and the mission ends when the verdict says "localized" or after its last bearing.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely import Point, Polygon

from backend.api.suggestion import HEIGHT_M, WIDTH_M, suggested_mission
from backend.mission.localization import DOUBT, Localization, localization
from backend.mission.planning import base_policy_decision
from backend.settings import Settings
from backend.spec import Place
from backend.wiring import walls
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.heading_offset import heading_offset
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame, angle_to_compass, compass_to_angle
from hardware.readings import BearingReading, GeoPoint, Sweep
from hardware.sim.turn import turn_once
from hardware.sim.world import Emitter, FrontEnd, RadioLink, World
from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief
from planner.belief.verdict import points_at, verdict
from planner.types import Bearing, Peak

HOME = GeoPoint(50.6234, 7.2046)
FREQUENCY_HZ = 868_300_000.0
HEIGHT_ABOVE_M = 40.0
MOST_PLACES = 15
HEADING_SIGMA_DEG = float(Settings.model_fields["heading_sigma_deg"].default)
WRONG_DEG = 30.0
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
"""More than the stated sigma covers: the search can only tell."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """Of one mission. in_c95, error_m: of the last belief. faulty: accepted bearings with the fault. known: those of
    them that the localizer counts as contradicting its estimate at the end. doubted: it ever said "contradict".
    offset_told: the caution of an offset common to all bearings stood at the end."""

    localized: bool
    in_c95: bool
    error_m: float
    stated_m: float
    bearings: int
    rejected: int
    faulty: int
    known: int
    doubted: bool
    offset_told: bool


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
    task: Localization, sky: Sky, pattern: AntennaPattern, finder: SparseDirectionFinder, place: tuple[float, float]
) -> tuple[Bearing | None, bool, int]:
    """(bearing or None, faulty, rejected sweeps) at one place, retakes included."""
    sensor = task.mission.sensor
    for attempt in range(1 + sensor.maximum_retakes):
        sweep, wrong = sky.sweep(*place)
        x, y, jumped = sky.reported(*place)
        if jumped and sky.fault.seen:
            sweep = dataclasses.replace(sweep, drift_m=sky.fault.jump_m)
        reading = finder.estimate(sweep, pattern)
        if reading.accepted and reading.quality >= sensor.minimum_quality:
            bearing = as_bearing(reading, x, y, sensor.outlier_probability)
            direction = math.atan2(sky.truth[1] - place[1], sky.truth[0] - place[0])
            off_deg = abs(math.degrees(math.remainder(bearing.angle - direction, 2.0 * math.pi)))
            return bearing, wrong or jumped or off_deg > WRONG_DEG, attempt
    return None, False, 1 + sensor.maximum_retakes


def as_bearing(reading: BearingReading, x: float, y: float, outlier_probability: float) -> Bearing:
    peaks = tuple(Peak(compass_to_angle(p.bearing_deg), p.weight) for p in reading.peaks)
    angle, sigma = compass_to_angle(reading.bearing_deg), math.radians(reading.sigma_deg)
    return Bearing(x, y, angle, sigma, outlier_probability, peaks)


def fly(seed: int, fault: Fault, pattern: AntennaPattern, finder: SparseDirectionFinder) -> Outcome:
    """One mission of the suggested specification with the base policy."""
    home = Place(lat=HOME.lat_deg, lon=HOME.lon_deg)
    spec = suggested_mission(home)
    spec = spec.model_copy(update={"planner": spec.planner.model_copy(update={"method": "base_policy"})})
    task = localization(spec, home, 0.0)
    sky = make_sky(seed, fault, task.frame)
    bearings: list[Bearing] = []
    faulty: list[bool] = []
    rejected, doubted, localized = 0, False, False
    position, without = (0.0, 0.0), list[tuple[float, float]]()
    belief = task.planning_belief(bearings)
    for _ in range(MOST_PLACES):
        decision = base_policy_decision(task, belief, position, without)
        position = (decision.x, decision.y)
        bearing, wrong, refused = measure(task, sky, pattern, finder, position)
        rejected += refused
        if bearing is None:
            without.append(position)
            continue
        bearings.append(bearing)
        faulty.append(wrong)
        folded = task.belief(bearings)
        said = verdict(task.problem, task.rule, bearings, folded)
        doubted = doubted or not said.consistent or any("contradict" in reason for reason in said.reasons)
        belief = task.planning_belief(bearings) if folded is None else folded
        if said.localized and not offset_stands(bearings, finder.heading_sigma_deg):
            localized = True
            break
    offset_told = offset_stands(bearings, finder.heading_sigma_deg)
    return outcome(task, sky, belief, bearings, faulty, localized, rejected, doubted, offset_told)


def offset_stands(bearings: Sequence[Bearing], heading_sigma_deg: float) -> bool:
    """Whether the mission would caution against an offset common to these bearings, and claim nothing."""
    places = np.array([(b.x, b.y) for b in bearings]).reshape(-1, 2)
    direction = np.array([angle_to_compass(b.angle) for b in bearings])
    own = np.sqrt(np.maximum(np.degrees([b.sigma for b in bearings]) ** 2 - heading_sigma_deg**2, 0.0))
    doubt = max((b.outlier_probability for b in bearings), default=0.0)
    found = heading_offset(places, direction, own, max(doubt, DOUBT))
    return found is not None and found.significant


def outcome(
    task: Localization,
    sky: Sky,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    faulty: Sequence[bool],
    localized: bool,
    rejected: int,
    doubted: bool,
    offset_told: bool,
) -> Outcome:
    spread = estimate(belief, task.problem.estimator)
    known = sum(not points_at(b, spread.x, spread.y) for b, wrong in zip(bearings, faulty, strict=True) if wrong)
    return Outcome(
        localized=localized,
        in_c95=bool(Polygon(confidence_region(belief)).covers(Point(sky.truth))),
        error_m=math.dist((spread.x, spread.y), sky.truth),
        stated_m=spread.expected_rmse,
        bearings=len(bearings),
        rejected=rejected,
        faulty=sum(faulty),
        known=known,
        doubted=doubted,
        offset_told=offset_told,
    )


def row(fault: Fault, outcomes: Sequence[Outcome]) -> str:
    """One line of the table; figures of the claims are of the missions that said "localized"."""
    claims = [o for o in outcomes if o.localized]
    errors = np.array([o.error_m for o in claims])
    stated = np.array([o.stated_m for o in claims])
    inside = np.mean([o.in_c95 for o in claims])
    half = 1.96 * math.sqrt(max(float(inside * (1.0 - inside)), 0.25 / len(claims)) / len(claims))
    bad, known = sum(o.faulty for o in outcomes), sum(o.known for o in outcomes)
    return (
        f"| {fault.name} | {len(outcomes)} | {100 * len(claims) / len(outcomes):.1f} % | "
        f"{100 * inside:.1f} ± {100 * half:.1f} % | {np.median(errors):.1f} | {np.quantile(errors, 0.9):.1f} | "
        f"{np.quantile(errors, 0.99):.0f} | {np.mean(stated):.1f} | {100 * np.mean(errors > 3.0 * stated):.1f} % | "
        f"{np.mean([o.bearings for o in outcomes]):.2f} | {np.mean([o.rejected for o in outcomes]):.2f} | "
        f"{f'{known} of {bad}' if bad else '-'} | {100 * np.mean([o.doubted for o in outcomes]):.0f} % | "
        f"{100 * np.mean([o.offset_told for o in outcomes]):.1f} % |"
    )


HEADER = (
    "| fault | missions | localized | truth in C95 | error: median, m | 90 % | 99 % | stated, m | beyond 3 x stated | "
    "bearings | rejected sweeps | faulty bearings seen through | contradiction told | common offset told |\n"
    + "|---" * 14
    + "|"
)


def main() -> None:
    parser = argparse.ArgumentParser(description="Fly simulated missions with a bad sensor.")
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument(
        "--heading-sigma", type=float, default=HEADING_SIGMA_DEG, help="degrees; as the server's setting"
    )
    parser.add_argument("--only", help="faults whose name contains this")
    arguments = parser.parse_args()
    pattern, finder = load_pattern(SMALL_YAGI), SparseDirectionFinder(heading_sigma_deg=arguments.heading_sigma)
    print(HEADER)
    for fault in (*FAULTS, *UNCOVERED):
        if arguments.only and arguments.only not in fault.name:
            continue
        seeds = range(arguments.first_seed, arguments.first_seed + arguments.missions)
        print(row(fault, [fly(seed, fault, pattern, finder) for seed in seeds]), flush=True)


if __name__ == "__main__":
    main()
