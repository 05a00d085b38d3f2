"""Random kills -9 in flight (figure 8): is every acknowledged fact there, is the belief identical, how soon is HOLD?

    python -m tests.benchmarks.kill_loop --kills 1000 --database sqlite
    python -m tests.benchmarks.kill_loop --kills 1000 --database postgresql
    python -m tests.benchmarks.kill_loop --kills 30 --away 6.2 7.0 --whole 0     restarts as the failsafe begins
    python -m tests.benchmarks.kill_loop --kills 12 --whole 1 --speedup 1        when a whole start holds the vehicle
    python -m tests.benchmarks.kill_loop --kills 50 --pieces 8 --seed 40 --add --out docs/measurements
                                                                                 400 more, kept after each 50

The real server over real sockets flies the simulated vehicle, which lives in a process of its own and flies on. A
server is a fork of a process that has imported everything, so that a thousand restarts take two hours rather than
five; every `--whole`-th is a whole `crossfix serve`. A fact counts as acknowledged once the websocket has shown it.
Nobody touches the sticks: a takeover is a failsafe taken for a pilot. Prints one JSON object; ends with status 1 when
anything was lost, doubled, changed, late or taken for a pilot.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pieces import figures_kept, rows_kept
from tests.benchmarks.figures.writer import add_out, write
from tests.benchmarks.kill_findings import HIGH_LOAD, Findings, figures, runs
from tests.conftest import PostgresCluster, postgres_programs, postgres_user
from tests.system.console import Console, Event, console, simulated_vehicle

START_PATIENCE_S = 120.0
DOWN = "ground"
"""The craft's last phase: the mission has ended and it is down."""
FLYING = ("taking_off", "planning", "flying", "measuring")
"""The mission in the server's hands: no phase in which one is after a restart."""
STEERING = (176, 192)
"""MAV_CMD_DO_SET_MODE, MAV_CMD_DO_REPOSITION: the commands that hold a vehicle."""
LONG_SEARCH = {"localization": {"expected_rmse_m": 1.0, "maximum_bearings": 60}, "planner": {"budget": 400}}


def arguments(folder: Path, database: str | None, speedup: float, seed: int) -> list[str]:
    given = ["--port", "0", "--data-dir", str(folder), "--speedup", str(speedup), "--seed", str(seed), "--json"]
    return given + (["--database", database] if database else [])


def zygote() -> None:
    """Reads one line a server: its arguments. Forks it, and says its process id on standard error."""
    from backend.cli import serve as _serve  # noqa: F401 (what takes seconds to import)
    from backend.cli.main import app

    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    for line in sys.stdin:
        pid = os.fork()
        if pid == 0:
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            os.close(0)
            app(["serve", *json.loads(line)], prog_name="crossfix", standalone_mode=True)
            os._exit(0)
        print(pid, file=sys.stderr, flush=True)


@dataclass
class Server:
    url: str
    pid: int
    began: float

    def kill(self) -> None:
        os.kill(self.pid, signal.SIGKILL)

    async def gone(self) -> None:
        """As a supervisor waits before it starts the next one."""
        async with asyncio.timeout(10):
            while not ended(self.pid):  # noqa: ASYNC110 (another process)
                await asyncio.sleep(0.005)


def ended(pid: int) -> bool:
    with suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    return True


