"""What one mission says of its bearings, fixes and forecasts where the truth is known: pure, over its facts.

A bearing's error is measured against the place that somebody told.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise

from backend.events import (
    AntennaFact,
    BeliefUpdated,
    CraftSource,
    MissionDrafted,
    MissionEdited,
    MissionStarted,
    PlaceReached,
    PlanChosen,
    Recorded,
    TruthNoted,
)
from backend.search.counted import counted
from backend.search.covering import covers
from hardware.frame import LocalFrame
from hardware.readings import Place

FACTS_NEEDED = (
    "mission_drafted",
    "mission_edited",
    "mission_started",
    "plan_chosen",
    "place_reached",
    "bearing_measured",
    "bearing_excluded",
    "bearing_included",
    "source_mute_changed",
    "belief_updated",
    "truth_noted",
)
RECKONING = 4
"""Of `told`: one more with every change of what it says, since what it said is kept."""
LEAST_SIGMA_DEG = 0.1


@dataclass(frozen=True, slots=True)
class ToldFix:
    """error_m, stated_m: of the estimate, true and expected. inside: the 95 % region."""

    emitter_id: str
    error_m: float
    stated_m: float
    inside: bool
    localized: bool


@dataclass(frozen=True, slots=True)
class Flown:
    """An antenna as one mission flew it. in_file_deg, mounted_deg: of its front to the nose, clockwise, before and
    after what the mission takes off its bearings. antenna "": nobody kept which it was."""

    antenna: str
    at_utc: datetime
    in_file_deg: float
    mounted_deg: float


@dataclass(frozen=True, slots=True)
class ToldError:
    """error_deg: as flown, clockwise of the truth, in [-180, 180)."""

    craft_id: str
    place: Place
    error_deg: float
    sigma_deg: float


@dataclass(frozen=True, slots=True)
class Leg:
    """Between places that a craft reached one after another."""

    craft_id: str
    distance_m: float
    time_s: float


@dataclass(frozen=True, slots=True)
class ToldForecast:
    """What a plan said of the time until all that it was made for are localized, and what it took from there."""

    time_90_s: float
    took_s: float


@dataclass(frozen=True, slots=True)
class Told:
    """not_found: emitters that were looked for in vain. flown: by craft, of every craft that has an error. forecasts:
    of plans whose emitters were localized."""

    crafts: list[str]
    antennas: list[str]
    not_found: int
    fixes: list[ToldFix]
    flown: dict[str, Flown]
    errors: list[ToldError]
    legs: list[Leg]
    forecasts: list[ToldForecast]


def sound(kept: Told) -> bool:
    """Whether what came out of a file can be reckoned with: finite, spreads above zero, of crafts that flew."""
    numbers = [
        *(number for fix in kept.fixes for number in (fix.error_m, fix.stated_m)),
        *(number for one in kept.flown.values() for number in (one.in_file_deg, one.mounted_deg)),
        *(number for error in kept.errors for number in (error.error_deg, error.sigma_deg)),
        *(number for leg in kept.legs for number in (leg.distance_m, leg.time_s)),
        *(number for one in kept.forecasts for number in (one.time_90_s, one.took_s)),
    ]
    spreads = [*(fix.stated_m for fix in kept.fixes), *(error.sigma_deg for error in kept.errors)]
    flew = all(error.craft_id in kept.flown for error in kept.errors)
    return flew and all(math.isfinite(number) for number in numbers) and all(spread > 0.0 for spread in spreads)


def told(recorded: Sequence[Recorded]) -> Told:
    """recorded: of FACTS_NEEDED, in order."""
    started = [r.event for r in recorded if isinstance(r.event, MissionStarted)]
    truth = {r.event.emitter_id: r.event.place for r in recorded if isinstance(r.event, TruthNoted)}  # the last word
    known = {emitter: place for emitter, place in truth.items() if place is not None}
    errors = list(_errors(recorded, known))
    flown = _flown(recorded)
    return Told(
        crafts=sorted({event.craft_id for event in started}),
        antennas=sorted({event.antenna.name for event in started if event.antenna is not None}),
        not_found=sum(place is None for place in truth.values()),
        fixes=list(_fixes(recorded, known)),
        flown={one: flown.get(one, Flown("", recorded[0].at_utc, 0.0, 0.0)) for one in {e.craft_id for e in errors}},
        errors=errors,
        legs=list(_legs(recorded)),
        forecasts=list(_forecasts(recorded)),
    )


def _fixes(recorded: Sequence[Recorded], known: Mapping[str, Place]) -> Iterable[ToldFix]:
    last = {r.event.emitter_id: r.event for r in recorded if isinstance(r.event, BeliefUpdated)}
    for emitter_id, place in known.items():
        belief = last.get(emitter_id)
        estimate = None if belief is None else belief.estimate
        if belief is None or estimate is None or belief.bearings == 0:
            continue
        east, north = LocalFrame(place).to_enu(Place(lat=estimate.lat, lon=estimate.lon))
        inside = covers(estimate.c95, place)
        yield ToldFix(emitter_id, math.hypot(east, north), estimate.expected_rmse_m, inside, belief.localized)


def _flown(recorded: Sequence[Recorded]) -> dict[str, Flown]:
    """By craft."""
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    taken_off = specs[-1].sensor.bearing_offset_deg if specs else 0.0
    found: dict[str, Flown] = {}
    for record in recorded:
        match record.event:
            case MissionStarted(craft_id=craft_id, antenna=None):
                found[craft_id] = Flown("", record.at_utc, 0.0, -taken_off)
            case MissionStarted(craft_id=craft_id, antenna=AntennaFact(name=name, offset_to_nose_deg=mounted)):
                found[craft_id] = Flown(name, record.at_utc, mounted + taken_off, mounted)
            case _:
                pass
    return found


def _errors(recorded: Sequence[Recorded], known: Mapping[str, Place]) -> Iterable[ToldError]:
    """Of the counted bearings that a craft took, of emitters whose place is known and was the same all the time."""
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    moving = {one.emitter_id for spec in specs[-1:] for one in spec.emitters if one.movement.kind != "still"}
    places = {emitter: place for emitter, place in known.items() if emitter not in moving}
    for fact in counted(record.event for record in recorded):
        if fact.emitter_id not in places or not isinstance(fact.source, CraftSource):
            continue
        east, north = LocalFrame(fact.place).to_enu(places[fact.emitter_id])
        wanted = math.degrees(math.atan2(east, north))
        error_deg = (fact.bearing_deg - wanted + 180.0) % 360.0 - 180.0
        yield ToldError(fact.source.craft_id, fact.place, error_deg, max(fact.sigma_deg, LEAST_SIGMA_DEG))


def _legs(recorded: Sequence[Recorded]) -> Iterable[Leg]:
    reached = [r.event for r in recorded if isinstance(r.event, PlaceReached)]
    for craft_id in sorted({event.craft_id for event in reached}):
        for before, after in pairwise(event for event in reached if event.craft_id == craft_id):
            if after.flight_time_s > 0:
                east, north = LocalFrame(before.place).to_enu(after.place)
                yield Leg(craft_id, math.hypot(east, north), after.flight_time_s)


def _forecasts(recorded: Sequence[Recorded]) -> Iterable[ToldForecast]:
    """A plan's times are until the last one is localized that it was made for; one that never was tells nothing."""
    emitters: list[str] = []
    claimed: set[str] = set()
    waiting: list[tuple[datetime, float, set[str]]] = []
    for record in recorded:
        match record.event:
            case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
                emitters = [emitter.emitter_id for emitter in spec.emitters]
            case PlanChosen(time_90_s=time_90_s, emitter_id=one, forecasts=each) if time_90_s is not None:
                planned_for = [one] if one is not None else [of.emitter_id for of in each] or emitters
                waiting.append((record.at_utc, time_90_s, set(planned_for) - claimed))
            case BeliefUpdated(emitter_id=emitter_id, localized=False):
                claimed.discard(emitter_id)
            case BeliefUpdated(emitter_id=emitter_id):
                claimed.add(emitter_id)
                for at_utc, time_90_s, missing in waiting:
                    if missing == {emitter_id} and at_utc < record.at_utc:
                        yield ToldForecast(time_90_s, (record.at_utc - at_utc).total_seconds())
                    missing.discard(emitter_id)
            case _:
                pass
