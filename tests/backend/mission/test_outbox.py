from __future__ import annotations

import asyncio

from stage import REFUSED, MemoryJournal, MemoryPublisher

from backend.events import FIRST_CRAFT, Event, HoldOrdered, ResumeOrdered
from backend.mission.outbox import Outbox
from hardware.clock import ScaledClock


def held(by: str) -> Event:
    return HoldOrdered(craft_id=FIRST_CRAFT, by=by, reason=None)


def resumed(by: str) -> Event:
    return ResumeOrdered(craft_id=FIRST_CRAFT, by=by)


def made() -> tuple[Outbox, MemoryJournal, MemoryPublisher]:
    journal = MemoryJournal(ScaledClock())
    publisher = MemoryPublisher(journal)
    return Outbox("m", journal, publisher, last_seq=0), journal, publisher


async def test_facts_are_stored_in_order_and_shown_afterwards() -> None:
    outbox, journal, publisher = made()
    outbox.record([held("one"), resumed("a")])
    outbox.record([])
    outbox.record([held("two")])
    assert publisher.shown == []
    await outbox.flushed()
    assert publisher.shown == journal.stored["m"]
    assert [r.seq for r in publisher.shown] == [1, 2, 3]
    assert outbox.last_seq == 3
    await outbox.close()


async def test_whoever_waits_for_what_is_handed_in_so_far_does_not_wait_for_what_comes_after() -> None:
    outbox, journal, _ = made()
    more = True

    async def again() -> None:
        await asyncio.sleep(0)
        if more:
            outbox.after(again)

    outbox.after(again)
    outbox.record([resumed("a")])
    async with asyncio.timeout(60):
        await outbox.flushed()
    assert len(journal.stored["m"]) == 1
    more = False
    await outbox.close()


async def test_a_journal_that_fails_is_asked_again_and_the_order_is_kept() -> None:
    outbox, journal, publisher = made()
    journal.away = True
    done: list[str] = []

    async def later() -> None:
        done.append("later")

    outbox.record([resumed("a")])
    outbox.after(later)
    for _ in range(20):
        await asyncio.sleep(0.005)
    assert outbox.failing
    assert publisher.shown == []
    assert done == []
    journal.away = False
    await outbox.flushed()
    assert not outbox.failing
    assert [r.event.kind for r in publisher.shown] == ["resume_ordered"]
    assert done == ["later"]
    await outbox.close()


async def test_nobody_waits_for_ever_for_a_journal_that_stores_nothing() -> None:
    outbox, journal, publisher = made()
    journal.away = True
    outbox.record([resumed("a")])
    async with asyncio.timeout(60):
        await outbox.flushed(0.01)
        assert outbox.failing
        await outbox.close(0.01)
    assert publisher.shown == []
    journal.away = False
    outbox.record([resumed("b")])
    await outbox.flushed()
    assert journal.kinds("m") == ["resume_ordered"], "what was being written when it ended is lost"
    await outbox.close()


async def test_whoever_is_patient_gets_what_a_slow_journal_stores() -> None:
    outbox, journal, _ = made()

    async def slow() -> None:
        await asyncio.sleep(0.1)

    outbox.after(slow)
    outbox.record([resumed("a")])
    await outbox.flushed(0.001)
    assert journal.kinds("m") == ["resume_ordered"]
    await outbox.close()


async def test_a_fact_that_is_refused_for_good_is_kept_aside_and_said_once_and_holds_nothing_up() -> None:
    said: list[str] = []
    journal = MemoryJournal(ScaledClock())
    publisher = MemoryPublisher(journal)
    outbox = Outbox("m", journal, publisher, 0, said.append)
    journal.refuses = {"hold_ordered"}
    outbox.record([resumed("a"), held("one"), resumed("b")])
    outbox.record([held("two")])
    outbox.record([resumed("c")])
    await outbox.flushed()
    assert journal.kinds("m") == ["resume_ordered"] * 3
    assert publisher.shown == journal.stored["m"]
    assert journal.aside == [held("one"), held("two")]
    assert outbox.refused == 2
    (detail,) = said
    assert "hold_ordered" in detail
    assert str(REFUSED.detail) in detail
    await outbox.close()


async def test_work_that_fails_for_a_reason_of_its_own_holds_nothing_up() -> None:
    outbox, journal, _ = made()

    async def broken() -> None:
        raise KeyError("a defect")

    outbox.after(broken)
    outbox.record([resumed("a")])
    await outbox.flushed()
    assert journal.kinds("m") == ["resume_ordered"]
    assert outbox.refused == 1
    await outbox.close()


async def test_closing_waits_for_what_was_handed_in() -> None:
    outbox, journal, _ = made()
    outbox.record([resumed("a")])
    await outbox.close()
    assert journal.kinds("m") == ["resume_ordered"]
    outbox.record([held("late")])
    await outbox.close()
    assert journal.kinds("m") == ["resume_ordered", "hold_ordered"]