class Servers:
    """Starts them one after the other, forked or whole."""

    def __init__(self, given: list[str]) -> None:
        self._given = given
        self._zygote: asyncio.subprocess.Process | None = None

    async def forked(self) -> Server:
        if self._zygote is None:
            self._zygote = await asyncio.create_subprocess_exec(
                sys.executable, "-m", "tests.benchmarks.kill_loop", "zygote",
                stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
            )  # fmt: skip
        process = self._zygote
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        began = time.monotonic()
        process.stdin.write(json.dumps(self._given).encode() + b"\n")
        words = await process.stderr.readline()
        while not words.strip().isdigit():
            words = await process.stderr.readline()
            if not words:
                raise RuntimeError("the process that forks servers is gone")
        try:
            url = json.loads(await asyncio.wait_for(process.stdout.readline(), START_PATIENCE_S))["url"]
        except TimeoutError:
            said = b""
            with suppress(TimeoutError):
                said = await asyncio.wait_for(process.stderr.read(4096), 1)
            os.kill(int(words), signal.SIGKILL)
            raise RuntimeError(f"no server answers after {START_PATIENCE_S:.0f} s; it said: {said.decode()}") from None
        return Server(url, int(words), began)

    async def whole(self) -> Server:
        began = time.monotonic()
        process = await asyncio.create_subprocess_exec(
            str(Path(sys.executable).with_name("crossfix")), "serve", *self._given,
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.DEVNULL,
        )  # fmt: skip
        assert process.stdout is not None
        url = json.loads(await asyncio.wait_for(process.stdout.readline(), START_PATIENCE_S))["url"]
        return Server(url, process.pid, began)

    async def close(self) -> None:
        if self._zygote is not None and self._zygote.stdin is not None:
            self._zygote.stdin.close()
            await self._zygote.wait()


def taken_by_a_pilot(event: dict[str, Any]) -> bool:
    return event["kind"] == "authority_changed" and event["authority"]["who"] == "pilot"


def silence_answered(event: dict[str, Any]) -> bool:
    """The autopilot's failsafe acted because it heard nothing from us."""
    reason = event.get("reason") or {}
    return reason.get("code") == "failsafe_flies" and reason["because"] == "silence"


def last_beliefs(events: list[Event]) -> dict[str, tuple[tuple[str, ...], str]]:
    """By emitter: (ids of all bearings and legs, digest) of its last belief, none where any of those came after it:
    what is heard of one emitter tells of the compass, and so counts for the others."""
    heard = list[str]()
    known = dict[str, tuple[tuple[str, ...], str]]()
    for recorded in events:
        event = recorded["event"]
        if event["kind"] in ("bearing_measured", "heard_on_the_way"):
            heard.append(event.get("bearing_id") or event["leg_id"])
        elif event["kind"] == "belief_updated":
            known[event["emitter_id"]] = (tuple(heard), event["digest"])
    return {name: belief for name, belief in known.items() if belief[0] == tuple(heard)}


async def phase_after_restart(client: httpx.AsyncClient, mission_id: str) -> str:
    """Asked again while the database is too busy to answer (503), as a page does, until the restart is recorded."""
    async with asyncio.timeout(30):
        while True:
            answer = await client.get(f"/api/missions/{mission_id}")
            assert answer.status_code in (200, 503), f"the mission is not there any more: {answer.text}"
            if answer.status_code == 200 and answer.json()["phase"] not in FLYING:
                return answer.json()["phase"]
            await asyncio.sleep(0.02)


async def vehicle_time(folder: Path) -> float | None:
    """Seconds since the simulated vehicle was switched on, None before there is one."""
    if not (folder / "simulated_vehicle.json").exists():
        return None
    return (await (await simulated_vehicle(folder)).order("ping"))["time_s"]


async def told_after_s(folder: Path, since_s: float | None, speedup: float) -> float | None:
    """Seconds of wall time from `since_s` until the vehicle was told to hold, None when it was not."""
    if since_s is None:
        return None
    sent = (await (await simulated_vehicle(folder)).order("commands", since_s=since_s))["commands"]
    return next(((at - since_s) / speedup for at, number in sent if number in STEERING), None)


async def all_shown(shown: Console, count: int) -> None:
    """Wait for this number of events; reopen the websocket when a busy server closed it, as the page does."""
    async with asyncio.timeout(60):
        while len(shown.events) < count:
            if shown.cut_off:
                shown.events.clear()
                await shown.watch()
            await asyncio.sleep(0.05)


async def new_mission(shown: Console) -> None:
    await shown.draft(**LONG_SEARCH)
    await shown.ready()
    await shown.watch()
    await shown.start(120)


