"""Legs in the field world that are listened on: where the craft and its nose are, and what comes of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from backend.events import CraftSource, HeardOnTheWay
from backend.search.way_facts import Leg, way_fact
from backend.simulation.field_world import Field
from backend.spec import FIRST_EMITTER, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.yaw_swings import Seen, Swinging
from planner.types import FloatArray, FullMotion

Listens = Literal["places", "way", "way_swinging"]
"""At places alone; on the way too, the nose turned to where it leads and then kept there; or on the way while the nose
swings."""
LISTENED_HZ = 10.0


@dataclass(frozen=True, slots=True)
class Flown:
    """A leg, LISTENED_HZ points a second. x, y: (n,) m ENU. nose_deg: (n,) clockwise from north, continuous."""

    x: FloatArray
    y: FloatArray
    nose_deg: FloatArray

    @property
    def heading(self) -> float:
        """Of the nose at its end, rad ccw from east."""
        return math.radians(90.0 - float(self.nose_deg[-1]))

    @property
    def turned_deg(self) -> float:
        """Either way."""
        return float(np.abs(np.diff(self.nose_deg)).sum())


def flown(here: tuple[float, float], place: tuple[float, float], heading: float, swinging: Swinging | None) -> Flown:
    """As the movement model has it: turn to where it leads, accelerate, brake. heading: of the nose before, rad ccw
    from east. swinging: what the nose does from then on; it follows at the rate that is asked for."""
    motion, way = FullMotion(), np.array(place) - np.array(here)
    length = float(np.hypot(*way))
    direction = math.atan2(way[1], way[0])
    turn = math.remainder(direction - heading, 2.0 * math.pi)
    fastest = min(motion.speed, math.sqrt(motion.acceleration * length))
    ramp_s, cruise_s = fastest / motion.acceleration, (length - fastest**2 / motion.acceleration) / fastest
    turning_s = abs(turn) / motion.turn_rate
    at = np.arange(0.0, turning_s + 2.0 * ramp_s + cruise_s, 1.0 / LISTENED_HZ)
    flying = at - turning_s
    speed = np.clip(np.minimum(flying, 2.0 * ramp_s + cruise_s - flying) * motion.acceleration, 0.0, fastest)
    done = np.minimum(np.cumsum(speed) / LISTENED_HZ / length, 1.0)
    nose = 90.0 - np.degrees(heading + turn * np.minimum(at / max(turning_s, 1e-9), 1.0))
    if swinging is not None:
        nose = _swung(nose, at, done * length, length, speed, swinging)
    return Flown(here[0] + done * way[0], here[1] + done * way[1], nose)


def _swung(
    nose: FloatArray, at: FloatArray, flown_m: FloatArray, length: float, speed: FloatArray, swinging: Swinging
) -> FloatArray:
    """nose: (n,) without swings, degrees clockwise from north, continuous. The study's areas have no fence near."""
    found, goal = nose.copy(), float(nose[-1])
    for k in range(1, len(nose)):
        if flown_m[k] <= 0.0:
            continue
        left = goal - found[k - 1]
        found[k] = found[k - 1] + math.copysign(min(abs(left), swinging.plan.rate_deg_s / LISTENED_HZ), left)
        seen = Seen(
            at_s=float(at[k]),
            heading_deg=float(found[k]),
            flown_m=float(flown_m[k]),
            to_go_m=length - float(flown_m[k]),
            speed_m_s=float(speed[k]),
            clear_m=math.inf,
            ours=True,
        )
        if (yaw_deg := swinging.see(seen)) is not None:
            goal = float(found[k]) + math.remainder(yaw_deg - float(found[k]), 360.0)
    return found


def listened(
    field: Field,
    leg: Flown,
    turned_at: Sequence[tuple[float, float]],
    number: int,
    sensor: SensorSpec,
    pattern: AntennaPattern,
) -> HeardOnTheWay:
    """What a mission would record of the leg. turned_at: m ENU, where the craft has turned or will, its end among them.
    number: of the leg, from 0."""
    samples, headings = field.along(leg.x, leg.y, leg.nose_deg, LISTENED_HZ, number)
    begin = field.frame.to_geo(float(leg.x[0]), float(leg.y[0]))
    places = tuple(field.frame.to_geo(*place) for place in turned_at)
    told = Leg(CraftSource(craft_id="craft-1"), number + 1, begin, places)
    return way_fact(told, FIRST_EMITTER, sensor, pattern, samples, headings)
