"""A journal that was exported, by this Crossfix or an earlier one, is read back."""

from __future__ import annotations

import gzip
import json
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest

from backend.events import FORM, Recorded
from backend.store.digest import EPOCH
from backend.store.entries import EventRow, to_records
from backend.store.exported import export_of_today
from backend.store.upgrade import FIRST_FORM
from backend.wire.export import journal_json

JOURNAL = Path(__file__).parents[2] / "golden" / "journals" / "imported.json.gz"
STORED = json.loads(gzip.decompress(JOURNAL.read_bytes()))
POINT = ["2026-11-22T10:00:00+00:00", 50.6, 7.2, 140.0, 90.0]


def recorded() -> list[Recorded]:
    rows = [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]]
    return to_records(STORED["mission_id"], rows)


def exported_before() -> dict[str, Any]:
    """As Crossfix 0.1.0 exported it."""
    mission_id = STORED["mission_id"]
    events = [
        {
            "seq": seq,
            "mission_id": mission_id,
            "at_utc": (EPOCH + timedelta(microseconds=at_us)).isoformat(),
            "event": json.loads(body),
        }
        for seq, at_us, _, body in STORED["rows"]
    ]
    return {"mission_id": mission_id, "software": "crossfix 0.1.0", "events": events, "track": [POINT]}


def test_a_journal_exported_before_is_read_as_the_stored_one() -> None:
    now = export_of_today(exported_before())
    assert now["events"] == recorded()
    assert (now["form"], now["tracks"]) == (FORM, {"craft-1": [POINT]})


def test_a_journal_exported_today_stays_as_it_is() -> None:
    exported = json.loads(journal_json(recorded(), {}))
    now = export_of_today(exported)
    assert now == {name: exported[name] for name in ("mission_id", "form", "tracks")} | {"events": recorded()}
    assert export_of_today(now) == now


@pytest.mark.parametrize("wrong", [{"form": FORM + 1}, {"events": [{"seq": 1}]}, {"events": 3}, {"form": FORM}])
def test_what_is_no_journal_of_ours_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        export_of_today(exported_before() | wrong)
