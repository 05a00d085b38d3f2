"""Under which names a browser may reach the server, and what every answer to it carries."""

from __future__ import annotations

import ipaddress
from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.datastructures import MutableHeaders
from starlette.types import Message, Send


class Hosts:
    """`allowed`: names besides localhost. An IP address cannot be rebound, a name can: only known names pass."""

    def __init__(self, allowed: Iterable[str]) -> None:
        self._allowed = {"localhost", *(host.lower() for host in allowed)}

    def ours(self, host: str) -> bool:
        """host: a Host header."""
        try:
            parts = urlsplit(f"//{host}")
            name, _ = parts.hostname, parts.port
        except ValueError:
            return False
        if not name or parts.netloc != host or "@" in host:
            return False
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return name in self._allowed
        return True


def secured(send: Send, host: str, path: str) -> Send:
    """MapLibre makes its worker from a blob and its icons from data; nothing comes from another machine."""
    policy = (
        "default-src 'self'; script-src 'self'; worker-src 'self' blob:; style-src 'self' 'unsafe-inline'; "
        f"img-src 'self' data: blob:; connect-src 'self' ws://{host} wss://{host} blob: data:; frame-src 'self'; "
        "frame-ancestors 'self'; object-src 'none'; base-uri 'none'; form-action 'self'"
    )

    async def send_secured(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers.setdefault("content-security-policy", policy)
            headers["x-content-type-options"] = "nosniff"
            headers["referrer-policy"] = "no-referrer"
            headers["cross-origin-opener-policy"] = "same-origin"
            headers["cross-origin-resource-policy"] = "same-origin"
            if path.startswith("/api/"):
                headers.setdefault("cache-control", "no-store")
        await send(message)

    return send_secured
