from __future__ import annotations

import asyncio

from doubles import MemoryJournal, MemoryPublisher

from backend.events import HoldOrdered, ResumeOrdered
from backend.mission.outbox import Outbox
from hardware.clock import ScaledClock


def made() -> tuple[Outbox, MemoryJournal, MemoryPublisher]:
    journal = MemoryJournal(ScaledClock())
    publisher = MemoryPublisher(journal)
    return Outbox("m", journal, publisher, last_seq=0), journal, publisher


async def test_facts_are_stored_in_order_and_shown_afterwards() -> None:
    outbox, journal, publisher = made()
    outbox.record([HoldOrdered(by="a", reason="one"), ResumeOrdered(by="a")])
    outbox.record([])
    outbox.record([HoldOrdered(by="a", reason="two")])
    assert publisher.shown == []
    await outbox.flushed()
    assert publisher.shown == journal.stored["m"]
    assert [r.seq for r in publisher.shown] == [1, 2, 3]
    assert outbox.last_seq == 3
    await outbox.close()


async def test_a_journal_that_fails_is_asked_again_and_the_order_is_kept() -> None:
    outbox, journal, publisher = made()
    journal.away = True
    done: list[str] = []

    async def later() -> None:
        done.append("later")

    outbox.record([ResumeOrdered(by="a")])
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


async def test_closing_waits_for_what_was_handed_in() -> None:
    outbox, journal, _ = made()
    outbox.record([ResumeOrdered(by="a")])
    await outbox.close()
    assert journal.kinds("m") == ["resume_ordered"]
    outbox.record([HoldOrdered(by="a", reason="late")])
    await outbox.close()
    assert journal.kinds("m") == ["resume_ordered", "hold_ordered"]
