"""The decision replayed: what a flown mission would have believed and chosen with another sensor model or planner.

Rebuilt from the stored facts alone; nothing of it is recorded, and nothing flies by it.
"""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from backend.api.another_antenna import AnotherAntenna
from backend.api.beliefs import FOLDED_KINDS
from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    HeardOnTheWay,
    PlacePassed,
    PlaceReached,
    PlanChosen,
    Recorded,
    Supposition,
    SweepRejected,
)
from backend.reasons import Reason
from backend.search.area import corner_of
from backend.search.localization import Localization
from backend.search.planning import next_place
from backend.search.state import SearchState, evolve
from backend.search.together import together
from backend.spec import MissionSpec
from backend.wire.belief_frame import encode_belief
from backend.wire.resources import SweepFact, WhatIf, WhatIfRequest, WhatIfStep
from hardware.readings import Place
from planner.belief.grid import GridBelief
from planner.types import PlannerError

SUPPOSED_KINDS = (*FOLDED_KINDS, "recording_imported", "place_reached", "place_passed")
"""The events that the answer depends on: a sweep that was rejected may tell something through another antenna, the
antenna that flew is named at the start or the import, and from a place that was passed the next one is chosen."""


def what_if(
    mission_id: str, recorded: Sequence[Recorded], wanted: WhatIfRequest, antenna: AnotherAntenna | None = None
) -> WhatIf | None:
    """None when the mission had fewer bearings by then. Heavy (a plan of one thread): call it off the event loop.

    recorded: of SUPPOSED_KINDS, in order. antenna: through which the sweeps are taken again, None: they stay as flown.
    """
    recorded = _believed_by(recorded, wanted)
    found = suppose(recorded, wanted, wanted.bearings, antenna)
    if found is None:
        return None
    task, bearings, supposed = found.task, found.counted, found.sweeps
    fact, belief = found.said[-1]
    platform, number = _last_place(recorded, bearings, found.home)
    plan, no_plan = _plan(task, _bearings(supposed), platform, number)
    frame = encode_belief(
        mission_id, task.emitter_id, 0, fact.bearings, belief.density, task.corners_lon_lat(belief), lite=True
    )
    return WhatIf(
        steps=[_step(count, then, found.flown.get(count)) for count, (then, _) in enumerate(found.said)],
        belief=fact,
        plan=plan,
        no_plan=no_plan,
        frame_base64=base64.b64encode(frame).decode(),
        sweeps=supposed,
        antenna=None if antenna is None else antenna.named,
        legs_left_out=found.legs_left_out,
    )


@dataclass(frozen=True, slots=True)
class Supposed:
    """counted: the flown bearings that count. said: before the first and after each of them, with the fact and the
    belief. flown: what was said in flight, by the number of bearings. legs_left_out: that would count but for the other
    antenna, with which they cannot be heard again."""

    task: Localization
    home: Place
    counted: Sequence[BearingMeasured]
    flown: dict[int, BeliefUpdated]
    sweeps: list[SweepFact]
    said: list[tuple[BeliefUpdated, GridBelief]]
    legs_left_out: int


def suppose(
    recorded: Sequence[Recorded], wanted: Supposition, bearings: int | None, antenna: AnotherAntenna | None
) -> Supposed | None:
    """The beliefs of a supposition. bearings None: all that count. None: the mission had fewer."""
    state, flown, then = _flown(recorded, wanted.emitter_id, bearings)
    if state is None:
        return None
    home = state.home or corner_of(state.mission.area)
    mission = changed(state.mission, wanted)
    about = wanted.emitter_id or mission.emitters[0].emitter_id
    tasks = together(mission, home, about)
    task = tasks.emitters[about]
    counted = state.emitters[task.emitter_id].bearings
    supposed: list[SweepFact] = []
    flown_legs = [leg for leg in state.emitters[task.emitter_id].legs if leg.leg_id not in wanted.without]
    bare, legs = task, _legs_of_each(recorded, counted, () if antenna else flown_legs)
    task = bare.after((), legs[0])
    said = [task.belief_fact([])]
    unheard = {one.sweep_id for one in state.emitters[task.emitter_id].unheard}
    for number, sweeps in enumerate(_sweeps_of_each(recorded, counted), start=1):
        supposed += _taken(sweeps, supposed, mission, wanted, antenna)
        silent = [fact for fact in supposed if isinstance(fact, SweepRejected) and fact.sweep_id in unheard]
        told = tasks.about(_others_supposed(then.get(number, state), wanted), about).beside
        # through another antenna the other emitters' bearings would be others, too: none of them counts
        task = replace(bare.after(silent, legs[number]), beside=told if antenna is None else None)
        said.append(task.belief_fact(_bearings(supposed)))
    return Supposed(task, home, counted, flown, supposed, said, len(flown_legs) if antenna else 0)


