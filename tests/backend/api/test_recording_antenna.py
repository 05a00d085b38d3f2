"""A turn that another antenna took is heard through that antenna, wherever it is heard again."""

from __future__ import annotations

import httpx
import pytest
from recorded_turn import BESIDE, SQUINT_DEG, turn_csv

from hardware.direction_finding.pattern_file import pattern_json

AREA = {"type": "Polygon", "coordinates": [[[7.2, 50.6], [7.204, 50.6], [7.204, 50.602], [7.2, 50.602], [7.2, 50.6]]]}
HERE = {"lat": "50.6", "lon": "7.2"}
BEARING_DEG = 60.0
PATTERN = ("antenna", ("whip.json", pattern_json(BESIDE).encode()))


@pytest.fixture
async def mission_id(client: httpx.AsyncClient) -> str:
    spec = {"name": "m", "area": AREA, "emitters": [{"frequency_hz": BESIDE.frequency_hz}]}
    return (await client.post("/api/missions", json=spec)).json()["mission_id"]


async def bring(client: httpx.AsyncClient, mission_id: str, *more: tuple[str, tuple[str, bytes]]) -> httpx.Response:
    turn = ("files", ("turn.csv", turn_csv(BESIDE, BEARING_DEG).encode()))
    return await client.post(f"/api/missions/{mission_id}/recordings", files=[turn, *more], data=HERE)


async def events(client: httpx.AsyncClient, mission_id: str, kind: str) -> list[dict]:
    told = (await client.get(f"/api/missions/{mission_id}/events")).json()["events"]
    return [record["event"] for record in told if record["event"]["kind"] == kind]


async def test_a_turn_is_heard_through_the_pattern_that_came_with_it(client, mission_id):
    ours = (await bring(client, mission_id)).json()
    (wrong,) = ours["sweeps"]
    assert abs(wrong["bearing_deg"] - BEARING_DEG) > 0.8 * SQUINT_DEG
    reply = await bring(client, mission_id, PATTERN)
    assert reply.status_code == 201, reply.text
    theirs = reply.json()
    (right,) = theirs["sweeps"]
    assert right["bearing_deg"] == pytest.approx(BEARING_DEG, abs=2.0)
    assert ours["recording_id"] != theirs["recording_id"], "the same turn through another antenna is another import"
    assert (await bring(client, mission_id, PATTERN)).json()["already"] is True
    _, imported = await events(client, mission_id, "recording_imported")
    assert imported["antenna"]["name"] == BESIDE.name


async def test_it_is_heard_through_it_again_in_a_what_if(client, mission_id):
    await bring(client, mission_id, PATTERN)
    asked = {"bearings": 1, "offset_to_nose_deg": 10.0}
    told = (await client.post(f"/api/missions/{mission_id}/what-if", json=asked)).json()
    (again,) = told["sweeps"]
    assert again["bearing_deg"] == pytest.approx(BEARING_DEG + 10.0, abs=2.0)
    assert told["antenna"]["name"] == BESIDE.name


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"{}", "not_a_pattern"),
        (b"\xff\xfe", "not_a_pattern"),
        (pattern_json(BESIDE).replace("868300000.0", "150000000.0").encode(), "pattern_of_other_frequency"),
    ],
)
async def test_a_pattern_that_cannot_be_used_is_refused_and_nothing_is_imported(client, mission_id, content, code):
    reply = await bring(client, mission_id, ("antenna", ("whip.json", content)))
    assert reply.status_code == 422
    assert (reply.json()["reason"]["code"], [one["field"] for one in reply.json()["errors"]]) == (code, ["antenna"])
    assert await events(client, mission_id, "recording_imported") == []
