"""The preflight checklist: the vehicle's own checks, the receiver, the specification and safety at the start."""

from __future__ import annotations

import asyncio

from backend.events import CheckFact
from backend.mission.equipment import Equipment
from backend.mission.errors import MissionInputError
from backend.mission.fresh import fresh
from backend.mission.listening import Listening, expected_pulses
from backend.mission.localization import Localization, localization
from backend.mission.planning import lay_out_ways
from backend.mission.safety import Situation, start_vetoes
from backend.spec import MissionSpec, Place
from hardware.readings import PreflightCheck, Telemetry

RECEIVER_WALL_S = 3.0


def home_of(telemetry: Telemetry) -> tuple[Place | None, float | None]:
    """The vehicle's home and its height AMSL; where it stands when the autopilot has not said."""
    point = telemetry.home or telemetry.position
    amsl = telemetry.home_amsl_m
    if amsl is None and telemetry.altitude_amsl_m is not None:
        amsl = telemetry.altitude_amsl_m - (telemetry.altitude_relative_m or 0.0)
    return (None if point is None else Place(lat=point.lat_deg, lon=point.lon_deg)), amsl


def task_at(mission: MissionSpec, telemetry: Telemetry) -> tuple[Localization | None, CheckFact]:
    """The mission's task seen from the vehicle's home, and the line of the checklist that says whether there is one."""
    home, amsl = home_of(telemetry)
    if home is None or amsl is None:
        return None, _fact("area", False, "the vehicle's home is not known yet", "wait for a GPS fix")
    try:
        task = localization(mission, home, amsl)
    except MissionInputError as error:
        return None, _fact("area", False, str(error), error.remedy)
    lay_out_ways(task)
    return task, _fact("area", True, f"{task.limits.fence.area:.0f} m2 to fly in", "")


async def checklist(
    mission: MissionSpec, equipment: Equipment, listening: Listening | None, antenna: CheckFact | None = None
) -> tuple[tuple[CheckFact, ...], Localization | None]:
    """All checks, and the task when the specification is sound. listening: that of a running mission, else None.

    antenna: what its check before a known emitter said, when there was one.
    """

    def situation() -> Situation:
        return Situation(equipment.vehicle.telemetry(), equipment.clock.now())

    await fresh(situation)
    checks = [_of(check) for check in await equipment.vehicle.preflight()]
    task, sound = await asyncio.to_thread(task_at, mission, equipment.vehicle.telemetry())
    checks.append(sound)
    if task is not None:
        vetoes = start_vetoes(task.limits, await fresh(situation))
        checks += [_fact(f"safety: {v.rule}", False, v.detail, v.remedy) for v in vetoes]
        if not vetoes:
            checks.append(_fact("safety", True, "fence, battery and position allow the start", ""))
    checks.append(await _receiver(mission, equipment, listening))
    checks.append(_pattern(mission, equipment))
    checks += [] if antenna is None else [antenna]
    return tuple(checks), task


async def _receiver(mission: MissionSpec, equipment: Equipment, listening: Listening | None) -> CheckFact:
    frequency = mission.emitter.frequency_hz
    remedy = "check that the receiver is plugged in and not in use by another program"
    if listening is not None:
        return _fact("receiver", listening.state == "ok", listening.trouble or "delivers samples", remedy)
    pulses = expected_pulses(mission.emitter)
    trial = Listening(equipment.receiver, equipment.clock, frequency, mission.timers.receiver_silent_s, pulses)
    trial.start()
    try:
        heard = await trial.first_sample(RECEIVER_WALL_S + (0.0 if pulses is None else 2.0 * pulses.period_s))
        if heard:
            return _fact("receiver", True, f"delivers samples at {frequency / 1e6:.4f} MHz", "")
        if pulses is not None and trial.last is not None:
            unheard = f"works, but hears no pulse of the tag at {frequency / 1e6:.4f} MHz"
            return _fact("receiver", False, unheard, "bring the tag near, or know that it is out of range here", False)
        blocking = pulses is None or trial.state == "lost"
        return _fact("receiver", False, trial.trouble or "delivers no samples", remedy, blocking)
    finally:
        await trial.stop()


def _pattern(mission: MissionSpec, equipment: Equipment) -> CheckFact:
    pattern = equipment.pattern
    detail = pattern.other_frequency(mission.emitter.frequency_hz)
    if detail:
        return _fact("antenna pattern", False, detail, "measure the pattern at the emitter's frequency", False)
    return _fact("antenna pattern", True, pattern.name, "")


def _of(check: PreflightCheck) -> CheckFact:
    return CheckFact(name=check.name, ok=check.ok, detail=check.detail, remedy=check.remedy, blocking=check.blocking)


def _fact(name: str, ok: bool, detail: str, remedy: str, blocking: bool = True) -> CheckFact:
    return CheckFact(name=name, ok=ok, detail=detail, remedy=remedy, blocking=blocking)
