"""Every kind of belief that a flight may ask for, folded once on the ground, so that its machine code is there by then.

On a new machine, or after an upgrade, that takes some twenty seconds of processor time; later it is read from the disk.
Machine code is made for kinds of arrays, whatever their size: all is folded over a strip of a few hundred cells.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from backend.events import FIRST_CRAFT, CraftSource
from backend.search.localization import Localization, localization
from backend.search.planner_bearings import source_name
from backend.spec import MissionSpec, MovementSpec, Place, Polygon
from hardware.frame import LocalFrame
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief, heard_on_the_way
from planner.belief.shared_source import with_shared_errors
from planner.belief.verdict import verdict
from planner.on_the_way import Stretch
from planner.types import Bearing

SOURCE = source_name(CraftSource(craft_id=FIRST_CRAFT))
SIGMA = math.radians(7.0)
LENGTH_M, WIDTH_M = 300.0, 6.0
"""Of the strip: a belief has a hundred cells along the longer side."""
FEWEST_ROLLOUTS = 10
TWICE = tuple(
    Bearing(x, -60.0, math.radians(angle), SIGMA, 0.1, source=SOURCE) for x, angle in ((-60.0, 45.0), (60.0, 135.0))
)
"""They cross in the strip."""
STRETCH = Stretch(
    source=SOURCE,
    x=(0.0, 5.0, 10.0),
    y=(0.0, 0.0, 0.0),
    front=(0.0, 0.8, 1.6),
    power_db=(0.0, 3.0, 1.0),
    gain_db=(0.0, -6.0, -15.0, -6.0),
    sigma=SIGMA,
    leg="leg",
)


def in_a_strip(mission: MissionSpec, home: Place) -> MissionSpec:
    """The same search where it is least work to plan: the strip begins at the home and lies north of it."""
    frame = LocalFrame(home)
    east = LENGTH_M / 2
    corners = ((-east, 0.0), (east, 0.0), (east, WIDTH_M), (-east, WIDTH_M), (-east, 0.0))
    strip = Polygon(coordinates=[[(point.lon, point.lat) for point in (frame.to_geo(x, y) for x, y in corners)]])
    planner = mission.planner.model_copy(update={"budget": FEWEST_ROLLOUTS})
    return mission.model_copy(update={"area": strip, "planner": planner})


def fold_first_beliefs(mission: MissionSpec, home: Place) -> Iterator[None]:
    """Of an emitter that stands still, before and after a bearing, with and without a leg; of two that share their
    errors; of one that moves. Heavy, each step of it: take them off the event loop."""
    task = localization(mission, home)
    if isinstance(task.prior, JointBelief):
        heard_on_the_way(task.prior, (STRETCH,))
        yield
        known = _judged(task)
        yield
        if isinstance(known, JointBelief):
            known = heard_on_the_way(known, (STRETCH,))
            yield
            with_shared_errors((known, known))
            yield
    (emitter, *_) = mission.emitters
    moves = emitter.model_copy(update={"movement": MovementSpec(kind="walking")})
    _judged(localization(mission.model_copy(update={"emitters": [moves]}), home))


def _judged(task: Localization) -> GridBelief:
    belief = task.planning_belief(TWICE)
    verdict(task.problem, task.rule, TWICE, belief)
    return belief
