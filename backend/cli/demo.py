"""`crossfix demo`: one whole simulated mission over real sockets, as a browser would fly it, and how well it did."""

from __future__ import annotations

import asyncio
import tempfile
import webbrowser
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import httpx
import typer
import websockets

from backend.cli.demo_flight import DemoFailed, fly
from backend.cli.demo_grade import sentences, summary
from backend.cli.edge import print_json, remark, stop, words_of
from backend.cli.running import CannotServe, running_server, stop_on_signals
from backend.settings import Settings, settings_of
from backend.simulation.emitters import EMITTERS, SimulatedEmitter
from backend.spec import MOST_EMITTERS, EmitterSpec, MovementSpec
from backend.store.delivery import DatabaseAway
from backend.store.opening import DatabaseUnusable
from backend.store.reading import JournalUnavailable
from hardware.direction_finding.pattern_file import PatternError
from hardware.ports import HardwareError
from planner.reason import text_of

CARRIER = EmitterSpec()
TAG = EmitterSpec(frequency_hz=150_000_000.0, kind="pulsed", label="wildlife tag")
"""What the page's preset for wildlife sets."""

TAG_SENSOR = {"measurement_time_s": 45.0, "sigma_deg": 9.0}
GAITS: tuple[Literal["animal", "walking", "drifting"], ...] = ("animal", "walking", "drifting")
SPACING_HZ = 100_000.0
"""Between the frequencies of several emitters."""
PERIODS_S = (1.3, 1.05, 1.6, 0.85)
"""Of tags at one frequency."""
PACE_M_S = 0.2
"""Of emitters that move."""


def movement(kind: str | None, pace: float | None) -> MovementSpec:
    """kind None: still. Raises ValueError for one that is not known, and for a pace of what stands still."""
    if kind is None:
        if pace is not None:
            raise ValueError("--pace is for emitters that move: add --moves")
        return MovementSpec()
    for known in GAITS:
        if kind == known:
            return MovementSpec(kind=known, speed_m_s=PACE_M_S if pace is None else pace)
    raise ValueError(f"--moves {kind!r} is not known: choose one of {', '.join(GAITS)}")


def sought(
    first: EmitterSpec,
    count: int,
    moving: MovementSpec | None = None,
    most_important: int | None = None,
    by_rhythm: bool = False,
) -> list[EmitterSpec]:
    """Emitters like the first, each at a frequency of its own; by_rhythm: tags at one, each with a period of its own.
    most_important: the number of the one to look for first, None: all are alike. Raises ValueError for a number that
    none has, for more tags at one frequency than there are periods, and for carriers there."""
    if most_important is not None and most_important > count:
        raise ValueError(f"--first {most_important}: there are {count} emitters; name one of them, or raise --emitters")
    if by_rhythm and (first.kind != "pulsed" or count > len(PERIODS_S)):
        raise ValueError(f"--by-rhythm is for 2 to {len(PERIODS_S)} tags: add --tag, and --emitters")
    return [
        first.model_copy(
            update={
                "emitter_id": f"emitter-{number}",
                "movement": moving or MovementSpec(),
                "priority": 1 if number == most_important else None,
            }
            | (
                {"pulse_period_s": PERIODS_S[number - 1]}
                if by_rhythm
                else {"frequency_hz": first.frequency_hz + (number - 1) * SPACING_HZ}
            )
        )
        for number in range(1, count + 1)
    ]


def simulated(emitters: list[EmitterSpec]) -> list[SimulatedEmitter]:
    """What is always there, and the further emitters that are looked for."""
    wanted = [_simulated(emitter) for emitter in emitters]
    first = wanted[0].frequency_hz
    return [*(wanted[0] if other.frequency_hz == first else other for other in EMITTERS), *wanted[1:]]


def _simulated(emitter: EmitterSpec) -> SimulatedEmitter:
    period_s = emitter.pulse_period_s if emitter.kind == "pulsed" else None
    kind = emitter.movement.kind
    return SimulatedEmitter(
        emitter.frequency_hz, period_s, None if kind == "still" else kind, emitter.movement.speed_m_s
    )


