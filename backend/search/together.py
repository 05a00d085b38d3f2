"""The localizations of a search's emitters, each with all that the search's facts tell of it besides its own bearings.

These are the turns that heard nothing of it, the legs on which it was heard and, where a source's errors are shared
(planner.belief.shared_source), the other emitters' bearings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from threading import Lock

from backend.search.localization import Localization, localization
from backend.search.state import SearchState
from backend.spec import MissionSpec, Place
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.belief.shared_source import with_shared_errors
from planner.detection import Silence
from planner.on_the_way import Stretch
from planner.types import Bearing

SHARED_KEPT = 8
"""Times at which the beliefs about all emitters are kept: a turn's bearings come together, and beliefs one by one."""

THREADS = 2
"""That weigh emitters at once where one waits for all of them."""

Known = tuple[str, tuple[Silence, ...], tuple[Bearing, ...], tuple[Stretch, ...]]
"""What the belief about an emitter stands on by itself."""


@dataclass(frozen=True, slots=True)
class Together:
    """emitters: by id; those whose errors are shared must be among them (`together`)."""

    emitters: Mapping[str, Localization]
    _found: dict[tuple[Known, ...], Mapping[str, JointBelief]] = field(
        default_factory=dict[tuple[Known, ...], Mapping[str, JointBelief]], repr=False, compare=False
    )
    _lock: Lock = field(default_factory=Lock, repr=False, compare=False)

    def about(self, search: SearchState, emitter_id: str) -> Localization:
        """Of one emitter as things stand."""
        task = self._alone(search, emitter_id)
        sharing = task.mission.sharing
        if emitter_id not in sharing:
            return task
        others = {
            other: (self._alone(search, other), search.emitters[other].bearings)
            for other in sharing
            if other != emitter_id and search.emitters[other].bearings
        }
        heard = {other: (one, one.planner_bearings(facts)) for other, (one, facts) in others.items()}
        return replace(task, beside=partial(self._shared, emitter_id, heard))

    def _alone(self, search: SearchState, emitter_id: str) -> Localization:
        """By what was measured of this emitter alone."""
        known = search.emitters[emitter_id]
        return self.emitters[emitter_id].after(known.unheard, known.legs)

    def _shared(
        self, emitter_id: str, others: Mapping[str, tuple[Localization, tuple[Bearing, ...]]], alone: GridBelief
    ) -> GridBelief:
        """The belief with what the others tell. One thread at a time: what it finds is what the next one asks for."""
        if not isinstance(alone, JointBelief) or not alone.folded:
            return alone
        with self._lock:
            beliefs = {emitter_id: alone}
            for other, (task, bearings) in others.items():
                belief = task.belief(bearings)
                if isinstance(belief, JointBelief):
                    beliefs[other] = belief
            names = sorted(beliefs)
            key = tuple((name, one.silences, one.folded, one.stretches) for name in names for one in (beliefs[name],))
            found = self._found.get(key)
            if found is None:
                shared = with_shared_errors([beliefs[name] for name in names], THREADS)
                found = dict(zip(names, shared, strict=True))
                while len(self._found) >= SHARED_KEPT:
                    del self._found[next(iter(self._found))]
                self._found[key] = found
            return found[emitter_id]


def together(mission: MissionSpec, home: Place, emitter_id: str) -> Together:
    """What it takes to tell of one emitter. Raises MissionInputError as `localization` does."""
    return Together({name: localization(mission, home, name) for name in {emitter_id, *told_of(mission, emitter_id)}})


def told_of(mission: MissionSpec, emitter_id: str) -> tuple[str, ...]:
    """The emitters that share a source's errors with this one, itself among them; nobody when it shares none."""
    return mission.sharing if emitter_id in mission.sharing else ()
