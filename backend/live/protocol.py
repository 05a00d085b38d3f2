"""uvicorn's websocket, except for two kinds of peers that have left.

One that answers no ping is cut off at once: uvicorn closes such a connection politely, which waits for its write buffer
to drain: with a peer that does not read, for ever, and the sender waits with it. One that left before the handshake was
answered is no error: uvicorn drops the answer, and then misses it.
"""

from __future__ import annotations

from starlette.types import Receive, Scope, Send
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol


class LiveProtocol(WebSocketsSansIOProtocol):
    """For uvicorn's option `ws`."""

    def keepalive_timeout(self) -> None:
        """Called by websockets when a pong is overdue."""
        super().keepalive_timeout()
        self.transport.abort()

    async def run_asgi(self) -> None:
        """One connection, from the handshake to its end."""
        app = self.app

        async def whoever_stays(scope: Scope, receive: Receive, send: Send) -> None:
            try:
                await app(scope, receive, send)
            except RuntimeError:
                if not self._left_early():
                    raise
            if self._left_early():
                raise ClientDisconnected

        self.app = whoever_stays
        await super().run_asgi()

    def _left_early(self) -> bool:
        return not self.handshake_complete and self.transport.is_closing()
