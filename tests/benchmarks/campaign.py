"""Endurance and trouble, one benchmark after the other, and what came of the wanted figures.

    python -m tests.benchmarks.campaign soak            (or: make soak; half an hour)
    python -m tests.benchmarks.campaign chaos           (or: make chaos; hours)
    python -m tests.benchmarks.campaign chaos --short   (or: make chaos SHORT=1; about five minutes)
    python -m tests.benchmarks.campaign chaos --only full half

scale: share of the full effort. Figures that count effort itself (kills, requests, minutes) are wanted in this share,
and marked so; everything else is wanted as it is. only: the steps whose name has one of these words.

Beside each step stands what other programs took of the machine before or after it. A missed time on a busy machine is
no verdict on the server, and is marked so: measure it again when the machine is idle. A fact that was lost is a defect
at any load. Ends with status 1 when a figure is missed or was not measured or a benchmark failed, with 3 when nothing
but times on a busy machine was missed.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import psutil

from tests.benchmarks.figures.reader import read_all
from tests.benchmarks.figures.record import Record
from tests.benchmarks.figures.wanted import BY_KEY

EFFORT = frozenset({"kills", "outage_minutes", "fuzz_requests", "fuzz_messages"})
TIMES = frozenset({"ms", "s"})
"""Units of what a busy machine makes worse."""
BUSY_SHARE = 0.25
"""Of all cores, taken by other programs: above it, a time that is missed says nothing."""
LOOK_S = 2.0
SHORT_SCALE = 0.004
DEFECT, UNDECIDED = 1, 3
"""Exit statuses."""
LAST_LINES = 12


@dataclass(frozen=True, slots=True)
class Step:
    """keys: the wanted figures that it measures. environment: besides this process's own. within_s: it hangs when it
    takes longer."""

    what: str
    command: tuple[str, ...]
    keys: tuple[str, ...] = ()
    environment: Mapping[str, str] = field(default_factory=dict[str, str])
    within_s: float = 24 * 3600.0


@dataclass(frozen=True, slots=True)
class Ran:
    """How a step went. status: of its process; None: it hung and was ended. others_share: of all cores, taken
    by other programs, before or after it, whichever is more."""

    status: int | None
    seconds: float
    others_share: float
    said: str

    @property
    def how(self) -> str:
        """In words."""
        end = "hung" if self.status is None else f"ended with status {self.status}"
        return f"{end} after {self.seconds:.0f} s; other programs took {self.others_share:.0%} of the machine"

    @property
    def busy(self) -> bool:
        """Are its times about this machine's other work?"""
        return self.others_share > BUSY_SHARE


def share(full: float, scale: float, least: int) -> str:
    return str(max(least, round(full * scale)))


def soak(scale: float, out: Path, short: bool) -> list[Step]:
    load, to = "tests.benchmarks.live_load", ("--out", str(out))
    return [
        Step(
            "a hundred viewers, five of them stalled",
            (load, "fanout", "--seconds", share(600, scale, 60), *to),
            ("fanout", "fanout_memory"),
        ),
        Step("aborts under load", (load, "abort", "--times", share(200, scale, 10), *to), ("abort",)),
        Step(
            "files from outside",
            ("tests.benchmarks.hostile_uploads", *to),
            ("upload_abort", "upload_memory", "upload_answer"),
        ),
    ]


def chaos(scale: float, out: Path, short: bool) -> list[Step]:
    to = ("--out", str(out))
    storage, killed = "tests.benchmarks.storage_faults", ("kills", "kill_lost", "kill_beliefs", "restart")
    fuzz = {
        "CROSSFIX_FUZZ_OUT": str(out),
        "CROSSFIX_FUZZ_REQUESTS": share(100_000, scale, 100),
        "CROSSFIX_FUZZ_MESSAGES": share(100_000, scale, 100),
    }
    kills = share(1000, scale, 4)
    steps = [
        Step("kill -9, SQLite", ("tests.benchmarks.kill_loop", "--kills", kills, *to), killed),
        Step(
            "kill -9, PostgreSQL",
            ("tests.benchmarks.kill_loop", "--database", "postgresql", "--kills", kills, *to),
            killed,
        ),
        *(
            Step(
                f"random stories, {name}",
                ("tests.benchmarks.random_stories", "--flavour", flavour, "--stories", share(250, scale, 3), *to),
                ("out_of_reach", "stories"),
            )
            for flavour, name in (("px4", "PX4"), ("ardupilot", "ArduCopter"))
        ),
        Step(
            "database away",
            (storage, "outage", "--minutes", str(max(0.5, 10 * scale)), *to),
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
            ("pytest", "tests/fuzz", "-n", "2", "--timeout", "86400", "-q"),
            ("fuzz_requests", "fuzz_messages", "fuzz_failures"),
            fuzz,
        ),
        Step(
            "1010 half-sent requests",
            ("tests.benchmarks.half_sent", "--seconds", "30" if short else "60", *to),
            ("half_sent", "half_sent_lost"),
        ),
    ]
    if not short:  # they belong to `make test` as well
        steps.append(Step("links, vehicle and replay", ("pytest", "-q", "-m", "system", *TESTED)))
    return steps


