"""Files of the built page: hashed assets are kept for ever, everything else is asked for again."""

from __future__ import annotations

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Message, Receive, Scope, Send

INDEX = "index.html"


class PageFiles:
    """What `make build` has made, as far as it is there."""

    def __init__(self, folder: Path) -> None:
        self._index = folder / INDEX
        self._files = StaticFiles(directory=folder, check_dir=False)

    @property
    def built(self) -> bool:
        """Else the page says how to build it."""
        return self._index.is_file()

    async def find(self, scope: Scope, name: str = "") -> Response | None:
        """The file that is asked for, or `name`; None when there is none of that name."""
        try:
            response = await self._files.get_response(name or scope["path"].lstrip("/") or INDEX, scope)
        except HTTPException as error:
            if error.status_code == 404:
                return None
            raise
        kept = "public, max-age=31536000, immutable" if scope["path"].startswith("/assets/") else "no-cache"
        response.headers["cache-control"] = kept
        return response


async def send_file(response: Response, scope: Scope, receive: Receive, send: Send) -> None:
    """Raises FileNotFoundError, with nothing sent, when a build has taken the file away since it was found."""
    start: list[Message] = []

    async def send_begun(message: Message) -> None:
        if message["type"] == "http.response.start":
            start.append(message)
            return
        while start:
            await send(start.pop())
        await send(message)

    await response(scope, receive, send_begun)
