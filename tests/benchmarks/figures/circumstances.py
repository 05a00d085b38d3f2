"""When, where and from which commit a benchmark runs."""

from __future__ import annotations

import os
import platform
import shlex
import subprocess
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from tests.benchmarks.figures.record import Load

ROOT = Path(__file__).parents[3]
OUT = "--out"


@dataclass(frozen=True, slots=True)
class Begun:
    """A run at its beginning. commit: null outside a git checkout. load: the one-minute average."""

    command: str
    commit: str | None
    date: str
    machine: str
    load: float


def begin(file: str) -> Begun:
    """file: `__file__` of the benchmark that was started with `python -m`."""
    module = ".".join(Path(file).resolve().relative_to(ROOT).with_suffix("").parts)
    return Begun(
        command=command_line(module, sys.argv[1:]),
        commit=commit(),
        date=f"{datetime.now(UTC):%Y-%m-%dT%H:%MZ}",
        machine=machine(),
        load=os.getloadavg()[0],
    )


def load_until_now(begun: Begun) -> Load:
    now = os.getloadavg()[0]
    return Load(least=round(min(begun.load, now), 1), most=round(max(begun.load, now), 1))


def command_line(module: str, arguments: list[str]) -> str:
    """What to type to have it again; where the record went is left out, and a folder of this machine is no name."""
    kept, skipping = [], False
    for argument in arguments:
        if skipping:
            skipping = False
        elif argument == OUT:
            skipping = True
        elif not argument.startswith(f"{OUT}="):
            kept.append("FOLDER" if Path(argument).is_absolute() else argument)
    return shlex.join(["python", "-m", module, *kept])


def commit() -> str | None:
    """The checkout's commit; changed measurements alone do not make it "-dirty", since benchmarks write them."""
    if not (ROOT / ".git").exists():
        return None
    head = _git("rev-parse", "--short=10", "HEAD")
    changed = _git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/measurements*")
    return f"{head}-dirty" if changed else head


def machine() -> str:
    """Cores that this process may use, processor, Python."""
    cores = len(os.sched_getaffinity(0))
    return f"{cores} cores, {_processor()}, {platform.system()}, Python {platform.python_version()}"


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return " ".join(line.partition(":")[2].split())
    return platform.machine()


def _git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
