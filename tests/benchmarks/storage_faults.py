"""The database goes away in flight (figure 15): does the flight go on, is everything stored exactly once afterwards?

    python -m tests.benchmarks.storage_faults outage --minutes 10
    python -m tests.benchmarks.storage_faults full-disk

outage: PostgreSQL loses its power in flight and comes back minutes later. full-disk: SQLite and its spool live in a
file system of a few megabytes (tmpfs; needs root) that is filled in flight, and emptied again. A whole server flies the
simulated vehicle; what the websocket showed is compared with what the database holds afterwards. Prints one JSON
object; ends with status 1 when a fact was lost, doubled or changed, when the flight stood still, or when the warning of
the full disk took longer than 2 s.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import select
from sqlalchemy.ext.asyncio import create_async_engine

from backend.cli.running import running_server
from backend.settings import Settings
from backend.store.tables import events, sweeps
from hardware.sim.autopilot.launch import SimulatedAutopilot
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.kill_loop import postgres_cluster
from tests.system.console import Console, console, simulated_vehicle

LONG_SEARCH = {"localization": {"expected_rmse_m": 0.1, "maximum_bearings": 200}, "planner": {"budget": 400}}
WARNED_WITHIN_S = 2.0
SMALL_DISK_MB = 32
FULL_FOR_S = 20.0


def database_state(shown: Console) -> str:
    return shown.messages["status"][-1]["database"]


async def fly_to_first_bearing(shown: Console) -> None:
    await shown.draft(**LONG_SEARCH)
    await shown.ready(60)
    await shown.watch()
    assert (await shown.order("start"))["accepted"]
    await shown.until_event("bearing_measured", wall_s=120)


async def fly_on(shown: Console, vehicle: SimulatedAutopilot, seconds: float) -> None:
    """The battery is kept full and the operator lets the search go on."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        await vehicle.order("battery", percent=100)
        await asyncio.sleep(min(5.0, max(0.0, until - time.monotonic())))


async def stored(url: str, mission_id: str) -> tuple[list[tuple[int, str]], set[str]]:
    """((seq, body) of the mission's events, the ids of its sweeps) as the database holds them."""
    engine = create_async_engine(url)
    try:
        async with engine.connect() as connection:
            rows = select(events.c.seq, events.c.body).where(events.c.mission_id == mission_id).order_by(events.c.seq)
            kept = select(sweeps.c.sweep_id).where(sweeps.c.mission_id == mission_id)
            said = [(int(seq), str(body)) for seq, body in await connection.execute(rows)]
            return said, {str(sweep_id) for (sweep_id,) in await connection.execute(kept)}
    finally:
        await engine.dispose()


async def finding(settings: Settings, shown: Console, before: int, during: int, waiting: int) -> dict[str, Any]:
    """Ends the flight and compares. before, during: facts shown until the fault began and until it ended."""
    held = await shown.order("hold")
    assert held["accepted"], f"{held['reason']} (phases: {shown.phases[-4:]})"
    await shown.until(lambda: database_state(shown) == "ok", 60)
    await shown.until_phase("hold")
    await asyncio.sleep(2.0)
    told = {recorded["seq"]: recorded["event"] for recorded in shown.events}
    rows, kept = await stored(settings.async_database_url, shown.mission_id)
    read = {seq: json.loads(body) for seq, body in rows}
    bearings = shown.of("bearing_measured")
    lost = [seq for seq, event in told.items() if read.get(seq) != event]
    return {
        "facts_before": before,
        "facts_during": during - before,
        "bearings_during": sum(before < recorded["seq"] <= during for recorded in bearings),
        "most_entries_waiting": waiting,
        "facts_shown": len(told),
        "facts_stored": len(rows),
        "lost_doubled_or_changed": len(lost)
        + (len(rows) - len(read))
        + sum(seq != n for n, (seq, _) in enumerate(rows, 1)),
        "bearings_without_sweep": sum(recorded["event"]["sweep_id"] not in kept for recorded in bearings),
    }


