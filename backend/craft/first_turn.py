"""Would the craft come home before its first turn? Asked on the ground by what is asked in flight.

In flight the first place is held against the battery once it is chosen, after the climb, and one that is too far away
brings the craft home: it took off for nothing. So the place is chosen before the start, by the same planner from the
same knowledge, and held against the charge that the climb leaves; so is the next one where a search goes on from the
ground. A climb tells which way the wind blows, along the way
perhaps, and the flight reckons with more then: nobody on the ground knows that, so that it is a caution and no refusal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise, product

from backend.craft.endurance import CLIMB_M_S, Endurance, in_strong_wind
from backend.craft.safety import Limits, Situation, battery_vetoes
from backend.events import FIRST_CRAFT
from backend.reasons import Reason, checks, safety
from backend.search.choosing import choose_place
from backend.search.planning import way_to
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.search.turn_schedule import turn_s
from backend.spec import MissionSpec, Place
from planner.travel import straight_suffices
from planner.types import PlannerError


def limits_with(limits: Limits, mission: MissionSpec, search: SearchState) -> Limits:
    """The limits with the turn that is made for what is still looked for."""
    sought = [emitter.emitter_id for emitter in search.sought]
    return replace(limits, measurement_time_s=turn_s(mission, sought))


@dataclass(frozen=True, slots=True)
class FirstTurn:
    """refusal: the flight would end before its first turn. caution: it may, in wind."""

    refusal: Reason | None = None
    caution: Reason | None = None


@dataclass(frozen=True, slots=True)
class Onward:
    """Of a search that goes on from the ground: where it is to turn next, None: not planned yet, and places that are
    not to be chosen."""

    chosen: Place | None = None
    avoid: tuple[Place, ...] = ()
    craft_id: str = FIRST_CRAFT


FROM_NOTHING = Onward()


def first_turn(
    task: SearchTask,
    search: SearchState,
    limits: Limits,
    situation: Situation,
    threads: int,
    onward: Onward = FROM_NOTHING,
) -> FirstTurn:
    """Of a vehicle that stands ready. Plans where the answer depends on it, else is quick. Synchronous; a thread's."""
    telemetry = situation.telemetry
    if telemetry.battery_percent is None or telemetry.position is None:
        return FirstTurn()
    limits, here = limits_with(limits, task.mission, search), limits.frame.to_enu(telemetry.position)
    height = task.altitude_at(telemetry.position) - task.home_amsl_m
    climb = situation.endurance.likely_percent(max(height, 0.0) / CLIMB_M_S)
    left = replace(telemetry, battery_percent=max(telemetry.battery_percent - climb, 0.0), altitude_relative_m=height)
    climbed = replace(situation, telemetry=left)
    if straight_suffices(limits.problem) and not _short_in_wind(limits, climbed, _farthest(limits, here)):
        return FirstTurn()
    try:
        place = onward.chosen or _next_place(task, search, here, situation.now_s, threads, onward)
        points = [here, *way_to(task.first, here, limits.frame.to_enu(place))]
    except PlannerError as error:  # no place or no way: in flight there is nothing to plan, and it comes home
        return FirstTurn(error.reason)
    legs = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
    short = _short(limits, climbed, legs)
    far_m = sum(math.hypot(*leg) for leg in legs)
    if short is None:
        windy = _short_in_wind(limits, climbed, legs)
        return FirstTurn(caution=checks.FirstTurnInLittleWind(telemetry.battery_percent, far_m) if windy else None)
    takes = telemetry.battery_percent - short.left_percent
    full = takes + short.needed_percent + limits.reserve_percent <= 100.0
    kind = safety.FirstTurnBeyondCharge if full else safety.FirstTurnBeyondBattery
    return FirstTurn(kind(telemetry.battery_percent, far_m, takes, short.needed_percent, limits.reserve_percent))


def _next_place(
    task: SearchTask, search: SearchState, here: tuple[float, float], now_s: float, threads: int, onward: Onward
) -> Place:
    """Raises PlannerError."""
    number, avoid = search.place_number + 1, onward.avoid
    return choose_place(task, search, here, number, now_s, threads, onward.craft_id, avoid).place


def _short(limits: Limits, climbed: Situation, legs: list[tuple[float, float]]) -> safety.BatteryShort | None:
    """What the flight's rule has against legs (east, north m) from where the vehicle stands, and a turn there."""
    position = climbed.telemetry.position
    if position is None:
        return None
    here = limits.frame.to_enu(position)
    end = limits.frame.to_geo(here[0] + sum(leg[0] for leg in legs), here[1] + sum(leg[1] for leg in legs))
    found = battery_vetoes(limits, climbed, limits.measurement_time_s, legs, end)
    return next((veto for veto in found if isinstance(veto, safety.BatteryShort)), None)


def _short_in_wind(limits: Limits, climbed: Situation, legs: list[tuple[float, float]]) -> bool:
    """Whether it is short as soon as a strong wind is known to blow from some direction."""

    def blown(endurance: Endurance) -> Situation:
        return replace(climbed, endurance=endurance)

    return any(_short(limits, blown(one), legs) is not None for one in in_strong_wind())


def _farthest(limits: Limits, here: tuple[float, float]) -> list[tuple[float, float]]:
    """A straight leg that is as long as any that the fence leaves room for."""
    left, bottom, right, top = limits.fence.bounds
    corners = [(x - here[0], y - here[1]) for x, y in product((left, right), (bottom, top))]
    return [max(corners, key=lambda corner: math.hypot(*corner))]
