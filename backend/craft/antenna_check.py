"""The antenna before a known emitter: the vehicle is turned by hand, on the ground, while the receiver listens."""

from __future__ import annotations

import asyncio
import math
from dataclasses import replace

import numpy as np

from backend.craft.checklist import check_fact
from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening, channel_of
from backend.events import AntennaChecked
from backend.reasons import Reason
from backend.reasons.safety import NoPosition
from backend.search.errors import MissionInputError
from backend.spec import MissionSpec
from hardware.direction_finding.calibration import check_antenna
from hardware.direction_finding.heading import ClockOffset, estimate_clock_offset
from hardware.direction_finding.sweep import SweepError, assemble_sweep, turned_deg
from hardware.frame import LocalFrame
from hardware.readings import HeadingSample, Place, PowerSample, PreflightCheck
from hardware.reasons.antenna import AntennaAskew, ReceiverClockOff
from hardware.reasons.vehicle_news import ClockRateOdd

WHOLE_TURN_DEG = 355.0
LOOK_S = 0.2
BEARING_ONLY_M = 1000.0
"""An emitter of which only the bearing is known is taken to stand this far away."""
CLOCK_ALLOWED_S = 0.25


async def check_by_hand(
    equipment: CraftEquipment, mission: MissionSpec, emitter: Place | float, wait_s: float, by: str
) -> AntennaChecked:
    """Listen until the vehicle was turned once all the way round, at most `wait_s` of wall time, and judge.

    emitter: its place, or its bearing in degrees clockwise from true north. Raises MissionInputError when the vehicle's
    own place is not known.
    """
    equipment = equipment.flown_with(mission.sensor)
    here = equipment.vehicle.telemetry().position
    if here is None:
        raise MissionInputError(NoPosition(), "emitter")
    known = _place(emitter, here)
    first = mission.emitters[0]
    listening = Listening(equipment.receiver, equipment.clock, (channel_of(first),), mission.timers.receiver_silent_s)
    listening.start()
    began_s = equipment.clock.now()
    try:
        for _ in range(math.ceil(wait_s / LOOK_S)):
            await asyncio.sleep(LOOK_S)
            headings = equipment.vehicle.headings(began_s)
            if turned_deg(np.array([h.heading_deg for h in headings])) >= WHOLE_TURN_DEG:
                break
        await equipment.clock.sleep(LOOK_S)
        samples = [s for s in listening.of(first, began_s, equipment.clock.now()) if s.detected]
        headings = equipment.vehicle.headings(began_s)
        trouble = listening.trouble
    finally:
        await listening.stop()
    rate = equipment.vehicle.telemetry().odd_clock_rate
    if rate is not None:
        found = PreflightCheck("antenna", False, ClockRateOdd(rate))
    else:
        found = await asyncio.to_thread(_judge, equipment, mission, samples, headings, here, known, trouble)
    fact = check_fact(replace(found, blocking=found.blocking and not found.ok))
    return AntennaChecked(check=fact, emitter=known, by=by)


def _place(emitter: Place | float, here: Place) -> Place:
    if isinstance(emitter, Place):
        return emitter
    angle = math.radians(emitter)
    return LocalFrame(here).to_geo(BEARING_ONLY_M * math.sin(angle), BEARING_ONLY_M * math.cos(angle))


def _judge(
    equipment: CraftEquipment,
    mission: MissionSpec,
    samples: list[PowerSample],
    headings: list[HeadingSample],
    here: Place,
    emitter: Place,
    trouble: Reason | None,
) -> PreflightCheck:
    """Heavy: call it off the event loop."""
    if not samples and trouble is not None:
        return PreflightCheck("antenna", False, trouble)
    clock = ClockOffset(0.0, False)
    try:
        clock = estimate_clock_offset(samples, headings, equipment.pattern)
        sweep = assemble_sweep(
            samples,
            headings,
            frequency_hz=mission.emitters[0].frequency_hz,
            altitude_amsl_m=0.0,
            position=here,
            clock_offset_s=clock.offset_s if clock.identified else 0.0,
        )
    except SweepError as error:
        return PreflightCheck("antenna", False, error.reason)
    found = check_antenna(sweep, equipment.pattern, emitter)
    if isinstance(found.reason, AntennaAskew):
        in_file = math.remainder(found.reason.offset_deg + mission.sensor.bearing_offset_deg, 360.0)
        return replace(found, reason=replace(found.reason, offset_deg=in_file))
    if found.ok and clock.identified and abs(clock.offset_s) > CLOCK_ALLOWED_S:
        return replace(found, ok=False, reason=ReceiverClockOff(clock.offset_s))
    return found
