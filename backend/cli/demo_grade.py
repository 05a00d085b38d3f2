"""How well a simulated mission did: what it claims, against where its emitters stand."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from shapely import Point
from shapely.geometry import shape

from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    Event,
    MissionDrafted,
    MissionEnded,
    MissionStarted,
    PlanChosen,
    Recorded,
    SweepRejected,
)
from backend.settings import Settings
from backend.simulation.emitters import Signal
from backend.spec import EmitterSpec
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.reason import text_of

E = TypeVar("E", bound=Event)


@dataclass(slots=True)
class MissionLog:
    """Every event that the websocket told, in order. holds: why the mission stopped and was resumed."""

    mission_id: str
    recorded: list[Recorded] = field(default_factory=list[Recorded])
    holds: list[str] = field(default_factory=list[str])

    def all(self, kind: type[E], emitter_id: str | None = None) -> list[E]:
        """Of one emitter, or whomever they are about."""
        events = [r.event for r in self.recorded if isinstance(r.event, kind)]
        return [event for event in events if emitter_id is None or getattr(event, "emitter_id", None) == emitter_id]


TruthAt = Callable[[float], Mapping[Signal, Place]]
"""Where each emitter is at a time (UTC epoch seconds); empty when that is not known."""


def summary(log: MissionLog, settings: Settings, truths: Mapping[Signal, Place] | TruthAt) -> dict[str, Any]:
    """What `--json` prints. truths: where each emitter stands, or is at a time; empty when that is not known. An
    emitter is graded at its last claim, when it was claimed at all, and then by where it was.

    `localized` and `outcome` are the mission's. Errors, bearings and sweeps are those of its first emitter; the others
    follow in `emitters` when there are several.
    """
    ended = log.all(MissionEnded)[-1]
    emitters = log.all(MissionDrafted)[-1].spec.emitters
    truth_at: TruthAt = truths if callable(truths) else lambda _: truths
    graded = [_graded(log, emitter, truth_at) for emitter in emitters]
    name, signal = emitters[0].emitter_id, _signal(emitters[0])
    bearings = log.all(BearingMeasured, name)
    result = {
        "localized": ended.outcome == "localized",
        "error_m": graded[0]["error_m"],
        "expected_rmse_m": graded[0]["expected_rmse_m"],
        "in_c95": graded[0]["in_c95"],
        "bearings": len(bearings),
        "bearing_errors_deg": [
            _bearing_error(b, truth)
            for b in bearings
            if (truth := truth_at(b.taken_at_s or 0.0).get(signal)) is not None
        ],
        "bearing_sigmas_deg": [b.sigma_deg for b in bearings],
        "rejected_sweeps": len(log.all(SweepRejected, name)),
        "mission_time_s": ended.mission_time_s,
        "plan_ms": [p.plan_ms for p in log.all(PlanChosen) if p.source == "planner"],
        "database": settings.async_database_url.split(":///", 1)[-1],
        "outcome": ended.outcome,
        "reason": text_of(ended.reason),
        "holds": log.holds,
        "seed": settings.seed,
        "world": settings.world,
        "mission_id": log.mission_id,
    }
    return result | ({"emitters": graded} if len(graded) > 1 else {})


def _graded(log: MissionLog, emitter: EmitterSpec, truth_at: TruthAt) -> dict[str, Any]:
    """The last claim about an emitter, else the last estimate, against where it was then."""
    beliefs = [
        (record.event, record.at_utc.timestamp())
        for record in log.recorded
        if isinstance(record.event, BeliefUpdated) and record.event.emitter_id == emitter.emitter_id
    ]
    moves = emitter.movement.kind != "still"
    claims = [one for one in beliefs if moves and one[0].localized] or beliefs
    last, at_s = claims[-1] if claims else (None, 0.0)
    estimate = None if last is None else last.estimate
    truth = truth_at(at_s).get(_signal(emitter))
    error_m = in_c95 = None
    if estimate is not None and truth is not None:
        error_m = math.hypot(*LocalFrame(truth).to_enu(Place(estimate.lat, estimate.lon)))
        in_c95 = bool(shape(estimate.c95.model_dump()).covers(Point(truth.lon, truth.lat)))
    return {
        "emitter_id": emitter.emitter_id,
        "frequency_hz": emitter.frequency_hz,
        "priority": emitter.priority,
        "found_s": _found_s(log, beliefs),
        "localized": last is not None and last.localized,
        "error_m": error_m,
        "expected_rmse_m": None if estimate is None else estimate.expected_rmse_m,
        "in_c95": in_c95,
    }


def _found_s(log: MissionLog, beliefs: Sequence[tuple[BeliefUpdated, float]]) -> float | None:
    """From the start until the claim that stands in the end was made; None without one."""
    began_s = next((r.at_utc.timestamp() for r in log.recorded if isinstance(r.event, MissionStarted)), None)
    since_s: float | None = None
    for belief, at_s in beliefs:
        since_s = (at_s if since_s is None else since_s) if belief.localized else None
    return None if began_s is None or since_s is None else since_s - began_s


def _signal(emitter: EmitterSpec) -> Signal:
    return Signal(emitter.frequency_hz, emitter.pulse_period_s if emitter.kind == "pulsed" else None)


def _bearing_error(measured: BearingMeasured, truth: Place) -> float:
    """Measured minus true bearing, degrees in [-180, 180)."""
    east, north = LocalFrame(measured.place).to_enu(truth)
    return (measured.bearing_deg - math.degrees(math.atan2(east, north)) + 180.0) % 360.0 - 180.0


def sentences(result: dict[str, Any]) -> Sequence[str]:
    """The summary for people: the mission in one line, then an emitter a line when there are several."""
    seconds = round(result["mission_time_s"])
    took = f"{seconds // 60}:{seconds % 60:02d}"
    several = [f"{graded['emitter_id']}: {_how_near(graded)}" for graded in result.get("emitters", [])]
    if not result["localized"]:
        return (f"Not localized after {took} and {result['bearings']} bearings: {result['reason']}", *several)
    return (f"Localized after {took} with {result['bearings']} bearings: {_how_near(result)}", *several)


def _how_near(graded: dict[str, Any]) -> str:
    if graded["expected_rmse_m"] is None:
        return "no estimate."
    expected = f"{graded['expected_rmse_m']:.1f} m expected"
    if graded["error_m"] is None:
        return f"{expected}."
    inside = "inside" if graded["in_c95"] else "outside"
    return f"{graded['error_m']:.1f} m from the emitter, {expected}, {inside} C95."
