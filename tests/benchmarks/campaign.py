"""Endurance and trouble, one benchmark after the other, and what came of the wanted figures.

    python -m tests.benchmarks.campaign soak  --scale 1       (or: make soak)
    python -m tests.benchmarks.campaign chaos --scale 0.01    (or: make chaos SCALE=0.01)

scale: share of the full effort. Figures that count effort itself (kills, requests, minutes) are wanted in this share,
and marked so; everything else is wanted as it is. Ends with status 1 when a figure is missed or was not measured, or a
benchmark failed.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tests.benchmarks.figures.reader import read_all
from tests.benchmarks.figures.record import Record
from tests.benchmarks.figures.wanted import BY_KEY

EFFORT = frozenset({"kills", "outage_minutes", "fuzz_requests", "fuzz_messages"})


@dataclass(frozen=True, slots=True)
class Step:
    """keys: the wanted figures that it measures. environment: besides this process's own."""

    what: str
    command: tuple[str, ...]
    keys: tuple[str, ...]
    environment: Mapping[str, str] = field(default_factory=dict[str, str])


def share(full: float, scale: float, least: int) -> str:
    return str(max(least, round(full * scale)))


def soak(scale: float, out: Path) -> list[Step]:
    load, to = "tests.benchmarks.live_load", ("--out", str(out))
    return [
        Step(
            "a hundred viewers, five of them stalled",
            (load, "fanout", "--seconds", share(600, scale, 20), *to),
            ("fanout", "fanout_memory"),
        ),
        Step("aborts under load", (load, "abort", "--times", share(200, scale, 3), *to), ("abort",)),
        Step(
            "files from outside",
            ("tests.benchmarks.hostile_uploads", *to),
            ("upload_abort", "upload_memory", "upload_answer"),
        ),
    ]


def chaos(scale: float, out: Path) -> list[Step]:
    to = ("--out", str(out))
    storage, killed = "tests.benchmarks.storage_faults", ("kills", "kill_lost", "kill_beliefs", "restart")
    fuzz = {
        "CROSSFIX_FUZZ_OUT": str(out),
        "CROSSFIX_FUZZ_REQUESTS": share(100_000, scale, 100),
        "CROSSFIX_FUZZ_MESSAGES": share(100_000, scale, 100),
    }
    kills = share(1000, scale, 3)
    return [
        Step("kill -9, SQLite", ("tests.benchmarks.kill_loop", "--kills", kills, *to), killed),
        Step(
            "kill -9, PostgreSQL",
            ("tests.benchmarks.kill_loop", "--database", "postgresql", "--kills", kills, *to),
            killed,
        ),
        Step(
            "database away",
            (storage, "outage", "--minutes", str(max(0.2, 10 * scale)), *to),
            ("outage_minutes", "outage_lost"),
        ),
        Step("disk full", (storage, "full-disk", *to), ("disk_full", "disk_full_lost")),
        Step(
            "pilot takes over, PX4", ("tests.benchmarks.takeover", "--times", share(200, scale, 2), *to), ("takeover",)
        ),
        Step(
            "pilot takes over, ArduCopter",
            ("tests.benchmarks.takeover", "--flavour", "ardupilot", "--times", share(200, scale, 2), *to),
            ("takeover",),
        ),
        Step(
            "odd requests and messages",
            ("pytest", "tests/fuzz", "--timeout", "86400", "-q"),
            ("fuzz_requests", "fuzz_messages", "fuzz_failures"),
            fuzz,
        ),
        Step("1010 half-sent requests", ("tests.benchmarks.half_sent", *to), ("half_sent", "half_sent_lost")),
        Step("links, vehicle and replay", ("pytest", "-q", "-m", "system", *TESTED), ()),
    ]


TESTED = ("tests/system/test_links.py", "tests/system/test_faults.py", "tests/system/test_backup.py")
"""Figures 9 and 13: what these assert is not counted, it holds or it does not."""


def run(step: Step) -> bool:
    return subprocess.run([sys.executable, "-m", *step.command], env={**os.environ, **step.environment}).returncode == 0


def verdicts(records: Sequence[Record], keys: Sequence[str], scale: float) -> list[tuple[bool, str]]:
    """(met, a line) for each wanted figure; one that nobody measured is missed."""
    lines: list[tuple[bool, str]] = []
    for key in dict.fromkeys(keys):
        want = BY_KEY[key]
        found = [f for record in records for f in record.figures if f.wanted is not None and f.wanted.key == key]
        if not found:
            lines.append((False, f"{want.number:>3}  not measured  {want.what}"))
        for figure in found:
            least = want.at_least
            if key in EFFORT and least is not None:
                met = figure.value >= least * scale
                bound = f"at least {least * scale:g} (this run's share of {least:g})"
            else:
                met = bool(figure.met)
                bound = f"at least {least:g}" if least is not None else f"at most {want.at_most:g}"
            standing = "met" if met else "MISSED"
            lines.append(
                (met, f"{want.number:>3}  {standing:12}  {figure.name}: {figure.value:g} {figure.unit} ({bound})")
            )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign", choices=("soak", "chaos"))
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--out", type=Path, help="keep the records here; they count only at full scale")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix=f"crossfix-{given.campaign}-") as folder:
        out: Path = given.out or Path(folder)
        steps = {"soak": soak, "chaos": chaos}[given.campaign](given.scale, out)
        broken: list[str] = []
        for number, step in enumerate(steps, start=1):
            print(f"\n[{number}/{len(steps)}] {step.what}", flush=True)
            began = time.monotonic()
            if not run(step):
                broken.append(step.what)
            print(f"      {time.monotonic() - began:.0f} s", flush=True)
        lines = verdicts(read_all(out), [key for step in steps for key in step.keys], given.scale)
    print(f"\nNo.  standing      figure ({given.campaign}, scale {given.scale:g})")
    print("\n".join(line for _, line in lines))
    for what in broken:
        print(f"  -  MISSED        {what}: the benchmark ended with an error")
    missed = sum(not met for met, _ in lines) + len(broken)
    print(f"{missed} missed." if missed else "Nothing missed.")
    sys.exit(bool(missed))


if __name__ == "__main__":
    main()
