"""What if: nothing is recorded by asking."""

from __future__ import annotations

from typing import Any

import pytest
from equipment import FRAME, spec
from flights import flying, order, stuck
from stage import Stage

from backend.commands import Override
from backend.events import PlanChosen
from backend.mission import questions
from backend.reasons.safety import OutsideFence, PilotControls


async def test_a_forecast_and_a_preview_say_how_long_it_may_take(stage: Stage) -> None:
    seen = await stage.room.questions.preview(spec())
    assert seen.first_place
    mission_id = await stage.room.drafts.create(spec(), "anna")
    recorded = len(stage.journal.events(mission_id))
    near, far = FRAME.to_geo(0, -20), FRAME.to_geo(0, -900)
    allowed, beside = await stage.room.questions.expected_time(mission_id, near)
    assert beside is None
    assert allowed.reason is None
    assert allowed.mean_s is not None
    assert allowed.p90_s is not None
    assert allowed.p90_s >= allowed.mean_s
    refused, compared = await stage.room.questions.expected_time(mission_id, far, instead_of=near)
    assert compared is not None
    assert compared.difference_s > 60.0
    assert compared.rules == ()
    assert isinstance(refused.reason, OutsideFence)
    assert len(stage.journal.events(mission_id)) == recorded


async def test_what_was_told_of_a_place_stands_in_the_record_when_it_is_chosen(stage: Stage) -> None:
    mission_id = await stuck(stage)
    place = FRAME.to_geo(0, -20)
    told, _ = await stage.room.questions.expected_time(mission_id, place)
    assert (await order(stage, mission_id, Override(place=place))).accepted
    assert (await order(stage, mission_id, Override(place=FRAME.to_geo(5, -25)))).accepted
    asked, unasked = [e for e in stage.journal.events(mission_id) if isinstance(e, PlanChosen)][-2:]
    assert (asked.expected_time_s, asked.time_90_s) == (told.mean_s, told.p90_s)
    assert (unasked.expected_time_s, unasked.time_90_s) == (None, None)


async def test_in_flight_a_forecast_says_what_forbids_the_place_now(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await stage.room.questions.expected_time(mission_id, FRAME.to_geo(0, -20)))[0].reason is None
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    assert (await stage.room.questions.expected_time(mission_id, FRAME.to_geo(0, -20)))[0].reason == PilotControls()


async def test_a_place_left_for_its_sweeps_is_no_argument_against_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage(rejected=20)
    compared: list[Any] = []
    real = questions.compare
    monkeypatch.setattr(questions, "compare", lambda *given: compared.append(given) or real(*given))
    await stage.room.start_up()
    mission_id = await flying(stage)
    await stage.until_true(lambda: len(stage.journal.of_kind(mission_id, PlanChosen)) == 2)
    left, chosen = (one.place for one in stage.journal.of_kind(mission_id, PlanChosen))
    _, beside = await stage.room.questions.expected_time(mission_id, FRAME.to_geo(0, -20), instead_of=chosen)
    assert beside is not None
    assert left in compared[0][-1]
    await stage.room.shut_down()
