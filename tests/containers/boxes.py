"""The containers of docker-compose.yml, by the commands that docs/install-for-a-team.md gives."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Sequence
from pathlib import Path

SOURCES = Path(__file__).parents[2]
CODE = re.compile(r"\b[0-9A-Z]{4}(?:-[0-9A-Z]{4}){3}\b")
"""Of the first admin, as the server prints it."""
CODE_S = 900.0
PROJECT = "crossfix-walked-through"
"""Not the name that docker-compose.yml has: what somebody flies with on this machine keeps its volumes."""
EMPTIED = ("missions", "database")
"""The volumes that a restore wants empty."""


class Boxes:
    """compose: the program, `docker compose` or what stands in for it."""

    def __init__(self, compose: Sequence[str]) -> None:
        self._compose = tuple(compose)

    async def __call__(self, *arguments: str) -> str:
        """What `docker compose ARGUMENTS` printed. Raises RuntimeError with what it complained of."""
        return await run(*self._compose, "--project-name", PROJECT, *arguments)

    async def inside(self, *command: str) -> str:
        """What it printed in the server's container."""
        return await self("exec", "-T", "server", *command)

    async def empty(self) -> None:
        """All down; missions and database gone."""
        await self("down")
        engine = self._compose[0].removesuffix("-compose")
        await run(engine, "volume", "rm", *(f"{PROJECT}_{volume}" for volume in EMPTIED))

    async def first_code(self) -> str:
        """The newest of the server's log, once one is there. Raises TimeoutError."""
        async with asyncio.timeout(CODE_S):
            while True:
                if codes := CODE.findall(await self("logs", "server")):
                    return codes[-1]
                await asyncio.sleep(2.0)


async def run(*command: str) -> str:
    process = await asyncio.create_subprocess_exec(
        *command, cwd=SOURCES, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
    )
    out, said = await process.communicate()
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: {said.decode()[-2000:]}")
    return out.decode()
