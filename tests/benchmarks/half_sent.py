"""A thousand requests whose end never comes: does whoever flies still get through? Run it by hand, or with make chaos:

    python -m tests.benchmarks.half_sent                                  a server of its own
    python -m tests.benchmarks.half_sent --url https://localhost          one that runs, behind its proxy

Half of the connections send the beginning of a request, half nothing (after the TLS handshake, where there is one). All
of them come back as soon as they are closed. Meanwhile somebody who is connected already and newcomers order, once a
second each: a hold to the craft of a server of its own, where nobody signs in; else the question whether it is well.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import ssl
import sys
import tempfile
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit
from uuid import uuid4

import httpx

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

HALF = b"POST /api/missions HTTP/1.1\r\nHost: localhost\r\nContent-Type: applic"
PATIENCE_S = 20.0
AGAIN_S = 0.5


@dataclass
class Crowd:
    """open: connections that are held now. opened, closed: since the beginning."""

    open: int = 0
    most: int = 0
    opened: int = 0
    closed: int = 0


@dataclass
class Answers:
    """Seconds until each order was answered; unanswered: refused, cut off or not within PATIENCE_S."""

    took_s: list[float] = field(default_factory=list[float])
    unanswered: int = 0


async def half_sent(url: str, silent: bool, crowd: Crowd) -> None:
    """One stranger, again and again."""
    parts = urlsplit(url)
    context = ssl.create_default_context() if parts.scheme == "https" else None
    if context is not None:
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    port = parts.port or (443 if context else 80)
    while True:
        with suppress(OSError):
            reader, writer = await asyncio.open_connection(parts.hostname, port, ssl=context)
            crowd.open, crowd.opened = crowd.open + 1, crowd.opened + 1
            crowd.most = max(crowd.most, crowd.open)
            try:
                if not silent:
                    writer.write(HALF)
                await reader.read()
            finally:
                crowd.open, crowd.closed = crowd.open - 1, crowd.closed + 1
                writer.close()
        await asyncio.sleep(AGAIN_S)


async def asked(client: httpx.AsyncClient, orders: bool, answers: Answers) -> None:
    began = time.monotonic()
    try:
        if orders:
            body = {"command_id": str(uuid4()), "command": {"kind": "hold"}}
            reply = await client.post("/api/crafts/craft-1/commands", json=body)
        else:
            reply = await client.get("/health")
        reply.raise_for_status()
    except httpx.HTTPError:
        answers.unanswered += 1
    else:
        answers.took_s.append(time.monotonic() - began)


def client_of(url: str) -> httpx.AsyncClient:
    return httpx.AsyncClient(base_url=url, verify=False, timeout=PATIENCE_S)


async def measured(url: str, orders: bool, connections: int, seconds: float) -> tuple[Crowd, Answers, Answers]:
    """The crowd, and the answers to whoever was connected before it and to newcomers."""
    crowd, before, new = Crowd(), Answers(), Answers()
    async with client_of(url) as client:
        await asked(client, orders, Answers())
        strangers = [asyncio.create_task(half_sent(url, bool(n % 2), crowd)) for n in range(connections)]
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            await asked(client, orders, before)
            async with client_of(url) as newcomer:
                await asked(newcomer, orders, new)
            await asyncio.sleep(1.0)
        for stranger in strangers:
            stranger.cancel()
        await asyncio.gather(*strangers, return_exceptions=True)
    return crowd, before, new


@asynccontextmanager
async def own_server() -> AsyncIterator[str]:
    crossfix = str(Path(sys.executable).with_name("crossfix"))
    with tempfile.TemporaryDirectory(prefix="half-sent-") as folder:
        server = await asyncio.create_subprocess_exec(
            crossfix, "serve", "--json", "--port", "0", "--data-dir", folder, stdout=asyncio.subprocess.PIPE
        )
        assert server.stdout is not None
        try:
            yield json.loads(await server.stdout.readline())["url"]
        finally:
            server.terminate()
            await server.wait()


async def run(url: str | None, connections: int, seconds: float) -> tuple[Crowd, Answers, Answers]:
    if url is not None:
        return await measured(url, False, connections, seconds)
    async with own_server() as own:
        return await measured(own, True, connections, seconds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--url", help="of a server that runs; default: one of its own")
    parser.add_argument("--connections", type=int, default=1010)
    parser.add_argument("--seconds", type=float, default=30.0)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    crowd, before, new = asyncio.run(run(given.url, given.connections, given.seconds))
    unanswered = before.unanswered + new.unanswered
    asked_in_all = len(before.took_s) + len(new.took_s) + unanswered
    where = "through the proxy" if given.url else "the server alone"
    figures = [
        wanted("half_sent", unanswered, of=where, note=f"of {asked_in_all}"),
        plain("half-sent requests kept up", given.connections, ""),
        plain("of them open at the same time, at most", crowd.most, ""),
        plain("opened in all", crowd.opened, "", note=f"{given.seconds:g} s"),
    ]
    for name, answers in (("connected before", before), ("newcomers", new)):
        if answers.took_s:
            ordered = sorted(answers.took_s)
            figures.append(plain(f"answered, {name}, median", round(1e3 * ordered[len(ordered) // 2]), "ms"))
            figures.append(plain(f"answered, {name}, worst", round(1e3 * ordered[-1]), "ms"))
    name = "half_sent_proxy" if given.url else "half_sent_server"
    for figure in figures:
        print(f"{figure.name}: {figure.value:g} {figure.unit} {figure.note}".rstrip())
    write(given.out, name, f"Half-sent requests, {where}", begun, figures, page="people.md")


if __name__ == "__main__":
    main()
