"""The preflight checklist: the vehicle's own checks, the receiver, the specification and safety at the start."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Sequence

import numpy as np

from backend.craft.endurance import Endurance, unknown
from backend.craft.equipment import CraftEquipment
from backend.craft.first_turn import FirstTurn, first_turn
from backend.craft.ground_check import ground_checks, knows_nothing
from backend.craft.listening import Listening, channels_for, channels_of
from backend.craft.nets import nets_check
from backend.craft.recent_telemetry import recent
from backend.craft.return_altitude import least_return_altitude_m, return_altitude_check
from backend.craft.safety import Limits, Situation, battery_to_return_percent, limits_of, start_vetoes
from backend.craft.way_home import ABOVE_HOME_M
from backend.events import CheckFact
from backend.ports import Grounds
from backend.reasons import Reason, checks
from backend.reasons.refusals import NoHome
from backend.search.errors import MissionInputError
from backend.search.planning import lay_out_ways
from backend.search.state import SearchState
from backend.search.task import SearchTask, search_task
from backend.search.turn_schedule import heard_at_once, turn_s, turn_schedule
from backend.spec import MissionSpec, Place
from backend.terrain import Terrain
from hardware.frame import LocalFrame
from hardware.ports import LOST_PERCENT
from hardware.readings import Channel, CheckName, PreflightCheck, Telemetry
from hardware.reasons.receiver import SamplesLost
from planner.types import FloatArray

RECEIVER_WALL_S = 3.0
COUNTED_S = 2.0
"""For so long a receiver is asked what it loses: its first tenth of a second tells nothing."""
FEWEST_TURNS = 2
"""One place tells a direction and no distance."""


def home_of(telemetry: Telemetry) -> tuple[Place | None, float | None]:
    """The vehicle's home and its height AMSL; where it stands when the autopilot has not said.

    Both autopilots make the place and the height where they are armed their home, and until then tell of the last one:
    a vehicle that was carried, or landed elsewhere, or whose barometer drifts, takes off from a home that nobody has
    heard of yet.
    """
    stands, amsl = telemetry.altitude_amsl_m, telemetry.home_amsl_m
    if stands is not None and _waits(telemetry):
        amsl = stands
    elif stands is not None and amsl is None:
        amsl = stands - (telemetry.altitude_relative_m or 0.0)
    home = telemetry.position if _home_away_m(telemetry) is not None else telemetry.home
    return home or telemetry.position, amsl


def _waits(telemetry: Telemetry) -> bool:
    """To be armed."""
    return telemetry.armed is False and telemetry.in_air is False


def _home_away_m(telemetry: Telemetry) -> float | None:
    """How far a vehicle that waits to be armed stands from the home that it tells of; None where it is at home."""
    place, home = telemetry.position, telemetry.home
    if place is None or home is None or telemetry.altitude_amsl_m is None:
        return None
    if not _waits(telemetry):
        return None
    away_m = math.hypot(*LocalFrame(home).to_enu(place))
    return away_m if away_m > ABOVE_HOME_M else None


def task_at(mission: MissionSpec, telemetry: Telemetry, terrain: Terrain | None) -> tuple[SearchTask | None, CheckFact]:
    """The mission's task seen from the vehicle's home, and the line of the checklist that says whether there is one."""
    home, amsl = home_of(telemetry)
    if home is None or amsl is None:
        return None, _fact("area", False, NoHome())
    try:
        task = search_task(mission, home, amsl, terrain)
        if terrain is not None and knows_nothing(task):
            task = search_task(mission, home, amsl)
    except MissionInputError as error:
        return None, _fact("area", False, error.reason)
    lay_out_ways(task.first)
    return task, _fact("area", True, checks.RoomToFly(task.fence.area))


async def checklist(
    mission: MissionSpec,
    equipment: CraftEquipment,
    listening: Listening | None,
    antenna: CheckFact | None = None,
    grounds: Grounds | None = None,
    search: SearchState | None = None,
) -> tuple[tuple[CheckFact, ...], SearchTask | None]:
    """All checks, and the task when the specification is sound. listening: that of a running mission, else None.

    antenna: what its check before a known emitter said, when there was one. grounds: where terrain is found, if any.
    search: what is known before the start, from which the first place is chosen; None: it is not asked whether the
    battery lasts for that.
    """

    def situation() -> Situation:
        return Situation(equipment.vehicle.telemetry(), equipment.clock.now())

    await recent(situation)
    found = [check_fact(check) for check in await equipment.vehicle.preflight()]
    away_m = _home_away_m(equipment.vehicle.telemetry())
    found += [] if away_m is None else [_fact("home", False, checks.HomeMovesHere(away_m), blocking=False)]
    home, _ = home_of(equipment.vehicle.telemetry())
    terrain = None if grounds is None or home is None else await grounds.around(home)
    task, sound = await asyncio.to_thread(task_at, mission, equipment.vehicle.telemetry(), terrain)
    least_m = None if task is None else await asyncio.to_thread(least_return_altitude_m, task)
    over_terrain = task is not None and task.ground.terrain is not None
    returns = await return_altitude_check(mission.flight, equipment.vehicle, least_m, over_terrain)
    found += [sound] if returns is None else [returns, sound]
    if task is not None:
        found += await asyncio.to_thread(ground_checks, task)
        limits = limits_of(task)
        found.append(await nets_check(equipment.vehicle, limits))
        vetoes = start_vetoes(limits, await recent(situation))
        first = FirstTurn()
        if search is not None and not vetoes:
            first = await asyncio.to_thread(first_turn, task, search, limits, situation(), equipment.threads)
            vetoes = () if first.refusal is None else (first.refusal,)
        found += [_fact("safety", False, veto) for veto in vetoes]
        if not vetoes:
            found.append(_fact("safety", True, checks.StartAllowed()))
            cautions = await asyncio.to_thread(_battery, limits, situation())
            cautions += [] if cautions or first.caution is None else [first.caution]
            found += [_fact("battery", False, caution, blocking=False) for caution in cautions]
    found.append(await _receiver(mission, equipment, listening))
    found.append(_pattern(mission, equipment))
    found += [] if antenna is None else [antenna]
    return tuple(found), task


async def _receiver(mission: MissionSpec, equipment: CraftEquipment, listening: Listening | None) -> CheckFact:
    groups = heard_at_once(mission.emitters, mission.sensor.receiver_band_hz)
    works: Reason = checks.ReceiverDelivers(len(channels_of(mission)))
    if len(groups) > 1:
        works = checks.ReceiverTakesTurns(len(channels_of(mission)), len(groups), turn_schedule(mission).seconds)
    elif turn_s(mission) > mission.sensor.measurement_time_s:
        works = checks.TurnTakesLong(turn_s(mission))
    if listening is not None:
        trouble = listening.trouble
        if trouble is None:
            return _losing(listening) or _fact("receiver", True, works)
        return _fact("receiver", False, trouble)
    for group in groups:
        wrong = await _wrong_with(mission, equipment, channels_for(group))
        if wrong is not None:
            return wrong
    return _fact("receiver", True, works)


async def _wrong_with(mission: MissionSpec, equipment: CraftEquipment, channels: Sequence[Channel]) -> CheckFact | None:
    """None: every channel of these was heard, and nothing got lost."""
    trial = Listening(equipment.receiver, equipment.clock, channels, mission.timers.receiver_silent_s)
    counted_at_s = equipment.clock.now() + COUNTED_S
    trial.start()
    try:
        unheard = [channel for channel in channels if not await _heard(trial, channel)]
        if not unheard:
            await equipment.clock.sleep(max(counted_at_s - equipment.clock.now(), 0.0))
            return _losing(trial)
        silent = next((channel for channel in unheard if trial.last(channel.frequency_hz) is None), None)
        if silent is None:
            unheard_here = _fact("receiver", False, checks.TagUnheard(unheard[0].frequency_hz), blocking=False)
            return _losing(trial) or unheard_here
        trouble = trial.trouble
        blocking = silent.pulses is None or trial.state == "lost"
        return _fact("receiver", False, checks.NoSamples() if trouble is None else trouble, blocking)
    finally:
        await trial.stop()


def _losing(listening: Listening) -> CheckFact | None:
    lost_percent = listening.lost_percent
    return _fact("receiver", False, SamplesLost(lost_percent), blocking=False) if lost_percent > LOST_PERCENT else None


async def _heard(trial: Listening, channel: Channel) -> bool:
    wall_s = RECEIVER_WALL_S + (0.0 if channel.pulses is None else 2.0 * channel.pulses.period_s)
    return await trial.first_sample(channel.frequency_hz, wall_s)


def _pattern(mission: MissionSpec, equipment: CraftEquipment) -> CheckFact:
    pattern = equipment.pattern
    for emitter in mission.emitters:
        other = pattern.other_frequency(emitter.frequency_hz)
        if other is not None:
            return _fact("pattern", False, other, blocking=False)
    return _fact("pattern", True, checks.PatternInUse(pattern.name))


def check_fact(check: PreflightCheck) -> CheckFact:
    """The hardware's check, as facts and the wire carry it."""
    return CheckFact(name=check.name, ok=check.ok, reason=check.reason, blocking=check.blocking)


