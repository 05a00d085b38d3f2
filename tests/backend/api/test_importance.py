"""The order of importance by REST: in a specification, and by a command, hostile values too."""

from __future__ import annotations

from typing import Any
from uuid import uuid4

import httpx
import pytest

AREA = {
    "type": "Polygon",
    "coordinates": [[[7.2, 50.62], [7.21, 50.62], [7.21, 50.63], [7.2, 50.63], [7.2, 50.62]]],
}


def spec(*priorities: Any) -> dict[str, Any]:
    emitters = [
        {"emitter_id": f"tag-{number}", "frequency_hz": 150e6 + number * 1e5, "priority": priority}
        for number, priority in enumerate(priorities, 1)
    ]
    return {"name": "m", "area": AREA, "emitters": emitters}


async def drafted(client: httpx.AsyncClient, *priorities: Any) -> str:
    reply = await client.post("/api/missions", json=spec(*priorities))
    assert reply.status_code == 201, reply.text
    return reply.json()["mission_id"]


async def ordered(client: httpx.AsyncClient, mission: str, priorities: Any) -> httpx.Response:
    command = {"kind": "set_priorities", "priorities": priorities}
    request = {"command_id": str(uuid4()), "command": command}
    return await client.post(f"/api/missions/{mission}/commands", json=request)


async def test_a_drafted_order_is_kept_and_edited_with_the_rest(client: httpx.AsyncClient) -> None:
    mission = await drafted(client, 2, None, 1)
    kept = (await client.get(f"/api/missions/{mission}")).json()["spec"]
    assert [one["priority"] for one in kept["emitters"]] == [2, None, 1]
    edited = await client.put(f"/api/missions/{mission}/spec", json=spec(1, 1))
    assert [one["priority"] for one in edited.json()["spec"]["emitters"]] == [1, 1]


@pytest.mark.parametrize("wrong", [0, -1, 33, 1.5, "first", 1e300, [1], {"a": 1}])
async def test_what_is_no_priority_is_refused_and_named(client: httpx.AsyncClient, wrong: Any) -> None:
    reply = await client.post("/api/missions", json=spec(wrong))
    assert reply.status_code == 422
    assert "priority" in reply.text
    mission = await drafted(client, None)
    reply = await ordered(client, mission, {"tag-1": wrong})
    assert reply.status_code == 422
    assert "tag-1" in reply.text


@pytest.mark.parametrize(
    "wrong", [None, 1, [], "tag-1", {"../../etc": 1}, {"": 1}, {"x" * 41: 1}, {f"tag-{n}": 1 for n in range(33)}]
)
async def test_what_is_no_order_is_refused(client: httpx.AsyncClient, wrong: Any) -> None:
    assert (await ordered(client, await drafted(client, None), wrong)).status_code == 422


async def test_before_the_start_the_order_is_edited_not_commanded(client: httpx.AsyncClient) -> None:
    mission = await drafted(client, None, None)
    reply = (await ordered(client, mission, {"tag-1": 1})).json()
    assert (reply["accepted"], reply["reason"]["code"]) == (False, "not_started")
    assert (await client.get(f"/api/missions/{mission}")).json()["spec"]["emitters"][0]["priority"] is None
