"""`crossfix serve`: the server with its page, for a simulated vehicle or a real one."""

from __future__ import annotations

import asyncio
import logging
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from backend.cli.edge import print_json, remark, stop
from backend.logs import configure
from backend.settings import Settings, settings_of
from planner.loading import load
from planner.reason import ReasonedError, text_of

if TYPE_CHECKING:  # it loads seconds of libraries, and a vehicle left in flight is to be held first
    from backend.auth.access import Mode


def serve(
    host: Annotated[str | None, typer.Option(help="Address to listen on. Default: 127.0.0.1.")] = None,
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="Port; 0: any free one. Default: 8600.")] = None,
    database: Annotated[
        str | None, typer.Option(help="sqlite:///FILE or postgresql://... Default: SQLite in the data directory.")
    ] = None,
    users: Annotated[
        bool | None, typer.Option("--users", help="People sign in, on this machine too. Always so with another --host.")
    ] = None,
    data_dir: Annotated[Path | None, typer.Option(help="Where database, spool and maps live. Default: ./data.")] = None,
    vehicle: Annotated[
        str | None,
        typer.Option(help="Real vehicle: udpin://0.0.0.0:14540, tcpout://HOST:PORT, serial:///dev/ttyUSB0:57600."),
    ] = None,
    receiver: Annotated[
        str | None,
        typer.Option(
            help="simulated, payload, soapy:driver=NAME, rtl_tcp://HOST[:PORT], sigmf:FILE or recording:FILE. "
            "Default: the payload's when CROSSFIX_PAYLOAD_TOKENS lets one in, else a simulated emitter."
        ),
    ] = None,
    pattern: Annotated[
        Path | None, typer.Option(help="Antenna pattern (JSON or turntable table). Default: a small Yagi.")
    ] = None,
    flavour: Annotated[str | None, typer.Option(help="Simulated autopilot: px4 or ardupilot. Default: px4.")] = None,
    speedup: Annotated[
        float | None, typer.Option(help="Seconds of simulated time a second of real time. Default: 1.")
    ] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Of the simulated world: where the emitter stands.")] = None,
    world: Annotated[
        str | None,
        typer.Option(help="Simulated surroundings: open, or multipath (walls that reflect). Default: open."),
    ] = None,
    emitter: Annotated[
        list[str] | None,
        typer.Option(
            help="A simulated emitter more, MHZ, MHZ/PULSE_PERIOD_S, and ,GAIT:SPEED behind either: 150.1/1.5 or "
            "150.2,animal:0.2. As often as there are emitters."
        ),
    ] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object when the server answers.")] = False,
) -> None:
    """Start the server and say where the page is. Without --vehicle it flies a simulated one. Ctrl-C stops it.

    Example: crossfix serve --port 8600 --speedup 5
    """
    try:
        settings = settings_of(
            host=host,
            port=port,
            users=users,
            database_url=database,
            data_dir=data_dir,
            vehicle_url=vehicle,
            receiver=receiver,
            antenna_pattern=pattern,
            simulate=flavour,
            time_factor=speedup,
            seed=seed,
            world=world,
            emitters=tuple(emitter) if emitter else None,
        )
        configure(settings, verbose=logging.getLogger().isEnabledFor(logging.INFO))
    except ValueError as error:
        stop(error)
    except OSError as error:
        stop(f"the log file {error.filename} cannot be written: {error.strerror}")
    try:
        asyncio.run(_serve(settings, json_))
    except (ReasonedError, RuntimeError, ValueError) as error:
        _stop_because(error)
    except KeyboardInterrupt:
        raise typer.Exit(0) from None


async def _serve(settings: Settings, json_: bool) -> None:
    """What was left in flight is held before anything else is loaded, which takes seconds: a thread does that while
    the link is served."""
    from backend.first_hold import hold_what_flies

    first = await hold_what_flies(settings)
    server = await asyncio.to_thread(load, "backend.cli.running")
    async with server.running_server(settings, leave_flying=True, first=first) as running:
        server.stop_on_signals(running, remark)
        what = settings.vehicle_url or f"a simulated {settings.simulate} vehicle"
        access = running.services.access
        code = access.begin_first_admin()
        if json_:
            shown = {"url": running.url, "vehicle": what, "database": settings.shown_database, "people": access.mode}
            print_json(shown if code is None else {**shown, "first_admin_code": code})
        else:
            page = settings.public_url or running.url.rstrip("/")
            typer.echo(f"Crossfix flies {what}. The page: {page}/", err=False)
            typer.echo(who_may_enter(access.mode, page, code), err=False)
        if settings.plain_http and settings.reachable_from_outside:
            remark("CROSSFIX_PLAIN_HTTP: passwords cross the network as they are; it has to encrypt by itself.")
        await running.gone


def who_may_enter(mode: Mode, page: str, code: str | None) -> str:
    """page: its address. code: of the first admin, where there is none yet."""
    match mode:
        case "alone":
            return "Only this machine reaches it: one person, no sign-in."
        case "waiting":
            return f"Nobody can use it yet. Make the first admin (the code works once): {page}/#/first-admin/{code}"
        case "people":
            return "Whoever uses it signs in."


def _stop_because(error: ReasonedError | RuntimeError | ValueError) -> NoReturn:
    """Raises what nobody foresaw."""
    from backend.cli.running import CannotServe
    from backend.ports import JournalUnavailable
    from backend.store.delivery import DatabaseAway

    match error:
        case DatabaseAway() | JournalUnavailable():
            stop(f"{text_of(error.reason)} Try again when the machine is less busy.")
        case ReasonedError() | ValueError() | CannotServe():
            stop(error)
        case _:
            raise error
