"""`crossfix thin`: take old raw sweeps now, or see what that would free; flown paths are packed."""

from __future__ import annotations

import asyncio
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from backend.cli.edge import print_json, remark, stop
from backend.settings import Settings, settings_of


def thin(
    keep_days: Annotated[
        float | None,
        typer.Option(
            min=0,
            help="Keep those of missions that ended within this number of days. Default: CROSSFIX_KEEP_SWEEPS_DAYS.",
        ),
    ] = None,
    database: Annotated[
        str | None, typer.Option(help="As `crossfix serve` has it. Default: SQLite in the data directory.")
    ] = None,
    data_dir: Annotated[Path | None, typer.Option(help="The server's data directory. Default: ./data.")] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only say what would be taken.")] = False,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Take the raw power samples, and the IQ, of missions that ended long ago; bearings, beliefs and paths stay, the
    paths of all missions that are over packed. The server may run.

    Example: crossfix thin --keep-days 365 --dry-run
    """
    from sqlalchemy.exc import SQLAlchemyError

    from backend.store.opening import DatabaseUnusable
    from backend.store.reading import why

    try:
        settings = settings_of(database_url=database, data_dir=data_dir, keep_sweeps_days=keep_days)
        if settings.keep_sweeps_days is None:
            raise ValueError("for how many days are sweeps kept? Name --keep-days, or set CROSSFIX_KEEP_SWEEPS_DAYS")
        taken = asyncio.run(_thin(settings, settings.keep_sweeps_days, dry_run))
    except (ValueError, DatabaseUnusable) as error:
        stop(error)
    except (SQLAlchemyError, OSError) as error:
        stop(f"the database does not answer: {why(error)}")
    if json_:
        print_json({"missions": taken[0], "sweeps": taken[1], "bytes": taken[2], "taken": not dry_run})
    else:
        does = "would take" if dry_run else "took"
        typer.echo(f"{does} {taken[1]:,} raw sweeps of {taken[0]:,} missions: {taken[2]:,} bytes.")


async def _thin(settings: Settings, keep_days: float, dry_run: bool) -> tuple[int, int, int]:
    from backend.store import retention
    from backend.store.engine import database_missing, dispose, engine_for_once, shrink
    from backend.store.iq_folder import IqFolder
    from backend.store.opening import DatabaseUnusable, claimed

    url = settings.async_database_url
    missing = database_missing(url)
    if missing is not None:
        raise ValueError(missing)
    engine = engine_for_once(url, 10.0)
    try:
        work = retention.old_sweeps if dry_run else retention.thin
        packed = 0
        taken = await work(engine, keep_days, datetime.now(UTC))
        if not dry_run:
            packed = await retention.pack_paths(engine, datetime.now(UTC))
            await retention.thin_iq(engine, IqFolder.of_settings(settings), keep_days, datetime.now(UTC))
        if (taken.sweeps or packed) and engine.dialect.name == "sqlite":
            try:
                with claimed(url):
                    await shrink(engine)
            except DatabaseUnusable:
                remark(
                    "the server runs: the freed space is used again, and the file shrinks when this is run without it"
                )
    finally:
        await dispose(engine)
    return taken.missions, taken.sweeps, taken.size_bytes
