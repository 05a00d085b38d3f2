"""How a craft turns for a sweep as far as it needs: to the sector's beginning, through it, and on while a look says so.

Every leg is a turn of the vehicle that telemetry confirms, so a hold ends it as it ends a whole turn.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.craft.sweep_turns import turn_and_listen
from backend.events import TurnFact
from backend.reasons import Reason
from backend.search.sector import CIRCLE_DEG, TOLERANCE_DEG, GoOn, Stop, TurnPlan, look, turn_fact
from backend.search.turn_schedule import Round
from backend.spec import EmitterSpec, MissionSpec
from hardware.direction_finding.sweep import SweepError, assemble_sweep, turned_deg
from hardware.readings import BearingReading, Sweep

FACING_DEG = 10.0
"""A nose within this of the sector's beginning needs no swing: the margin holds more."""


@dataclass(slots=True)
class TurnShown:
    """What whoever watches sees of the turn under way. emitters: those that are listened to. goal_deg: degrees to turn,
    as decided so far. began_s: None while the nose swings to where the turn begins."""

    emitters: tuple[EmitterSpec, ...] = ()
    goal_deg: float = CIRCLE_DEG
    begin_deg: float | None = None
    because: Reason | None = None
    began_s: float | None = None


@dataclass(frozen=True, slots=True)
class Turned:
    """began_s, ended_s: of what was listened to. turn None: once all the way round, as ever."""

    began_s: float
    ended_s: float
    turn: TurnFact | None

    def as_turned(self, sweep: Sweep) -> Sweep:
        """With what the direction finder must know of the turn."""
        return replace(sweep, partial=self.turn is not None and self.turn.partial)


async def turn_as_planned(
    equipment: CraftEquipment,
    mission: MissionSpec,
    one: Round,
    wanted: Collection[str],
    listening: Listening,
    plan: TurnPlan | None,
    shown: TurnShown,
) -> Turned:
    """plan None: the mission turns whole circles and records nothing of why. one, wanted: as in `turn_and_listen`,
    where the turn is a whole one. Raises VehicleError."""
    shown.emitters = one.emitters
    if plan is None or plan.begin_deg is None:
        shown.began_s = equipment.clock.now()
        began_s, ended_s = await turn_and_listen(equipment, mission, one, wanted, listening)
        if plan is None:
            return Turned(began_s, ended_s, None)
        offset = equipment.pattern.offset_to_nose_deg
        heard = [h.heading_deg for h in equipment.vehicle.headings(began_s)]
        begin_deg = heard[0] + offset if heard else offset
        return Turned(began_s, ended_s, turn_fact(plan, begin_deg, CIRCLE_DEG, (), look(plan, 0.0, CIRCLE_DEG, None)))
    (emitter,) = mission.emitters
    return await _through_sector(equipment, emitter, mission.sensor.turn_rate_deg_s, listening, plan, shown)


async def _through_sector(
    equipment: CraftEquipment,
    emitter: EmitterSpec,
    rate_deg_s: float,
    listening: Listening,
    plan: TurnPlan,
    shown: TurnShown,
) -> Turned:
    vehicle, offset = equipment.vehicle, equipment.pattern.offset_to_nose_deg
    assert plan.begin_deg is not None
    shown.begin_deg, shown.goal_deg, shown.because = plan.begin_deg, plan.width_deg, plan.why
    heading_deg = vehicle.telemetry().heading_deg
    swing = 0.0 if heading_deg is None else math.remainder(plan.begin_deg - offset - heading_deg, CIRCLE_DEG)
    if abs(swing) > FACING_DEG:
        await vehicle.turn(rate_deg_s, swing)
    began_s = shown.began_s = equipment.clock.now()
    steps = list[GoOn]()
    await vehicle.turn(rate_deg_s, plan.width_deg)
    while True:
        ended_s = equipment.clock.now()
        await listening.heard_until(ended_s)
        nose = np.unwrap([h.heading_deg for h in vehicle.headings(began_s)], period=CIRCLE_DEG)
        turned = min(turned_deg(nose), CIRCLE_DEG)
        begin_deg = float(nose[0]) + offset if nose.size else plan.begin_deg
        reading = await _reading(equipment, emitter, listening, (began_s, ended_s), turned)
        decided = look(plan, begin_deg, turned, reading)
        if isinstance(decided, Stop):
            return Turned(began_s, ended_s, turn_fact(plan, begin_deg, turned, steps, decided))
        steps.append(decided)
        shown.goal_deg, shown.because = turned + decided.by_deg, decided.why
        await vehicle.turn(rate_deg_s, decided.by_deg)


async def _reading(
    equipment: CraftEquipment,
    emitter: EmitterSpec,
    listening: Listening,
    heard_s: tuple[float, float],
    turned: float,
) -> BearingReading | None:
    """Of what was heard so far; None when that is no sweep."""
    heard = listening.of(emitter, *heard_s)
    try:
        sweep = assemble_sweep(
            [sample for sample in heard if sample.detected],
            equipment.vehicle.headings(heard_s[0] - 1.0),
            frequency_hz=emitter.frequency_hz,
            altitude_amsl_m=math.nan,
        )
    except SweepError:
        return None
    partial = replace(sweep, partial=turned < CIRCLE_DEG - TOLERANCE_DEG)
    return await asyncio.to_thread(equipment.finder.estimate, partial, equipment.pattern)
