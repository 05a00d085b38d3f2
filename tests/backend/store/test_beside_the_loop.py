"""A mission of many facts is read, folded and compared beside the event loop, a piece at a time."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from stepped_clock import SteppedClock

from backend.beside import MANY
from backend.events import HoldOrdered, MissionDrafted, MissionStarted, Recorded
from backend.mission import records as mission_records
from backend.mission.records import Records
from backend.mission.state import MissionState
from backend.spec import MissionSpec, Place, Polygon
from backend.store import digest, entries, journal, packed
from backend.store.brought import Brought
from backend.store.entries import JournalConflict, to_row

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
STARTED = MissionStarted(
    craft_id="craft-1", by="operator", home=Place(lat=50.6, lon=7.2), home_amsl_m=100.0, software="0.1.0"
)
FACTS = 1_200


def holds(count: int) -> list[HoldOrdered]:
    notes = ["x" * 2_000 if n % 10 == 0 else str(n) for n in range(count)]
    return [HoldOrdered(craft_id="craft-1", by=note, reason=None) for note in notes]


@pytest.fixture
async def many(bench) -> journal.SqlJournal:
    """A mission of FACTS facts, some of them long, read by a server that did not write it."""
    first = await bench.open()
    await first.append("m", [MissionDrafted(spec=SPEC), *holds(FACTS - 1)])
    await bench.close()
    return await bench.open()


def watch(monkeypatch: pytest.MonkeyPatch, *places: tuple[Any, str]) -> list[tuple[str, bool, int]]:
    """Of each call: its name, whether it was on the event loop's thread, and how many facts it was given."""
    called: list[tuple[str, bool, int]] = []
    loop = threading.get_ident()

    def watched(name: str, work: Callable[..., Any]) -> Callable[..., Any]:
        def call(*args: Any, **named: Any) -> Any:
            facts = max((len(given) for given in args if isinstance(given, list | tuple)), default=1)
            called.append((name, threading.get_ident() == loop, facts))
            return work(*args, **named)

        return call

    for place, name in places:
        monkeypatch.setattr(place, name, watched(name, getattr(place, name)))
    return called


def held_up(called: Sequence[tuple[str, bool, int]]) -> int:
    """The most facts that one call on the event loop worked on."""
    return max((facts for _, on_loop, facts in called if on_loop), default=0)


def brought_of(recorded: Sequence[Recorded]) -> Brought:
    rows = tuple(to_row(record.seq, record.at_utc, record.event) for record in recorded)
    return Brought("m", rows, digest.fold(None, recorded), (), (), "crossfix")


async def test_a_mission_that_is_here_is_compared_a_piece_at_a_time(many, monkeypatch) -> None:
    brought = brought_of(await many.read("m"))
    called = watch(monkeypatch, (journal, "fold"), (journal, "to_row"), (entries, "_record"))
    pieces = list[int]()
    read = journal.SqlJournal.read

    async def counted(this: journal.SqlJournal, *args: Any, **named: Any) -> list[Recorded]:
        pieces.append(len(found := await read(this, *args, **named)))
        return found

    monkeypatch.setattr(journal.SqlJournal, "read", counted)
    assert await many.bring_in(brought, "Ada") is False
    assert max(pieces) <= journal.PIECE < FACTS
    assert sum(pieces) == FACTS, "all of it was compared"
    assert not any(on_loop for name, on_loop, _ in called), "no fact is parsed or written on the event loop"
    assert "fold" not in {name for name, _, _ in called}


@pytest.mark.parametrize("at", [0, journal.PIECE, FACTS - 1])
async def test_one_that_differs_in_any_piece_is_refused(many, at) -> None:
    brought = brought_of(await many.read("m"))
    rows = list(brought.rows)
    rows[at] = to_row(rows[at].seq, (await many.read("m"))[at].at_utc, HoldOrdered(craft_id="c", by="z", reason=None))
    with pytest.raises(JournalConflict):
        await many.bring_in(Brought("m", tuple(rows), brought.digest, (), (), "crossfix"), "Ada")


async def test_one_that_is_longer_than_what_is_here_is_refused(many) -> None:
    brought = brought_of(await many.read("m"))
    more = to_row(FACTS + 1, (await many.read("m"))[-1].at_utc, HoldOrdered(craft_id="c", by="z", reason=None))
    with pytest.raises(JournalConflict):
        await many.bring_in(Brought("m", (*brought.rows, more), brought.digest, (), (), "crossfix"), "Ada")


async def test_the_first_fact_after_a_start_reads_none_of_the_others(many, monkeypatch) -> None:
    called = watch(monkeypatch, (journal, "fold"), (packed, "unpacked"))
    await many.append("m", [HoldOrdered(craft_id="craft-1", by="now", reason=None)])
    assert [one for one in called if one[0] == "fold"] == [("fold", True, 1)]
    assert len(called) == 1, "no stored text is unpacked"


async def test_of_a_mission_under_way_the_others_are_folded_beside_the_loop_a_piece_at_a_time(
    bench, monkeypatch
) -> None:
    first = await bench.open()
    await first.append("m", [MissionDrafted(spec=SPEC), STARTED, *holds(FACTS)])
    await bench.close()
    again = await bench.open()
    called = watch(monkeypatch, (journal, "fold"))
    await again.append("m", [HoldOrdered(craft_id="craft-1", by="now", reason=None)])
    assert held_up(called) == 1
    assert sum(facts for _, on_loop, facts in called if not on_loop) == FACTS + 2
    assert max(facts for _, _, facts in called) <= journal.PIECE < FACTS
    assert len(again._written["m"].recorded) == FACTS + 3, "all of it is there while the database is away"


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_stored_texts_are_unpacked_beside_the_loop(many, monkeypatch) -> None:
    called = watch(monkeypatch, (packed, "unpacked"))
    assert len(await many.read("m")) == FACTS
    assert len([one for one in called if one[1]]) <= MANY
    assert len(called) >= FACTS


async def test_a_state_is_folded_a_piece_at_a_time_beside_the_loop(many, monkeypatch) -> None:
    whole = mission_records.fold_on(MissionState(), await many.read("m"))
    called = watch(monkeypatch, (mission_records, "fold_on"))
    state, last_seq = await Records(many, None, SteppedClock(0.0)).load("m")  # type: ignore[arg-type]
    assert (state, last_seq) == (whole, FACTS)
    assert held_up(called) <= MANY
    assert max(facts for _, _, facts in called) <= mission_records.PIECE < FACTS
