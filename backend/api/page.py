"""The built page; unknown paths are the page."""

from __future__ import annotations

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, Response
from starlette.types import Receive, Scope, Send

from backend.api.page_files import INDEX, PageFiles, send_file
from backend.api.problems import not_found

NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Crossfix: the page is not built</title>
<style>body{font:1.1rem/1.5 system-ui,sans-serif;max-width:40rem;margin:15vh auto;padding:0 1rem}</style>
<h1>The page is not built yet</h1><p>The server runs. Build its page with <code>make build</code> (or start with
<code>make run</code>), then load this address again.</p></html>"""


class Page:
    """ASGI application for every path that is no API path."""

    def __init__(self, folder: Path) -> None:
        self._files = PageFiles(folder)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Raises ApiProblem 404 when a build has taken the file away meanwhile."""
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 4404, "reason": "no such websocket"})
            return
        response = await self._respond(scope)
        try:
            await send_file(response, scope, receive, send)
        except FileNotFoundError as error:
            raise not_found("file", scope["path"]) from error

    async def _respond(self, scope: Scope) -> Response:
        path = scope["path"]
        if path == "/api" or path.startswith("/api/"):
            raise not_found("page", path)
        if scope["method"] not in {"GET", "HEAD"}:
            raise HTTPException(405, headers={"allow": "GET, HEAD"})
        if not self._files.built:
            return HTMLResponse(NOT_BUILT, status_code=503, headers={"cache-control": "no-store"})
        response = await self._files.find(scope)
        if response is None and not Path(path).suffix:
            response = await self._files.find(scope, INDEX)
        if response is None:
            raise not_found("file", path)
        return response
