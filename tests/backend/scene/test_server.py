"""The private viser server lets in only whom the proxy announced."""

from __future__ import annotations

import asyncio
import queue
import socket
from collections.abc import Iterator
from contextlib import suppress

import pytest
import websockets
from narrowing import a
from viser import ClientHandle, _messages
from viser_page import camera_message, unpacked
from websockets.typing import Subprotocol

from backend.scene.server import SUBPROTOCOL, SceneServer


class Heard:
    def __init__(self) -> None:
        self.opened: queue.Queue[tuple[str, object]] = queue.Queue()
        self.closed: queue.Queue[tuple[str, int]] = queue.Queue()


@pytest.fixture
def heard() -> Heard:
    return Heard()


@pytest.fixture
def server(heard: Heard, capfd: pytest.CaptureFixture[str]) -> Iterator[SceneServer]:
    server = SceneServer(
        lambda view_id, window: heard.opened.put((view_id, window)),
        lambda view_id, number: heard.closed.put((view_id, number)),
    )
    yield server
    server.stop()
    assert capfd.readouterr().out == ""


async def connect(server: SceneServer, own: socket.socket) -> websockets.ClientConnection:
    own.setblocking(False)
    await asyncio.get_running_loop().sock_connect(own, ("127.0.0.1", server.port))
    return await websockets.connect(
        f"ws://127.0.0.1:{server.port}/",
        sock=own,
        subprotocols=[Subprotocol(SUBPROTOCOL)],
        compression=None,
        proxy=None,
    )


def bound_socket() -> socket.socket:
    own = socket.socket()
    own.bind(("127.0.0.1", 0))
    return own


async def test_an_announced_connection_becomes_a_window_of_its_view(server: SceneServer, heard: Heard) -> None:
    own = bound_socket()
    server.announce(own.getsockname()[1], "view-one")
    async with await connect(server, own) as connection:
        await connection.send(camera_message())
        view_id, window = await asyncio.to_thread(heard.opened.get, True, 60)
        assert view_id == "view-one"
        a(ClientHandle, window).scene.add_glb("/hello", b"only for this window")
        async with asyncio.timeout(60):
            while b"only for this window" not in unpacked(await connection.recv()):
                pass
    assert (await asyncio.to_thread(heard.closed.get, True, 60))[0] == "view-one"


async def test_whoever_comes_by_himself_is_turned_away(server: SceneServer, heard: Heard) -> None:
    connection = await connect(server, bound_socket())
    with suppress(websockets.ConnectionClosed):
        await connection.send(camera_message())
    async with asyncio.timeout(60):
        await connection.wait_closed()
    assert connection.close_code == 1008
    assert heard.opened.empty()


async def test_a_port_that_was_forgotten_is_no_announcement(server: SceneServer) -> None:
    own = bound_socket()
    server.announce(own.getsockname()[1], "view-one")
    server.forget(own.getsockname()[1])
    connection = await connect(server, own)
    async with asyncio.timeout(60):
        await connection.wait_closed()
    assert connection.close_code == 1008


def test_no_viewer_can_open_a_tunnel_to_the_outside(server: SceneServer) -> None:
    handlers = server._server._websock_server._incoming_handlers
    assert _messages.ShareUrlRequest not in handlers


def test_it_listens_on_loopback_only(server: SceneServer) -> None:
    assert server._server.get_host() == "127.0.0.1"
