from __future__ import annotations

import asyncio
import json
import logging
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from backend import wiring
from backend.search.reported import ReportedBearing
from backend.settings import Settings
from backend.wiring import open_simulation
from hardware.clock import ScaledClock
from hardware.direction_finding.pattern_file import PatternError
from hardware.ports import ReceiverError
from hardware.reasons.payload import PayloadTokensMissing
from hardware.reasons.receiver import ReceiverMisnamed
from hardware.reasons.table import FileUnreadable
from planner.reason import Reason, ReasonedError


@pytest.mark.parametrize(
    ("given_settings", "error", "reason"),
    [
        ({"receiver": "nonsense", "vehicle_url": "udpin://127.0.0.1:1"}, ReceiverError, ReceiverMisnamed),
        ({"receiver": "payload", "vehicle_url": "udpin://127.0.0.1:1"}, ReceiverError, PayloadTokensMissing),
        ({"antenna_pattern": "/nowhere/pattern.json"}, PatternError, FileUnreadable),
    ],
)
async def test_settings_that_name_nothing_are_refused_with_a_reason(
    tmp_path: Path, given_settings: dict[str, str], error: type[ReasonedError], reason: type[Reason]
) -> None:
    with pytest.raises(error) as refused:
        async with open_simulation(Settings(data_dir=tmp_path, **given_settings)):  # type: ignore[arg-type]
            pass
    assert isinstance(refused.value.reason, reason)


async def test_an_address_of_no_vehicle_is_refused_with_the_forms_there_are(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="udpin://"):
        async with open_simulation(Settings(data_dir=tmp_path, vehicle_url="nonsense")):
            pass


@pytest.mark.parametrize("ahead_s", [-7200.0, 7200.0])
async def test_a_bearing_by_udp_is_as_old_on_the_missions_clock_as_in_the_world(
    caplog: pytest.LogCaptureFixture, ahead_s: float
) -> None:
    """The two part where the machine was suspended, its clock was set, or a simulated mission runs faster."""
    taken: asyncio.Future[tuple[str, ReportedBearing]] = asyncio.get_running_loop().create_future()

    async def add(mission_id: str, report: ReportedBearing) -> None:
        taken.set_result((mission_id, report))

    flights = SimpleNamespace(active=SimpleNamespace(mission_id="flying"))
    missions: Any = SimpleNamespace(flights=flights, reports=SimpleNamespace(add=add))
    clock = ScaledClock(start_utc=time.time() + ahead_s)
    said = {"latitude": 50.6, "longitude": 7.2, "bearing": 90, "timestamp": time.time() - 60.0}
    with caplog.at_level(logging.WARNING):
        async with wiring._bearings_by_udp(Settings(bearings_udp_port=0), missions, clock):
            port = caplog.records[-1].args[1]  # type: ignore[index]
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                data = json.dumps({"type": "BEARING", "bearing_type": "absolute", **said})
                sender.sendto(data.encode(), ("127.0.0.1", port))  # type: ignore[arg-type]
            mission_id, report = await asyncio.wait_for(taken, 30.0)
    assert mission_id == "flying"
    assert clock.now() - report.taken_at_s == pytest.approx(60.0, abs=20.0)


def test_a_server_that_ends_compiles_no_further_belief(monkeypatch: pytest.MonkeyPatch) -> None:
    folded, ended = list[int](), threading.Event()

    def fold(*_: object) -> Iterator[None]:
        for number in range(4):
            folded.append(number)
            if number == 1:
                ended.set()
            yield

    monkeypatch.setattr(wiring, "fold_first_beliefs", fold)
    wiring.compile_beliefs(ended)
    assert folded == [0, 1]
