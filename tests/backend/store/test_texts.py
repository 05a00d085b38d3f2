"""Facts are sent as they are stored; what a reader gets is what it would get of the facts themselves."""

from __future__ import annotations

import gzip
import json
from collections.abc import Sequence
from datetime import timedelta
from pathlib import Path

import pytest
from facts import SPEC
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.events import FORM, HoldOrdered, MissionDrafted, MissionEdited, Recorded
from backend.store import entries
from backend.store.digest import EPOCH, fold, to_columns
from backend.store.engine import make_engine
from backend.store.entries import EventRow, to_records, to_row, to_texts
from backend.store.tables import events, missions
from backend.store.upgrade import FIRST_FORM

JOURNALS = Path(__file__).parents[2] / "golden" / "journals"
PATIENCE_S = 60.0
HELD = HoldOrdered(craft_id="craft-1", by='ä \u2028 "quoted"', reason=None)


def of_before(name: str) -> tuple[str, list[EventRow]]:
    told = json.loads(gzip.decompress((JOURNALS / f"{name}.json.gz").read_bytes()))
    return told["mission_id"], [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in told["rows"]]


def of_today(rows: Sequence[EventRow]) -> list[EventRow]:
    return [to_row(record.seq, record.at_utc, record.event) for record in to_records("m", rows)]


async def lay(url: str, mission_id: str, rows: Sequence[EventRow]) -> None:
    """Rows as a server of then left them."""
    engine = make_engine(url, PATIENCE_S)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(missions.insert().values(to_columns(fold(None, to_records(mission_id, rows)))))
        named = ("seq", "at_us", "kind", "form", "body")
        told = [{"mission_id": mission_id} | {name: getattr(row, name) for name in named} for row in rows]
        await connection.execute(events.insert(), told)
    await engine.dispose()


@pytest.mark.parametrize("name", sorted(path.name.removesuffix(".json.gz") for path in JOURNALS.glob("*.json.gz")))
def test_every_fact_is_told_as_if_it_had_been_decoded(name: str) -> None:
    mission_id, old = of_before(name)
    for rows in (old, of_today(old), [*of_today(old[:5]), *old[5:]]):
        assert to_texts(mission_id, rows) == [r.model_dump_json() for r in to_records(mission_id, rows)]


@settings(deadline=None)
@given(st.integers(0, 4_000_000_000_000_000), st.integers(1, 2**31 - 1))
def test_times_are_told_alike(at_us: int, seq: int) -> None:
    rows = [to_row(seq, EPOCH + timedelta(microseconds=at_us), HELD)]
    assert to_texts("m", rows) == [to_records("m", rows)[0].model_dump_json()]


def test_a_text_of_today_is_not_decoded(monkeypatch: pytest.MonkeyPatch) -> None:
    row = to_row(1, EPOCH, HELD)
    (text,) = to_texts("m", [row])
    monkeypatch.setattr(entries, "_record", lambda *_: pytest.fail("it was decoded"))
    assert to_texts("m", [row]) == [text]


def test_a_form_that_lacks_a_field_is_completed() -> None:
    body = json.loads(MissionDrafted(spec=SPEC).model_dump_json())
    del body["spec"]["timers"]
    (text,) = to_texts("m", [EventRow(1, 0, "mission_drafted", FORM - 1, json.dumps(body))])
    assert json.loads(text)["event"] == json.loads(MissionDrafted(spec=SPEC).model_dump_json())


async def test_pages_of_a_journal_of_all_forms_say_the_whole(bench) -> None:
    """The imported sweeps of form 1 are named in a fact that the later pages do not hold."""
    mission_id, old = of_before("imported")
    middle = len(old) * 2 // 3
    rows = [*old[:middle], *of_today(old)[middle:]]
    await lay(bench.url, mission_id, rows)
    bench.timeout_s = PATIENCE_S
    journal = await bench.open()
    whole = [record.model_dump_json() for record in await journal.read(mission_id)]
    pages: list[str] = []
    while told := await journal.read_texts(mission_id, after=len(pages), most=7):
        assert len(told) <= 7
        pages += told
    assert pages == whole
    assert [Recorded.model_validate_json(text).seq for text in pages] == list(range(1, len(rows) + 1))


async def test_a_mission_that_is_written_to_is_told_from_memory(bench) -> None:
    bench.timeout_s = PATIENCE_S
    journal = await bench.open()
    await journal.append("m", [MissionDrafted(spec=SPEC), MissionEdited(spec=SPEC), HELD])
    in_memory = await journal.read_texts("m", after=1, most=2)
    assert len(in_memory) == 2
    assert await (await bench.open("other.spool")).read_texts("m", after=1) == in_memory
