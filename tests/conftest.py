"""Fixtures for every room: a temporary PostgreSQL where its programs are installed, a journal on either database."""

from __future__ import annotations

import asyncio
import gc
import glob
import os
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import AsyncIterator, Generator, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from uuid import uuid4

import asyncpg
import psutil
import pytest

from backend.settings import Settings
from backend.store.engine import make_engine, migrate
from backend.store.journal import SqlJournal
from backend.store.spool import Spool

sys.path.insert(0, str(Path(__file__).parent / "doubles"))  # not tests/ itself: it would hide the packages
sys.path.append(str(Path(__file__).parents[1]))  # for `from tests.reasons import ...`

FOLDERS = {"browser": ("browser",), "system": ("system", "fuzz/test_live.py")}
"""Where `make stories` and `make system` look for their tests, and where `make unit` looks for none."""

LONGEST = (
    "browser/test_emitters.py",
    "browser/test_motion.py",
    "browser/test_fly.py",
    "browser/test_screens.py",
    "browser/test_thirty_days.py",
    "browser/test_page.py",
    "backend/craft/test_machine_sweep.py",
    "strikes/test_strike.py",
    "planner/kernels/test_compiled.py",
    "backend/store/test_outage.py",
    "backend/mission/test_learning.py",
    "test_wheel.py",
    "contracts/vehicle/test_link.py",
    "benchmarks/test_battery_home.py",
)
"""Files of few tests that take long, the longest first. One that began last would keep one worker busy alone."""


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What is imported and collected stays: the collector walked through it again and again, a fifth of the time that
    each worker took to find its tests."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    here = Path(__file__).parent
    _hold_marks_to_folders(here, items)
    if hasattr(config, "workerinput"):
        _put_long_files_first(here, items)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """What failed before it was tried again: what passed then is only named, and what failed again is shown by
    its second failure, which may follow from the first."""
    for report in terminalreporter.getreports("rerun"):
        terminalreporter.section(f"first failure of {report.nodeid}", "-")
        terminalreporter.write_line(report.longreprtext)


def _put_long_files_first(here: Path, items: list[pytest.Item]) -> None:
    """For `--dist loadfile --no-loadscope-reorder`, whose workers take the files in this order: after the longest ones
    those with the most tests, as xdist would have them."""
    ranks = {here / file: rank for rank, file in enumerate(LONGEST)}
    if gone := [str(file) for file in ranks if not file.is_file()]:
        raise pytest.UsageError(f"LONGEST of {__file__} names files that are no more: {gone}")
    tests = Counter(item.path for item in items)
    items.sort(key=lambda item: (ranks.get(item.path, len(ranks)), -tests[item.path], item.path))


def _hold_marks_to_folders(here: Path, items: list[pytest.Item]) -> None:
    """A test that lies where no target of the Makefile looks for its mark would never run."""
    for item in items:
        if item.get_closest_marker("long") is not None:  # `make long` looks everywhere
            continue
        for mark, folders in FOLDERS.items():
            lies_there = any(item.path.is_relative_to(here / folder) for folder in folders)
            if lies_there != (item.get_closest_marker(mark) is not None):
                raise pytest.UsageError(f"{item.nodeid}: {mark!r} must mark the tests of {folders}, and no others")


EMPTIED = """
SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = current_database() AND pid <> pg_backend_pid();
DROP SCHEMA public CASCADE;
CREATE SCHEMA public;
"""
"""Migrations make nothing outside this schema; a connection that a test left open could hold a lock on it."""


