"""What checked missions told is reckoned once, and never counts for a mission of which more is known since."""

from __future__ import annotations

import gzip
import json
from collections.abc import Collection

import httpx
import pytest

from backend.api.services import Services
from backend.events import (
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BeliefUpdated,
    Event,
    Recorded,
    SourceMuteChanged,
    TruthNoted,
)
from backend.settings import REPOSITORY
from backend.spec import Place
from backend.store import told_folder
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM
from backend.wire.library import Calibration

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
FLOWN = [
    record.event
    for record in to_records(
        STORED["mission_id"], [EventRow(s, at_us, k, FIRST_FORM, body) for s, at_us, k, body in STORED["rows"]]
    )
]
BEARINGS = [fact for fact in FLOWN if isinstance(fact, BearingMeasured)]
ESTIMATE = next(e.estimate for e in reversed(FLOWN) if isinstance(e, BeliefUpdated) and e.estimate is not None)
MISSIONS = ("m1", "m2")


def truth(north_deg: float = 0.0) -> TruthNoted:
    place = Place(lat=ESTIMATE.lat + north_deg, lon=ESTIMATE.lon)
    return TruthNoted(emitter_id="emitter-1", place=place, accuracy_m=3.0, how="map", by="anna")


@pytest.fixture
async def reckoned(services: Services, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Two checked missions lie in the journal; which of them were reckoned out of their facts."""
    for mission_id in MISSIONS:
        await services.journal.append(mission_id, [*FLOWN, truth()])
    asked: list[str] = []
    read_kinds = services.journal.read_kinds

    async def read(mission_id: str, kinds: Collection[str]) -> list[Recorded]:
        asked.append(mission_id)
        return await read_kinds(mission_id, kinds)

    monkeypatch.setattr(services.journal, "read_kinds", read)
    return asked


async def calibration(client: httpx.AsyncClient, **asked: str) -> Calibration:
    answer = await client.get("/api/calibration", params=asked)
    assert answer.status_code == 200, answer.text
    return Calibration.model_validate_json(answer.content)


async def test_a_mission_is_reckoned_once(client: httpx.AsyncClient, reckoned: list[str]) -> None:
    first = await calibration(client)
    assert sorted(reckoned) == list(MISSIONS)
    assert (first.missions, len(first.fixes), len(first.bearings)) == (2, 2, 2 * len(BEARINGS))
    assert await calibration(client) == first
    assert (await calibration(client, craft="craft-1")).missions == 2
    assert (await calibration(client, craft="another")).missions == 0
    assert sorted(reckoned) == list(MISSIONS)


@pytest.mark.parametrize(
    ("since", "errors"),
    [
        ([truth(0.01)], len(BEARINGS)),
        ([truth().model_copy(update={"place": None})], 0),
        (
            [BearingExcluded(emitter_id="emitter-1", bearing_id=BEARINGS[0].bearing_id, by="a", reason="")],
            len(BEARINGS) - 1,
        ),
        (
            [
                BearingExcluded(emitter_id="emitter-1", bearing_id=BEARINGS[0].bearing_id, by="a", reason=""),
                BearingIncluded(emitter_id="emitter-1", bearing_id=BEARINGS[0].bearing_id, by="a"),
            ],
            len(BEARINGS),
        ),
        ([SourceMuteChanged(source=BEARINGS[0].source, muted=True, by="a")], 0),
    ],
)
async def test_what_is_known_since_counts_at_once(
    client: httpx.AsyncClient, services: Services, reckoned: list[str], since: list[Event], errors: int
) -> None:
    first = await calibration(client)
    reckoned.clear()
    after = first
    for fact in since:
        await services.journal.append("m1", [fact])
        after = await calibration(client)
    assert reckoned == ["m1"] * len(since), "and nothing of the other mission is reckoned again"
    of = {mission_id: [one for one in after.bearings if one.mission_id == mission_id] for mission_id in MISSIONS}
    assert (len(of["m1"]), len(of["m2"])) == (errors, len(BEARINGS))
    fix, before = ([one for one in found.fixes if one.mission_id == "m1"] for found in (after, first))
    assert (fix == before) == (not isinstance(since[0], TruthNoted))


async def test_another_way_to_reckon_reckons_again(
    client: httpx.AsyncClient, reckoned: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    await calibration(client)
    monkeypatch.setattr(told_folder, "RECKONING", told_folder.RECKONING + 1)
    reckoned.clear()
    await calibration(client)
    assert sorted(reckoned) == list(MISSIONS)


async def test_what_cannot_be_read_or_written_is_reckoned_again(
    client: httpx.AsyncClient, services: Services, reckoned: list[str]
) -> None:
    first = await calibration(client)
    (services.told.directory / "m1.json").write_text('{"state": "')
    reckoned.clear()
    assert await calibration(client) == first
    assert reckoned == ["m1"]
    services.told.forget(MISSIONS)
    services.told.directory.rmdir()
    services.told.directory.write_text("in the way")
    for _ in range(2):
        assert await calibration(client) == first
    assert sorted(reckoned) == ["m1", "m1", "m1", "m2", "m2"]


async def test_of_a_deleted_mission_nothing_is_kept(
    client: httpx.AsyncClient, services: Services, reckoned: list[str]
) -> None:
    first = await calibration(client)
    assert (await client.delete("/api/missions/m1")).status_code == 204
    assert (await calibration(client)).missions == 1
    assert services.told.missions() == ["m2"]
    assert (await client.post("/api/missions/m1/restore")).status_code == 200
    assert await calibration(client) == first