def _fact(name: CheckName, ok: bool, reason: Reason, blocking: bool = True) -> CheckFact:
    return CheckFact(name=name, ok=ok, reason=reason, blocking=blocking)


def _battery(limits: Limits, situation: Situation) -> list[Reason]:
    """Cautions about the turns that a full battery, or this one, is sure to last for."""
    charge, corners = situation.telemetry.battery_percent, np.vstack(limits.problem.area)
    if not limits.battery_telemetry or charge is None:
        return []
    if not lasts_for(100.0, limits, unknown(), FEWEST_TURNS, corners.mean(axis=0)):
        return [checks.FewTurnsOnABattery(FEWEST_TURNS, limits.measurement_time_s)]
    farthest = corners[np.hypot(*corners.T).argmax()]
    if not lasts_for(charge, limits, situation.endurance, FEWEST_TURNS, farthest):
        return [checks.FewTurnsOnThisCharge(charge, FEWEST_TURNS, limits.measurement_time_s)]
    return []


def lasts_for(charge_percent: float, limits: Limits, endurance: Endurance, turns: int, out: FloatArray) -> bool:
    """Whether a battery does, with the way out to (2,) m ENU and home, and the reserve."""
    east, north = float(out[0]), float(out[1])
    takes = endurance.way_percent([(east, north)], limits.speed_m_s, turns * limits.measurement_time_s)
    home = battery_to_return_percent(limits, limits.frame.to_geo(east, north), endurance, limits.altitude_relative_m)
    return takes + home + limits.reserve_percent <= charge_percent
