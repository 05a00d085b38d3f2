"""`crossfix backup`: everything that a server keeps, in one archive, while it flies."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from backend.cli.edge import print_json, remark, stop
from backend.settings import settings_of


def backup(
    target: Annotated[
        Path | None, typer.Argument(help="File or folder. Default: crossfix-TIME.zip in this folder.")
    ] = None,
    database: Annotated[
        str | None,
        typer.Option(help="As `crossfix serve` has it. Default: SQLite in the data directory."),
    ] = None,
    data_dir: Annotated[Path | None, typer.Option(help="The server's data directory. Default: ./data.")] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object at the end.")] = False,
) -> None:
    """Save missions, maps, overlays, terrain and whatever else the server keeps. It may fly meanwhile.

    Example: crossfix backup /media/stick --data-dir data
    """
    from backend.backup.making import make_backup
    from backend.backup.manifest import BackupError

    at = datetime.now(UTC)
    name = f"crossfix-{at:%Y%m%dT%H%M%SZ}.zip"
    path = Path(name) if target is None else target / name if target.is_dir() else target
    try:
        settings = settings_of(database_url=database, data_dir=data_dir)
        made = make_backup(settings, path, lambda what: remark(f"saving {what}"), at)
    except (BackupError, ValueError) as error:
        stop(error)
    for gone in made.gone:
        remark(f"{gone} was deleted meanwhile and is not in the archive")
    size = path.stat().st_size
    if json_:
        print_json(
            {"archive": str(path), "bytes": size, "rows": made.manifest.rows, "parts": len(made.manifest.members)}
        )
    else:
        typer.echo(f"{path}: {made.manifest.rows:,} rows and {len(made.manifest.members)} parts in {size:,} bytes.")
        typer.echo(f"Try it: crossfix restore {path} --check")
