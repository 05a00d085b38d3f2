"""When to strike at a new mission: at what the nose does by the vehicle's own end of the link and by what is shown."""

from __future__ import annotations

import asyncio
import math
import random
import time
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, get_args

from tests.strikes.missions import FLYING_M_S, speed_m_s
from tests.strikes.nose import While, rate_deg_s
from tests.strikes.proxy import ATTITUDE, Passed, Proxy
from tests.system.console import Console

MOMENTS: tuple[While, ...] = get_args(While)
TURNS_DEG_S = 10.0
LATER_S = 1.0
"""A strike comes at most this long after its moment was seen."""
TURNED_BACK_S = 0.6
"""A nose turns back for so long at most after it was seen to."""
MOMENT_S = 150.0
"""The longest wait for a moment."""
SEARCHES = ("planning", "flying", "measuring")


async def moment(shown: Console, proxy: Proxy, chance: random.Random, during: While) -> None:
    """Returns at some time in it. Raises TimeoutError when it does not come, or the mission leaves the search."""
    end_s, later_s = time.monotonic() + MOMENT_S, TURNED_BACK_S if during == "turn back" else LATER_S
    while time.monotonic() < end_s:
        phase = shown.phases[-1]
        if phase == "hold":  # for a reason of its own
            await shown.order("resume")
            await asyncio.sleep(1.0)
        elif phase not in SEARCHES:
            raise TimeoutError(f"the mission is {phase}: {shown.of('phase_changed')[-1]['event']['reason']}")
        if phase != "measuring":
            shown.messages.pop("sweep_progress", None)
        if is_now(shown, proxy, during):
            await asyncio.sleep(chance.uniform(0.0, later_s))
            if during == "turn back" or is_now(shown, proxy, during):
                return
        await asyncio.sleep(0.05)
    raise TimeoutError(f"no {during} within {MOMENT_S:g} s")


def is_now(shown: Console, proxy: Proxy, during: While) -> bool:
    phase, record = shown.phases[-1], proxy.record[-200:]
    flies = phase == "flying" and (speed_m_s(record) or 0.0) > FLYING_M_S
    if during == "turn back":
        return flies and turned_back(record)
    if abs(rate_deg_s(record)) < TURNS_DEG_S:
        return False
    if during == "swing":
        return flies
    told = shown.messages.get("sweep_progress", [])
    if phase != "measuring" or not told or told[-1]["sector"] is None:
        return False
    return during == "sector" or extended(told)


def extended(told: Sequence[dict[str, Any]]) -> bool:
    """The sector that is shown goes further than it was laid."""
    goals = [one["sector"]["goal_deg"] for one in told if one["sector"] is not None]
    return bool(goals) and goals[-1] > min(goals) + 1.0


def turned_back(record: Sequence[Passed]) -> bool:
    """The nose has just changed the side to which it turns."""
    rates = [
        (passed.at_s, math.degrees(passed.fields["yawspeed"]))
        for passed in record
        if passed.number == ATTITUDE and passed.way == "from"
    ]
    recent = [rate for at_s, rate in rates if at_s > rates[-1][0] - TURNED_BACK_S]
    turning = [rate for rate in recent if abs(rate) > TURNS_DEG_S / 2.0]
    return any(before * after < 0.0 for before, after in pairwise(turning))
