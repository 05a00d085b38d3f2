"""What every Journal does (backend.mission.ports): facts in order, without gaps, durable before they are told."""

from __future__ import annotations

import asyncio

import pytest

from backend.events import HoldOrdered, MissionDrafted, MissionEnded, MissionStarted
from backend.mission.ports import Journal
from backend.spec import MissionSpec, Place, Polygon

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
DRAFT = MissionDrafted(spec=SPEC)
STARTED = MissionStarted(by="operator", home=Place(lat=50.6, lon=7.2), home_amsl_m=100.0, software="0.1.0")
ENDED = MissionEnded(outcome="localized", reason="within 10 m", mission_time_s=200.0)


def hold(reason: str = "wind") -> HoldOrdered:
    return HoldOrdered(by="operator", reason=reason)


async def test_an_append_of_nothing_is_nothing(journal: Journal):
    await journal.append("m", [DRAFT])
    assert await journal.append("m", []) == []
    assert len(await journal.read("m")) == 1


async def test_missions_do_not_mix(journal: Journal):
    for mission_id in ("one", "two"):
        await journal.append(mission_id, [DRAFT, hold(mission_id)])
    for mission_id in ("one", "two"):
        read = await journal.read(mission_id)
        assert [(r.seq, r.mission_id) for r in read] == [(1, mission_id), (2, mission_id)]
        assert read[1].event.reason == mission_id


async def test_sequence_counts_from_one_without_gaps(journal: Journal):
    first = await journal.append("m", [DRAFT, hold()])
    second = await journal.append("m", [hold("rain")])
    assert [record.seq for record in first + second] == [1, 2, 3]
    assert await journal.read("m") == first + second
    assert await journal.read("m", after=2) == second


async def test_concurrent_appends_get_distinct_numbers(journal: Journal):
    await journal.append("m", [DRAFT])
    await asyncio.gather(*(journal.append("m", [hold(str(n))]) for n in range(30)))
    read = await journal.read("m")
    assert [record.seq for record in read] == list(range(1, 32))
    assert {record.event.reason for record in read[1:]} == {str(n) for n in range(30)}


async def test_a_cancelled_caller_leaves_no_gap_and_no_double(journal: Journal):
    await journal.append("m", [DRAFT])
    for n in range(10):
        task = asyncio.create_task(journal.append("m", [hold(str(n))]))
        await asyncio.sleep(0)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
    await journal.append("m", [hold("end")])
    read = await journal.read("m")
    assert [record.seq for record in read] == list(range(1, len(read) + 1))
    assert [record.event.reason for record in read[1:]] == [*map(str, range(10)), "end"]


async def test_unfinished_are_those_started_and_not_ended(journal: Journal):
    await journal.append("draft", [DRAFT])
    await journal.append("flying", [DRAFT, STARTED])
    await journal.append("over", [DRAFT, STARTED, ENDED])
    assert await journal.unfinished() == ["flying"]


async def test_a_mission_begins_with_its_draft(journal: Journal):
    with pytest.raises(ValueError, match="no draft"):
        await journal.append("m", [hold()])
    assert await journal.read("m") == []
