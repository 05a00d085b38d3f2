"""The 3D scene on our own port: the page, its websocket, and what a view shows."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import httpx
import pytest
import websockets
from fastapi import FastAPI
from viser_page import camera_message, unpacked
from websockets.typing import Origin, Subprotocol

from backend.api.scene import close_scene_views
from backend.events import MissionDrafted
from backend.scene.server import SUBPROTOCOL
from backend.spec import MissionSpec, Polygon

AREA = Polygon(coordinates=[[(7.20, 50.62), (7.21, 50.62), (7.21, 50.63), (7.20, 50.63), (7.20, 50.62)]])
VIEW = "view-0001"


@pytest.fixture
async def scenes(app: FastAPI, services) -> AsyncIterator[FastAPI]:
    await services.journal.append("m1", [MissionDrafted(spec=MissionSpec(name="draft", area=AREA))])
    yield app
    await close_scene_views(app)


async def test_a_view_is_made_and_changed(scenes: FastAPI, client: httpx.AsyncClient) -> None:
    reply = await client.put(f"/api/scene/views/{VIEW}", json={"mission_id": "m1"})
    assert reply.status_code == 200, reply.text
    assert reply.json()["url"] == f"/scene/{VIEW}/"
    changed = await client.put(f"/api/scene/views/{VIEW}", json={"mission_id": "m1", "seq": 1, "theme": "light"})
    assert changed.json()["seq"] == 1
    assert (await client.get(f"/api/scene/views/{VIEW}")).json() == changed.json()


async def test_unknown_missions_and_views_are_said_to_be_unknown(scenes: FastAPI, client: httpx.AsyncClient) -> None:
    for reply in (
        await client.put(f"/api/scene/views/{VIEW}", json={"mission_id": "nope"}),
        await client.get("/api/scene/views/never-made"),
        await client.get("/scene/", params={"mission": "nope"}),
    ):
        assert reply.status_code == 404
        assert reply.json()["remedy"]


@pytest.mark.parametrize(
    "body", [{"seq": 0}, {"mission_id": "a b"}, {"hidden": ["everything"]}, {"belief_height_m": -1}]
)
async def test_wishes_that_make_no_sense_are_refused(scenes: FastAPI, client: httpx.AsyncClient, body: dict) -> None:
    assert (await client.put(f"/api/scene/views/{VIEW}", json=body)).status_code == 422


async def test_the_address_alone_leads_to_a_view_of_its_own(scenes: FastAPI, client: httpx.AsyncClient) -> None:
    first, second = [await client.get("/scene/", params={"mission": "m1", "seq": "1"}) for _ in range(2)]
    assert first.status_code == second.status_code == 303
    assert first.headers["location"] != second.headers["location"]
    view_id = first.headers["location"].split("/")[2]
    assert (await client.get(f"/api/scene/views/{view_id}")).json()["mission_id"] == "m1"


async def test_the_page_is_visers_under_our_rules(scenes: FastAPI, client: httpx.AsyncClient) -> None:
    reply = await client.get(f"/scene/{VIEW}/")
    assert reply.status_code == 200
    assert "<title>Viser</title>" in reply.text
    policy = reply.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "http" not in policy.replace("ws://127.0.0.1", "").replace("wss://127.0.0.1", "")
    again = await client.get(f"/scene/{VIEW}/", headers={"if-none-match": reply.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


async def test_a_browser_gets_the_scene_over_the_websocket(scenes: FastAPI, served: str) -> None:
    async with httpx.AsyncClient(base_url=f"http://{served}") as client:
        await client.put(f"/api/scene/views/{VIEW}", json={"mission_id": "m1"})
        async with (
            asyncio.timeout(30),
            websockets.connect(
                f"ws://{served}/scene/{VIEW}", subprotocols=[Subprotocol(SUBPROTOCOL)], max_size=None, proxy=None
            ) as socket,
        ):
            assert socket.subprotocol == SUBPROTOCOL
            await socket.send(camera_message())
            heard = b""
            while b"glTF" not in heard:
                heard = unpacked(await socket.recv())
            view = (await client.get(f"/api/scene/views/{VIEW}")).json()
            assert (view["watchers"], view["shown_seq"]) == (1, 1)
        async with asyncio.timeout(30):
            while (await client.get(f"/api/scene/views/{VIEW}")).json()["watchers"]:
                pass


async def test_a_page_of_another_version_is_told_to_load_again(scenes: FastAPI, served: str) -> None:
    with pytest.raises(websockets.InvalidStatus) as refused:
        await websockets.connect(f"ws://{served}/scene/{VIEW}", subprotocols=[Subprotocol("viser-v0.0.1")], proxy=None)
    assert refused.value.response.status_code == 403


async def test_a_page_of_another_site_gets_nothing(scenes: FastAPI, served: str) -> None:
    with pytest.raises(websockets.InvalidStatus):
        await websockets.connect(
            f"ws://{served}/scene/{VIEW}",
            subprotocols=[Subprotocol(SUBPROTOCOL)],
            origin=Origin("http://evil.example"),
            proxy=None,
        )