def _last_place(recorded: Sequence[Recorded], bearings: Sequence[BearingMeasured], home: Place) -> tuple[Place, int]:
    """Where the craft chooses the next place, and that one's number: the last bearing's, or one passed since."""
    newest = bearings[-1].bearing_id if bearings else None
    platform = bearings[-1].place if bearings else home
    number = max((fact.place_number for fact in bearings), default=0)
    reached, since = dict[int, Place](), newest is None
    for record in recorded:
        match record.event:
            case BearingMeasured(bearing_id=bearing_id) if since or bearing_id == newest:
                if since:
                    break
                since = True
            case PlaceReached(place_number=there, place=place):
                reached[there] = place
            case PlacePassed(place_number=there) if since and there in reached:
                platform, number = reached[there], there
            case _:
                pass
    return platform, number + 1


def _believed_by(recorded: Sequence[Recorded], wanted: WhatIfRequest) -> Sequence[Recorded]:
    """What the belief shown at that event was told: a leg after it was heard, and did not count yet."""
    if wanted.until is None:
        return recorded
    happened = [one for one in recorded if one.seq <= wanted.until]
    believed = max((one.seq for one in happened if _is_belief_about(one, wanted.emitter_id)), default=0)
    return [one for one in happened if one.seq <= believed or not isinstance(one.event, HeardOnTheWay)]


def _is_belief_about(one: Recorded, emitter_id: str | None) -> bool:
    """None: about any emitter."""
    return isinstance(one.event, BeliefUpdated) and emitter_id in (None, one.event.emitter_id)


def changed(mission: MissionSpec, wanted: Supposition) -> MissionSpec:
    """The specification with what is wanted otherwise; fields that are None stay."""
    of_sensor = ("sigma_deg", "outlier_probability", "bearing_errors", "sweep_evidence")
    sensor = {name: getattr(wanted, name) for name in of_sensor}
    planner = {name: getattr(wanted, name) for name in ("method", "base_policy", "selection", "estimator", "budget")}
    return mission.model_copy(
        update={
            "sensor": mission.sensor.model_copy(update={k: v for k, v in sensor.items() if v is not None}),
            "planner": mission.planner.model_copy(update={k: v for k, v in planner.items() if v is not None}),
        }
    )


def _flown(
    recorded: Sequence[Recorded], emitter_id: str | None, bearings: int | None
) -> tuple[SearchState | None, dict[int, BeliefUpdated], dict[int, SearchState]]:
    """The last state with this number of counted bearings, and what was said in flight after each number of them, with
    the state in which it was.

    emitter_id None: of the first emitter. bearings None: the last state of all.
    """
    state, found = SearchState(), None
    said: dict[int, BeliefUpdated] = {}
    then: dict[int, SearchState] = {}
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
        wanted = emitter_id or next(iter(state.emitters), "")
        if isinstance(record.event, BeliefUpdated) and record.event.emitter_id == wanted:
            said[record.event.bearings] = record.event
            then[record.event.bearings] = state
        if wanted in state.emitters and bearings in (None, len(state.emitters[wanted].bearings)):
            found = state
    return found, said, then


