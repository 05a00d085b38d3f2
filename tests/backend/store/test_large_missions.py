"""A large mission that is not under way: a new fact is written without a look at the others, and all are read alike."""

from __future__ import annotations

import sqlite3

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import make_url

from backend.events import HoldOrdered, MissionDrafted, MissionEnded, MissionLabelled, MissionStarted, Recorded
from backend.reasons.search import Localized
from backend.spec import MissionSpec, Place, Polygon
from backend.store import written
from backend.store.digest import fold
from backend.store.entries import EventRow
from backend.store.handed_over import FactsDamaged, HandedOver, made_of
from backend.store.journal import SqlJournal
from backend.store.written import Written

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
STARTED = MissionStarted(
    craft_id="craft-1", by="operator", home=Place(lat=50.6, lon=7.2), home_amsl_m=100.0, software="0.1.0"
)
LABEL = MissionLabelled(name="named", tags=["a"], notes="", by="anna")
DRAFT = [MissionDrafted(spec=SPEC), *(HoldOrdered(craft_id="craft-1", by=str(n), reason=None) for n in range(20))]
OVER = [DRAFT[0], STARTED, *DRAFT[1:], MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0)]


@pytest.fixture(autouse=True)
def _few_are_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(written, "KEPT_WHOLE", 10)
    monkeypatch.setattr("backend.store.journal.PIECE", 7)


async def read_anew(bench) -> list[Recorded]:
    return await (await bench.open("other.spool")).read("m")


@pytest.fixture(params=[DRAFT, OVER], ids=["a draft", "over"])
async def labelled(request: pytest.FixtureRequest, bench) -> SqlJournal:
    """By a server that has not written its other facts."""
    await (await bench.open()).append("m", request.param)
    await bench.close()
    journal = await bench.open()
    await journal.append("m", [LABEL])
    return journal


async def test_it_is_read_alike_from_wherever(labelled: SqlJournal, bench) -> None:
    whole = await read_anew(bench)
    assert [record.seq for record in whole] == list(range(1, len(whole) + 1))
    for after in (0, 3, len(whole) - 2, len(whole) - 1, len(whole)):
        for most in (None, 1, 5, len(whole)):
            assert await labelled.read("m", after, most) == whole[after:][:most]
            texts = [record.model_dump_json() for record in whole[after:][:most]]
            assert await labelled.read_texts("m", after, most) == texts
    kinds = ("mission_drafted", "mission_labelled")
    assert await labelled.read_kinds("m", kinds) == [whole[0], whole[-1]]
    assert await labelled.mission("m") == fold(None, whole)


async def test_the_next_server_writes_on(labelled: SqlJournal, bench) -> None:
    last = (await labelled.read("m"))[-1].seq
    (second,) = await labelled.append("m", [LABEL])
    assert second.seq == last + 1
    (third,) = await (await bench.open("other.spool")).append("m", [LABEL])
    assert third.seq == last + 2


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_what_waits_in_the_spool_is_read_behind_what_is_stored(labelled: SqlJournal, bench) -> None:
    stored = await labelled.read("m")
    other = sqlite3.connect(make_url(bench.url).database or "", isolation_level=None)
    other.execute("BEGIN EXCLUSIVE")
    waiting = [*await labelled.append("m", [LABEL]), *await labelled.append("m", [LABEL])]
    assert labelled.report().spooled == 2
    assert await labelled.read("m") == [*stored, *waiting]
    assert await labelled.read("m", 2, len(stored)) == [*stored, *waiting][2:][: len(stored)]
    assert (await labelled.read_kinds("m", ["mission_labelled"]))[-2:] == waiting
    assert (await labelled.hand_over("m")).recorded() == [*stored, *waiting]
    other.execute("ROLLBACK")
    other.close()
    await labelled.start_up()
    assert await read_anew(bench) == [*stored, *waiting]


async def test_one_under_way_is_kept_whole(bench) -> None:
    await (await bench.open()).append("m", OVER[:-1])
    await bench.close()
    journal = await bench.open()
    await journal.append("m", [LABEL])
    assert journal._written["m"].recorded == await read_anew(bench)


@pytest.mark.parametrize("facts", [DRAFT, OVER[:-1]], ids=["a draft", "under way"])
async def test_it_is_handed_over_whole_out_of_memory_too(bench, facts) -> None:
    journal = await bench.open()
    await journal.append("m", facts)
    handed = await journal.hand_over("m")
    assert handed.recorded() == await journal.read("m") == await read_anew(bench)
    assert len(handed.pieces) == -(-len(facts) // 7)
    assert await (await bench.open("third.spool")).hand_over("m") == handed
    assert await journal.hand_over("nothing") == HandedOver((), {})


async def test_what_is_no_fact_is_damage(bench) -> None:
    journal = await bench.open()
    await journal.append("m", DRAFT)
    (piece, *others) = (await journal.hand_over("m")).pieces
    torn = HandedOver((piece.replace(b"hold_ordered", b"hold_torn"), *others), {})
    with pytest.raises(FactsDamaged, match="hold_torn"):
        made_of(torn, lambda _recorded, _tracks: "", {})


@given(st.integers(0, 12), st.integers(0, 12), st.integers(0, 25), st.none() | st.integers(0, 25))
def test_what_is_stored_only_and_what_is_here_make_up_what_was_asked(before, here, after, most) -> None:
    rows = [EventRow(seq, 0, "", 0, "") for seq in range(1, before + here + 1)]
    known: Written = Written(None, rows[before:], before)  # type: ignore[arg-type]
    stored = rows[:before][after:][: known.stored_only(after, most)]
    assert len(stored) == known.stored_only(after, most)
    assert [*stored, *known.here(after, most)] == rows[after:][:most]
    assert known.last_seq == len(rows)
