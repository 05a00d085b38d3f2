"""A server that others can reach, before anybody has signed in, and what they bring."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from served import Server, started

PASSWORD = "correct horse battery"
PHONE: dict[str, Any] = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@dataclass
class Shared:
    """People sign in. code: of its first admin."""

    server: Server
    code: str


@contextmanager
def team_server(data_dir: Path) -> Iterator[Shared]:
    arguments = ["--data-dir", str(data_dir), "--speedup", "3", "--seed", "3", "--users"]
    process = started([*arguments, "--port", "0"])
    assert process.stdout is not None
    told = json.loads(process.stdout.readline())
    assert told["people"] == "waiting"
    server = Server(told["url"], data_dir, arguments, process)
    try:
        yield Shared(server, told["first_admin_code"])
    finally:
        server.stop()
