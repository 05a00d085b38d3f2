"""An exported mission (`mission.json`) for `crossfix localize`: believed again by its own facts, as in flight."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from backend.events import BeliefUpdated, Recorded
from backend.events.bearings import BearingSource
from backend.search.area import corner_of
from backend.search.state import SearchState, evolve
from backend.search.together import together
from backend.store.brought_facts import number_of, unfit
from backend.store.exported import ExportedLater, NotExported, export_of_today
from hardware.direction_finding.table_file import decoded
from planner.reason import text_of


def exported_in(path: Path) -> list[Recorded] | None:
    """The events of an exported mission; None for a file of something else. Raises ValueError for one of neither."""
    if not path.is_file():
        return None  # whoever reads it as a table says what is wrong; and a pipe is read only once
    try:
        text = decoded(path.read_bytes())
    except OSError:
        return None
    if not text.lstrip().startswith("{"):
        return None
    try:
        exported = json.loads(text, parse_float=number_of, parse_int=number_of)
        recorded: list[Recorded] = export_of_today(exported)["events"]
    except ExportedLater:
        raise
    except (NotExported, ValueError, RecursionError) as error:
        raise ValueError(
            f"{path} holds no bearings that are read: of what Crossfix exports, take the journal (JSON) or the CSV"
        ) from error
    wrong = unfit(recorded)
    if wrong is not None:
        raise ValueError(f"{path} is no journal as Crossfix exports it: event {wrong.seq} is none that it records")
    return recorded


def localize_mission(recorded: list[Recorded], named: str | None) -> dict[str, Any]:
    """As `crossfix localize` answers of other files. named: an emitter by its id, label or number, None: the only one.

    Raises ValueError, PlannerError.
    """
    state = SearchState()
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
    mission, name = state.mission, _emitter(state, named)
    task = together(mission, state.home or corner_of(mission.area), name).about(state, name)
    bearings = state.emitters[name].bearings
    fact, _ = task.belief_fact(bearings)
    return {
        "estimate": None if fact.estimate is None else {"lat": fact.estimate.lat, "lon": fact.estimate.lon},
        "estimator": mission.planner.estimator,
        "expected_rmse_m": None if fact.estimate is None else fact.estimate.expected_rmse_m,
        "c95": None if fact.estimate is None else fact.estimate.model_dump(mode="json")["c95"],
        "consistent": fact.consistent,
        "localized": fact.localized,
        "not_yet": [text_of(reason) for reason in fact.not_yet],
        "bearings": fact.bearings,
        "sigma_deg": max((one.sigma_deg for one in bearings), default=None),
        "outlier_probability": mission.sensor.outlier_probability,
        "sources": _sources(fact),
    }


def _emitter(state: SearchState, named: str | None) -> str:
    emitters = state.mission.emitters
    if named is None and len(emitters) == 1:
        return emitters[0].emitter_id
    ids = [one.emitter_id for one in emitters]
    names = [state.mission.name_of(one) for one in ids]
    numbers = [str(number) for number in range(1, len(ids) + 1)]
    for known in (ids, names, [one.label for one in emitters], numbers):
        if known.count(named or "") == 1:
            return ids[known.index(named or "")]
    raise ValueError(f"the mission looks for {', '.join(names)}: choose one with --tag")


def _sources(fact: BeliefUpdated) -> list[dict[str, Any]]:
    return [{"name": _name(one.source)} | one.model_dump(mode="json", exclude={"source"}) for one in fact.sources]


def _name(source: BearingSource) -> str:
    match source.kind:
        case "craft":
            return source.craft_id
        case "person":
            return source.name
        case "import":
            return source.recording_id
