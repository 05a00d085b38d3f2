"""Journals that an earlier Crossfix stored mean today what they meant then.

tests/golden/journals holds each journal's rows as they were in the database (seq, at_us, kind, body) and what the code
of then folded from them: after each belief and at the end.
"""

from __future__ import annotations

import gzip
import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from backend.events import BeliefUpdated, Recorded
from backend.mission.state import MissionState, evolve, fold
from backend.search.area import corner_of
from backend.search.localization import localization
from backend.spec import FIRST_EMITTER
from backend.store import digest
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM

JOURNALS = Path(__file__).parent / "journals"
NAMES = sorted(path.name.removesuffix(".json.gz") for path in JOURNALS.glob("*.json.gz"))


@cache
def recorded(name: str) -> list[Recorded]:
    stored = json.loads(gzip.decompress((JOURNALS / f"{name}.json.gz").read_bytes()))
    rows = [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in stored["rows"]]
    return to_records(stored["mission_id"], rows)


def folded_then(name: str) -> list[dict[str, Any]]:
    return json.loads((JOURNALS / f"{name}.folded.json").read_text())


def told(state: MissionState) -> dict[str, Any]:
    """The state in the words of the old code."""
    search, craft = state.search, state.craft
    emitter = search.emitters[FIRST_EMITTER]
    return {
        "phase": state.phase,
        "outcome": search.outcome,
        "bearing_ids": list(emitter.bearing_ids),
        "excluded": sorted(emitter.excluded),
        "digest": None if emitter.belief is None else emitter.belief.digest,
        "belief_current": emitter.belief_current,
        "localized": emitter.localized,
        "place_number": search.place_number,
        "automatic": craft.automatic,
        "pilot_has_control": craft.taken_over,
        "links_down": sorted(craft.links_down),
        "open_alert_topics": sorted(alert.topic for alert in (*search.open_alerts, *craft.open_alerts)),
        "answered": {command_id: answer.accepted for command_id, answer in state.answered.items()},
    }


@pytest.mark.parametrize("name", NAMES)
def test_it_folds_to_what_it_was(name: str) -> None:
    for then in folded_then(name):
        seq = then.pop("seq")
        assert told(fold(recorded(name)[:seq])) == then, f"after event {seq}"


@pytest.mark.parametrize("name", NAMES)
def test_the_list_of_missions_says_the_same(name: str) -> None:
    line, state = digest.fold(None, recorded(name)), fold(recorded(name))
    assert (line.phase, line.outcome, line.flying) == (state.phase, state.search.outcome, bool(state.engaged))
    assert (line.emitters, line.bearings) == (1, len(state.search.emitters[FIRST_EMITTER].bearings))


@pytest.mark.parametrize("name", NAMES)
def test_its_beliefs_are_rebuilt(name: str) -> None:
    """Equal grids stay equal and others different; their bits may differ between processors."""
    state, digests = MissionState(), set[tuple[str, str]]()
    for fact in recorded(name):
        search = state.search
        if isinstance(fact.event, BeliefUpdated):
            task = localization(search.mission, search.home or corner_of(search.mission.area), FIRST_EMITTER)
            belief, _ = task.belief_fact(search.emitters[FIRST_EMITTER].bearings)
            assert claim(belief) == claim(fact.event), f"event {fact.seq}"
            assert spread(belief) == pytest.approx(spread(fact.event), rel=1e-6), f"event {fact.seq}"
            digests.add((fact.event.digest, belief.digest))
        state = evolve(state, fact.event, fact.at_utc.timestamp())
    assert len(digests) == len({then for then, _ in digests}) == len({now for _, now in digests})


def claim(belief: BeliefUpdated) -> tuple[Any, ...]:
    estimated = belief.estimate is not None
    return belief.bearings, estimated, belief.consistent, belief.localized, len(belief.not_yet), belief.contradicting


def spread(belief: BeliefUpdated) -> tuple[float, ...]:
    estimate = belief.estimate
    if estimate is None:
        return ()
    return estimate.lat, estimate.lon, estimate.expected_rmse_m, estimate.major_axis_m, estimate.minor_axis_m
