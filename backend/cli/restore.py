"""`crossfix restore`: an archive back onto an empty server, or only looked through."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from backend.cli.edge import print_json, remark, stop
from backend.settings import settings_of


def restore(
    archive: Annotated[Path, typer.Argument(help="What `crossfix backup` made.")],
    database: Annotated[
        str | None,
        typer.Option(help="sqlite:///FILE or postgresql://... Default: SQLite in the data directory."),
    ] = None,
    data_dir: Annotated[Path | None, typer.Option(help="An empty data directory. Default: ./data.")] = None,
    check: Annotated[bool, typer.Option("--check", help="Only read every part and compare its checksum.")] = False,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object at the end.")] = False,
) -> None:
    """Put an archive back. No server may run on the target, and the target must be empty; it may be the other database.

    Example: crossfix restore crossfix-20260601T120000Z.zip --data-dir restored
    """
    from backend.backup.archive import Archive
    from backend.backup.manifest import BackupError
    from backend.backup.restoring import restore as put_back

    try:
        settings = settings_of(database_url=database, data_dir=data_dir)
        if check:
            with Archive(archive) as opened:
                opened.verify()
                manifest = opened.manifest
            if json_:
                print_json({"whole": True, **manifest.model_dump(mode="json", exclude={"members"})})
            else:
                typer.echo(
                    f"{archive} is whole: {manifest.rows:,} rows and {len(manifest.members)} parts, "
                    f"made by crossfix {manifest.software} at {manifest.made_at_utc:%Y-%m-%d %H:%M} UTC."
                )
            return
        restored = put_back(settings, archive, lambda what: remark(f"restoring {what}"))
    except (BackupError, ValueError) as error:
        stop(error)
    if restored.pattern is not None:
        remark(f"the antenna pattern lies at {restored.pattern}: name it with --pattern or CROSSFIX_ANTENNA_PATTERN")
    if json_:
        print_json({"missions": restored.missions, "rows": restored.rows, "files": restored.files})
    else:
        typer.echo(f"Restored {restored.missions:,} missions ({restored.rows:,} rows) and {restored.files:,} files.")
