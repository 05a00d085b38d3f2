"""`crossfix recover`: a code for somebody who has lost their password, made on the server's machine."""

from __future__ import annotations

import asyncio
import getpass
import time
from typing import Annotated

import typer

from backend.cli.edge import print_json, stop
from backend.settings import AUDIT_FILE, Settings, settings_of
from planner.reason import text_of


def recover(
    name: Annotated[str, typer.Argument(help="Of the person, as the page shows it.")],
    admin: Annotated[
        bool, typer.Option("--admin", help="They manage people from then on: when no other admin can enter.")
    ] = False,
    database: Annotated[
        str | None, typer.Option(help="sqlite:///FILE or postgresql://... Default: SQLite in the data directory.")
    ] = None,
    data_dir: Annotated[str | None, typer.Option(help="Where the server keeps its data. Default: ./data.")] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Print a code with which a person chooses a new password on the page, while the server runs. It works once, for an
    hour, and stands in the audit log.

    Example: crossfix recover Ada
    """
    from backend.auth.keeping import Denied
    from backend.ports import JournalUnavailable

    try:
        settings = settings_of(database_url=database, data_dir=data_dir)
        shown, code = asyncio.run(_made(settings, name, admin))
    except JournalUnavailable as error:
        stop(f"{text_of(error.reason)} Is this the data directory of the server (--data-dir)?")
    except (Denied, ValueError) as error:
        stop(error)
    except OSError as error:
        stop(f"{error.filename or 'the data directory'} cannot be written: {error.strerror}")
    if json_:
        print_json({"name": shown, "code": code})
    else:
        typer.echo(f'{shown} opens the page, then "Password lost?", and enters this code within an hour: {code}')


async def _made(settings: Settings, name: str, admin: bool) -> tuple[str, str]:
    from backend.auth.audit import AuditLog
    from backend.auth.keeping import Keeping
    from backend.auth.people import People
    from backend.auth.records import Records
    from backend.auth.recovery import make_recovery
    from backend.store.engine import database_missing, make_engine

    url = settings.async_database_url
    missing = database_missing(url)
    if missing is not None:
        raise ValueError(missing)
    keeping = Keeping(Records(make_engine(url, settings.database_timeout_s), 30.0))
    audit = AuditLog(settings.data_dir / AUDIT_FILE, time.time)
    try:
        people = People(keeping)
        assert keeping.records is not None
        people.load((await keeping.records.load()).people)
        person = people.named(name)
        if person is None:
            names = ", ".join(person.name for person in people.by_name) or "nobody yet"
            raise ValueError(f"nobody here is called {name!r}; there are: {names}")
        audit.note(
            call="crossfix recover", who=getpass.getuser(), of=person.name, admin=admin, address="this machine",
            outcome="allowed",
        )  # fmt: skip
        await audit.flushed()
        return person.name, make_recovery(settings.data_dir, person.person_id, admin, time.time())
    finally:
        await audit.close()
        await keeping.close()
