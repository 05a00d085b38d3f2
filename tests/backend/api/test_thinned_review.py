"""A mission whose raw sweeps were taken and whose facts and path are packed is reviewed as before."""

from __future__ import annotations

import gzip
import json
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import numpy as np
from sqlalchemy import func, select

from backend.api.services import Services
from backend.events import BearingMeasured, TruthNoted
from backend.ports import TrackPoint
from backend.settings import REPOSITORY
from backend.store.engine import engine_for_once
from backend.store.entries import EventRow, to_records
from backend.store.retention import pack_paths, thin
from backend.store.tables import sweeps, tracks
from backend.store.upgrade import FIRST_FORM
from hardware.readings import Sweep

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
ID = STORED["mission_id"]
FLOWN = [
    record.event
    for record in to_records(ID, [EventRow(s, at_us, k, FIRST_FORM, body) for s, at_us, k, body in STORED["rows"]])
]
BEARINGS = [fact for fact in FLOWN if isinstance(fact, BearingMeasured)]
PATH = [
    TrackPoint(1_700_000_000.25 + n / 2, round(50.62 + n * 1e-6, 7), 7.2, 160.011, 40.011, 2.66, 94.0, "HOLD")
    for n in range(300)
]
LONG_AFTER = datetime.fromtimestamp(1_700_000_000.0, UTC) + timedelta(days=1000)


async def fly(services: Services) -> None:
    journal = services.journal
    await journal.append(ID, FLOWN)
    for fact in BEARINGS:
        turn = np.arange(0.0, 360.0, 1.0)
        sweep = Sweep(1.7e9 + turn / 30.0, turn, -60.0 - turn / 10.0, 868.3e6, fact.place, 140.0)
        await journal.save_sweep(ID, str(fact.sweep_id), "craft-1", fact.emitter_id, fact.place_number, 1, sweep)
    await journal.save_track(ID, "craft-1", PATH)
    told = {"emitter_id": BEARINGS[0].emitter_id, "place": BEARINGS[0].place, "accuracy_m": 3.0}
    await journal.append(ID, [TruthNoted(**told, how="phone", by="Ada")])


async def reviewed(client: httpx.AsyncClient) -> dict[str, Any]:
    """What the review shows of statistics, belief and path."""
    base = f"/api/missions/{ID}"
    found: dict[str, Any] = {}
    for asked in (
        "",
        "/events?limit=5000",
        "/track",
        "/antenna",
        "/courses",
        "/export/geojson",
        "/export/csv",
        "/export/kml",
    ):
        answer = await client.get(base + asked)
        assert answer.status_code == 200, f"{asked}: {answer.text}"
        found[asked] = answer.content
    for seq in (1, len(FLOWN) // 2, len(FLOWN)):
        found[f"belief {seq}"] = (await client.get(f"{base}/beliefs", params={"seq": seq})).content
    found["calibration"] = (await client.get("/api/calibration")).json()
    supposed = {"bearings": len(BEARINGS), "sigma_deg": 12.0, "method": "base_policy", "base_policy": "ellipse"}
    found["what if"] = (await client.post(f"{base}/what-if", json=supposed)).json()
    found["what if"]["plan"].pop("plan_ms")  # how long it took this time
    return found


async def test_a_thinned_mission_is_reviewed_as_before(client, services, settings):
    await fly(services)
    before = await reviewed(client)
    assert before["calibration"]["missions"]
    assert len(json.loads(before["/track"])["points"]) == len(PATH)
    engine = engine_for_once(settings.async_database_url, 5.0)
    assert (await thin(engine, 365.0, LONG_AFTER)).sweeps == len(BEARINGS)
    assert await pack_paths(engine, LONG_AFTER) == 1
    async with engine.connect() as connection:
        for table in (sweeps, tracks):
            assert (await connection.execute(select(func.count()).select_from(table))).scalar_one() == 0
    await engine.dispose()
    assert await reviewed(client) == before
