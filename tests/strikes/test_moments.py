"""A strike's moment is seen where it is, and nowhere else."""

from __future__ import annotations

import math
from typing import Any

from tests.strikes.moments import extended, turned_back
from tests.strikes.proxy import ATTITUDE, Passed


def nose(at_s: float, deg_s: float) -> Passed:
    return Passed(at_s, "from", ATTITUDE, {"yawspeed": math.radians(deg_s)})


def shown(goal_deg: float | None) -> dict[str, Any]:
    return {"sector": None if goal_deg is None else {"begin_deg": 20.0, "goal_deg": goal_deg, "because": None}}


def test_a_nose_turns_back_once_it_goes_to_the_other_side() -> None:
    to_and_fro = [30.0, 30.0, 8.0, 1.0, -2.0, -9.0, -30.0]
    record = [nose(10.0 + 0.1 * step, rate) for step, rate in enumerate(to_and_fro)]

    assert not turned_back([])
    assert not turned_back(record[:5])
    assert turned_back(record[:6])
    assert turned_back(record)


def test_a_nose_that_slows_down_and_goes_on_has_not_turned_back_nor_one_that_did_long_ago() -> None:
    pulsing = [nose(10.0 + 0.1 * step, rate) for step, rate in enumerate([50.0, 20.0, 2.0, 30.0, 50.0])]
    long_ago = [nose(8.0, 30.0), nose(8.1, -30.0), *(nose(9.0 + 0.1 * step, -30.0) for step in range(10))]

    assert not turned_back(pulsing)
    assert not turned_back(long_ago)


def test_a_sector_is_extended_once_its_goal_has_grown() -> None:
    assert not extended([])
    assert not extended([shown(None), shown(None)])
    assert not extended([shown(200.0), shown(200.0)])
    assert extended([shown(200.0), shown(246.0)])