TESTED = ("tests/system/test_links.py", "tests/system/test_faults.py", "tests/system/test_backup.py")
"""Figures 9 and 13: what these assert is not counted, it holds or it does not."""
SHORT_WITHIN_S = 600.0
"""A step of a short run, on a busy machine too."""


def run(step: Step, log: Path) -> Ran:
    """Its output goes to a file, and its own processes end with it."""
    others_share, began = _busy_share(), time.monotonic()
    with log.open("wb") as said:
        process = subprocess.Popen(
            [sys.executable, "-m", *step.command],
            env={**os.environ, **step.environment},
            stdout=said,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            status: int | None = process.wait(step.within_s)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
    seconds = time.monotonic() - began
    time.sleep(LOOK_S)  # what it started and killed comes to its end
    return Ran(status, seconds, max(others_share, _busy_share()), log.read_text(errors="replace"))


def _busy_share() -> float:
    """Of all cores, now: a step's own processes cannot be told from others while it runs, since it kills some of them,
    and the system counts those for nobody."""
    return psutil.cpu_percent(LOOK_S) / 100.0


@dataclass(frozen=True, slots=True)
class Verdict:
    """key: of the wanted figure, "" where a benchmark itself failed. standing: "met", "MISSED", or "undecided" on a
    busy machine: a time that was missed, or nothing measured at all."""

    key: str
    standing: str
    line: str


def verdicts(records: Sequence[Record], keys: Mapping[str, bool], scale: float) -> list[Verdict]:
    """Of each wanted figure. keys: and whether the machine was busy when it was measured."""
    lines: list[Verdict] = []
    for key, busy in keys.items():
        want = BY_KEY[key]
        found = [f for record in records for f in record.figures if f.wanted is not None and f.wanted.key == key]
        if not found:
            standing = "undecided" if busy else "MISSED"
            lines.append(Verdict(key, standing, f"{want.number:>3}  {standing:12}  {want.what}: not measured"))
        for figure in found:
            least = want.at_least
            if key in EFFORT and least is not None:
                met = figure.value >= least * scale
                bound = f"at least {least * scale:g} (this run's share of {least:g})"
            else:
                met = bool(figure.met)
                bound = f"at least {least:g}" if least is not None else f"at most {want.at_most:g}"
            standing = "met" if met else "undecided" if busy and figure.unit in TIMES else "MISSED"
            lines.append(
                Verdict(
                    key,
                    standing,
                    f"{want.number:>3}  {standing:12}  {figure.name}: {figure.value:g} {figure.unit} ({bound})",
                )
            )
    return lines


def of_failures(ran: Sequence[tuple[Step, Ran]], found: Sequence[Verdict]) -> list[Verdict]:
    """Of the benchmarks that ended with an error which no figure of theirs explains."""
    missed = {verdict.key for verdict in found if verdict.standing != "met"}
    return [
        Verdict("", "MISSED", f"  -  {'MISSED':12}  {step.what}: it {result.how}")
        for step, result in ran
        if result.status != 0 and missed.isdisjoint(step.keys)
    ]


def campaign(steps: Sequence[Step], logs: Path) -> list[tuple[Step, Ran]]:
    """Runs them."""
    ran: list[tuple[Step, Ran]] = []
    for number, step in enumerate(steps, start=1):
        print(f"\n[{number}/{len(steps)}] {step.what}", flush=True)
        result = run(step, logs / f"step-{number}.log")
        ran.append((step, result))
        print(f"      {result.how}, load {os.getloadavg()[0]:.1f}", flush=True)
        if result.status != 0:
            print("\n".join(f"      | {line}" for line in result.said.splitlines()[-LAST_LINES:]), flush=True)
    return ran


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign", choices=("soak", "chaos"))
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--short", action="store_true", help="about five minutes on an idle machine")
    parser.add_argument("--only", nargs="+", metavar="WORD", help="the steps with one of these words in their name")
    parser.add_argument("--out", type=Path, help="keep the records here; they count only at full scale")
    given = parser.parse_args()
    scale = SHORT_SCALE if given.short else given.scale
    with tempfile.TemporaryDirectory(prefix=f"crossfix-{given.campaign}-") as folder:
        kept: Path = given.out or Path(folder)
        steps = [
            replace(step, within_s=SHORT_WITHIN_S) if given.short else step
            for step in {"soak": soak, "chaos": chaos}[given.campaign](scale, kept, given.short)
            if given.only is None or any(word in step.what for word in given.only)
        ]
        ran = campaign(steps, Path(folder))
        busy: dict[str, bool] = {}
        for step, result in ran:
            busy |= {key: result.busy or busy.get(key, False) for key in step.keys}
        found = verdicts(read_all(kept), busy, scale)
    found += of_failures(ran, found)
    print(f"\nNo.  standing      figure ({given.campaign}, scale {scale:g})")
    print("\n".join(verdict.line for verdict in found))
    counts = Counter(verdict.standing for verdict in found)
    if not counts["MISSED"] and not counts["undecided"]:
        print("Nothing missed.")
        return
    print(f"{counts['MISSED']} missed; {counts['undecided']} undecided, since other programs kept the machine busy.")
    sys.exit(DEFECT if counts["MISSED"] else UNDECIDED)


if __name__ == "__main__":
    main()