def _with_sigma(fact: BearingMeasured, sigma_deg: float | None) -> BearingMeasured:
    """None: its own. Of a smaller one what all bearings of its source have in common is a part, as large as it was."""
    if sigma_deg is None:
        return fact
    smaller = min(1.0, sigma_deg / fact.sigma_deg)
    shares = {name: smaller * getattr(fact, name) for name in ("heading_sigma_deg", "pattern_sigma_deg")}
    return fact.model_copy(update={"sigma_deg": sigma_deg, "likelihood": None, **shares})


def _others_supposed(search: SearchState, wanted: Supposition) -> SearchState:
    """The search with what is wanted otherwise of the bearings of all its emitters."""
    emitters = {
        name: replace(
            emitter,
            measured=tuple(_with_sigma(fact, wanted.sigma_deg) for fact in emitter.measured),
            excluded=emitter.excluded.union(wanted.without),
        )
        for name, emitter in search.emitters.items()
    }
    return replace(search, emitters=emitters)


def _sweeps_of_each(recorded: Sequence[Recorded], counted: Sequence[BearingMeasured]) -> Iterator[list[SweepFact]]:
    """For each counted bearing the sweeps that were rejected since the one before, and its own."""
    ids = {fact.bearing_id for fact in counted}
    emitters = {fact.emitter_id for fact in counted}
    sweeps: list[SweepFact] = []
    for record in recorded:
        match record.event:
            case SweepRejected(emitter_id=emitter_id) as rejected if emitter_id in emitters:
                sweeps.append(rejected)
            case BearingMeasured(bearing_id=bearing_id) as measured if bearing_id in ids:
                yield [*sweeps, measured]
                sweeps = []
            case _:
                pass


def _legs_of_each(
    recorded: Sequence[Recorded],
    counted: Sequence[BearingMeasured],
    legs: Sequence[HeardOnTheWay],
) -> list[list[HeardOnTheWay]]:
    """Before the first counted bearing and after each of them, the legs until the next."""
    ids, counting = {fact.bearing_id for fact in counted}, {leg.leg_id for leg in legs}
    found: list[list[HeardOnTheWay]] = [[]]
    for record in recorded:
        match record.event:
            case HeardOnTheWay(leg_id=leg_id) as leg if leg_id in counting:
                found[-1].append(leg)
            case BearingMeasured(bearing_id=bearing_id) if bearing_id in ids:
                found.append(list(found[-1]))
            case _:
                pass
    return found


def _taken(
    flown: Sequence[SweepFact],
    before: Sequence[SweepFact],
    mission: MissionSpec,
    wanted: Supposition,
    antenna: AnotherAntenna | None,
) -> list[SweepFact]:
    """The sweeps as wanted. A place that already gave its bearing would not have been measured again."""
    with_bearing = {fact.place_number for fact in _bearings(before)}
    taken: list[SweepFact] = []
    for fact in flown:
        if isinstance(fact, BearingMeasured) and fact.bearing_id in wanted.without:
            continue
        if antenna is not None and fact.place_number in with_bearing:
            continue
        heard = fact if antenna is None else antenna.heard(mission, fact)
        if heard.kind == "bearing_measured":
            with_bearing.add(heard.place_number)
            heard = _with_sigma(heard, wanted.sigma_deg)
        taken.append(heard)
    return taken


def _bearings(sweeps: Sequence[SweepFact]) -> list[BearingMeasured]:
    return [fact for fact in sweeps if isinstance(fact, BearingMeasured)]


def _plan(
    task: Localization, measured: Sequence[BearingMeasured], platform: Place, number: int
) -> tuple[PlanChosen | None, Reason | None]:
    belief = task.planning_belief(task.planner_bearings(measured))
    here = task.frame.to_enu(platform)
    try:
        return next_place(task, belief, measured, here, number, (), threads=1), None
    except PlannerError as error:
        return None, error.reason


def _step(bearings: int, then: BeliefUpdated, flown: BeliefUpdated | None) -> WhatIfStep:
    return WhatIfStep(
        bearings=bearings,
        expected_rmse_m=None if then.estimate is None else then.estimate.expected_rmse_m,
        localized=then.localized,
        flown_expected_rmse_m=None if flown is None or flown.estimate is None else flown.estimate.expected_rmse_m,
        flown_localized=None if flown is None else flown.localized,
    )