def demo(
    headless: Annotated[bool, typer.Option("--headless", help="No browser: fly, print the result, stop.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the simulated world and of the planner.")] = 1,
    speedup: Annotated[
        float | None, typer.Option(help="Simulated seconds a second of real time. Default: 5, with --vehicle 1.")
    ] = None,
    flavour: Annotated[str | None, typer.Option(help="Simulated autopilot: px4 or ardupilot. Default: px4.")] = None,
    vehicle: Annotated[
        str | None, typer.Option(help="Fly this autopilot instead, around its own home (udpin://0.0.0.0:14540 ...).")
    ] = None,
    world: Annotated[
        str | None,
        typer.Option(help="Simulated surroundings: open, or multipath (walls that reflect). Default: open."),
    ] = None,
    tag: Annotated[
        bool,
        typer.Option("--tag", help="Look for the simulated wildlife tag (pulses, 150 MHz), not the carrier."),
    ] = False,
    emitters: Annotated[
        int, typer.Option(min=1, max=MOST_EMITTERS, help="How many emitters to look for, each at its own frequency.")
    ] = 1,
    most_important: Annotated[
        int | None, typer.Option("--first", min=1, help="With --emitters: the number of the one to look for first.")
    ] = None,
    by_rhythm: Annotated[
        bool,
        typer.Option("--by-rhythm", help="With --tag and --emitters: at one frequency, each with a period of its own."),
    ] = False,
    band: Annotated[
        float | None,
        typer.Option(min=5.0, help="Band of the simulated receiver, kHz: what it hears at once; the mission says so."),
    ] = None,
    moves: Annotated[
        str | None, typer.Option(help="The emitters move, and are followed: animal, walking or drifting.")
    ] = None,
    pace: Annotated[
        float | None, typer.Option(min=0.01, max=5.0, help=f"With --moves: how fast, m/s. Default: {PACE_M_S}.")
    ] = None,
    mend_failsafes: Annotated[
        bool,
        typer.Option(help="Set failsafe parameters of the autopilot that would not act, and say which."),
    ] = True,
    data_dir: Annotated[
        Path | None, typer.Option(help="Where the database goes. Default: a new temporary directory.")
    ] = None,
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="Port of the page. Default: any free one.")] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Fly one whole mission: a simulated emitter, a simulated or real vehicle, the real server and its websocket.

    Example: crossfix demo --headless --seed 3 --json
    """
    folder = data_dir or Path(tempfile.mkdtemp(prefix="crossfix-demo-"))
    try:
        settings = settings_of(
            host="127.0.0.1",
            port=port or 0,
            data_dir=folder,
            vehicle_url=vehicle,
            simulate=flavour,
            simulated_flies_on=False,
            time_factor=speedup if speedup is not None else (5.0 if vehicle is None else 1.0),
            seed=seed,
            world=world,
            simulated_band_hz=None if band is None else band * 1000.0,
        )
    except ValueError as error:
        stop(error)
    try:
        looked_for = sought(TAG if tag else CARRIER, emitters, movement(moves, pace), most_important, by_rhythm)
        result = asyncio.run(_demo(settings, headless, json_, mend_failsafes, tag, looked_for))
    except (CannotServe, DatabaseUnusable, HardwareError, PatternError, ValueError) as error:
        stop(error)
    except (DatabaseAway, JournalUnavailable) as error:
        typer.echo(f"crossfix: {words_of(text_of(error.reason))} Try again.", err=True)
        raise typer.Exit(1) from None
    except (DemoFailed, httpx.HTTPError, websockets.WebSocketException, OSError) as error:
        typer.echo(f"crossfix: {words_of(error)}", err=True)
        raise typer.Exit(1) from None
    except KeyboardInterrupt:
        raise typer.Exit(130) from None
    if json_:
        print_json(result)
    elif headless:
        _tell(result)


async def _demo(
    settings: Settings, headless: bool, json_: bool, mend: bool, tag: bool, emitters: list[EmitterSpec]
) -> dict[str, Any]:
    changes: Mapping[str, Any] = {
        "emitters": [emitter.model_dump(mode="json") for emitter in emitters],
        "sensor": (TAG_SENSOR if tag else {}) | {"receiver_band_hz": settings.simulated_band_hz},
        "localization": {"follow": any(emitter.movement.kind != "still" for emitter in emitters)},
    }
    async with running_server(settings, emitters=simulated(emitters)) as running:
        if not headless:
            remark(f"the page: {running.url}")
            await asyncio.to_thread(webbrowser.open, running.url)
        log = await fly(running, settings, mend, changes)
        result = summary(log, settings, {} if running.receiver is None else running.receiver.truth_at)
        if not headless:
            _tell(result, err=json_)
            remark("the page stays open to look at; Ctrl-C stops the server")
            stop_on_signals(running, remark)
            await running.gone
        return result


def _tell(result: dict[str, Any], err: bool = False) -> None:
    for sentence in sentences(result):
        typer.echo(sentence, err=err)
