"""Several emitters, one compass: a craft that believes in a common error flies around it, and finds them all."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from backend.api.suggestion import suggested_mission
from backend.cli.demo import CARRIER, simulated, sought
from backend.events import BearingMeasured, CraftSource
from backend.search.localization import Localization, localization
from backend.search.planning import next_place_together
from backend.simulation.emitters import Signal, emitter_places
from hardware.readings import Place

HOME = Place(50.6234, 7.2046)
OWN_DEG, HEADING_DEG = 1.2, 4.0
"""As the simulated direction finder states them; the compass is right, which nobody knows."""
MOST, SEED = 8, 1


def heard(task: Localization, number: int, place: Place, emitter: Place, error_deg: float) -> BearingMeasured:
    (x, y), (east, north) = task.frame.to_enu(place), task.frame.to_enu(emitter)
    return BearingMeasured(
        emitter_id=task.emitter_id,
        source=CraftSource(craft_id="craft-1"),
        bearing_id=f"{task.emitter_id}-{number}",
        sweep_id=None,
        place_number=number,
        place=place,
        altitude_amsl_m=0.0,
        bearing_deg=(math.degrees(math.atan2(east - x, north - y)) + error_deg) % 360.0,
        sigma_deg=math.hypot(OWN_DEG, HEADING_DEG),
        quality=0.95,
        peaks=[],
        snr_db=40.0,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
        heading_sigma_deg=HEADING_DEG,
        measurement_time_s=16.0,
    )


def test_no_turn_is_taken_twice_at_one_place_and_all_are_localized() -> None:
    """A craft that took its bearings to be independent stayed where it was until twenty places were used."""
    mission = suggested_mission(HOME).model_copy(update={"emitters": sought(CARRIER, 3)})
    mission = mission.model_copy(update={"planner": mission.planner.model_copy(update={"budget": 100})})
    truth, rng = emitter_places(SEED, HOME, simulated(mission.emitters)), np.random.default_rng(SEED)
    tasks = [localization(mission, HOME, emitter.emitter_id) for emitter in mission.emitters]
    measured: dict[str, list[BearingMeasured]] = {task.emitter_id: [] for task in tasks}
    wanted, here, places = list(tasks), (0.0, 0.0), list[tuple[float, float]]()
    for number in range(1, MOST + 1):
        chosen = next_place_together([(t, measured[t.emitter_id]) for t in wanted], here, number, (), threads=1)
        here = tasks[0].frame.to_enu(chosen.place)
        places.append(here)
        wanted = []
        for task in tasks:
            emitter = truth[Signal(mission.emitter(task.emitter_id).frequency_hz)]
            facts = measured[task.emitter_id]
            facts.append(heard(task, number, chosen.place, emitter, OWN_DEG * float(rng.standard_normal())))
            if not task.belief_fact(facts)[0].localized:
                wanted.append(task)
        if not wanted:
            break
    assert [task.emitter_id for task in wanted] == [], f"not localized after {len(places)} places: {places}"
    assert min(math.dist(one, other) for one, other in pairwise(places)) > 5.0, places
