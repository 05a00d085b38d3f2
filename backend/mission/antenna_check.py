"""The antenna before a known emitter: the vehicle is turned by hand, on the ground, while the receiver listens."""

from __future__ import annotations

import asyncio
import math
from dataclasses import replace

import numpy as np

from backend.events import AntennaChecked, CheckFact
from backend.mission.equipment import Equipment
from backend.mission.errors import MissionInputError
from backend.mission.listening import Listening, expected_pulses
from backend.spec import MissionSpec, Place
from hardware.direction_finding.calibration import check_antenna
from hardware.direction_finding.heading import ClockOffset, estimate_clock_offset
from hardware.direction_finding.sweep import SweepError, assemble_sweep, turned_deg
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint, HeadingSample, PowerSample, PreflightCheck

WHOLE_TURN_DEG = 355.0
LOOK_S = 0.2
BEARING_ONLY_M = 1000.0
"""An emitter of which only the bearing is known is taken to stand this far away."""
CLOCK_ALLOWED_S = 0.25


async def check_by_hand(
    equipment: Equipment, mission: MissionSpec, emitter: Place | float, wait_s: float, by: str
) -> AntennaChecked:
    """Listen until the vehicle was turned once all the way round, at most `wait_s` of the wall, and judge.

    emitter: its place, or its bearing in degrees clockwise from true north. Raises MissionInputError when the vehicle's
    own place is not known.
    """
    here = equipment.vehicle.telemetry().position
    if here is None:
        raise MissionInputError("the vehicle does not know where it is", "wait for a GPS fix", "emitter")
    known = _place(emitter, here)
    listening = Listening(
        equipment.receiver,
        equipment.clock,
        mission.emitter.frequency_hz,
        mission.timers.receiver_silent_s,
        expected_pulses(mission.emitter),
    )
    listening.start()
    began_s = equipment.clock.now()
    try:
        for _ in range(math.ceil(wait_s / LOOK_S)):
            await asyncio.sleep(LOOK_S)
            headings = equipment.vehicle.headings(began_s)
            if turned_deg(np.array([h.heading_deg for h in headings])) >= WHOLE_TURN_DEG:
                break
        await equipment.clock.sleep(LOOK_S)
        samples = [s for s in listening.between(began_s, equipment.clock.now()) if s.detected]
        headings = equipment.vehicle.headings(began_s)
        trouble = listening.trouble
    finally:
        await listening.stop()
    found = await asyncio.to_thread(_judge, equipment, mission, samples, headings, here, known, trouble)
    fact = CheckFact(
        name=found.name, ok=found.ok, detail=found.detail, remedy=found.remedy, blocking=found.blocking and not found.ok
    )
    return AntennaChecked(check=fact, emitter=Place(lat=known.lat_deg, lon=known.lon_deg), by=by)


def _place(emitter: Place | float, here: GeoPoint) -> GeoPoint:
    if isinstance(emitter, Place):
        return GeoPoint(emitter.lat, emitter.lon)
    angle = math.radians(emitter)
    return LocalFrame(here).to_geo(BEARING_ONLY_M * math.sin(angle), BEARING_ONLY_M * math.cos(angle))


def _judge(
    equipment: Equipment,
    mission: MissionSpec,
    samples: list[PowerSample],
    headings: list[HeadingSample],
    here: GeoPoint,
    emitter: GeoPoint,
    trouble: str,
) -> PreflightCheck:
    """Heavy: call it off the event loop."""
    if not samples and trouble:
        return PreflightCheck("antenna", False, f"the receiver: {trouble}", "plug it in and tune it, then turn again")
    clock = ClockOffset(0.0, False)
    try:
        clock = estimate_clock_offset(samples, headings, equipment.pattern)
        sweep = assemble_sweep(
            samples,
            headings,
            frequency_hz=mission.emitter.frequency_hz,
            altitude_amsl_m=0.0,
            position=here,
            clock_offset_s=clock.offset_s if clock.identified else 0.0,
        )
    except SweepError as error:
        return PreflightCheck("antenna", False, error.problem, error.remedy)
    found = check_antenna(sweep, equipment.pattern, emitter)
    if clock.identified and abs(clock.offset_s) > CLOCK_ALLOWED_S:
        late = f"the receiver's clock is {clock.offset_s:+.2f} s off the vehicle's"
        if found.ok:
            return replace(found, ok=False, detail=late, remedy="set both by GPS or NTP, then turn again")
        return replace(found, detail=f"{found.detail}; {late}")
    return found
