"""Where the nose swings on a leg: about the directions in which the emitter is expected from its middle. Pure."""

from __future__ import annotations

import math

from hardware.yaw_swings import SwingPlan
from planner.directions import shortest_arc
from planner.types import FloatArray

SHARE = 0.9
"""Of the expected directions, that the antenna passes."""
MARGIN_DEG = 45.0
"""To either side of them: half a beam and its flank."""
LEAST_DEG, MOST_DEG = 60.0, 120.0
"""To either side of the middle: less shows no shape of the beam, more takes longer than a stretch of way."""


def swing_plan(
    expected: FloatArray, offset_to_nose_deg: float, rate_deg_s: float, facing_deg: float | None
) -> SwingPlan:
    """expected: (360,) probability of the directions 0, 1, .. degrees clockwise from north. facing_deg: of the nose at
    the end of the leg, None: anywhere."""
    arc = shortest_arc(expected, SHARE)
    middle = math.degrees(arc.begin + 0.5 * arc.width)
    amplitude = min(max(0.5 * math.degrees(arc.width) + MARGIN_DEG, LEAST_DEG), MOST_DEG)
    return SwingPlan((middle - offset_to_nose_deg) % 360.0, amplitude, rate_deg_s, facing_deg)
