"""Whether the facts of a bundle are such as a Crossfix records: pages and exports reckon with what is refused here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from backend.events import (
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BeliefUpdated,
    EstimateFact,
    Event,
    HeardOnTheWay,
    MissionDrafted,
    MissionEdited,
    MissionLabelled,
    MissionStarted,
    PhaseChanged,
    Recorded,
    RecordingImported,
    SweepRejected,
    VariantKept,
)
from backend.names import TURNS_WRITING
from backend.reasons.request import BundleFactWrong, FactFault
from backend.search.covering import is_region

LARGEST = 1e100
"""Of any number: far more than a mission tells, and its square is finite, too."""

OfEmitter = BearingMeasured | BearingExcluded | BearingIncluded | BeliefUpdated | SweepRejected | HeardOnTheWay


@dataclass(slots=True)
class _Before:
    """What the facts so far told. told: ids of bearings, turns and legs."""

    crafts: set[str] = field(default_factory=set[str])
    told: set[str] = field(default_factory=set[str])


def unfit(recorded: Sequence[Recorded]) -> BundleFactWrong | None:
    """The first that no Crossfix of any age recorded; None: there is none."""
    before = _Before()
    for record in recorded:
        fault = _fault(record.event, before)
        if fault is not None:
            return BundleFactWrong(fault, record.seq)
        _take(before, record.event)
    return None


def _take(before: _Before, fact: Event) -> None:
    match fact:
        case MissionStarted(craft_id=craft_id):
            before.crafts.add(craft_id)
        case BearingMeasured(bearing_id=told_id) | SweepRejected(sweep_id=told_id) | HeardOnTheWay(leg_id=told_id):
            before.told.add(told_id)
        case _:
            pass


def _fault(fact: Event, before: _Before) -> FactFault | None:
    match fact:
        case BearingMeasured(bearing_id=told_id) if told_id in before.told:
            return "bearing_twice"
        case BearingMeasured(sweep_id=sweep_id, sigma_deg=sigma_deg):
            return "spread" if sigma_deg <= 0.0 else _ids([] if sweep_id is None else [sweep_id])
        case SweepRejected(sweep_id=sweep_id):
            return _ids([sweep_id])
        case RecordingImported(sweep_ids=sweep_ids):
            return _ids(sweep_ids)
        case BearingExcluded(bearing_id=told_id) | BearingIncluded(bearing_id=told_id):
            return None if told_id in before.told else "unknown_bearing"
        case BeliefUpdated(bearings=bearings, estimate=estimate):
            return "spread" if bearings < 0 else None if estimate is None else _estimate(estimate)
        case PhaseChanged(craft_id=craft_id, after=after):
            return None if after == "ground" or craft_id in before.crafts else "not_started"
        case MissionLabelled(name=name, tags=tags):
            return _names([name, *tags])
        case VariantKept(name=name):
            return _names([name])
        case _:
            return None


def _estimate(estimate: EstimateFact) -> FactFault | None:
    if not on_earth(estimate.lat, estimate.lon):
        return "place"
    spreads = (estimate.expected_rmse_m, estimate.c95_area_m2, estimate.major_axis_m, estimate.minor_axis_m)
    return "spread" if min(spreads) < 0.0 else None if is_region(estimate.c95) else "region"


def _ids(ids: Iterable[str]) -> FactFault | None:
    return None if all(map(is_id, ids)) else "id"


def _names(names: Iterable[str]) -> FactFault | None:
    return "name" if any(TURNS_WRITING.intersection(name) for name in names) else None


def of_emitters_looked_for(recorded: Sequence[Recorded]) -> bool:
    """Of any other no server records a bearing, and no export finds its frequency."""
    emitters: frozenset[str] = frozenset()
    for record in recorded:
        fact = record.event
        if isinstance(fact, MissionDrafted | MissionEdited):
            emitters = frozenset(emitter.emitter_id for emitter in fact.spec.emitters)
        elif isinstance(fact, OfEmitter) and fact.emitter_id not in emitters:
            return False
    return True


def number_of(text: str) -> float | int:
    """Raises ValueError for one that cannot be reckoned with."""
    number = float(text)
    if abs(number) > LARGEST:
        raise ValueError(f"no mission tells a number of {len(text)} characters that is as large as this")
    return int(text) if text.lstrip("-").isdigit() else number


def is_id(text: Any) -> bool:
    """As Crossfix makes them."""
    plain = isinstance(text, str) and text.isascii() and text.replace("-", "").replace("_", "").isalnum()
    return plain and len(text) <= 64


def on_earth(lat_deg: float, lon_deg: float) -> bool:
    """WGS84."""
    return abs(lat_deg) <= 90 and abs(lon_deg) <= 180
