"""Whole searches in the field world: sweeps through the direction finder, beliefs and claims as in a mission.

Only flying is simplified: a craft takes as long as the fitted movement model says (thesis 6.4.3), turns at every place,
once around or through a sector, and settles. Before a sector its yaw is laid on the way: what of the swing the flight
does not cover is waited for. Mission k has the same world in every row, and its n-th sweep the same chance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import Literal

import numpy as np
from shapely import Point, Polygon

from backend.api.suggestion import suggested_mission
from backend.cli.field_gyration import GYRATION, circling, heard_circling
from backend.cli.field_legs import Listens, flown, listened
from backend.cli.field_rivals import RIVALS
from backend.craft.state import retakes
from backend.events import BearingMeasured, BeliefUpdated, CraftSource, HeardOnTheWay, SweepRejected
from backend.reasons.turning import WayToldEnough
from backend.search.lessons import errors_now
from backend.search.localization import Localization, localization
from backend.search.never_stop import PAUSE_S, turn_or_pass
from backend.search.planning import decide, foreseen, in_nine_of_ten
from backend.search.sector import (
    GoOn,
    Stop,
    TurnPlan,
    expected_here,
    look,
    must_be_whole,
    planned_turn,
    turn_fact,
    whole_turn,
)
from backend.search.sweep_facts import Taken, sweep_fact
from backend.search.swings import swing_plan
from backend.simulation.field_world import Antenna, Field, antenna_pattern, drawn_field
from backend.spec import MissionSpec, PlannerSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.sweep import first_part
from hardware.readings import Place
from hardware.yaw_swings import Swinging
from planner.belief.estimate import confidence_region
from planner.belief.grid import GridBelief
from planner.geometry import bounds
from planner.motion import flight_time, turn_between
from planner.types import Decision, FloatArray, FullMotion

CRAFT_ID = "craft-1"
HOME = Place(50.6234, 7.2046)
HOME_XY = (0.0, 0.0)
SETTLE_S = 4.0
"""After a turn, before the craft flies on."""
HOVER_W = 250.0
"""Of a multicopter of 2 kg; flown at 8 m/s it needs no less, so that energy is time."""
HEADING_SIGMA_DEG = 4.0
"""What the craft states of its heading."""
FAR_M = 50.0
"""Bearings from nearer do not count in the statistics of bearings, as in the thesis' (6.3.2)."""
OUTLIER_DEG = 30.0
LATE_S = 400.0
"""Within it missions are to say localized; a gyration that has not is not waited for."""
LOOK_S = 1.0
"""To brake, look, and turn on, when a sector was not enough."""

SWINGING: tuple[Listens, ...] = ("way_swinging", "never_stopping")
Turns = Literal["whole", "sector"]
Errors = Literal["joint", "independent"]
AS_FLOWN: tuple[Turns, Listens] = ("sector", "way_swinging")
"""In new missions."""


@dataclass(frozen=True, slots=True)
class FieldOptions:
    """turns: once around at every place, or as far as needed. turn_rate_deg_s: of a sweep. compass_sd_deg: of the
    flights' heading errors; compass_deg: their heading error, to either side, instead. listens: where. antenna: that is
    flown. errors: of bearings, as the specification has them. sigma_factor: what every bearing's sigma is widened by.
    flights: of the craft before these, from whose bearings it learns (field_lessons).
    """

    planner: str = "crossfix"
    turns: Turns = "whole"
    listens: Listens = "places"
    turn_rate_deg_s: float = 30.0
    compass_sd_deg: float = 4.0
    compass_deg: float | None = None
    antenna: Antenna = "yagi"
    errors: Errors = "joint"
    sigma_factor: float = 1.0
    flights: int = 0


@dataclass(frozen=True, slots=True)
class FieldMission:
    """What came of one. error_m, stated_m, in_c95: at the end. off_deg: of the accepted bearings from beyond FAR_M.
    foretold: by each plan: bearings so far, when, and until localized in the mean and in nine of ten, s."""

    seed: int
    localized: bool
    time_s: float
    in_c95: bool
    error_m: float
    stated_m: float
    bearings: int
    rejected: int
    turned_deg: float
    off_deg: tuple[float, ...]
    foretold: tuple[tuple[int, float, float, float], ...] = ()

    @property
    def false_claim(self) -> bool:
        """Said localized, and wrong by more than three times what it stated."""
        return self.localized and self.error_m > 3.0 * self.stated_m


