"""uvicorn's websocket, except that a peer which answers no ping is cut off at once.

uvicorn closes such a connection politely, which waits for its write buffer to drain: with a peer that does not read,
for ever, and the sender waits with it.
"""

from __future__ import annotations

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol


class LiveProtocol(WebSocketsSansIOProtocol):
    """For uvicorn's option `ws`."""

    def keepalive_timeout(self) -> None:
        """Called by websockets when a pong is overdue."""
        super().keepalive_timeout()
        self.transport.abort()