async def fly_until_killed(server: Server, shown: Console, folder: Path, chance: random.Random) -> None:
    """Resume, fly for a while, kill."""
    vehicle = await simulated_vehicle(folder)
    await vehicle.order("battery", percent=100)
    if shown.phases[-1:] == ["hold"]:
        await shown.order("resume")
    await asyncio.sleep(chance.uniform(0.0, 3.0))
    server.kill()


async def compare(shown: Console, before: list[Event], found: Findings) -> None:
    """What was shown before the kill is there unchanged, and the belief comes back the same."""
    await all_shown(shown, len(before))
    found.lost += sum(one != two for one, two in zip(before, shown.events, strict=False))
    found.lost += sum(r["seq"] != n for n, r in enumerate(shown.events, 1))
    known = last_beliefs(before)
    if not known or shown.phases[-1:] != ["hold"]:
        return
    restarts = len(shown.of("server_restarted"))

    def rebuilt_or_over() -> bool:
        if shown.phases[-1] == DOWN:
            return True
        kinds = [r["event"]["kind"] for r in shown.events]
        since = len(kinds) - kinds[::-1].index("server_restarted") if restarts else len(kinds)
        told = {r["event"]["emitter_id"] for r in shown.events[since:] if r["event"]["kind"] == "belief_updated"}
        return known.keys() <= told

    await shown.until(rebuilt_or_over, 30)
    again = last_beliefs(shown.events)
    same = [name for name in known if name in again and again[name][0] == known[name][0]]
    found.beliefs_compared += len(same)
    found.beliefs_changed += sum(again[name][1] != known[name][1] for name in same)


async def loop(
    kills: int, folder: Path, database: str | None, speedup: float, seed: int, whole: int, away: tuple[float, float]
) -> Findings:
    chance, found = random.Random(seed), Findings()
    servers, server = Servers(arguments(folder, database, speedup, seed)), None
    mission_id, before, seen = "", list[Event](), 0
    try:
        while True:
            kind = "whole" if whole and found.kills % whole == whole - 1 else "forked"
            since_s = await vehicle_time(folder)
            server = await (servers.whole() if kind == "whole" else servers.forked())
            async with console(server.url) as shown:
                if mission_id:
                    shown.mission_id = mission_id
                    phase = await phase_after_restart(shown.client, mission_id)
                    found.found_in[phase] += 1
                    if phase == "hold":
                        found.hold_s[kind].append(time.monotonic() - server.began)
                        told = await told_after_s(folder, since_s, speedup)
                        if told is not None:
                            found.told_s[kind].append(told)
                    await shown.watch()
                    await compare(shown, before, found)
                if found.kills >= kills:
                    if mission_id and shown.phases[-1] != DOWN:
                        await shown.order("abort")
                    vehicle = await simulated_vehicle(folder)
                    server.kill()
                    await vehicle.stop()
                    return found
                if not mission_id or shown.phases[-1] == DOWN:
                    await shown.close()
                    shown.events.clear()
                    await new_mission(shown)
                    mission_id, seen = shown.mission_id, 0
                    found.missions += 1
                known = len(shown.events) if before else 0
                await fly_until_killed(server, shown, folder, chance)
                await server.gone()
                await asyncio.sleep(0.05)  # what was sent before the kill is read
                before = list(shown.events)
                found.kills += 1
                found.phases[shown.phases[-1] if shown.phases else "draft"] += 1
                new = before[known:]
                found.acknowledged += len(new)
                found.bearings += sum(r["event"]["kind"] == "bearing_measured" for r in new)
                since_kill = before[seen:]
                seen = len(before)
                found.taken_for_a_pilot += sum(taken_by_a_pilot(r["event"]) for r in since_kill)
                found.late_failsafes += sum(silence_answered(r["event"]) for r in since_kill)
            await asyncio.sleep(chance.uniform(*away))
            if sys.stderr.isatty() or found.kills % 20 == 0:
                print(json.dumps(found.summary()), file=sys.stderr, flush=True)
    except BaseException:
        print(json.dumps(found.summary()), file=sys.stderr, flush=True)
        raise
    finally:
        if server is not None:
            with suppress(ProcessLookupError):
                server.kill()
        await servers.close()


