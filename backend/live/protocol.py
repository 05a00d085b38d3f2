"""uvicorn's websocket, except for three kinds of peers that have left.

One that answers no ping is cut off at once: uvicorn closes such a connection politely, which waits for its write buffer
to drain: with a peer that does not read, for ever, and the sender waits with it. One that left before the handshake was
answered is no error: uvicorn drops the answer, and then misses it. Nor is it one to say something to a peer that was
cut off for what it sent (too long, no UTF-8), which uvicorn takes for words after the application's own goodbye until
the loop has told the end of the connection; nor that somebody sends what is no UTF-8, which it logs with a traceback.
"""

from __future__ import annotations

from starlette.types import Receive, Scope, Send
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import CloseCode
from websockets.protocol import State


class LiveProtocol(WebSocketsSansIOProtocol):
    """For uvicorn's option `ws`."""

    def keepalive_timeout(self) -> None:
        """Called by websockets when a pong is overdue."""
        super().keepalive_timeout()
        self.disconnected = True
        self.transport.abort()

    def send_receive_event_to_app(self) -> None:
        """Called with the last part of a message. What a goodbye in the same piece of data has overtaken is dropped."""
        if self.conn.state is not State.OPEN:
            self.frames = []
            return
        if self.curr_msg_data_type == "text":
            try:
                b"".join(self.frames).decode()
            except UnicodeDecodeError:
                self.conn.send_close(CloseCode.INVALID_DATA)
                self.handle_parser_exception()
                return
        super().send_receive_event_to_app()

    def handle_parser_exception(self) -> None:
        """Called when the peer sent what ends a connection."""
        super().handle_parser_exception()
        self.disconnected = True

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
