"""How a sweep turns: once for a carrier; for a tag slowly, and again until every heading was listened to enough."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from backend.mission.equipment import Equipment
from backend.mission.listening import Listening
from backend.spec import MissionSpec
from hardware.direction_finding.sweep import unheard_slices
from hardware.readings import HeadingSample, PowerSample

SLICES = 16
SPARE = 1.1
"""The turn is so much slower than the pulses just need: they do not come in step with the headings."""
PATIENCE = 1.5
"""A heading that was listened to for so many times its pulses without hearing them has none to offer."""
MOST_TURNS = 3
SLOWEST_DEG_S = 2.0


def turn_rate_deg_s(mission: MissionSpec) -> float:
    """As specified, but for a tag no faster than lets each sixteenth of the circle hear its pulses in one turn."""
    rate, emitter = mission.sensor.turn_rate_deg_s, mission.emitter
    if emitter.kind == "carrier":
        return rate
    turn_s = SLICES * mission.sensor.pulses_per_heading * emitter.pulse_period_s * SPARE
    return max(min(rate, 360.0 / turn_s), SLOWEST_DEG_S)


async def turn_and_listen(equipment: Equipment, mission: MissionSpec, listening: Listening) -> tuple[float, float]:
    """Begin and end (s) of the turning, whose samples have all arrived by now. Raises VehicleError."""
    began_s = ended_s = equipment.clock.now()
    for _ in range(1 if mission.emitter.kind == "carrier" else MOST_TURNS):
        await equipment.vehicle.turn(turn_rate_deg_s(mission))
        ended_s = equipment.clock.now()
        await listening.heard_until(ended_s)
        if complete(mission, listening.between(began_s, ended_s), equipment.vehicle.headings(began_s)):
            break
    return began_s, ended_s


def complete(mission: MissionSpec, samples: Sequence[PowerSample], headings: Sequence[HeadingSample]) -> bool:
    """Whether each heading has heard enough pulses, or was listened to long enough to know that it hears none."""
    if mission.emitter.kind == "carrier":
        return True
    if len(headings) < 2:
        return False
    at_s = np.array([h.at_s for h in headings])
    nose = np.unwrap(np.array([h.heading_deg for h in headings]), period=360.0)
    heard_s = [s.at_s for s in samples if s.detected]
    wanted = mission.sensor.pulses_per_heading
    lacking = unheard_slices(np.interp(heard_s, at_s, nose) % 360.0, SLICES, wanted)
    moments = np.linspace(at_s[0], at_s[-1], max(int((at_s[-1] - at_s[0]) * 20.0), 2))
    slices = (np.interp(moments, at_s, nose) % 360.0 / (360.0 / SLICES)).astype(np.int64) % SLICES
    listened_s = np.bincount(slices, minlength=SLICES) * (at_s[-1] - at_s[0]) / moments.size
    enough_s = PATIENCE * wanted * mission.emitter.pulse_period_s
    return all(listened_s[int(middle / (360.0 / SLICES))] >= enough_s for middle in lacking)
