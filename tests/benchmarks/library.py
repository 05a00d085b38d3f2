"""The library at scale (figure 27): 5,000 missions with 500,000 bearings, listed, searched, opened by a whole server.

    python -m tests.benchmarks.library --database sqlite
    python -m tests.benchmarks.library --database postgresql
    python -m tests.benchmarks.library --database postgresql://user@host/empty

Times are of the whole request on the loopback, so they are no less than the server's own. Storage is what the database
grows by when flights of an hour are written to it: as retention leaves them, and as they are written.
"""

from __future__ import annotations

import argparse
import asyncio
import statistics
import tempfile
import time
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from pathlib import Path

import httpx
from sqlalchemy import Table
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.cli.running import running_server
from backend.settings import Settings
from backend.store.digest import MissionDigest
from backend.store.engine import make_engine
from backend.store.opening import open_journal
from backend.store.retention import pack_paths
from backend.store.tables import events, paths, sweeps, tracks
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.kill_loop import postgres_cluster
from tests.benchmarks.library_stock import copy_id, counted, multiply, size_bytes, write_template

TIMES = 25
NOBODY = "udpin://127.0.0.1:7399"
"""No vehicle: a simulated one would compete for the processor."""
DATABASE_S = 60.0
"""On a machine that does much else: nothing may wait in a spool, where it is not measured."""
HOURS, HOUR_BEARINGS = 20, 66
"""Flights of an hour that storage is the mean of, with a bearing in 54 s as in the recorded flight."""


@dataclass(frozen=True, slots=True)
class Question:
    """paths: asked one after another, over and over. stated: one of those that the wanted figure is of. once: what
    counts is the first answer, for which nothing is kept yet."""

    name: str
    paths: Sequence[str]
    stated: bool = True
    once: bool = False


