"""Answers about a large mission are put together beside the event loop."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from backend.api import review, summary
from backend.events import HoldOrdered, MissionDrafted
from backend.ports import TrackPoint
from backend.spec import MissionSpec, Polygon
from backend.store import entries
from hardware.readings import Place, Sweep

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
POINTS = 1_000
PATH = [TrackPoint(1.7e9 + n, 50.6, 7.2, 140.0, 40.0, 90.0, 80.0, "AUTO") for n in range(POINTS)]
NOSE = np.linspace(0.0, 360.0, POINTS)
SWEEP = Sweep(
    at_s=1.7e9 + NOSE, heading_deg=NOSE, power_db=np.sin(NOSE), frequency_hz=150e6,
    position=Place(50.6, 7.2), altitude_amsl_m=140.0,
)  # fmt: skip


@pytest.fixture
async def large(services) -> str:
    holds = [HoldOrdered(craft_id="craft-1", by=str(n), reason=None) for n in range(200)]
    await services.journal.append("m", [MissionDrafted(spec=SPEC), *holds])
    await services.journal.save_track("m", "craft-1", PATH)
    await services.journal.save_sweep("m", "s1", "craft-1", "emitter-1", 1, 1, SWEEP)
    return "/api/missions/m"


@pytest.mark.parametrize(
    ("place", "name", "asked"),
    [
        (summary, "track_fact", "track"),
        (summary, "sweep_record", "sweeps/s1"),
        (review, "raw_files", "export/bundle"),
    ],
)
async def test_nothing_that_grows_with_a_mission_is_done_on_the_loop(
    client, large, monkeypatch, place: Any, name: str, asked: str
) -> None:
    loop, where = threading.get_ident(), list[bool]()
    work: Callable[..., Any] = getattr(place, name)

    def watched(*args: Any, **named: Any) -> Any:
        where.append(threading.get_ident() == loop)
        return work(*args, **named)

    monkeypatch.setattr(place, name, watched)
    answer = await client.get(f"{large}/{asked}")
    assert answer.status_code == 200, answer.text
    assert where, "it was done"
    assert not any(where)


async def test_a_path_and_a_sweep_are_told_whole(client, large) -> None:
    told = (await client.get(f"{large}/track")).json()
    assert set(told) == {"mission_id", "craft_id", "points"}
    assert len(told["points"]) == POINTS
    sweep = (await client.get(f"{large}/sweeps/s1")).json()
    assert len(sweep["power_db"]) == POINTS


async def test_the_process_that_makes_a_file_reads_the_facts_and_the_server_none(
    client, services, large, monkeypatch
) -> None:
    here = (await client.get(f"{large}/export/json")).content
    services.journal._written.pop("m", None)
    read = list[object]()
    monkeypatch.setattr("backend.api.heavy.LONG_FACTS", 1)
    monkeypatch.setattr(entries, "_record", lambda *asked: read.append(asked))
    assert (await client.get(f"{large}/export/json")).content == here
    assert read == []
    await services.desk.close()
