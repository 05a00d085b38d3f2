"""One measurement: turn on the spot, listen to all emitters, make a sweep of each and find its direction."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from itertools import count
from statistics import fmean
from uuid import uuid4

import numpy as np

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.craft.sector_turns import Turned, TurnShown, turn_as_planned
from backend.events import BearingMeasured, CraftSource, SilenceFact, SweepRejected
from backend.ports import SectorShown
from backend.reasons import Reason
from backend.search.sector import TurnPlan
from backend.search.sweep_facts import Taken, rejected, sweep_fact
from backend.search.turn_schedule import turn_schedule
from backend.spec import EmitterSpec, MissionSpec
from hardware.direction_finding.silence import chances_by_heading, relative_gain_db
from hardware.direction_finding.sweep import SweepError, assemble_sweep, turned_deg
from hardware.ports import ReceiverError, VehicleError
from hardware.readings import PowerSample, Sweep
from hardware.reasons.receiver import NothingHeardInTurn
from hardware.reasons.sweep import NoPulseHeard, PulsesNotGiven, RhythmNotHeard
from hardware.reasons.vehicle import PositionLost
from hardware.reasons.vehicle_news import ClockRateOdd

PROGRESS_S = 0.2


@dataclass(frozen=True, slots=True)
class Measured:
    """sweep None: the power could not be made into one. fact: what to record."""

    sweep_id: str
    sweep: Sweep | None
    fact: BearingMeasured | SweepRejected


async def measure(
    equipment: CraftEquipment,
    mission: MissionSpec,
    mission_id: str,
    listening: Listening,
    place_number: int,
    attempt: int,
    wanted: Collection[str],
    plan: TurnPlan | None = None,
) -> tuple[Measured, ...]:
    """One result an emitter that was listened to; the turn lasts until those with the ids `wanted` were heard well
    enough, and goes round once for each group of them that the receiver hears at once. plan: of a mission that turns
    only as far as needed.

    Raises VehicleError when the turn fails, ReceiverError when nothing was heard at all.
    """
    ordered_s = equipment.clock.now()
    shown, turned = TurnShown(), dict[str, Turned]()
    sought = set(wanted) or {emitter.emitter_id for emitter in mission.emitters}
    progress = asyncio.create_task(_show_progress(equipment, mission_id, listening, place_number, shown))
    try:
        for one in turn_schedule(mission, sought).rounds:
            done = await turn_as_planned(equipment, mission, one, sought, listening, plan, shown)
            turned |= {emitter.emitter_id: done for emitter in one.emitters}
    finally:
        progress.cancel()
        await asyncio.gather(progress, return_exceptions=True)
    listened = [(emitter, done) for emitter in mission.emitters if (done := turned.get(emitter.emitter_id)) is not None]
    heard = {emitter.emitter_id: listening.of(emitter, done.began_s, done.ended_s) for emitter, done in listened}
    pulsed = any(emitter.kind == "pulsed" for emitter, _ in listened)
    if not any(heard.values()) and not (pulsed and listening.state == "ok"):
        raise ReceiverError(NothingHeardInTurn())
    taken_s = equipment.clock.now() - ordered_s
    results = (
        _result(
            equipment,
            mission,
            emitter,
            heard[emitter.emitter_id],
            listening.not_given(emitter, done.began_s, done.ended_s),
            place_number,
            attempt,
            done,
            taken_s,
        )
        for emitter, done in listened
    )
    return tuple(await asyncio.gather(*results))


async def _result(
    equipment: CraftEquipment,
    mission: MissionSpec,
    emitter: EmitterSpec,
    samples: list[PowerSample],
    not_given: PulsesNotGiven | None,
    place_number: int,
    attempt: int,
    turned: Turned,
    taken_s: float,
) -> Measured:
    """not_given: pulses at its frequency that nobody knows whose they are. taken_s: from the order to the bearing."""
    sweep_id = str(uuid4())
    source = CraftSource(craft_id=equipment.craft_id)
    taken = Taken(emitter.emitter_id, source, sweep_id, place_number, attempt, turned.turn)
    telemetry, headings = equipment.vehicle.telemetry(), equipment.vehicle.headings(turned.began_s - 1.0)
    silence = SilenceFact(
        chances=chances_by_heading(
            sorted({sample.at_s for sample in samples}),  # one that only shows that the receiver lives repeats a time
            headings,
            equipment.pattern.offset_to_nose_deg,
            pulsed=emitter.kind == "pulsed",
        ),
        gain_db=relative_gain_db(equipment.pattern),
    )
    try:
        sweep = assemble_sweep(
            [sample for sample in samples if sample.detected],
            headings,
            frequency_hz=emitter.frequency_hz,
            altitude_amsl_m=math.nan if telemetry.altitude_amsl_m is None else telemetry.altitude_amsl_m,
            position=None,
            tag=emitter.label,
        )
    except SweepError as error:
        if telemetry.position is None:
            raise VehicleError(PositionLost()) from error
        unheard = emitter.kind == "pulsed" and not any(sample.detected for sample in samples)
        reason = _unheard(not_given) if unheard else error.reason
        told = silence if unheard and samples and not_given is None else None
        return Measured(sweep_id, None, rejected(taken, telemetry.position, 0.0, reason, silence=told))
    sweep = turned.as_turned(sweep)
    if telemetry.odd_clock_rate is not None:  # it became so during the turn
        odd = ClockRateOdd(telemetry.odd_clock_rate)
        return Measured(sweep_id, sweep, rejected(taken, sweep.position, 0.0, odd))
    reading = await asyncio.to_thread(equipment.finder.estimate, sweep, equipment.pattern)
    if not_given is not None:
        reading = replace(reading, remarks=(*reading.remarks, not_given))
    middle_s = fmean((turned.began_s, turned.ended_s))
    return Measured(sweep_id, sweep, sweep_fact(taken, mission.sensor, sweep, reading, taken_s, middle_s, silence))


def _unheard(not_given: PulsesNotGiven | None) -> Reason:
    if not_given is None:
        return NoPulseHeard()
    left = not_given.overlapping + not_given.unclear + not_given.strangers
    return RhythmNotHeard(not_given.given, left)


async def _show_progress(
    equipment: CraftEquipment,
    mission_id: str,
    listening: Listening,
    place_number: int,
    shown: TurnShown,
) -> None:
    """The running sweep to whoever watches: antenna heading and power so far, of each emitter in turn."""
    offset = equipment.pattern.offset_to_nose_deg
    for number in count():
        await equipment.clock.sleep(PROGRESS_S)
        await asyncio.sleep(0.05)
        if shown.began_s is None:
            continue
        headings = equipment.vehicle.headings(shown.began_s)
        emitter = shown.emitters[number % len(shown.emitters)]
        found = listening.of(emitter, shown.began_s, equipment.clock.now())
        samples = [s for s in found if s.detected]
        if len(headings) < 2 or not samples:
            continue
        nose = np.unwrap(np.array([h.heading_deg for h in headings]), period=360.0)
        at = np.interp([s.at_s for s in samples], [h.at_s for h in headings], nose)
        equipment.publisher.sweep_progress(
            mission_id,
            equipment.craft_id,
            emitter.emitter_id,
            place_number,
            [float(h) for h in (at + offset) % 360.0],
            [s.power_db for s in samples],
            turned_deg(nose),
            None if shown.begin_deg is None else SectorShown(shown.begin_deg, shown.goal_deg, shown.because),
        )
