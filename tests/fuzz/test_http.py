"""No request, however odd, makes the server stumble; every answer is what the schema promises.

CROSSFIX_FUZZ_REQUESTS=100000 makes it a long run: the default is a taste of it. A long run is rounds, each with a
server and a flight of its own: the list of missions and what the generator remembers stay short, and so does the time
that a request takes. CROSSFIX_FUZZ_OUT names the folder for a record of what was found.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, cast
from uuid import uuid4

import httpx
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as fixed_seed
from hypothesis import strategies as st
from schemathesis.checks import (
    content_type_conformance,
    not_a_server_error,
    response_schema_conformance,
    status_code_conformance,
)

from backend.api.schema import wire_schema
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import plain, wanted, write

REQUESTS = int(os.environ.get("CROSSFIX_FUZZ_REQUESTS", "400"))
A_ROUND = int(os.environ.get("CROSSFIX_FUZZ_ROUND", "2000"))
SEED = int(os.environ.get("CROSSFIX_FUZZ_SEED", "1"))
OUT = os.environ.get("CROSSFIX_FUZZ_OUT")

WITHOUT = set(os.environ.get("CROSSFIX_FUZZ_WITHOUT", "").split(","))
"""Tags of operations to leave alone."""

schemathesis.serializer.alias("application/zip", "application/octet-stream")  # a bundle

CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]


class Targets:
    """Ids that exist, so that requests get past the first "not found"."""

    def __init__(self, base_url: str) -> None:
        self.base_url = base_url
        self.spec = httpx.get(f"{base_url}/api/defaults").json()["spec"]
        self.missions = [httpx.post(f"{base_url}/api/missions", json=self.spec).json()["mission_id"] for _ in range(3)]
        self._start(self.missions[0])

    def _start(self, mission_id: str, patience_s: float = 60.0) -> None:
        """Ordered until it is accepted: a vehicle that was just switched on is not ready at once."""
        until, answer = time.monotonic() + patience_s, {"accepted": False}
        while not answer["accepted"]:
            assert time.monotonic() < until, answer
            body = {"command_id": str(uuid4()), "command": {"kind": "start"}}
            answer = httpx.post(f"{self.base_url}/api/missions/{mission_id}/commands", json=body, timeout=30.0).json()
            time.sleep(0.2)

    def aim(self, case: schemathesis.Case, chance: random.Random) -> None:
        """Mostly at something that is there. Plans that are merely large are left out: they take time, no faults."""
        if "mission_id" in (case.path_parameters or {}) and chance.random() < 0.7:
            case.path_parameters["mission_id"] = chance.choice(self.missions)
        body = case.body
        if isinstance(body, dict) and "area" in body and chance.random() < 0.7:
            body["area"] = self.spec["area"]
        for part, heavy in (("planner", "budget"), ("planner", "action_spacing_m"), ("flight", "fence_margin_m")):
            if isinstance(body, dict) and isinstance(content := body.get(part), dict):
                content.pop(heavy, None)


def fuzz(base_url: str, requests: int, seed: int, slowest: defaultdict[str, float]) -> Counter[tuple[str, int]]:
    """How often each operation answered what. slowest: seconds of the wall by operation, kept up."""
    targets, seen = Targets(base_url), Counter()
    schema = schemathesis.openapi.from_dict(wire_schema("0"))
    operations = [cast(Any, result).ok() for result in schema.get_all_operations()]
    operations = [operation for operation in operations if not WITHOUT & set(operation.tags or ())]
    modes = [schemathesis.GenerationMode.POSITIVE, schemathesis.GenerationMode.NEGATIVE]
    cases = st.one_of([operation.as_strategy(generation_mode=mode) for operation in operations for mode in modes])

    @fixed_seed(seed)
    @settings(
        max_examples=requests,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=cast(list[HealthCheck], list(HealthCheck)),
    )
    @given(cases, st.integers(0, 2**32))
    def one(case: schemathesis.Case, number: int) -> None:
        targets.aim(case, random.Random(number))
        began = time.monotonic()
        response: Any = case.call(base_url=base_url, timeout=300)
        slowest[case.operation.label] = max(slowest[case.operation.label], time.monotonic() - began)
        seen[case.operation.label, response.status_code] += 1
        case.validate_response(response, checks=CHECKS)

    one()
    return seen


@contextmanager
def server(folder: Path) -> Iterator[str]:
    """A server of its own process: its memory and its log can be looked at, and its threads are not ours."""
    folder.mkdir()
    environment = {**os.environ, "CROSSFIX_SPOOL_RESERVE_BYTES": str(2**20)}
    command = [str(Path(sys.executable).with_name("crossfix")), "serve", "--port", "0", "--json", "--speedup", "10"]
    with (folder / "log").open("wb") as log:
        process = subprocess.Popen(
            [*command, "--data-dir", str(folder / "data")], stdout=subprocess.PIPE, stderr=log, env=environment
        )
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())["url"]
            assert process.poll() is None, "the server is gone"
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=30)
            leave_nothing_flying(folder / "data")


def leave_nothing_flying(data_dir: Path) -> None:
    """A simulated vehicle in the middle of a mission flies on by itself when its server ends."""
    register = data_dir / "simulated_vehicle.json"
    if register.exists():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as orders:
            orders.sendto(b'{"do": "stop"}', ("127.0.0.1", json.loads(register.read_text())["control_port"]))


@pytest.mark.system
@pytest.mark.timeout(120 + REQUESTS)
def test_no_request_makes_the_server_stumble(tmp_path: Path, capsys):
    seen: Counter[tuple[str, int]] = Counter()
    slowest: defaultdict[str, float] = defaultdict(float)
    began, begun = time.monotonic(), begin(__file__)
    for number, done in enumerate(range(0, REQUESTS, A_ROUND)):
        folder = tmp_path / str(number)
        with server(folder) as url:
            seen += fuzz(url, min(A_ROUND, REQUESTS - done), SEED + number, slowest)
            assert httpx.get(f"{url}/api/health", timeout=30).status_code == 200
        assert "Traceback" not in (folder / "log").read_text()
        shutil.rmtree(folder)
        with capsys.disabled():
            statuses = Counter(status for (_, status), count in seen.items() for _ in range(count))
            print(
                f"\n{sum(seen.values())} requests to {len({label for label, _ in seen})} operations in "
                f"{time.monotonic() - began:.0f} s: {dict(statuses)}; slowest "
                f"{max(slowest.values()):.1f} s: {max(slowest, key=lambda label: slowest[label])}"
            )
    assert sum(seen.values()) >= REQUESTS
    answered = Counter(status for (_, status), count in seen.items() for _ in range(count))
    figures = [
        wanted("fuzz_requests", sum(seen.values())),
        wanted("fuzz_failures", 0, of="HTTP"),
        plain("operations", len({label for label, _ in seen}), ""),
        plain("slowest answer", round(max(slowest.values()), 1), "s"),
        *(plain(f"answered {status}", count, "") for status, count in sorted(answered.items())),
    ]
    command = f"CROSSFIX_FUZZ_REQUESTS={REQUESTS} CROSSFIX_FUZZ_SEED={SEED} pytest tests/fuzz/test_http.py"
    begun = replace(begun, command=command)
    write(
        Path(OUT) if OUT else None, "fuzz_http", "Fuzzing the API", begun, figures, page="faults-in-flight.md#fuzzing"
    )
