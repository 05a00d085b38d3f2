"""What if: nothing is recorded by asking."""

from __future__ import annotations

from equipment import FRAME, spec
from flights import stuck
from stage import Stage

from backend.reasons.safety import OutsideFence, PilotControls


async def test_a_forecast_and_a_preview_say_how_long_it_may_take(stage: Stage) -> None:
    seen = await stage.room.questions.preview(spec())
    assert seen.first_place
    mission_id = await stage.room.drafts.create(spec(), "anna")
    recorded = len(stage.journal.events(mission_id))
    near, far = FRAME.to_geo(0, -20), FRAME.to_geo(0, -900)
    allowed = await stage.room.questions.expected_time(mission_id, near)
    assert allowed.reason is None
    assert allowed.mean_s is not None
    assert allowed.p90_s is not None
    assert allowed.p90_s >= allowed.mean_s
    refused = await stage.room.questions.expected_time(mission_id, far)
    assert isinstance(refused.reason, OutsideFence)
    assert len(stage.journal.events(mission_id)) == recorded


async def test_in_flight_a_forecast_says_what_forbids_the_place_now(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await stage.room.questions.expected_time(mission_id, FRAME.to_geo(0, -20))).reason is None
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    assert (await stage.room.questions.expected_time(mission_id, FRAME.to_geo(0, -20))).reason == PilotControls()
