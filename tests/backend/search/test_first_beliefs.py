"""In a process of its own: in this one other tests have compiled everything."""

from __future__ import annotations

import subprocess
import sys

FOLDED = """
import sys
sys.path.insert(0, "tests/doubles")
from dataclasses import replace
import facts, ground, legs
from numba.core.registry import CPUDispatcher
from backend.api.suggestion import SENSOR, suggested_mission
from backend.search.emitter import EmitterState
from backend.search.first_beliefs import fold_first_beliefs, in_a_strip
from backend.search.localization import localization
from backend.search.state import SearchState
from backend.search.task import search_task
from backend.spec import EmitterSpec, MissionSpec, MovementSpec
from hardware.readings import Place

def compiled():
    modules = [module for name, module in list(sys.modules.items()) if name.startswith("planner.belief")]
    found = {id(one): one for module in modules for one in vars(module).values() if isinstance(one, CPUDispatcher)}
    return {(one.py_func.__name__, signature) for one in found.values() for signature in one.signatures}

place = Place(0.0, 0.0)
assert len(list(fold_first_beliefs(in_a_strip(suggested_mission(place), place), place))) == 4
before = compiled()
taken = facts.bearing(1).model_copy(update={"place": ground.HOME, "taken_at_s": 1e9})
emitters = [EmitterSpec(), EmitterSpec(emitter_id="emitter-2", frequency_hz=869.5e6)]
mission = MissionSpec(name="m", area=ground.AREA, sensor=SENSOR, emitters=emitters)
one = localization(mission.model_copy(update={"emitters": emitters[:1]}), ground.HOME).after((), [legs.way()])
one.belief_fact([])
one.belief_fact([taken])
known = {name: EmitterState(name, measured=(taken,), ways=(legs.way(),)) for name in ("emitter-1", "emitter-2")}
search = replace(SearchState(), spec=mission, emitters=known, home=ground.HOME)
search_task(mission, ground.HOME, 100.0).together.about(search, "emitter-1").belief_fact([taken])
moves = EmitterSpec(movement=MovementSpec(kind="walking"))
localization(mission.model_copy(update={"emitters": [moves]}), ground.HOME).belief_fact([taken])
print(len(before), sorted(name for name, _ in compiled() - before))
"""


def test_no_flight_waits_for_a_belief_to_be_compiled() -> None:
    told = subprocess.run([sys.executable, "-c", FOLDED], capture_output=True, text=True, timeout=240, check=True)
    count, added = told.stdout.strip().split(" ", 1)
    assert int(count) >= 5
    assert added == "[]"
