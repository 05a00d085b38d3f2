"""A backup made in flight by the command line, restored, and folded again: the same belief, to the byte."""

from __future__ import annotations

import asyncio
import json
import sys
from pathlib import Path

import pytest
from console import Console

from backend.api.beliefs import belief_frame
from backend.cli.running import RunningServer
from backend.settings import Settings
from backend.store.opening import open_journal

pytestmark = pytest.mark.system


async def crossfix(*arguments: str | Path) -> dict[str, object]:
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        "backend.cli.main",
        *map(str, arguments),
        "--json",
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
    )
    out, said = await process.communicate()
    assert process.returncode == 0, said.decode()
    return json.loads(out)


async def test_a_mission_saved_in_flight_is_believed_alike_after_the_restore(
    server: RunningServer, operator: Console, tmp_path: Path
) -> None:
    archive, restored = tmp_path / "flight.zip", tmp_path / "restored"
    assert (await operator.order("start"))["accepted"]
    await operator.until_event("belief_updated", count=2)
    known = operator.events[-1]["seq"]
    made = await crossfix("backup", archive, "--data-dir", server.services.settings.data_dir)
    assert isinstance(made["rows"], int)
    assert made["rows"] > known
    assert (await operator.order("hold"))["accepted"], "the flight did not go on"
    put_back = await crossfix("restore", archive, "--data-dir", restored)
    assert put_back["missions"] == 1

    async with open_journal(Settings(data_dir=restored), lambda: 0.0) as journal:
        recorded = await journal.read(operator.mission_id)
    assert recorded[-1].seq >= known
    told = {event["seq"]: event["event"] for event in operator.events}
    for record in recorded:
        if record.seq in told:
            assert record.event.model_dump(mode="json") == told[record.seq]
    reply = await operator.client.get(f"/api/missions/{operator.mission_id}/beliefs", params={"seq": recorded[-1].seq})
    assert belief_frame(operator.mission_id, recorded, lite=False) == reply.content
