"""One viser server for all 3D viewers, on a private loopback port; what each of its windows shows is said per window.

viser runs an event loop in a thread of its own. A window is let in only when the proxy has announced the local port it
comes from: whoever finds the private port by himself, a page of another site for example, is turned away.
"""

# pyright: reportPrivateUsage=false, reportUnknownMemberType=false
# (viser names no public way to see who connects, nor the types of these parts)

from __future__ import annotations

import contextlib
import io
import logging
import threading
from collections.abc import Callable
from typing import Any

import httpx
import viser
from viser import _messages

log = logging.getLogger("crossfix.scene")

SUBPROTOCOL = f"viser-v{viser.__version__}"

Opened = Callable[[str, viser.ClientHandle], None]
Closed = Callable[[str, int], None]


class SceneServer:
    """`opened` and `closed` are called in viser's threads: (view id, window) and (view id, window's number)."""

    def __init__(self, opened: Opened, closed: Closed) -> None:
        self._opened, self._closed = opened, closed
        self._announced: dict[int, str] = {}
        self._views: dict[int, str] = {}
        self._lock = threading.Lock()
        with _quiet():
            self._server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        self.port = self._server.get_port()
        self.subprotocol = SUBPROTOCOL
        connections = self._server._websock_server
        # a viewer could otherwise ask viser to open a tunnel to a public relay
        connections.unregister_handler(_messages.ShareUrlRequest)
        connections.on_client_connect(self._let_in)
        self._server.on_client_connect(self._on_open)
        connections.on_client_disconnect(self._on_close)

    def page(self) -> bytes:
        """viser's client page, as it serves it. Blocks: call it in a thread."""
        reply = httpx.get(f"http://127.0.0.1:{self.port}/", trust_env=False)
        reply.raise_for_status()
        return reply.content

    def announce(self, local_port: int, view_id: str) -> None:
        """The next connection from this port of 127.0.0.1 is a window of the view."""
        with self._lock:
            self._announced[local_port] = view_id

    def forget(self, local_port: int) -> None:
        """The announced connection did not come, or is over."""
        with self._lock:
            self._announced.pop(local_port, None)

    def stop(self) -> None:
        """Blocks: call it in a thread."""
        with _quiet():
            self._server.stop()

    async def _let_in(self, connection: Any) -> None:
        """Runs before anything is sent to or taken from a new connection."""
        number = connection.client_id
        socket = self._server._websock_server._live_connections[number]
        with self._lock:
            view_id = self._announced.get(socket.remote_address[1])
            if view_id is not None:
                self._views[number] = view_id
        if view_id is None:
            log.warning("a connection from %s that nobody announced was turned away", socket.remote_address)
            await socket.close(1008, "come through the console")

    def _on_open(self, window: viser.ClientHandle) -> None:
        with self._lock:
            view_id = self._views.get(window.client_id)
        if view_id is not None:
            self._opened(view_id, window)

    def _on_close(self, connection: Any) -> None:
        with self._lock:
            view_id = self._views.pop(connection.client_id, None)
        if view_id is not None:
            self._closed(view_id, connection.client_id)


@contextlib.contextmanager
def _quiet():
    """viser prints a banner; standard output belongs to the command line."""
    with contextlib.redirect_stdout(io.StringIO()):
        yield
