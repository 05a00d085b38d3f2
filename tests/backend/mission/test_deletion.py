"""A mission is deleted on the ground only, and what was deleted does not fly, whoever is quicker."""

from __future__ import annotations

import asyncio

import pytest
from equipment import spec
from flights import order
from refusals import refusing
from stage import Stage

from backend import commands
from backend.ports import JournalDamaged
from backend.reasons import refusals
from backend.reasons.storage import MissionDamaged
from backend.search.errors import MissionConflict


async def test_a_mission_in_flight_stays_in_the_list(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    with refusing(refusals.StillUnderWay(), MissionConflict):
        await stage.room.review.delete(mission_id, "ben")
    assert not stage.journal.state(mission_id).search.deleted


async def test_a_mission_in_flight_stays_though_its_facts_are_damaged_meanwhile(stage: Stage, monkeypatch) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted

    async def damaged(*_: object) -> None:
        raise JournalDamaged(MissionDamaged(mission_id, "event 2"))

    monkeypatch.setattr(stage.journal, "read", damaged)
    with refusing(refusals.StillUnderWay(), MissionConflict):
        await stage.room.review.delete(mission_id, "ben")
    assert not {"mission_ended", "mission_deleted"} & set(stage.journal.kinds(mission_id))


async def test_a_deleted_mission_flies_once_it_is_restored(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    await stage.room.review.delete(mission_id, "ben")
    refused = await order(stage, mission_id, commands.Start())
    assert (refused.accepted, refused.reason) == (False, refusals.WasDeleted())
    assert "nets_noted" not in stage.journal.kinds(mission_id), "its autopilot is left alone"
    await stage.room.review.restore(mission_id, "ben")
    assert (await order(stage, mission_id, commands.Start())).accepted


async def test_a_mission_that_is_in_the_list_is_restored_without_a_fact(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    await stage.room.review.restore(mission_id, "ben")
    assert "mission_restored" not in stage.journal.kinds(mission_id)
    await stage.room.review.delete(mission_id, "ben")
    for _ in range(2):
        await stage.room.review.restore(mission_id, "ben")
    assert stage.journal.kinds(mission_id).count("mission_restored") == 1


@pytest.mark.parametrize("quicker", ["start", "delete"])
async def test_of_a_start_and_a_deletion_at_once_one_is_refused(stage: Stage, quicker: str) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    asked = {
        "start": lambda: asyncio.ensure_future(order(stage, mission_id, commands.Start())),
        "delete": lambda: asyncio.ensure_future(stage.room.review.delete(mission_id, "ben")),
    }
    under_way = {name: asked[name]() for name in sorted(asked, key=lambda name: name != quicker)}
    (deleted,) = await asyncio.gather(under_way["delete"], return_exceptions=True)
    started = (await under_way["start"]).accepted
    assert started == isinstance(deleted, MissionConflict)
    assert started != stage.journal.state(mission_id).search.deleted
