"""What a mission told is kept, so that it changes with the number of its reckoning only."""

from __future__ import annotations

import gzip
import hashlib
import json
import math
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

from facts import SECOND, TWO_SPEC, belief, plan
from pydantic import TypeAdapter

from backend.events import BeliefUpdated, Event, ForecastFact, MissionDrafted, PlanChosen, Recorded, TruthNoted
from backend.search.told import RECKONING, Told, sound, told
from backend.settings import REPOSITORY
from backend.spec import FIRST_EMITTER, MovementSpec, Place
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
TOLD = {4: "8dbac0a7058ce78d"}
"""By reckoning, the digest of what the stored flight tells."""


def flown() -> list[Recorded]:
    rows = [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]]
    facts = to_records(STORED["mission_id"], rows)
    found = next(r.event.estimate for r in reversed(facts) if isinstance(r.event, BeliefUpdated) and r.event.estimate)
    place = Place(lat=found.lat + 1e-4, lon=found.lon)
    truth = TruthNoted(emitter_id="emitter-1", place=place, accuracy_m=3.0, how="map", by="anna")
    return [*facts, facts[-1].model_copy(update={"seq": facts[-1].seq + 1, "event": truth})]


def rounded(value: Any) -> Any:
    """To what every machine reckons alike."""
    match value:
        case float():
            return round(value, 6)
        case list():
            return [rounded(one) for one in value]
        case dict():
            return {name: rounded(one) for name, one in value.items()}
        case _:
            return value


def test_what_is_told_changes_with_its_reckoning_only() -> None:
    said = rounded(TypeAdapter(Told).dump_python(told(flown()), mode="json"))
    assert (len(said["errors"]), len(said["fixes"]), len(said["legs"]), len(said["forecasts"])) == (3, 1, 2, 3)
    digest = hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:16]
    assert TOLD.get(RECKONING) == digest, "raise RECKONING in backend.search.told, and name the new digest here"


def test_where_a_moving_emitter_was_found_says_nothing_of_the_bearings_before() -> None:
    """An animal that walked on during the flight made its bearings outliers, and the next flight's sigma larger."""
    recorded = flown()
    drafted = recorded[0].event
    assert isinstance(drafted, MissionDrafted)
    hare = drafted.spec.emitters[0].model_copy(update={"movement": MovementSpec(kind="animal")})
    spec = drafted.spec.model_copy(update={"emitters": [hare]})
    said = told([recorded[0].model_copy(update={"event": MissionDrafted(spec=spec)}), *recorded[1:]])
    assert (said.errors, len(said.fixes)) == ([], 1)


def test_what_cannot_have_been_told_is_not_sound() -> None:
    said = told(flown())
    first = said.errors[0]
    odd = [
        replace(first, sigma_deg=0.0),
        replace(first, sigma_deg=math.inf),
        replace(first, error_deg=math.nan),
        replace(first, craft_id="another"),
    ]
    assert sound(said)
    assert not any(sound(replace(said, errors=[one])) for one in odd)
    assert not sound(replace(said, fixes=[replace(said.fixes[0], error_m=math.nan)]))
    assert not sound(replace(said, forecasts=[replace(said.forecasts[0], took_s=math.inf)]))


BEGAN = datetime(2026, 5, 1, 12, tzinfo=UTC)


def planned(emitter_id: str | None, time_90_s: float, *for_each: str) -> PlanChosen:
    each = [ForecastFact(emitter_id=one, expected_time_s=None) for one in for_each]
    return plan().model_copy(update={"emitter_id": emitter_id, "time_90_s": time_90_s, "forecasts": each})


def forecasts(*facts: tuple[float, Event]) -> list[tuple[float, float]]:
    """What they were and took, of a search for two emitters. facts: with their second."""
    drafted = (0.0, MissionDrafted(spec=TWO_SPEC))
    recorded = [
        Recorded(seq=seq, mission_id="m", at_utc=BEGAN + timedelta(seconds=at_s), event=fact)
        for seq, (at_s, fact) in enumerate([drafted, *facts], start=1)
    ]
    return [(one.time_90_s, one.took_s) for one in told(recorded).forecasts]


FIRST = FIRST_EMITTER


def test_a_forecast_is_held_against_the_emitters_that_it_was_made_for() -> None:
    assert forecasts(
        (10.0, planned(FIRST, 60.0)),
        (20.0, planned(SECOND, 400.0)),
        (50.0, belief(1, localized=True)),
        (60.0, planned(SECOND, 300.0)),
        (650.0, belief(2, localized=True, emitter_id=SECOND)),
    ) == [(60.0, 40.0), (400.0, 630.0), (300.0, 590.0)]


def test_a_plan_for_several_takes_until_the_last_of_them_is_claimed() -> None:
    both = (planned(None, 90.0, FIRST, SECOND), planned(None, 90.0))
    for plan_for_both in both:
        claims = ((30.0, belief(1, localized=True)), (80.0, belief(2, localized=True, emitter_id=SECOND)))
        assert forecasts((10.0, plan_for_both), *claims) == [(90.0, 70.0)]
        assert forecasts((10.0, plan_for_both), claims[0]) == [], "the other was never found"
        assert forecasts(claims[0], (40.0, planned(None, 90.0)), claims[1]) == [(90.0, 40.0)], "one was found before"


def test_what_is_lost_again_is_waited_for_again() -> None:
    lost = belief(2, localized=False)
    assert forecasts(
        (10.0, planned(FIRST, 60.0)),
        (30.0, belief(1, localized=True)),
        (40.0, lost),
        (50.0, planned(FIRST, 20.0)),
        (60.0, belief(3, localized=True)),
    ) == [(60.0, 20.0), (20.0, 10.0)]
