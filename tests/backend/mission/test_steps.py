"""What a step of the mission hands to the machine."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from ground import AREA, HOME, towards

from backend.mission.localization import localization
from backend.mission.steps import Steps
from backend.spec import MissionSpec


@pytest.mark.parametrize(("off_deg", "told"), [(0.0, False), (12.0, True)])
async def test_the_belief_comes_with_the_offset_that_its_bearings_share(off_deg: float, told: bool) -> None:
    nothing: Any = None
    equipment: Any = SimpleNamespace(heading_sigma_deg=4.0)
    task = localization(MissionSpec(name="m", area=AREA), HOME, 100.0)
    steps = Steps(equipment, task, "m", nothing, nothing, nothing)
    seen = [towards(x, y, (150.0, 60.0), sigma=4.2) for x, y in ((90, -40), (250, 20), (150, 160), (30, 60))]
    turned = [b.model_copy(update={"bearing_deg": (b.bearing_deg + off_deg) % 360.0}) for b in seen]
    ready: Any = await steps.belief(turned)
    assert ready.bearing_ids == tuple(b.bearing_id for b in turned)
    assert ready.heading_offset.offset_deg == pytest.approx(off_deg, abs=0.5)
    assert ready.heading_offset.significant == told