async def outage(minutes: float, speedup: float, seed: int) -> dict[str, Any]:
    with tempfile.TemporaryDirectory(prefix="crossfix-outage-") as folder:
        async with postgres_cluster() as cluster:
            url = await asyncio.to_thread(cluster.new_database)
            settings = Settings(port=0, data_dir=Path(folder), database_url=url, time_factor=speedup, seed=seed)
            async with running_server(settings) as server, console(server.url) as shown:
                await fly_to_first_bearing(shown)
                vehicle = await simulated_vehicle(Path(folder))
                before = len(shown.events)
                await asyncio.to_thread(cluster.stop)
                await fly_on(shown, vehicle, 60.0 * minutes)
                during, waiting = len(shown.events), server.services.journal.report().spooled
                await asyncio.to_thread(cluster.start)
                began = time.monotonic()
                await shown.until(lambda: database_state(shown) == "ok", 120)
                drained_s = time.monotonic() - began
                found = await finding(settings, shown, before, during, waiting)
    return {"away_minutes": minutes, "drained_after_s": round(drained_s, 2), **found}


@contextmanager
def small_disk() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="crossfix-small-") as folder:
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SMALL_DISK_MB}m", "tmpfs", folder], check=True)
        try:
            yield Path(folder)
        finally:
            subprocess.run(["umount", "--lazy", folder], check=True)


def fill(disk: Path) -> Path:
    """A file that takes every block that is left."""
    ballast = disk / "ballast"
    with ballast.open("wb", buffering=0) as file:
        try:
            while file.write(bytes(65536)):
                pass
        except OSError:
            return ballast
    raise RuntimeError("the disk took everything")


async def full_disk(speedup: float, seed: int) -> dict[str, Any]:
    with small_disk() as disk:
        settings = Settings(port=0, data_dir=disk, time_factor=speedup, seed=seed, disk_low_bytes=0)
        async with running_server(settings) as server, console(server.url) as shown:
            await fly_to_first_bearing(shown)
            vehicle = await simulated_vehicle(disk)
            before, began = len(shown.events), time.monotonic()
            ballast = await asyncio.to_thread(fill, disk)
            await shown.until(lambda: database_state(shown) != "ok", 30)
            warned_s = time.monotonic() - began
            await fly_on(shown, vehicle, FULL_FOR_S)
            during, waiting = len(shown.events), server.services.journal.report().spooled
            ballast.unlink()
            found = await finding(settings, shown, before, during, waiting)
    return {"disk_full_s": FULL_FOR_S, "warned_after_s": round(warned_s, 2), **found}


def outage_figures(found: dict[str, Any]) -> list[Figure]:
    return [
        wanted("outage_minutes", found["away_minutes"]),
        wanted("outage_lost", found["lost_doubled_or_changed"]),
        plain("all stored after it was back", found["drained_after_s"], "s"),
        *shared_figures(found),
    ]


def full_disk_figures(found: dict[str, Any]) -> list[Figure]:
    return [
        wanted("disk_full", found["warned_after_s"]),
        wanted("disk_full_lost", found["lost_doubled_or_changed"]),
        *shared_figures(found),
    ]


def shared_figures(found: dict[str, Any]) -> list[Figure]:
    return [
        plain("facts meanwhile", found["facts_during"], ""),
        plain("bearings meanwhile", found["bearings_during"], ""),
        plain("most entries waiting on disk", found["most_entries_waiting"], ""),
        plain("facts shown", found["facts_shown"], ""),
        plain("facts stored", found["facts_stored"], ""),
        plain("bearings without their sweep", found["bearings_without_sweep"], ""),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fault", choices=("outage", "full-disk"))
    parser.add_argument("--minutes", type=float, default=1.0, help="how long the database is away")
    parser.add_argument("--speedup", type=float, default=2.0)
    parser.add_argument("--seed", type=int, default=3)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    if given.fault == "outage":
        result = asyncio.run(outage(given.minutes, given.speedup, given.seed))
        name, title, made = "storage_outage", "Database away", outage_figures(result)
    else:
        result = asyncio.run(full_disk(given.speedup, given.seed))
        name, title, made = "storage_full_disk", "Full disk", full_disk_figures(result)
    print(json.dumps(result, indent=2))
    write(given.out, name, title, begun, made, page="faults-in-flight.md#storage")
    good = not result["lost_doubled_or_changed"] and not result["bearings_without_sweep"] and result["bearings_during"]
    sys.exit(not (good and result.get("warned_after_s", 0.0) <= WARNED_WITHIN_S))


if __name__ == "__main__":
    main()
