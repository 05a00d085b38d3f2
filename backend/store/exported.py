"""An exported journal (`mission.json`), perhaps of an earlier Crossfix, as it would be exported today."""

from __future__ import annotations

from typing import Any

from pydantic import TypeAdapter

from backend.events import FIRST_CRAFT, FORM, MissionDrafted, Recorded
from backend.store.upgrade import FIRST_FORM, READ_AS_IT_STANDS, Body, imports_of, upgraded

RECORDED = TypeAdapter(list[Recorded])


class NotExported(ValueError):
    """It is no exported journal."""


class ExportedLater(NotExported):
    """A later Crossfix exported it, in a form that is not known here."""


def export_of_today(exported: Any) -> Body:
    """Events (as Recorded) and tracks of what was parsed from the file. The first form named itself nowhere, and its
    only track had no craft.

    Raises NotExported, ExportedLater.
    """
    try:
        return _of_today(exported)
    except NotExported:
        raise
    except (LookupError, TypeError, ValueError, AttributeError, StopIteration) as error:
        raise NotExported(f"{type(error).__name__}: {error}") from error


def _of_today(exported: Body) -> Body:
    form, events = exported.get("form", FIRST_FORM), exported["events"]
    if form != FIRST_FORM and form not in READ_AS_IT_STANDS:
        raise ExportedLater(f"the journal is of form {form}: a later Crossfix exported it")
    tracks = {FIRST_CRAFT: exported["track"]} if form == FIRST_FORM else exported["tracks"]
    if form == FIRST_FORM:
        bodies = [record["event"] for record in events]
        imports = imports_of(body for body in bodies if body["kind"] == "recording_imported")
        events = [record | {"event": upgraded(record["event"], imports)} for record in events]
    recorded = RECORDED.validate_python(events)
    if not recorded or not isinstance(recorded[0].event, MissionDrafted):
        raise NotExported("a journal begins with the draft of its mission")
    return {
        "mission_id": exported["mission_id"],
        "form": FORM,
        "events": recorded,
        "tracks": tracks,
    }
