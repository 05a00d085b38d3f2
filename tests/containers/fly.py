"""docs/install-for-a-team.md, walked through: up from nothing, a mission flown, boxes killed in its flight, a restore.

    python -m tests.containers.fly --out docs/measurements

The containers have a project of their own, whose volumes are taken away at the end (`--keep`: everything stays), but
the ports and settings of `.env`. While the mission flies, a backup is made and server, database and proxy are killed,
one after the other; afterwards the backup is restored into empty volumes. Fails unless the mission comes back in hold
and goes on to localize its emitter, and its people and facts are there again after the restore. Wants SPEEDUP=1: any
faster, and the vehicle's own failsafe has landed it before the server is back.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import secrets
import shlex
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

import httpx

from tests.benchmarks.figures.circumstances import Begun, begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.containers.boxes import SOURCES, Boxes
from tests.containers.flight import Fact, Flight, answered, count, phase, trust, until_healthy, vehicle_ready

NAME = "ada"
SERVER_USER = "8600"


@dataclass
class Watch:
    """What took how long, said and kept."""

    figures: list[Figure] = field(default_factory=list)
    begun: float = field(default_factory=time.monotonic)

    def say(self, text: object) -> None:
        print(f"{time.monotonic() - self.begun:6.1f} s  {text}", flush=True)

    @asynccontextmanager
    async def timed(self, what: str, note: str = "") -> AsyncIterator[None]:
        """A figure, unless the block fails."""
        began = time.monotonic()
        yield
        self.figures.append(plain(what, round(time.monotonic() - began, 1), "s", note=note))
        self.say(what)


async def sealed(boxes: Boxes) -> None:
    """What the page says of the image. Raises RuntimeError where it is not so."""
    if (user := (await boxes.inside("id", "-u")).strip()) != SERVER_USER:
        raise RuntimeError(f"the server runs as user {user}")
    for place in ("/written", "/opt/crossfix/written", "/var/lib/written"):
        if "written" in await boxes.inside("sh", "-c", f"touch {place} 2>/dev/null && echo written || true"):
            raise RuntimeError(f"{place} can be written")
    server, page = [
        json.loads(await boxes.inside("cat", f"/opt/crossfix/bill/{name}.cdx.json")) for name in ("server", "page")
    ]
    if not server["components"]:
        raise RuntimeError("the server's bill of materials names nothing")
    if missing := left_out(page, json.loads((SOURCES / "frontend" / "package-lock.json").read_text())):
        raise RuntimeError(f"the page's bill of materials leaves out {missing}")


def left_out(bill: dict[str, Any], lock: dict[str, Any]) -> list[str]:
    """What npm's lock file wants for more than development, and the bill of materials (CycloneDX) does not name."""
    named = {each["name"] for each in bill["components"]}
    wanted = {path.rpartition("node_modules/")[2] for path, one in lock["packages"].items() if not one.get("dev")}
    return sorted(wanted - {""} - named)


async def back(boxes: Boxes, service: str, client: httpx.AsyncClient) -> None:
    """Killed and started again; the server is ready for its orders."""
    await boxes("kill", service)
    await boxes("up", "--detach")
    await until_healthy(client)
    await vehicle_ready(client)


async def fly(boxes: Boxes, client: httpx.AsyncClient, watch: Watch) -> tuple[Flight, str, list[Fact]]:
    """The mission, ended; the backup that was made in it; what must be in that at least. Raises RuntimeError when it is
    not localized."""
    spec = answered(await client.get("/api/defaults"))["spec"]
    flight = Flight(client, answered(await client.post("/api/missions", json=spec))["mission_id"])
    await flight.preflight()
    await flight.order("take_control")
    await flight.order("start")
    await flight.until(lambda facts: count(facts, "bearing_measured") >= 1)
    watch.say("a first bearing")
    saved = await flight.facts()
    async with watch.timed("backup in flight"):
        archive = json.loads(await boxes.inside("crossfix", "backup", "/backups", "--json"))["archive"]
    async with watch.timed("server killed in flight: the mission is back in hold"):
        await back(boxes, "server", client)
        facts = await flight.until(lambda facts: count(facts, "server_restarted") > 0 and phase(facts) == "hold")
    if facts[: len(saved)] != saved:
        raise RuntimeError("facts are lost")
    await flight.order("resume")
    for service in ("database", "proxy"):
        async with watch.timed(f"{service} killed in flight: all answers again"):
            await back(boxes, service, client)
    facts = await flight.until(lambda facts: count(facts, "mission_ended") > 0)
    outcome = next(fact["outcome"] for fact in facts if fact["kind"] == "mission_ended")
    watch.say(f"outcome: {outcome}, bearings: {count(facts, 'bearing_measured')}")
    if outcome != "localized":
        raise RuntimeError(f"the mission ended {outcome}")
    return flight, archive, saved


async def walk(boxes: Boxes, url: str, plain_url: str, watch: Watch) -> None:
    """The page from its first command to its last. Raises RuntimeError where it does not hold."""
    account = {"name": NAME, "password": secrets.token_urlsafe(24)}
    async with watch.timed("up from nothing: the image built, the first admin's code printed"):
        await boxes("up", "--build", "--detach")
        code = await boxes.first_code()
    await trust(url, plain_url)
    await sealed(boxes)
    # a browser leaves the usual port out of an origin
    origin = url.removesuffix(":443")
    async with httpx.AsyncClient(base_url=url, timeout=60.0, headers={"origin": origin}) as client:
        await until_healthy(client)
        answered(await client.post("/api/first-admin", json={"code": code, **account}))
        health = await vehicle_ready(client)
        watch.say(f"signed in; the server: {health}")
        if health["database"]["kind"] != "postgresql":
            raise RuntimeError("PostgreSQL does not keep the journal")
        async with watch.timed("mission: drafted to ended", "a backup and three killed boxes in it"):
            flight, archive, saved = await fly(boxes, client, watch)
        async with watch.timed("restore into empty volumes, and up again"):
            await boxes.empty()
            await boxes("run", "--rm", "-T", "server", "crossfix", "restore", archive)
            await boxes("up", "--detach")
            await until_healthy(client)
        answered(await client.post("/api/session", json=account))
        restored = await flight.facts()
        if restored[: len(saved)] != saved:
            raise RuntimeError("the restored mission is another one")
        watch.say(f"restored: {len(saved)} facts, and {NAME} signs in again")


async def main(boxes: Boxes, arguments: argparse.Namespace, begun: Begun) -> None:
    watch = Watch()
    try:
        await walk(boxes, arguments.url, arguments.plain, watch)
    finally:
        if not arguments.keep:
            await boxes("down", "--volumes")
    write(
        arguments.out,
        "containers",
        "The containers of docker-compose.yml",
        begun,
        watch.figures,
        page="install-for-a-team.md",
        remark=arguments.remark,
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--compose", default="docker compose", help="the program (%(default)s)")
    parser.add_argument("--url", default="https://localhost", help="the page (%(default)s)")
    parser.add_argument(
        "--plain", default="http://localhost", help="where the authority's certificate is (%(default)s)"
    )
    parser.add_argument("--keep", action="store_true", help="leave everything as it is at the end")
    parser.add_argument("--remark", default="", help="into the record: which images were stood in for, for instance")
    add_out(parser)
    given = parser.parse_args()
    asyncio.run(main(Boxes(shlex.split(given.compose)), given, begin(__file__)))