def questions(missions: int) -> list[Question]:
    """What the page asks: its list, the fields of its search, and what it reads when a mission is opened."""
    some = [f"/api/missions/{copy_id(number)}" for number in range(missions // 7, missions, max(1, missions // 5))]
    here = [f"box={7.2 + 0.01 * n:.3f},{50.62:.3f},{7.21 + 0.01 * n:.3f},{50.82:.3f}" for n in (3, 40, 77)]
    listed = "/api/missions?limit=50&"
    return [
        Question("list: first page", ["/api/missions?limit=50"]),
        Question("list: a page in the middle", [f"{listed}after=1730000000000000.{copy_id(0)}"]),
        Question("list: deleted", [f"{listed}deleted=true"]),
        Question("search: rectangle", [listed + box for box in here]),
        Question("search: dates", [f"{listed}since=2024-06-01T00:00:00Z&until=2024-06-08T00:00:00Z"]),
        Question("search: emitter", [f"{listed}emitter=148.35", f"{listed}emitter=lynx 21"]),
        Question("search: vehicle", [f"{listed}vehicle=kestrel"]),
        Question("search: result", [f"{listed}outcome=aborted"]),
        Question("search: text", [f"{listed}named=gravel", f"{listed}named=1234"]),
        Question("search: text that nothing has", [f"{listed}named=nowhere to be found"]),
        Question("search: all at once", [f"{listed}named=night&emitter=kite&outcome=localized&{here[1]}"]),
        Question("open: the mission", some),
        Question("open: its events", [f"{path}/events?limit=1000" for path in some]),
        Question("open: its belief", [f"{path}/beliefs" for path in some], stated=False),
        Question("calibration: 300 checked, never reckoned", ["/api/calibration"], stated=False, once=True),
        Question("calibration: the newest 300 checked", ["/api/calibration"], stated=False),
    ]


async def asked(url: str, question: Question) -> tuple[float, float]:
    """Median and 95th percentile, ms."""
    took: list[float] = []
    times = 0 if question.once else TIMES if question.stated else 1
    async with httpx.AsyncClient(base_url=url, timeout=600) as client:
        for number in range(times + 1):
            began = time.perf_counter()
            answer = await client.get(question.paths[number % len(question.paths)])
            took.append(1e3 * (time.perf_counter() - began))
            answer.raise_for_status()
    took = took if question.once else sorted(took[1:])
    return statistics.median(took), took[min(len(took) - 1, round(0.95 * len(took)))]


@asynccontextmanager
async def database(kind: str, folder: Path) -> AsyncIterator[str]:
    """An empty one: SQLite in `folder`, a cluster of our own, or the one that the URL names."""
    if kind == "postgresql":
        async with postgres_cluster() as cluster:
            yield Settings(database_url=await asyncio.to_thread(cluster.new_database)).async_database_url
    else:
        settings = Settings(data_dir=folder) if kind == "sqlite" else Settings(database_url=kind)
        yield settings.async_database_url


async def storage(kind: str) -> dict[str, float]:
    """Bytes of a flight hour: "facts"; "rows" of the path until it is packed; "samples" until they are taken; "packed",
    the path when its mission is over; "kept", what retention leaves of all of it."""
    sizes = await _grown(kind, ((events,), (events, tracks), (events, tracks, sweeps)))
    facts, with_path, whole = sizes
    (kept,) = await _grown(kind, ((events, paths),), packed=True)
    until = {"rows": with_path - facts, "samples": whole - with_path}
    return {"facts": facts, "packed": kept - facts, "kept": kept} | until


async def _grown(kind: str, written: Sequence[Sequence[Table]], packed: bool = False) -> list[float]:
    """By what a database grows with a flight hour when its rows of each of these groups of tables are written."""
    with tempfile.TemporaryDirectory(prefix="crossfix-library-") as folder:
        async with database(kind, Path(folder)) as url:
            flown, engine = await _laid_out(url, Path(folder), HOUR_BEARINGS, 3600.0, raw=not packed)
            if packed:
                assert await pack_paths(engine, datetime.now(UTC) + timedelta(days=1)) == 1
            sizes = [await size_bytes(engine)]
            for number, group in enumerate(written):
                await multiply(engine, flown, range(number * HOURS, (number + 1) * HOURS), group)
                sizes.append(await size_bytes(engine))
            await engine.dispose()
    return [(after - before) / HOURS for before, after in pairwise(sizes)]


async def _laid_out(
    url: str, folder: Path, bearings: int, track_s: float, raw: bool
) -> tuple[MissionDigest, AsyncEngine]:
    """The template, and a way into the database beside the server's."""
    settings = Settings(data_dir=folder, database_url=url, database_timeout_s=DATABASE_S)
    async with open_journal(settings, time.time) as journal:
        flown = await write_template(journal, bearings, track_s, raw)
    engine = make_engine(url, 60.0)
    return flown, engine


async def run(kind: str, missions: int, bearings: int) -> list[Figure]:
    """Fills an empty database, asks a server on it, and measures what a flight takes."""
    of = "PostgreSQL" if kind.startswith("postgres") else "SQLite"
    figures: list[Figure] = []
    with tempfile.TemporaryDirectory(prefix="crossfix-library-") as folder:
        async with database(kind, Path(folder)) as url:
            began = time.monotonic()
            flown, engine = await _laid_out(url, Path(folder), bearings, 0.0, raw=False)
            await multiply(engine, flown, range(missions))
            lie, taken = await counted(engine)
            size = await size_bytes(engine)
            await engine.dispose()
            took_s = time.monotonic() - began
            print(f"{lie} missions, {taken} bearings, {size / 1e9:.2f} GB, laid in within {took_s:.0f} s")
            settings = Settings(
                data_dir=Path(folder),
                database_url=url,
                database_timeout_s=DATABASE_S,
                port=0,
                vehicle_url=NOBODY,
                receiver="simulated",
            )
            async with running_server(settings) as server:
                for question in questions(missions):
                    median, high = await asked(server.url, question)
                    print(f"{question.name:38s} median {median:7.1f} ms, 95 % {high:7.1f} ms", flush=True)
                    figures.append(
                        plain(f"{of}: {question.name}", round(high, 1), "ms", note=f"median {median:.1f} ms")
                    )
    asked_for = {question.name for question in questions(missions) if question.stated}
    worst = max((f for f in figures if f.name.split(": ", 1)[1] in asked_for), key=lambda figure: figure.value)
    at_scale = f"{taken:,} bearings; the slowest: {worst.name.split(': ', 1)[1]}"
    figures.insert(0, wanted("library", worst.value, of=of, note=at_scale))
    kept = await storage(kind)
    a_bearing = round(kept["kept"] / HOUR_BEARINGS / 1e3, 1)
    figures.insert(1, wanted("library_storage", a_bearing, of=of, note="facts, indexes and the flown path"))
    figures += [
        plain(
            f"{of}: a flight hour after retention", round(kept["kept"] / 1e3), "kB", note=f"{HOUR_BEARINGS} bearings"
        ),
        plain(f"{of}: of it the flown path", round(kept["packed"] / 1e3), "kB"),
        plain(f"{of}: the flown path until it is packed", round(kept["rows"] / 1e3), "kB"),
        plain(f"{of}: raw sweeps of the hour, until retention", round(kept["samples"] / 1e3), "kB"),
    ]
    return figures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--database", default="sqlite", help="sqlite, postgresql (a cluster of its own), or the URL of an empty one"
    )
    parser.add_argument("--missions", type=int, default=5000)
    parser.add_argument("--bearings", type=int, default=100, help="of each mission")
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    figures = asyncio.run(run(arguments.database, arguments.missions, arguments.bearings))
    for figure in figures:
        print(figure.name, figure.value, figure.unit, figure.note)
    name = "library_postgresql" if arguments.database.startswith("postgres") else "library_sqlite"
    write(arguments.out, name, f"The library at scale on {figures[0].name.rsplit(': ', 1)[1]}", begun, figures)


if __name__ == "__main__":
    main()
