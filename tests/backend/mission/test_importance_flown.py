"""A whole mission on doubles of the ports that looks for one of two emitters first; the order changes in flight."""

from __future__ import annotations

from equipment import SECOND_HZ, TWO_EMITTERS, spec
from flights import order
from stage import Stage

from backend import commands
from backend.events import PlanChosen, PrioritiesChanged
from backend.spec import FIRST_EMITTER

SECOND = TWO_EMITTERS[1].emitter_id


async def test_each_plan_is_for_what_comes_first_when_it_is_made() -> None:
    stage = Stage(target=(30.0, 60.0), others={SECOND_HZ: (-60.0, 30.0)})
    await stage.room.start_up()
    mission_id = await stage.room.drafts.create(spec(TWO_EMITTERS).in_order({SECOND: 1}), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until(mission_id, "plan_chosen")
    (first, *_) = stage.journal.of_kind(mission_id, PlanChosen)
    assert (first.first, first.emitter_id, first.set_back) == ([SECOND], SECOND, []), "the base policy flies for one"
    changed = await order(stage, mission_id, commands.SetPriorities(priorities={FIRST_EMITTER: 1}))
    assert changed.accepted
    unknown = await order(stage, mission_id, commands.SetPriorities(priorities={"nobody": 1}))
    assert not unknown.accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    await stage.until_mission(mission_id, "done")
    facts = stage.journal.events(mission_id)
    after = facts[facts.index(stage.journal.of_kind(mission_id, PrioritiesChanged)[0]) :]
    assert all(plan.first in ([FIRST_EMITTER], []) for plan in after if isinstance(plan, PlanChosen))
    state = stage.journal.state(mission_id)
    assert state.search.mission.priorities == {FIRST_EMITTER: 1}
    assert all(emitter.localized for emitter in state.search.emitters.values())
    await stage.room.shut_down()