@asynccontextmanager
async def postgres_cluster() -> AsyncIterator[PostgresCluster]:
    """A cluster of its own, running."""
    programs, user = postgres_programs(), postgres_user()
    if programs is None:
        raise SystemExit("no PostgreSQL programs (initdb, postgres) on this machine")
    with tempfile.TemporaryDirectory(prefix="crossfix-postgresql-", ignore_cleanup_errors=True) as folder:
        cluster = PostgresCluster(programs, Path(folder), user)
        await asyncio.to_thread(cluster.give_folder)
        await asyncio.to_thread(cluster.create)
        await asyncio.to_thread(cluster.start)
        try:
            yield cluster
        finally:
            cluster.stop()


@asynccontextmanager
async def database_url(kind: str) -> AsyncIterator[str | None]:
    """None: SQLite in the data directory."""
    if kind == "sqlite":
        yield None
        return
    async with postgres_cluster() as cluster:
        yield await asyncio.to_thread(cluster.new_database)


def warm_up() -> None:
    """Into numba's cache, or every server that is killed while it compiles leaves the work to the next."""
    from backend.wiring import _warm_up

    _warm_up()


async def run(kills: int, database: str, speedup: float, seed: int, whole: int, away: tuple[float, float]) -> Findings:
    await asyncio.to_thread(warm_up)
    with tempfile.TemporaryDirectory(prefix="crossfix-kills-") as folder:
        async with database_url(database) as url:
            return await loop(kills, Path(folder), url, speedup, seed, whole, away)


def main() -> None:
    if sys.argv[1:] == ["zygote"]:
        zygote()
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=int(os.environ.get("CROSSFIX_KILLS", "20")))
    parser.add_argument("--database", choices=("sqlite", "postgresql"), default="sqlite")
    parser.add_argument("--speedup", type=float, default=12.0)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--whole", type=int, default=10, metavar="N", help="every N-th start is a whole one; 0: none")
    parser.add_argument("--away", type=float, nargs=2, default=(0.0, 0.0), metavar="S", help="no server for so long")
    parser.add_argument("--pieces", type=int, default=1, metavar="N", help="how many runs, each with the next seed")
    parser.add_argument("--add", action="store_true", help="to the runs of the record that is there")
    add_out(parser)
    given = vars(parser.parse_args())
    out, pieces, add, first = (given.pop(name) for name in ("out", "pieces", "add", "seed"))
    good = [piece(given | {"seed": seed}, out, add=add or seed > first) for seed in range(first, first + pieces)]
    sys.exit(not all(good))


def piece(given: dict[str, Any], out: Path | None, *, add: bool) -> bool:
    """One run and its record. given: the arguments of `run`. add: to the runs of before. False: see `Findings.good`."""
    begun = begin(__file__)
    found = asyncio.run(run(**given))
    print(json.dumps(found.summary(), indent=2), flush=True)
    database = {"sqlite": "SQLite", "postgresql": "PostgreSQL"}[given["database"]]
    name, title = "kill", "Kill -9"
    if given["whole"] == 1:
        name, title = "whole_starts", "Whole starts after kill -9"
        if begun.load >= HIGH_LOAD:
            name, title = f"{name}_loaded", f"{title} on a busy machine"
    name, title = f"{name}_{given['database']}", f"{title}, {database}"
    before = out if add else None
    table = rows_kept(before, name, runs(found, begun, given["seed"]))
    made = figures_kept(before, name, figures(found, table, database, begun.load))
    remark = "commit, date and load: of the last run; the table has those of each" if len(table.rows) > 1 else ""
    write(out, name, title, begun, made, tables=[table], page="faults-in-flight.md#kill--9", remark=remark)
    return found.good


if __name__ == "__main__":
    main()
