"""How a craft turns for a sweep: once for carriers; slowly for a tag, again until it listened long enough each way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.spec import EmitterSpec, MissionSpec
from hardware.direction_finding.sweep import unheard_slices
from hardware.readings import HeadingSample, PowerSample

SLICES = 16
SPARE = 1.1
"""The turn is so much slower than the pulses just need: they do not come in step with the headings."""
SILENT_AFTER = 1.5
"""A heading that was listened to for this many times its pulses without hearing them has none to offer."""
MOST_TURNS = 3
SLOWEST_DEG_S = 2.0


def turn_rate_deg_s(mission: MissionSpec) -> float:
    """As specified, but for tags no faster than lets each sixteenth of the circle hear their pulses in one turn."""
    rate = mission.sensor.turn_rate_deg_s
    for emitter in _tags(mission):
        turn_s = SLICES * mission.sensor.pulses_per_heading * emitter.pulse_period_s * SPARE
        rate = min(rate, max(360.0 / turn_s, SLOWEST_DEG_S))
    return rate


def _tags(mission: MissionSpec) -> list[EmitterSpec]:
    return [emitter for emitter in mission.emitters if emitter.kind == "pulsed"]


async def turn_and_listen(equipment: CraftEquipment, mission: MissionSpec, listening: Listening) -> tuple[float, float]:
    """Begin and end (s) of the turning, whose samples have all arrived by now. Raises VehicleError."""
    began_s = ended_s = equipment.clock.now()
    for _ in range(MOST_TURNS if _tags(mission) else 1):
        await equipment.vehicle.turn(turn_rate_deg_s(mission))
        ended_s = equipment.clock.now()
        await listening.heard_until(ended_s)
        headings = equipment.vehicle.headings(began_s)
        heard = [(tag, listening.between(began_s, ended_s, tag.frequency_hz)) for tag in _tags(mission)]
        if all(complete(tag, mission.sensor.pulses_per_heading, samples, headings) for tag, samples in heard):
            break
    return began_s, ended_s


def complete(tag: EmitterSpec, wanted: int, samples: Sequence[PowerSample], headings: Sequence[HeadingSample]) -> bool:
    """Whether each heading has heard `wanted` pulses, or was listened to long enough to know that it hears none."""
    if len(headings) < 2:
        return False
    at_s = np.array([h.at_s for h in headings])
    nose = np.unwrap(np.array([h.heading_deg for h in headings]), period=360.0)
    heard_s = [s.at_s for s in samples if s.detected]
    lacking = unheard_slices(np.interp(heard_s, at_s, nose) % 360.0, SLICES, wanted)
    began_s, turned_s = headings[0].at_s, headings[-1].at_s - headings[0].at_s
    moments = np.linspace(began_s, began_s + turned_s, max(int(turned_s * 20.0), 2))
    slices = (np.interp(moments, at_s, nose) % 360.0 / (360.0 / SLICES)).astype(np.int64) % SLICES
    listened_s = np.bincount(slices, minlength=SLICES) * (at_s[-1] - at_s[0]) / moments.size
    enough_s = SILENT_AFTER * wanted * tag.pulse_period_s
    return all(listened_s[int(middle / (360.0 / SLICES))] >= enough_s for middle in lacking)
