"""What a mission told is kept, so that it changes with the number of its reckoning only."""

from __future__ import annotations

import gzip
import hashlib
import json
import math
from dataclasses import replace
from typing import Any

from pydantic import TypeAdapter

from backend.events import BeliefUpdated, Recorded, TruthNoted
from backend.search.told import RECKONING, Told, sound, told
from backend.settings import REPOSITORY
from backend.spec import Place
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
TOLD = {2: "8dbac0a7058ce78d"}
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
