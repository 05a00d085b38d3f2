"""The built page: hashed assets are kept for ever, everything else is asked for again; unknown paths are the page."""

from __future__ import annotations

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Message, Receive, Scope, Send

from backend.api.problems import not_found

NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Crossfix: the page is not built</title>
<style>body{font:1.1rem/1.5 system-ui,sans-serif;max-width:40rem;margin:15vh auto;padding:0 1rem}</style>
<h1>The page is not built yet</h1><p>The server runs. Build its page with <code>make build</code> (or start with
<code>make run</code>), then load this address again.</p></html>"""


class Page:
    """ASGI application for every path that is no API path."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files = StaticFiles(directory=folder, check_dir=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Raises ApiProblem 404 when a build has taken the file away meanwhile."""
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 4404, "reason": "no such websocket"})
            return
        response = await self._respond(scope)
        try:
            await response(scope, receive, _begun_with_its_body(send))
        except FileNotFoundError as error:
            raise not_found("file", scope["path"]) from error

    async def _respond(self, scope: Scope) -> Response:
        path = scope["path"]
        if path == "/api" or path.startswith("/api/"):
            raise not_found("page", path)
        if scope["method"] not in {"GET", "HEAD"}:
            raise HTTPException(405, headers={"allow": "GET, HEAD"})
        if not (self._folder / "index.html").is_file():
            return HTMLResponse(NOT_BUILT, status_code=503, headers={"cache-control": "no-store"})
        response = await self._file(path.lstrip("/") or "index.html", scope)
        if response is None:
            if Path(path).suffix:
                raise not_found("file", path)
            response = await self._files.get_response("index.html", scope)
        kept = "public, max-age=31536000, immutable" if path.startswith("/assets/") else "no-cache"
        response.headers["cache-control"] = kept
        return response

    async def _file(self, path: str, scope: Scope) -> Response | None:
        try:
            return await self._files.get_response(path, scope)
        except HTTPException as error:
            if error.status_code == 404:
                return None
            raise


def _begun_with_its_body(send: Send) -> Send:
    """Holds the start of an answer back until its file has been opened: a page that is being rebuilt loses files
    between the look at one and its opening."""
    start: list[Message] = []

    async def send_begun(message: Message) -> None:
        if message["type"] == "http.response.start":
            start.append(message)
            return
        while start:
            await send(start.pop())
        await send(message)

    return send_begun
