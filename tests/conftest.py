"""Fixtures for every room: a temporary PostgreSQL where its programs are installed."""

from __future__ import annotations

import asyncio
import glob
import os
import pwd
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from uuid import uuid4

import asyncpg
import pytest


class PostgresCluster:
    """A cluster of its own on a loopback port; `pause` and `resume` make it hang, `stop` and `start` take it away."""

    def __init__(self, programs: Path, folder: Path, user: str | None) -> None:
        self.programs, self.folder, self.user = programs, folder, user
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.process: subprocess.Popen[bytes] | None = None

    def _as_user(self, *command: str) -> list[str]:
        return ["runuser", "-u", self.user, "--", *command] if self.user else list(command)

    def create(self) -> None:
        initdb = self._as_user(str(self.programs / "initdb"), "-D", str(self.folder / "data"), "-U", "crossfix")
        options = ["--auth=trust", "--no-sync", "--encoding=UTF8", "--locale=C"]
        subprocess.run([*initdb, *options], check=True, capture_output=True, cwd="/")

    def start(self) -> None:
        options = {"port": self.port, "listen_addresses": "127.0.0.1", "fsync": "off", "shared_buffers": "16MB"}
        options["unix_socket_directories"] = str(self.folder)
        flags = [part for name, value in options.items() for part in ("-c", f"{name}={value}")]
        command = self._as_user(str(self.programs / "postgres"), "-D", str(self.folder / "data"), *flags)
        self.process = subprocess.Popen(command, cwd="/", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 30
        while True:
            try:
                asyncio.run(self._ask("SELECT 1"))
                return
            except (OSError, asyncpg.PostgresError):
                if time.monotonic() > deadline or self.process.poll() is not None:
                    raise
                time.sleep(0.05)

    def _pid(self) -> int:
        return int((self.folder / "data" / "postmaster.pid").read_text().splitlines()[0])

    def stop(self) -> None:
        """At once, as when the machine loses its power."""
        if self.process is not None:
            os.kill(self._pid(), 3)
            self.process.wait(timeout=20)
            self.process = None

    async def _ask(self, statement: str) -> None:
        connection = await asyncpg.connect(self.url("postgres"), timeout=5)
        try:
            await connection.execute(statement)
        finally:
            await connection.close()

    def url(self, database: str) -> str:
        return f"postgresql://crossfix@127.0.0.1:{self.port}/{database}"

    def new_database(self) -> str:
        name = f"test_{uuid4().hex[:12]}"
        asyncio.run(self._ask(f"CREATE DATABASE {name}"))
        return self.url(name)


def _programs() -> Path | None:
    found = shutil.which("initdb")
    if found and shutil.which("postgres"):
        return Path(found).resolve().parent
    folders = sorted(glob.glob("/usr/lib/postgresql/*/bin"))
    return Path(folders[-1]) if folders else None


def _user() -> str | None:
    """PostgreSQL refuses to run as root."""
    if os.geteuid() != 0:
        return None
    names = {entry.pw_name for entry in pwd.getpwall()}
    return "postgres" if "postgres" in names else "nobody"


@pytest.fixture(scope="session")
def postgres_cluster() -> Iterator[PostgresCluster]:
    programs = _programs()
    if programs is None:
        pytest.skip("no PostgreSQL programs (initdb, postgres) on this machine")
    user = _user()
    with tempfile.TemporaryDirectory(prefix="crossfix-postgresql-", ignore_cleanup_errors=True) as folder:
        if user is not None:
            shutil.chown(folder, user)
        cluster = PostgresCluster(programs, Path(folder), user)
        cluster.create()
        cluster.start()
        try:
            yield cluster
        finally:
            cluster.stop()


@pytest.fixture
def postgresql_url(request: pytest.FixtureRequest) -> str:
    """An empty PostgreSQL database: CROSSFIX_TEST_POSTGRESQL_URL, or a new one in the temporary cluster."""
    given = os.environ.get("CROSSFIX_TEST_POSTGRESQL_URL")
    return given or request.getfixturevalue("postgres_cluster").new_database()
