"""What every Journal does (backend.ports): facts in order, without gaps, durable before they are sent on."""

from __future__ import annotations

import asyncio

import pytest
from narrowing import a

from backend.events import HoldOrdered, MissionDrafted, MissionEnded, MissionStarted, Phase, PhaseChanged, Recorded
from backend.ports import Journal
from backend.reasons.flight import Ordered
from backend.reasons.search import Localized
from backend.spec import MissionSpec, Place, Polygon

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
DRAFT = MissionDrafted(spec=SPEC)
STARTED = MissionStarted(
    craft_id="craft-1", by="operator", home=Place(lat=50.6, lon=7.2), home_amsl_m=100.0, software="0.1.0"
)
ENDED = MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0)


def hold(by: str = "operator") -> HoldOrdered:
    return HoldOrdered(craft_id="craft-1", by=by, reason=None)


def by(record: Recorded) -> str | None:
    return a(HoldOrdered, record.event).by


def craft_in(before: Phase, after: Phase) -> PhaseChanged:
    return PhaseChanged(craft_id="craft-1", before=before, after=after, reason=Ordered("abort", "operator"))


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
        assert by(read[1]) == mission_id


async def test_sequence_counts_from_one_without_gaps(journal: Journal):
    first = await journal.append("m", [DRAFT, hold()])
    second = await journal.append("m", [hold("another")])
    assert [record.seq for record in first + second] == [1, 2, 3]
    assert await journal.read("m") == first + second
    assert await journal.read("m", after=2) == second


async def test_concurrent_appends_get_distinct_numbers(journal: Journal):
    await journal.append("m", [DRAFT])
    await asyncio.gather(*(journal.append("m", [hold(str(n))]) for n in range(30)))
    read = await journal.read("m")
    assert [record.seq for record in read] == list(range(1, 32))
    assert {by(record) for record in read[1:]} == {str(n) for n in range(30)}


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
    assert [by(record) for record in read[1:]] == [*map(str, range(10)), "end"]


async def test_unfinished_are_those_started_and_not_ended_or_not_down(journal: Journal):
    up, down = craft_in("ground", "returning"), craft_in("returning", "ground")
    await journal.append("draft", [DRAFT])
    await journal.append("flying", [DRAFT, STARTED])
    await journal.append("on its way home", [DRAFT, STARTED, up, ENDED])
    await journal.append("over", [DRAFT, STARTED, up, ENDED, down])
    assert sorted(await journal.unfinished()) == ["flying", "on its way home"]


async def test_a_mission_begins_with_its_draft(journal: Journal):
    with pytest.raises(ValueError, match="no draft"):
        await journal.append("m", [hold()])
    assert await journal.read("m") == []
