"""A flight whose belief cannot be computed, on doubles of the ports."""

from __future__ import annotations

import pytest
from equipment import spec
from flights import order
from stage import Stage

from backend import commands
from backend.events import AlertRaised, BearingMeasured, BeliefUpdated
from backend.reasons.search import BeliefBroke
from backend.search.localization import Localization
from backend.spec import FIRST_EMITTER
from planner.reasons.refusal import EveryPlaceRefused
from planner.types import PlannerError


@pytest.mark.parametrize("error", [MemoryError(), PlannerError(EveryPlaceRefused())])
async def test_it_is_said_and_the_flight_goes_on_once_one_can_be_computed(
    stage: Stage, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until(mission_id, "plan_chosen")

    def fails(*_: object) -> None:
        raise error

    with monkeypatch.context() as broken:
        broken.setattr(Localization, "belief_fact", fails)
        await stage.until(mission_id, "alert_raised")
    (raised,) = stage.journal.of_kind(mission_id, AlertRaised)
    assert (raised.topic, raised.craft_id, raised.reason) == ("failure", None, BeliefBroke(FIRST_EMITTER))
    before = len(stage.journal.of_kind(mission_id, BeliefUpdated))
    (bearing,) = stage.journal.of_kind(mission_id, BearingMeasured)
    assert (await order(stage, mission_id, commands.ExcludeBearing(bearing_id=bearing.bearing_id))).accepted
    await stage.until(mission_id, "alert_cleared")
    assert len(stage.journal.of_kind(mission_id, BeliefUpdated)) == before + 1
    await stage.until(mission_id, "bearing_measured", 2)
