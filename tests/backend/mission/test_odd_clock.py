"""Missions of a vehicle whose headings cannot be dated: nothing is measured, and the operator knows why."""

from __future__ import annotations

from dataclasses import replace

from flights import flying, order
from stage import Stage

from backend import commands
from backend.events import AlertCleared, AlertRaised, BearingMeasured, PhaseChanged
from hardware.reasons.vehicle_news import ClockRateOdd


def runs_at(stage: Stage, rate: float | None) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, odd_clock_rate=rate)


def open_on_clock(stage: Stage, mission_id: str) -> list[AlertRaised]:
    cleared = {fact.alert_id for fact in stage.journal.of_kind(mission_id, AlertCleared)}
    raised = stage.journal.of_kind(mission_id, AlertRaised)
    return [alert for alert in raised if alert.topic == "clock" and alert.alert_id not in cleared]


async def test_a_clock_that_becomes_odd_while_measuring_holds_and_resume_goes_on_once_it_agrees(stage: Stage) -> None:
    mission_id = await flying(stage, "measuring")
    runs_at(stage, 0.9)
    await stage.until_phase(mission_id, "hold")
    (alert,) = open_on_clock(stage, mission_id)
    assert (alert.level, alert.reason) == ("warning", ClockRateOdd(0.9))
    assert stage.journal.of_kind(mission_id, PhaseChanged)[-1].reason == ClockRateOdd(0.9)
    assert stage.journal.of_kind(mission_id, BearingMeasured) == []
    runs_at(stage, None)
    await stage.until_true(lambda: not open_on_clock(stage, mission_id))
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "bearing_measured")


async def test_at_the_place_nothing_is_begun_while_the_clock_is_odd_even_when_somebody_resumes(stage: Stage) -> None:
    mission_id = await flying(stage, "flying")
    runs_at(stage, 1.2)
    await stage.until_phase(mission_id, "hold")
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "place_reached", 2)
    await stage.until_phase(mission_id, "hold")
    assert "turn" not in stage.vehicle.names
    assert len(open_on_clock(stage, mission_id)) == 1
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_phase(mission_id, "landing")
