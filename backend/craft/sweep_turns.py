"""How a craft turns for a sweep: once for carriers; slowly for a tag, again until it listened long enough each way."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening, channels_for
from backend.search.turn_schedule import MOST_TURNS, SLICES, SPARE, Round
from backend.spec import EmitterSpec, MissionSpec
from hardware.readings import HeadingSample, PowerSample

SILENT_AFTER = 1.5
"""A heading that was listened to for this many times its pulses without hearing them has none to offer."""
FEWER = 1
"""Pulses that a heading may lack that was listened to for about as long as all of them take: a tag keeps no step with
the turn, nor the turn, which goes in steps of ten degrees, with the headings."""


async def turn_and_listen(
    equipment: CraftEquipment, mission: MissionSpec, one: Round, wanted: Collection[str], listening: Listening
) -> tuple[float, float]:
    """Begin and end (s) of the turning, whose samples have all arrived by now. wanted: emitters by id; it goes round
    again only for these. Raises VehicleError, ReceiverError when the receiver does not change to this round's channels.
    """
    await listening.hear(channels_for(one.emitters))
    tags = [emitter for emitter in one.emitters if emitter.kind == "pulsed" and emitter.emitter_id in wanted]
    began_s = ended_s = equipment.clock.now()
    for _ in range(MOST_TURNS if tags else 1):
        await equipment.vehicle.turn(one.rate_deg_s)
        ended_s = equipment.clock.now()
        await listening.heard_until(ended_s)
        headings = equipment.vehicle.headings(began_s)
        heard = [(tag, listening.of(tag, began_s, ended_s)) for tag in tags]
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
