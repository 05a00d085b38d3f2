"""How a craft turns for a sweep: once for carriers; slowly for a tag, again until it listened long enough each way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.spec import EmitterSpec, MissionSpec
from hardware.readings import HeadingSample, PowerSample

SLICES = 16
SPARE = 1.1
"""The turn is so much slower than the pulses just need: they do not come in step with the headings."""
SILENT_AFTER = 1.5
"""A heading that was listened to for this many times its pulses without hearing them has none to offer."""
FEWER = 1
"""Pulses that a heading may lack that was listened to for about as long as all of them take: a tag keeps no step with
the turn, nor the turn, which goes in steps of ten degrees, with the headings."""
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
        heard = [(tag, listening.of(tag, began_s, ended_s)) for tag in _tags(mission)]
        if all(complete(tag, mission.sensor.pulses_per_heading, samples, headings) for tag, samples in heard):
            break
    return began_s, ended_s


def complete(tag: EmitterSpec, wanted: int, samples: Sequence[PowerSample], headings: Sequence[HeadingSample]) -> bool:
    """Whether each heading has heard `wanted` pulses, or was listened to long enough to know that it hears none.

    Headings are counted from where the turn began, else the one that it begins and ends with falls into two halves, and
    between two pulses each.
    """
    if len(headings) < 2:
        return False
    at_s = np.array([h.at_s for h in headings])
    nose: NDArray[np.float64] = np.unwrap(np.array([h.heading_deg for h in headings]), period=360.0)
    nose -= nose[0]
    heard = _in_slices(np.interp(np.array([s.at_s for s in samples if s.detected], dtype=np.float64), at_s, nose))
    began_s, turned_s = headings[0].at_s, headings[-1].at_s - headings[0].at_s
    moments = np.linspace(began_s, began_s + turned_s, max(int(turned_s * 20.0), 2))
    due = _in_slices(np.interp(moments, at_s, nose)) * (turned_s / moments.size / tag.pulse_period_s)
    nearly = (heard >= max(wanted - FEWER, 1)) & (due * SPARE >= wanted)
    return bool(((heard >= wanted) | nearly | (due >= SILENT_AFTER * wanted)).all())


def _in_slices(nose_deg: NDArray[np.float64]) -> NDArray[np.int64]:
    """(SLICES,) how many of the headings fall into each part of the circle."""
    return np.bincount((nose_deg % 360.0 / (360.0 / SLICES)).astype(np.int64) % SLICES, minlength=SLICES)
