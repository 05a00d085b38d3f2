"""No request, however odd, makes the server stumble; every answer is what the schema promises.

CROSSFIX_FUZZ_REQUESTS=100000 makes it a long run: the default is a taste of it. A long run is rounds, each with a seed,
a server and a flight of its own: the list of missions and what the generator remembers stay short, and so does the time
that a request takes. Rounds may run beside one another (`pytest -n 2`). `record.py` says how they are kept.
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
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, cast
from uuid import uuid4

import httpx
import pytest
import requests
import schemathesis
from hypothesis import HealthCheck, Phase, given, reject, settings
from hypothesis import seed as fixed_seed
from hypothesis import strategies as st
from schemathesis.checks import (
    content_type_conformance,
    not_a_server_error,
    response_schema_conformance,
    status_code_conformance,
)
from schemathesis.core.errors import InvalidSchema

from backend.api.schema import wire_schema
from tests.benchmarks.figures.circumstances import begin
from tests.fuzz.record import SEED, Fuzzing

REQUESTS = int(os.environ.get("CROSSFIX_FUZZ_REQUESTS", "400"))
A_ROUND = int(os.environ.get("CROSSFIX_FUZZ_ROUND", "2000"))
CLIENTS = 4
"""Requests beside one another: the next ones are made up while the server answers, and one that waits for the vehicle
holds up no other."""
DEAREST = 5
"""Operations that a round names with the time that they took."""

WITHOUT = set(os.environ.get("CROSSFIX_FUZZ_WITHOUT", "").split(","))
"""Tags of operations to leave alone."""

HTTP = Fuzzing(
    "fuzz_http",
    "Fuzzing the API",
    "fuzz_requests",
    "requests",
    "the API",
    sums=("answered 2xx", "refused 4xx"),
    most={"operations": "", "slowest answer": "s", "a round": "s"},
)

schemathesis.serializer.alias("application/zip", "application/octet-stream")  # a bundle

CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]


DEAR = {"budget": 50, "wait_s": 1.0}
"""Numbers that only cost time when they are large: simulated flights of a plan, seconds to wait for a carrier."""
DEAR_ANYWAY = ("action_spacing_m", "fence_margin_m")
"""Left out: what is usual costs less than what is allowed."""


def spare(content: Any) -> None:
    """Makes the costly numbers of a body small, at any depth."""
    if isinstance(content, list):
        for each in content:
            spare(each)
    if isinstance(content, dict):
        for name in DEAR_ANYWAY:
            content.pop(name, None)
        for name, most in DEAR.items():
            if isinstance(content.get(name), int | float) and content[name] > most:
                content[name] = most
        for each in content.values():
            spare(each)


class Targets:
    """Ids that exist, so that requests get past the first "not found"."""

    def __init__(self, base_url: str) -> None:
        self.base_url = base_url
        self.spec = httpx.get(f"{base_url}/api/defaults").json()["spec"]
        self.spec["planner"]["budget"] = DEAR["budget"]
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
        """Mostly at something that is there, and mostly cheap: what is merely large takes time and finds no faults."""
        if "mission_id" in (case.path_parameters or {}) and chance.random() < 0.7:
            case.path_parameters["mission_id"] = chance.choice(self.missions)
        body = case.body
        if isinstance(body, dict) and "area" in body and chance.random() < 0.7:
            body["area"] = self.spec["area"]
        if chance.random() < 0.98:
            spare(body)


class Enough(BaseException):
    """A request has failed: no more of them. No Exception, which hypothesis would try again."""


@dataclass
class Answers:
    """What the clients of one round saw. seen: how often each operation answered what. took_s: wall time, s, that each
    took in all. failures: the first says how to repeat it."""

    seen: Counter[tuple[str, int]] = field(default_factory=Counter)
    took_s: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    slowest_s: float = 0.0
    failures: list[BaseException] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def take(self, label: str, status: int, took_s: float) -> None:
        with self._lock:
            self.seen[label, status] += 1
            self.took_s[label] += took_s
            self.slowest_s = max(self.slowest_s, took_s)

    def statuses(self) -> Counter[int]:
        return Counter(status for (_, status), count in self.seen.items() for _ in range(count))

    def of(self, hundreds: int) -> int:
        return sum(count for status, count in self.statuses().items() if status // 100 == hundreds)

    def operations(self) -> int:
        return len({label for label, _ in self.seen})

    def dearest(self) -> str:
        labels = sorted(self.took_s, key=lambda label: -self.took_s[label])[:DEAREST]
        return ", ".join(f"{label} {self.took_s[label]:.0f} s" for label in labels)


class Clients:
    """Send cases and check the answers, in threads that keep their connections."""

    def __init__(self, base_url: str, answers: Answers) -> None:
        self._base_url, self._answers = base_url, answers
        self._own = threading.local()
        self._threads = ThreadPoolExecutor(CLIENTS)
        self._room = threading.Semaphore(2 * CLIENTS)

    def send(self, case: schemathesis.Case) -> None:
        """Returns when a client has taken it. Raises Enough."""
        if self._answers.failures:
            raise Enough
        self._room.acquire()
        self._threads.submit(self._one, case)

    def close(self) -> None:
        """All have been answered."""
        self._threads.shutdown()

    def _one(self, case: schemathesis.Case) -> None:
        try:
            began = time.monotonic()
            try:
                response: Any = self._call(case)
            except requests.ConnectionError:  # kept too long: the server had just closed it
                self._own.session = requests.Session()
                response = self._call(case)
            self._answers.take(case.operation.label, response.status_code, time.monotonic() - began)
            case.validate_response(response, checks=CHECKS)
        except BaseException as failure:  # noqa: BLE001 (told by the thread that waits for all of them)
            self._answers.failures.append(failure)
        finally:
            self._room.release()

    def _call(self, case: schemathesis.Case) -> Any:
        if not hasattr(self._own, "session"):
            self._own.session = requests.Session()
        return case.call(base_url=self._base_url, session=self._own.session, timeout=300)


@cache
def cases() -> st.SearchStrategy[schemathesis.Case]:
    """Of all operations, as the schema has them and as it does not. Kept: to make them takes seconds."""
    schema = schemathesis.openapi.from_dict(wire_schema("0"))
    operations = [cast(Any, result).ok() for result in schema.get_all_operations()]
    operations = [operation for operation in operations if not WITHOUT & set(operation.tags or ())]
    modes = [schemathesis.GenerationMode.POSITIVE, schemathesis.GenerationMode.NEGATIVE]
    return st.one_of([operation.as_strategy(generation_mode=mode) for operation in operations for mode in modes])


@st.composite
def possible_cases(draw: st.DrawFn) -> schemathesis.Case:
    """A case that the generator cannot make up is no request: it negates some schemas into what nothing fits."""
    try:
        return draw(cases())
    except InvalidSchema:
        reject()


def fuzz(base_url: str, count: int, seed: int, answers: Answers) -> None:
    """Raises what the first failed request says."""
    targets, clients = Targets(base_url), Clients(base_url, answers)

    @fixed_seed(seed)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=cast(list[HealthCheck], list(HealthCheck)),
    )
    @given(possible_cases(), st.integers(0, 2**32))
    def one(case: schemathesis.Case, number: int) -> None:
        targets.aim(case, random.Random(number))
        clients.send(case)

    try:
        one()
    except Enough:
        pass
    finally:
        clients.close()
    if answers.failures:
        raise answers.failures[0]


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


@pytest.mark.long
@pytest.mark.timeout(120 + A_ROUND)
@pytest.mark.parametrize("number", range(-(-REQUESTS // A_ROUND)))
def test_no_request_makes_the_server_stumble(number: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked, seed, answers, ended_well = min(A_ROUND, REQUESTS - number * A_ROUND), SEED + number, Answers(), False
    asked_for = f"CROSSFIX_FUZZ_REQUESTS={REQUESTS} CROSSFIX_FUZZ_ROUND={A_ROUND} CROSSFIX_FUZZ_SEED={SEED}"
    command = f"{asked_for} pytest tests/fuzz/test_http.py -n 2"
    began, begun = time.monotonic(), replace(begin(__file__), command=command)
    if number == 0:
        HTTP.begin_anew()
    try:
        with server(tmp_path / "served") as url:
            fuzz(url, asked, seed, answers)
            assert httpx.get(f"{url}/api/health", timeout=30).status_code == 200
        assert "Traceback" not in (tmp_path / "served" / "log").read_text()
        assert answers.seen.total() >= asked
        ended_well = True
    finally:
        took_s = time.monotonic() - began
        with capsys.disabled():  # on standard error, which xdist lets through
            for failure in answers.failures:
                print(f"\nseed {seed}: {failure}", file=sys.stderr, flush=True)
            print(
                f"\nseed {seed}, {took_s:.0f} s: {answers.seen.total()} requests to {answers.operations()} operations, "
                f"{dict(answers.statuses())}; slowest {answers.slowest_s:.1f} s; most time: {answers.dearest()}",
                file=sys.stderr,
                flush=True,
            )
        more = {
            "answered 2xx": answers.of(2),
            "refused 4xx": answers.of(4),
            "operations": answers.operations(),
            "slowest answer": round(answers.slowest_s, 1),
            "a round": round(took_s),
        }
        HTTP.keep(begun, seed, answers.seen.total(), int(not ended_well), more)
        shutil.rmtree(tmp_path / "served", ignore_errors=True)