class PostgresCluster:
    """A cluster of its own on a loopback port; `pause` and `resume` make it hang, `stop` and `start` take it away."""

    def __init__(self, programs: Path, folder: Path, user: str | None) -> None:
        self.programs, self.folder, self.user = programs, folder, user
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.process: subprocess.Popen[bytes] | None = None
        self._given_back: list[str] = []

    def _run(self, program: str, *arguments: str) -> subprocess.Popen[bytes]:
        command = [str(self.programs / program), "-D", str(self.folder / "data"), *arguments]
        return subprocess.Popen(
            command,
            cwd="/",
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            user=self.user,
            group=pwd.getpwnam(self.user).pw_gid if self.user else None,
            extra_groups=[] if self.user else None,
        )

    def give_folder(self) -> None:
        """To the user that PostgreSQL runs as."""
        if self.user is not None:
            shutil.chown(self.folder, self.user)

    def create(self) -> None:
        options = ["--auth=trust", "--no-sync", "--encoding=UTF8", "--locale=C"]
        if self._run("initdb", "-U", "crossfix", *options).wait(timeout=120):
            raise RuntimeError(f"initdb made no cluster in {self.folder}")

    def start(self) -> None:
        options = {"port": self.port, "listen_addresses": "127.0.0.1", "fsync": "off", "shared_buffers": "16MB"}
        options["unix_socket_directories"] = str(self.folder)
        flags = [part for name, value in options.items() for part in ("-c", f"{name}={value}")]
        self.process = self._run("postgres", *flags)
        deadline = time.monotonic() + 30
        while True:
            try:
                asyncio.run(self._ask("SELECT 1"))
                return
            except (OSError, asyncpg.PostgresError):
                if time.monotonic() > deadline or self.process.poll() is not None:
                    raise
                time.sleep(0.05)

    def stop(self) -> None:
        """At once, as when the machine loses its power."""
        if self.process is not None:
            self.process.send_signal(signal.SIGQUIT)
            self.process.wait(timeout=20)
            self.process = None

    def _all(self) -> list[psutil.Process]:
        assert self.process is not None
        postmaster = psutil.Process(self.process.pid)
        return [postmaster, *postmaster.children(recursive=True)]

    def pause(self) -> None:
        """As when the machine hangs: connections stay open and nothing answers."""
        for process in self._all():
            process.suspend()

    def resume(self) -> None:
        for process in self._all():
            process.resume()

    async def _ask(self, statement: str, database: str = "postgres") -> None:
        connection = await asyncpg.connect(self.url(database), timeout=5)
        try:
            await connection.execute(statement)
        finally:
            await connection.close()

    def url(self, database: str) -> str:
        return f"postgresql://crossfix@127.0.0.1:{self.port}/{database}"

    def new_database(self) -> str:
        """An empty one: made, or given back and emptied."""
        if self._given_back:
            name = self._given_back.pop()
            asyncio.run(self._ask(EMPTIED, name))
        else:
            name = f"test_{uuid4().hex[:12]}"
            asyncio.run(self._ask(f"CREATE DATABASE {name}"))
        return self.url(name)

    def give_back(self, url: str) -> None:
        """To be emptied and used again: one is 10 MB in 350 files to write and to remove."""
        self._given_back.append(url.rsplit("/", 1)[1])


def postgres_programs() -> Path | None:
    found = shutil.which("initdb")
    if found and shutil.which("postgres"):
        return Path(found).resolve().parent
    folders = sorted(glob.glob("/usr/lib/postgresql/*/bin"))
    return Path(folders[-1]) if folders else None


def postgres_user() -> str | None:
    """PostgreSQL refuses to run as root."""
    if os.geteuid() != 0:
        return None
    names = {entry.pw_name for entry in pwd.getpwall()}
    return "postgres" if "postgres" in names else "nobody"


@pytest.fixture(scope="session")
def postgres_cluster() -> Iterator[PostgresCluster]:
    programs = postgres_programs()
    if programs is None:
        pytest.skip("no PostgreSQL programs (initdb, postgres) on this machine")
    user = postgres_user()
    with tempfile.TemporaryDirectory(prefix="crossfix-postgresql-", ignore_cleanup_errors=True) as folder:
        cluster = PostgresCluster(programs, Path(folder), user)
        cluster.give_folder()
        cluster.create()
        cluster.start()
        try:
            yield cluster
        finally:
            cluster.stop()


@pytest.fixture
def postgresql_url(request: pytest.FixtureRequest) -> Iterator[str]:
    """An empty PostgreSQL database: CROSSFIX_TEST_POSTGRESQL_URL, or one in the temporary cluster."""
    given = os.environ.get("CROSSFIX_TEST_POSTGRESQL_URL")
    if given:
        yield given
        return
    cluster: PostgresCluster = request.getfixturevalue("postgres_cluster")
    url = cluster.new_database()
    yield url
    cluster.give_back(url)


@dataclass
class JournalBench:
    """Opens journals on one database and one spool, as restarts of one server do."""

    url: str
    folder: Path
    now_s: float = 1_700_000_000.0
    timeout_s: float = 1.0
    opened: list[SqlJournal] = field(default_factory=list)

    async def open(self, spool: str = "journal.spool") -> SqlJournal:
        engine = make_engine(self.url, self.timeout_s)
        kept = Spool(self.folder / spool, 256 * 1024)
        journal = SqlJournal(engine, kept, lambda: self.now_s, timeout_s=self.timeout_s)
        self.opened.append(journal)
        return journal

    async def close(self) -> None:
        for journal in self.opened:
            await journal.close()
        self.opened.clear()


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """An empty database, with its driver in the URL."""
    if request.param == "sqlite":
        return Settings(data_dir=tmp_path).async_database_url
    return Settings(database_url=request.getfixturevalue("postgresql_url")).async_database_url


@pytest.fixture
async def bench(database_url: str, tmp_path: Path) -> AsyncIterator[JournalBench]:
    await migrate(database_url)
    opened = JournalBench(database_url, tmp_path)
    yield opened
    await opened.close()


@pytest.fixture
async def journal(bench: JournalBench) -> SqlJournal:
    return await bench.open()
