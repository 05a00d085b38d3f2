"""The turn at a place, as it is laid out from what is known when it is made."""

from __future__ import annotations

from dataclasses import replace

import pytest
from equipment import FRAME, HOME, spec
from facts import bearing
from stage import Stage

from backend.craft.listening import Listening, channels_of
from backend.craft.safety import Situation, limits_of
from backend.craft.work import Work
from backend.search.emitter import EmitterState
from backend.search.sector import TurnPlan
from backend.search.state import SearchState
from backend.search.task import search_task
from backend.spec import FIRST_EMITTER, EmitterSpec, MovementSpec

DRIFTS = EmitterSpec(movement=MovementSpec(kind="drifting", speed_m_s=0.4))


def turn_after(seconds: float, emitter: EmitterSpec) -> TurnPlan:
    """Two bearings crossed at (0, 50) m, the newest so long ago; the craft is 40 m west of there."""
    stage = Stage()
    mission = spec([emitter])
    mission = mission.model_copy(update={"sensor": mission.sensor.model_copy(update={"sector_turns": True})})
    now_s = stage.clock.now() - seconds
    west, east = ({"place": FRAME.to_geo(x, 0.0), "bearing_deg": deg} for x, deg in ((-50.0, 45.0), (50.0, 315.0)))
    seen = (
        bearing(1).model_copy(update={**west, "taken_at_s": now_s - 60.0}),
        bearing(2).model_copy(update={**east, "taken_at_s": now_s}),
    )
    known = EmitterState(FIRST_EMITTER, measured=seen)
    search = replace(SearchState(), spec=mission, emitters={FIRST_EMITTER: known}, home=HOME)
    task = search_task(mission, HOME, 100.0)

    def unasked() -> Situation:
        raise AssertionError("a turn is laid out without looking at the vehicle")

    listening = Listening(stage.receiver, stage.clock, channels_of(mission), 5.0)
    work = Work(stage.craft(), task, limits_of(task), "m", listening, unasked, lambda: search, lambda *_: None)
    found = work._turn_at((-40.0, 50.0), 1)
    assert found is not None
    return found


def test_a_turn_is_laid_to_where_a_moving_emitter_may_have_gone_meanwhile() -> None:
    """A hold of some minutes, or a busy machine, may lie between the last turn and this one."""
    at_once, later = turn_after(20.0, DRIFTS), turn_after(600.0, DRIFTS)
    assert not at_once.whole
    assert later.width_deg > at_once.width_deg + 45.0


def test_one_that_stands_still_is_where_it_was() -> None:
    assert turn_after(600.0, EmitterSpec()).width_deg == pytest.approx(turn_after(20.0, EmitterSpec()).width_deg)