OURS = ("crossfix", "rollout")
"""The suggested mission's planner, and the specification's default: rollouts on the Fisher policy."""
PLANNERS = (*OURS, *RIVALS, GYRATION)


def mission_of(options: FieldOptions) -> MissionSpec:
    """The suggested mission, its craft's first; all planners measure and claim alike."""
    spec = suggested_mission(HOME)
    sensor = spec.sensor.model_copy(
        update={
            "bearing_errors": options.errors,
            "sigma_deg": options.sigma_factor * spec.sensor.sigma_deg,
            "measurement_time_s": 360.0 / options.turn_rate_deg_s + SETTLE_S,
            "turn_rate_deg_s": options.turn_rate_deg_s,
            "sector_turns": options.turns == "sector",
            "listen_on_the_way": options.listens != "places",
            "swing_on_the_way": options.listens in SWINGING,
            "never_stop": options.listens == "never_stopping",
        }
    )
    if options.errors == "joint":
        sensor = sensor.model_copy(update={"learned": errors_now((), sensor, CRAFT_ID, options.antenna)})
    own = spec.planner if options.planner == "crossfix" else PlannerSpec(estimator=spec.planner.estimator)
    return spec.model_copy(update={"sensor": sensor, "planner": own})


@dataclass(slots=True)
class FieldStudy:
    """Flies missions of one row."""

    options: FieldOptions
    spec: MissionSpec
    task: Localization
    pattern: AntennaPattern
    finder: SparseDirectionFinder
    first: Decision | None = None
    """Of where missions take their first bearing: what is known before it is the same in all."""

    @classmethod
    def of(cls, options: FieldOptions, spec: MissionSpec | None = None) -> FieldStudy:
        """What all missions of the row have in common. spec: instead of the first mission's of the craft."""
        spec = spec or mission_of(options)
        pattern = antenna_pattern(options.antenna)
        return cls(
            options, spec, localization(spec, HOME), pattern, SparseDirectionFinder(heading_sigma_deg=HEADING_SIGMA_DEG)
        )

    def field(self, seed: int) -> Field:
        """Where mission `seed` is flown."""
        options, area = self.options, bounds(self.task.problem.area)
        return drawn_field(seed, self.task.frame, area, options.compass_sd_deg, options.compass_deg, options.antenna)

    def fly(self, seed: int) -> FieldMission:
        """One mission, until it says localized or has taken its last bearing."""
        return self.flown(seed)[0]

    def flown(self, seed: int) -> tuple[FieldMission, GridBelief]:
        """With the belief at its end."""
        return self._gyrated(seed) if self.options.planner == GYRATION else self._stopping(seed)

    def _stopping(self, seed: int) -> tuple[FieldMission, GridBelief]:
        """Turns are made at places."""
        task, rate, field = self.task, self.options.turn_rate_deg_s, self.field(seed)
        rng, motion = np.random.default_rng([seed, 3]), FullMotion()
        measured, legs = list[BearingMeasured](), list[HeardOnTheWay]()
        here, heading, time_s = HOME_XY, 0.0, 0.0
        sweeps, rejected, passed, turned_deg = 0, 0, 0, 0.0
        way_deg, turned_at, avoid = 0.0, list[tuple[float, float]](), list[tuple[float, float]]()
        foretold = list[tuple[int, float, float, float]]()
        fact, belief = task.belief_fact(measured)
        while not fact.localized and sweeps + passed < self.spec.localization.maximum_bearings:
            place, times = self._choose(task, belief, measured, here, rng, avoid)
            if (in_90 := in_nine_of_ten(times)) is not None:
                foretold.append((len(measured), time_s, float(times.mean()), in_90))
            way = np.array(place) - np.array(here)
            length, flown_s = float(np.hypot(*way)), 0.0
            if length > 0.0:
                direction = float(np.arctan2(way[1], way[0]))
                time_s += float(flight_time(motion, length, turn_between(heading, direction)))
                swinging = self._swinging(task, belief, measured, here, place)
                # the yaw for a sector is laid on the way; a nose that swings there has only the end of it
                flown_s = float(flight_time(motion, length)) if swinging is None else 0.0
                if self.options.listens != "places":
                    nose = flown(here, place, heading, swinging)
                    legs.append(listened(field, nose, [*turned_at, place], len(legs), self.spec.sensor, self.pattern))
                    way_deg += nose.turned_deg
                    direction = nose.heading
                    task = self.task.after((), legs)
                    fact, belief = task.belief_fact(measured)
                heading = direction
            here = place
            if fact.localized:
                break
            if length > 0.0 and legs and self._passes(legs[-1], measured, fact):
                passed, time_s = passed + 1, time_s + PAUSE_S
                continue
            turned_at.append(place)
            for attempt in count(1):
                plan = self._turn(measured, here, attempt)
                swing_s = 0.0 if plan.begin_deg is None else _apart(heading, plan.begin_deg) / rate
                found, turned, looks = self.measured(field, here, sweeps, plan)
                spent_s = turned / rate + (looks - 1) * LOOK_S + SETTLE_S
                time_s += max(swing_s - flown_s, 0.0) + spent_s
                turned_deg += turned + swing_s * rate
                flown_s = 0.0
                if plan.begin_deg is not None:
                    heading = math.radians(90.0 - plan.begin_deg - turned)
                sweeps += 1
                if isinstance(found, BearingMeasured):
                    measured.append(found)
                    avoid.clear()
                    break
                rejected += 1
                if attempt > retakes(self.spec.sensor.maximum_retakes, bool(measured), found):
                    avoid.append(place)
                    break
            fact, belief = task.belief_fact(measured)
        ended = self._ended(field, fact, belief, measured, time_s, rejected, turned_deg + way_deg)
        return replace(ended, foretold=tuple(foretold)), belief

    def _passes(self, leg: HeardOnTheWay, measured: Sequence[BearingMeasured], fact: BeliefUpdated) -> bool:
        """Whether a mission that never stops does not turn after this leg."""
        asked = self.spec.sensor.never_stop and bool(measured) and leg.tells
        return asked and isinstance(turn_or_pass(fact, [leg]), WayToldEnough)

    def _gyrated(self, seed: int) -> tuple[FieldMission, GridBelief]:
        """The nose goes round all the time, and the craft flies on meanwhile."""
        field, task, rng = self.field(seed), self.task, np.random.default_rng([seed, 3])
        measured, circles, nose_deg = list[BearingMeasured](), 0, 0.0
        here, time_s, circle_s = (0.0, 0.0), 0.0, 360.0 / self.options.turn_rate_deg_s
        fact, belief = task.belief_fact(measured)
        while not fact.localized and time_s < LATE_S:
            way = circling(here, self._choose(task, belief, measured, here, rng)[0], nose_deg, circle_s)
            sweep, reading = heard_circling(field, way, circles, self.finder, self.pattern)
            here, nose_deg = (float(way.x[-1]), float(way.y[-1])), float(way.nose_deg[-1])
            time_s += circle_s
            circles += 1
            source = CraftSource(craft_id=CRAFT_ID)
            taken = Taken(self.task.emitter_id, source, f"sweep-{circles}", circles, 1)
            found = sweep_fact(taken, self.spec.sensor, sweep, reading, circle_s)
            if isinstance(found, BearingMeasured):
                measured.append(found)
                fact, belief = task.belief_fact(measured)
        rejected = circles - len(measured)
        return self._ended(field, fact, belief, measured, time_s, rejected, 360.0 * circles), belief

    def _ended(
        self,
        field: Field,
        fact: BeliefUpdated,
        belief: GridBelief,
        measured: Sequence[BearingMeasured],
        time_s: float,
        rejected: int,
        turned_deg: float,
    ) -> FieldMission:
        estimate = fact.estimate
        place = None if estimate is None else self.task.frame.to_enu(Place(estimate.lat, estimate.lon))
        return FieldMission(
            seed=field.seed,
            localized=fact.localized,
            time_s=time_s,
            in_c95=bool(Polygon(confidence_region(belief)).covers(Point(field.truth))),
            error_m=math.nan if place is None else math.dist(place, field.truth),
            stated_m=math.nan if estimate is None else estimate.expected_rmse_m,
            bearings=len(measured),
            rejected=rejected,
            turned_deg=turned_deg,
            off_deg=tuple(off for b in measured if (off := self.off_deg(field, b)) is not None),
        )

    def _choose(
        self,
        task: Localization,
        belief: GridBelief,
        measured: Sequence[BearingMeasured],
        here: tuple[float, float],
        rng: np.random.Generator,
        avoid: Sequence[tuple[float, float]] = (),
    ) -> tuple[tuple[float, float], FloatArray]:
        """With the times (n,) s that the plan foretells; a rival foretells none."""
        rival = RIVALS.get("fisher" if self.options.planner == GYRATION else self.options.planner)
        if rival is not None:
            return rival(foreseen(task.problem, measured, belief), belief, here, rng), np.empty(0)
        begins = here == HOME_XY and not measured and not task.stretches and not avoid
        known = self.first if begins else None
        decision = decide(task, belief, measured, here, avoid) if known is None else known
        if begins:
            self.first = decision
        return (decision.x, decision.y), decision.times

    def _swinging(
        self,
        task: Localization,
        belief: GridBelief,
        measured: Sequence[BearingMeasured],
        here: tuple[float, float],
        place: tuple[float, float],
    ) -> Swinging | None:
        if self.options.listens not in SWINGING:
            return None
        middle = (0.5 * (here[0] + place[0]), 0.5 * (here[1] + place[1]))
        expected, offset_deg = expected_here(task, belief, measured, middle), self.pattern.offset_to_nose_deg
        begin_deg = self._turn(measured, place, 1).begin_deg
        facing_deg = None if begin_deg is None else (begin_deg - offset_deg) % 360.0
        plan = swing_plan(expected, offset_deg, self.options.turn_rate_deg_s, facing_deg)
        return Swinging(plan, lambda _: math.inf)

    def _turn(self, measured: Sequence[BearingMeasured], here: tuple[float, float], attempt: int) -> TurnPlan:
        """By what turns told alone, as in flight, where nobody waits for what the leg told."""
        because = must_be_whole(self.spec, measured, attempt)
        if not self.spec.sensor.turns_in_sectors or because is not None:
            return whole_turn(because or "first")
        task, bearings = self.task, self.task.planner_bearings(measured)
        if task.belief(bearings) is None:
            return whole_turn("unsure")
        return planned_turn(expected_here(task, task.planning_belief(bearings), measured, here))

    def measured(
        self, field: Field, here: tuple[float, float], number: int, plan: TurnPlan
    ) -> tuple[BearingMeasured | SweepRejected, float, int]:
        """(what came of it, degrees turned, looks) of one sweep. here: m ENU. number: of all sweeps of the mission."""
        offset = self.pattern.offset_to_nose_deg
        start = None if plan.begin_deg is None else plan.begin_deg - offset
        whole = field.sweep(*here, number, self.options.turn_rate_deg_s, start)
        began = float(whole.heading_deg[0]) + offset
        turned, steps = plan.width_deg, list[GoOn]()
        while True:
            sweep = whole if turned >= 360.0 else first_part(whole, turned)
            reading = self.finder.estimate(sweep, self.pattern)
            decided = look(plan, began, turned, reading)
            if isinstance(decided, Stop):
                break
            steps.append(decided)
            turned += decided.by_deg
        taken = Taken(
            self.task.emitter_id,
            CraftSource(craft_id=CRAFT_ID),
            f"sweep-{number}",
            number + 1,
            1,
            turn_fact(plan, began, turned, steps, decided),
        )
        duration_s = turned / self.options.turn_rate_deg_s + len(steps) * LOOK_S + SETTLE_S
        fact = sweep_fact(taken, self.spec.sensor, sweep, reading, duration_s)
        return self._widened(fact) if isinstance(fact, BearingMeasured) else fact, turned, 1 + len(steps)

    def _widened(self, fact: BearingMeasured) -> BearingMeasured:
        """As the belief is to read it."""
        shares = ("sigma_deg", "heading_sigma_deg", "pattern_sigma_deg")
        wide = {name: self.options.sigma_factor * getattr(fact, name) for name in shares}
        return fact.model_copy(update=wide)

    def off_deg(self, field: Field, fact: BearingMeasured) -> float | None:
        """What a bearing is off by, the compass' error taken out; None from nearer than FAR_M."""
        x, y = self.task.frame.to_enu(fact.place)
        east, north = field.truth[0] - x, field.truth[1] - y
        if math.hypot(east, north) < FAR_M:
            return None
        seen = fact.bearing_deg + field.world.heading_error_deg
        return math.remainder(seen - math.degrees(math.atan2(east, north)), 360.0)


def _apart(heading: float, compass_deg: float) -> float:
    """Degrees between a heading (rad ccw from east) and one clockwise from north."""
    return abs(math.remainder(90.0 - math.degrees(heading) - compass_deg, 360.0))
