"""The decision replayed: what a flown mission would have believed and chosen with another sensor model or planner.

Rebuilt from the stored facts alone; nothing of it is recorded, and nothing flies by it.
"""

from __future__ import annotations

import base64
from collections.abc import Sequence

from backend.events import BearingMeasured, BeliefUpdated, PlanChosen, Recorded
from backend.mission.area import corner_of
from backend.mission.localization import Localization, localization
from backend.mission.planning import next_place
from backend.mission.state import MissionState, evolve
from backend.spec import MissionSpec, Place
from backend.wire.belief_frame import encode_belief
from backend.wire.resources import WhatIf, WhatIfRequest, WhatIfStep
from hardware.readings import GeoPoint
from planner.types import PlannerError


def what_if(mission_id: str, recorded: Sequence[Recorded], wanted: WhatIfRequest) -> WhatIf | None:
    """None when the mission never had so many bearings. Heavy (a plan of one thread): call it off the event loop.

    recorded: of backend.api.beliefs.FOLDED_KINDS, in order.
    """
    state, flown = _flown(recorded, wanted.bearings)
    if state is None:
        return None
    home = state.home or corner_of(state.mission.area)
    task = localization(changed(state.mission, wanted), home, state.home_amsl_m)
    measured = [_as_wanted(fact, wanted) for fact in state.bearings]
    said = [task.belief_fact(measured[:count]) for count in range(wanted.bearings + 1)]
    fact, belief = said[-1]
    platform = measured[-1].place if measured else home
    plan, no_plan = _plan(task, measured, platform)
    frame = encode_belief(mission_id, wanted.bearings, belief.density, task.corners_lon_lat(belief), lite=True)
    return WhatIf(
        steps=[_step(then, flown.get(then.bearings)) for then, _ in said],
        belief=fact,
        plan=plan,
        no_plan=no_plan,
        frame_base64=base64.b64encode(frame).decode(),
    )


def changed(mission: MissionSpec, wanted: WhatIfRequest) -> MissionSpec:
    """The specification with what is wanted otherwise; fields that are None stay."""
    sensor = {name: getattr(wanted, name) for name in ("sigma_deg", "outlier_probability")}
    planner = {name: getattr(wanted, name) for name in ("method", "base_policy", "selection", "estimator")}
    return mission.model_copy(
        update={
            "sensor": mission.sensor.model_copy(update={k: v for k, v in sensor.items() if v is not None}),
            "planner": mission.planner.model_copy(update={k: v for k, v in planner.items() if v is not None}),
        }
    )


def _flown(recorded: Sequence[Recorded], bearings: int) -> tuple[MissionState | None, dict[int, BeliefUpdated]]:
    """The last state of so many counted bearings, and what was said in flight after each number of them."""
    state, found, said = MissionState(), None, {}
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
        if isinstance(record.event, BeliefUpdated):
            said[record.event.bearings] = record.event
        if state.spec is not None and len(state.bearings) == bearings:
            found = state
    return found, said


def _as_wanted(fact: BearingMeasured, wanted: WhatIfRequest) -> BearingMeasured:
    return fact if wanted.sigma_deg is None else fact.model_copy(update={"sigma_deg": wanted.sigma_deg})


def _plan(task: Localization, measured: Sequence[BearingMeasured], platform: Place) -> tuple[PlanChosen | None, str]:
    belief = task.planning_belief(task.planner_bearings(measured))
    here = task.frame.to_enu(GeoPoint(platform.lat, platform.lon))
    number = max((fact.place_number for fact in measured), default=0) + 1
    try:
        return next_place(task, belief, measured, here, number, (), threads=1), ""
    except PlannerError as error:
        return None, str(error)


def _step(then: BeliefUpdated, flown: BeliefUpdated | None) -> WhatIfStep:
    return WhatIfStep(
        bearings=then.bearings,
        expected_rmse_m=None if then.estimate is None else then.estimate.expected_rmse_m,
        localized=then.localized,
        flown_expected_rmse_m=None if flown is None or flown.estimate is None else flown.estimate.expected_rmse_m,
        flown_localized=None if flown is None else flown.localized,
    )
