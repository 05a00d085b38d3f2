"""What a craft hears between two places of the field in `ground`."""

from __future__ import annotations

import math

import numpy as np
from facts import OWN
from ground import FRAME, HOME

from backend.events import HeardOnTheWay
from backend.search.way_facts import Leg, way_fact
from backend.spec import FIRST_EMITTER, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.readings import HeadingSample, PowerSample

TARGET = (120.0, 60.0)
PATTERN = AntennaPattern("test", np.array([0.0, 90.0, 180.0, 270.0]), np.array([0.0, -8.0, -15.0, -8.0]))


def way(turn_deg_s: float = 30.0, leg_id: str = "leg-1", target: tuple[float, float] = TARGET) -> HeardOnTheWay:
    """A leg of 100 m eastward from home, heard through the pattern from the target."""
    at = np.arange(0.0, 12.5, 0.1)
    samples, headings = [], []
    for t in at:
        x, nose = 8.0 * float(t), turn_deg_s * float(t)
        bearing_deg = math.degrees(math.atan2(target[0] - x, target[1]))
        gain = float(PATTERN.gain_at(np.array([(bearing_deg - nose) % 360.0]))[0])
        power = -50.0 + gain - 20.0 * math.log10(math.hypot(target[0] - x, target[1]))
        samples.append(PowerSample(float(t), 868.3e6, power, -130.0))
        headings.append(HeadingSample(float(t), nose % 360.0, FRAME.to_geo(x, 0.0)))
    leg = Leg(OWN, 1, HOME, (HOME, FRAME.to_geo(100.0, 0.0)))
    found = way_fact(leg, FIRST_EMITTER, SensorSpec(bearing_errors="joint"), PATTERN, samples, headings)
    return found.model_copy(update={"leg_id": leg_id})
