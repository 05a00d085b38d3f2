"""Legs in the field world that are listened on: where the craft and its nose are, and what comes of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from backend.events import CraftSource, HeardOnTheWay
from backend.search.way_facts import Leg, way_fact
from backend.simulation.field_world import Field, Way
from backend.spec import FIRST_EMITTER, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.yaw_swings import Seen, Swinging
from planner.motion import flight_time
from planner.types import FloatArray, FullMotion

Listens = Literal["places", "way", "way_swinging", "never_stopping"]
"""At places alone; on the way too, the nose turned to where it leads and then kept there; or on the way while the nose
swings; or so, and without a turn at most places."""
LISTENED_HZ = 10.0
GRAVITY_M_S2 = 9.81


AIR_M_S2 = 2.0
"""What the air brakes at the movement model's speed; it grows with the square of speed."""
NOSE_DEG_S2 = 60.0
"""How quickly the nose's rate changes."""


def flown(here: tuple[float, float], place: tuple[float, float], heading: float, swinging: Swinging | None) -> Way:
    """As the movement model has it, LISTENED_HZ points a second: turn to where it leads, accelerate, brake, and lean
    against both and the air. heading: of the nose before, rad ccw from east. swinging: what the nose does from then
    on; it follows at the rate that is asked for, as soon as it has it."""
    motion, way = FullMotion(), np.array(place) - np.array(here)
    length = float(np.hypot(*way))
    direction = math.atan2(way[1], way[0])
    turn = math.remainder(direction - heading, 2.0 * math.pi)
    turning_s = abs(turn) / motion.turn_rate
    at = np.arange(0.0, turning_s + float(flight_time(motion, length)) - motion.constant, 1.0 / LISTENED_HZ)
    speed = speeds(length, at - turning_s)
    done = np.minimum(np.cumsum(speed) / LISTENED_HZ / length, 1.0)
    nose = 90.0 - np.degrees(heading + turn * np.minimum(at / max(turning_s, 1e-9), 1.0))
    if swinging is not None:
        nose = _swung(nose, at, done * length, length, speed, swinging)
    lean = np.outer(leaning(speed), way / length)
    return Way(here[0] + done * way[0], here[1] + done * way[1], nose, lean)


def speeds(length: float, flying_s: FloatArray) -> FloatArray:
    """(n,) m/s at (n,) seconds after the start of a straight flight of `length` m > 0, from hover to hover."""
    motion = FullMotion()
    fastest = min(motion.speed, math.sqrt(motion.acceleration * length))
    ramp_s, cruise_s = fastest / motion.acceleration, (length - fastest**2 / motion.acceleration) / fastest
    left_s = 2.0 * ramp_s + cruise_s - flying_s
    return np.clip(np.minimum(flying_s, left_s) * motion.acceleration, 0.0, fastest)


def leaning(speed: FloatArray) -> FloatArray:
    """(n,) rad in the direction of flight, of a craft that flies so fast (m/s), LISTENED_HZ points a second."""
    air = AIR_M_S2 * (speed / FullMotion().speed) ** 2
    return np.arctan((np.gradient(speed) * LISTENED_HZ + air) / GRAVITY_M_S2)


def _swung(
    nose: FloatArray, at: FloatArray, flown_m: FloatArray, length: float, speed: FloatArray, swinging: Swinging
) -> FloatArray:
    """nose: (n,) without swings, degrees clockwise from north, continuous. The study's areas have no fence near."""
    found, goal, rate = nose.copy(), float(nose[-1]), 0.0
    for k in range(1, len(nose)):
        if flown_m[k] <= 0.0:
            continue
        left = goal - found[k - 1]
        # no faster than it can brake for the goal, and than asked for
        wanted = math.copysign(min(math.sqrt(2.0 * NOSE_DEG_S2 * abs(left)), swinging.plan.rate_deg_s), left)
        rate += max(-NOSE_DEG_S2 / LISTENED_HZ, min(NOSE_DEG_S2 / LISTENED_HZ, wanted - rate))
        found[k] = found[k - 1] + rate / LISTENED_HZ
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
    leg: Way,
    turned_at: Sequence[tuple[float, float]],
    number: int,
    sensor: SensorSpec,
    pattern: AntennaPattern,
) -> HeardOnTheWay:
    """What a mission would record of the leg. turned_at: m ENU, where the craft has turned or will, its end among them.
    number: of the leg, from 0."""
    samples, headings = field.along(leg, LISTENED_HZ, number)
    begin = field.frame.to_geo(float(leg.x[0]), float(leg.y[0]))
    places = tuple(field.frame.to_geo(*place) for place in turned_at)
    told = Leg(CraftSource(craft_id="craft-1"), number + 1, begin, places)
    return way_fact(told, FIRST_EMITTER, sensor, pattern, samples, headings)
