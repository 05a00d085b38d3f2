"""Whole missions of a real autopilot, unattended: what they claim, and what was ordered and said on the way.

    python -m tests.strikes.missions udpin://127.0.0.1:14540 --flavour px4 --times 10

Each is the suggested search with an emitter at another place, flown by a server of its own as a browser would fly it,
behind a link with a delay. The receiver is simulated. It stands where the autopilot says at its own end of the link, so
that a late or wrongly dated heading turns bearings as it would in the field. Prints a line a mission, then one JSON
object; ends with status 1 when a mission failed or claimed a place that is not so.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import httpx
import websockets

from backend.cli.demo_flight import DemoFailed, fly
from backend.cli.demo_grade import MissionLog, summary
from backend.cli.running import running_server
from backend.events import FIRST_CRAFT, BearingMeasured, HeardOnTheWay, MissionDrafted, PhaseChanged, SweepRejected
from backend.mission.flights import Flights
from backend.settings import Settings
from hardware.autopilot.status_texts import StatusTexts
from hardware.frame import LocalFrame
from hardware.ports import Vehicle, VehicleError
from hardware.readings import Place, Telemetry
from hardware.reasons.on_the_way import NoseSwung
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.strikes.proxy import (
    ATTITUDE,
    BATTERY_STATUS,
    COMMAND_INT,
    COMMAND_LONG,
    GLOBAL_POSITION,
    KEPT,
    STATUS_TEXT,
    Passed,
    Proxy,
    proxied,
)
from tests.strikes.strike import until

ORDERS = {20: "return", 21: "land", 22: "take-off", 115: "yaw", 176: "mode", 178: "speed", 192: "place", 400: "arm"}
"""MAV_CMD that move the vehicle, in words. A yaw step of PX4 is a place."""
TURNING_DEG_S = 3.0
"""Below, an autopilot corrects its heading."""
FLYING_M_S = 3.0
"""Below, it hovers, starts or brakes."""
IN_WORDS = {True: "yes", False: "no", None: None}
FALSE_TIMES = 3.0
"""A claim is false when its error is beyond this multiple of what it stated."""


@dataclass(frozen=True, slots=True)
class Flown:
    """One mission. emitter_m: where it stood, metres (east, north) of home. error_m, stated_m: None without a claim.

    turned_deg: yaw, to and fro, faster than `TURNING_DEG_S`, until it ended. drawn_mah: by the autopilot's count.
    speed_m_s: median over ground while flying. tilt_deg: of 99 in 100 attitudes, at most. nose: of each leg that swung.
    turns_deg: how far each turn went of a mission that decides it; empty where all are whole. planned_s: in the phase.
    orders: how often each reached the vehicle. texts: the autopilot's warnings and worse, each once, with how often.
    failed: why the mission was not flown to its end; "" when it was.
    """

    seed: int
    delay_s: float
    outcome: str
    emitter_m: tuple[float, float] | None
    error_m: float | None
    stated_m: float | None
    in_c95: bool | None
    bearing_errors_deg: tuple[float, ...]
    took_s: float
    holds: tuple[str, ...]
    turned_deg: float
    drawn_mah: float | None
    orders: Counter[str]
    texts: Counter[str]
    speed_m_s: float | None = None
    tilt_deg: float | None = None
    nose: tuple[NoseSwung, ...] = ()
    turns_deg: tuple[float, ...] = ()
    planned_s: float = 0.0
    failed: str = ""

    @property
    def localized(self) -> bool:
        return self.outcome == "localized"

    @property
    def false(self) -> bool:
        """It claimed a place, and that is wrong."""
        far = self.error_m is not None and self.stated_m is not None and self.error_m > FALSE_TIMES * self.stated_m
        return self.localized and far


def witness(proxy: Proxy) -> Callable[[], Telemetry]:
    """Where the vehicle is by its own end of the link, as if its news took no time."""

    def latest(number: int) -> Passed | None:
        heard = (passed for passed in reversed(proxy.record) if passed.number == number and passed.way == "from")
        return next(heard, None)

    def pose() -> Telemetry:
        offset_s = time.time() - time.monotonic()
        attitude, place = latest(ATTITUDE), latest(GLOBAL_POSITION)
        if attitude is None or place is None:
            return Telemetry(connected=True, at_s=time.time())
        return Telemetry(
            connected=True,
            at_s=time.time(),
            position=Place(place.fields["lat"] / 1e7, place.fields["lon"] / 1e7),
            position_at_s=place.at_s + offset_s,
            altitude_relative_m=place.fields["relative_alt"] / 1e3,
            heading_deg=math.degrees(attitude.fields["yaw"]) % 360.0,
            heading_at_s=attitude.at_s + offset_s,
        )

    return pose


def ordered(record: Sequence[Passed]) -> Counter[str]:
    commands = [p for p in record if p.way == "to" and p.number in (COMMAND_INT, COMMAND_LONG)]
    named = [ORDERS.get(int(command.fields["command"])) for command in commands]
    return Counter(name for name in named if name is not None)


def said(record: Sequence[Passed]) -> Counter[str]:
    """Whole texts, warnings and worse."""
    texts, whole = StatusTexts(), list[str]()
    for passed in record:
        if passed.way == "from" and passed.number == STATUS_TEXT:
            of = passed.fields
            found = texts.take(of["severity"], of["text"], of.get("id", 0), of.get("chunk_seq", 0), passed.at_s)
            whole += [f"{text.severity}: {text.text}" for text in found if text.severity != "information"]
    whole += [f"{text.severity}: {text.text}" for text in texts.overdue(math.inf) if text.severity != "information"]
    return Counter(whole)


def turned_deg(record: Sequence[Passed]) -> float:
    attitudes = [passed for passed in record if passed.way == "from" and passed.number == ATTITUDE]
    total = 0.0
    for before, after in pairwise(attitudes):
        rate = abs(math.degrees(after.fields["yawspeed"]))
        total += rate * (after.at_s - before.at_s) if rate > TURNING_DEG_S else 0.0
    return total


def drawn_mah(record: Sequence[Passed]) -> float | None:
    """None where the autopilot does not count, as PX4's own simulator does not."""
    counts = [p.fields["current_consumed"] for p in record if p.way == "from" and p.number == BATTERY_STATUS]
    return counts[-1] - counts[0] if counts and counts[-1] > counts[0] >= 0 else None


def speed_m_s(record: Sequence[Passed]) -> float | None:
    """Median of the reported ground speeds above `FLYING_M_S`; None without one."""
    told = [p.fields for p in record if p.way == "from" and p.number == GLOBAL_POSITION]
    speeds = [math.hypot(fields["vx"], fields["vy"]) / 100.0 for fields in told]
    return statistics.median(flying) if (flying := [speed for speed in speeds if speed > FLYING_M_S]) else None


def tilt_deg(record: Sequence[Passed]) -> float | None:
    told = [p.fields for p in record if p.way == "from" and p.number == ATTITUDE]
    tilts = sorted(math.degrees(math.acos(math.cos(fields["roll"]) * math.cos(fields["pitch"]))) for fields in told)
    return tilts[int(0.99 * (len(tilts) - 1))] if tilts else None


def noses(log: MissionLog) -> tuple[NoseSwung, ...]:
    """Of the first emitter's legs."""
    told = [reason for leg in log.all(HeardOnTheWay, _first_emitter(log)) for reason in leg.nose]
    return tuple(reason for reason in told if isinstance(reason, NoseSwung))


def turns_deg(log: MissionLog) -> tuple[float, ...]:
    """Of the first emitter's sweeps, in order."""
    sweeps = [record.event for record in log.recorded if isinstance(record.event, BearingMeasured | SweepRejected)]
    name = _first_emitter(log)
    return tuple(one.turn.turned_deg for one in sweeps if one.turn is not None and one.emitter_id == name)


def planned_s(log: MissionLog) -> float:
    """In which the craft hovered and waited for the planner: much on a busy machine."""
    changed = [record for record in log.recorded if isinstance(record.event, PhaseChanged)]
    waits = ((b, a) for b, a in pairwise(changed) if isinstance(b.event, PhaseChanged) and b.event.after == "planning")
    return sum((after.at_utc - before.at_utc).total_seconds() for before, after in waits)


def _first_emitter(log: MissionLog) -> str:
    return log.all(MissionDrafted)[-1].spec.emitters[0].emitter_id


async def one(url: str, seed: int, delay_s: float, changes: Mapping[str, Any] | None = None) -> Flown:
    """A mission that is not flown to its end is an outcome, too: the vehicle is then landed. changes: as `fly` takes
    them.
    """
    with tempfile.TemporaryDirectory(prefix="crossfix-mission-") as folder:
        async with proxied(url) as proxy:
            proxy.kept, proxy.delay_s = KEPT | {ATTITUDE, BATTERY_STATUS, GLOBAL_POSITION}, delay_s
            settings = Settings(
                port=0,
                data_dir=Path(folder),
                vehicle_url=proxy.url,
                seed=seed,
                live_ping_timeout_s=60.0,  # the console that watches is in this process, too
            )
            async with running_server(settings) as running:
                assert running.receiver is not None
                running.receiver.follow(witness(proxy))
                vehicle = running.services.missions.equipment.crafts[FIRST_CRAFT].vehicle
                found, failed = dict[str, Any](), ""
                nose, turns, waited_s = tuple[NoseSwung, ...](), tuple[float, ...](), 0.0
                began_s = time.monotonic()
                try:
                    log = await fly(running, settings, changes=changes)
                    found = summary(log, settings, running.receiver.truth)
                    nose, turns, waited_s = noses(log), turns_deg(log), planned_s(log)
                except (DemoFailed, httpx.HTTPError, websockets.ConnectionClosed) as error:
                    failed = f"{type(error).__name__}: {error}"
                    await _land(vehicle)
                await _nets_back(running.services.missions.flights)
                took_s = time.monotonic() - began_s
                home, truth = vehicle.telemetry().home, next(iter(running.receiver.truth.values()), None)
            return Flown(
                seed=seed,
                delay_s=delay_s,
                outcome=found.get("outcome", "not flown"),
                emitter_m=None if home is None or truth is None else LocalFrame(home).to_enu(truth),
                error_m=found.get("error_m"),
                stated_m=found.get("expected_rmse_m"),
                in_c95=found.get("in_c95"),
                bearing_errors_deg=tuple(found.get("bearing_errors_deg", ())),
                took_s=found.get("mission_time_s", took_s),
                holds=tuple(found.get("holds", ())),
                turned_deg=turned_deg(proxy.record),
                drawn_mah=drawn_mah(proxy.record),
                orders=ordered(proxy.record),
                texts=said(proxy.record),
                speed_m_s=speed_m_s(proxy.record),
                tilt_deg=tilt_deg(proxy.record),
                nose=nose,
                turns_deg=turns,
                planned_s=waited_s,
                failed=failed,
            )


async def _land(vehicle: Vehicle) -> None:
    with contextlib.suppress(VehicleError, TimeoutError):
        vehicle.take_control()
        await vehicle.land()
        await until(lambda: vehicle.telemetry().armed is False, 120.0, "the landing")


async def _nets_back(flights: Flights) -> None:
    """The next mission has a server of its own, that knows nothing of what this one owes to the vehicle's owner."""
    with contextlib.suppress(TimeoutError):
        await until(lambda: not flights.nets.owed, 60.0, "the owner's fence")


def line(flown: Flown) -> str:
    """For a person who watches the run."""
    if flown.failed:
        return f"seed {flown.seed}, {flown.delay_s * 1e3:.0f} ms: FAILED: {flown.failed}; {dict(flown.texts)}"
    errors = ", ".join(f"{error:.1f}" for error in flown.bearing_errors_deg)
    return (
        f"seed {flown.seed}, {flown.delay_s * 1e3:.0f} ms: {flown.outcome} in {flown.took_s:.0f} s, "
        f"{_metres(flown.error_m)} off, {_metres(flown.stated_m)} stated, in C95: {flown.in_c95}, "
        f"bearings off by {errors} deg, holds {list(flown.holds)}, orders {dict(flown.orders)}, "
        f"texts {dict(flown.texts)}"
    )


def _metres(value: float | None) -> str:
    return "nothing" if value is None else f"{value:.1f} m"


def missions_table(flights: Sequence[Flown]) -> Table:
    columns = (
        Column(name="seed"),
        Column(name="delay each way, ms"),
        Column(name="emitter: m east"),
        Column(name="m north"),
        Column(name="outcome"),
        Column(name="error, m", decimals=1),
        Column(name="stated, m", decimals=1),
        Column(name="in C95"),
        Column(name="bearings"),
        Column(name="bearing error at most, deg", decimals=1),
        Column(name="holds"),
        Column(name="orders"),
    )
    rows = [
        (
            flown.seed,
            round(flown.delay_s * 1e3),
            None if flown.emitter_m is None else round(flown.emitter_m[0]),
            None if flown.emitter_m is None else round(flown.emitter_m[1]),
            flown.failed or flown.outcome,
            flown.error_m,
            flown.stated_m,
            IN_WORDS[flown.in_c95],
            len(flown.bearing_errors_deg),
            max(map(abs, flown.bearing_errors_deg), default=None),
            "; ".join(flown.holds),
            ", ".join(f"{count} {name}" for name, count in flown.orders.most_common()),
        )
        for flown in flights
    ]
    return Table(name="missions", columns=columns, rows=tuple(rows))


def texts_table(flights: Sequence[Flown]) -> Table:
    texts = sum((flown.texts for flown in flights), Counter[str]())
    rows = tuple((text, count, sum(text in flown.texts for flown in flights)) for text, count in texts.most_common())
    columns = (Column(name="the autopilot said"), Column(name="times"), Column(name="in missions"))
    return Table(name="texts", columns=columns, rows=rows)


def figures(flights: Sequence[Flown]) -> list[Figure]:
    note = f"of {len(flights)}"
    claims = [flown for flown in flights if flown.localized and flown.error_m is not None]
    bearings = [error for flown in flights for error in flown.bearing_errors_deg]
    found = [
        plain("missions flown to their end", sum(not flown.failed for flown in flights), "", note=note),
        plain("missions localized", sum(flown.localized for flown in flights), "", note=note),
        plain("false claims", sum(flown.false for flown in flights), "", note="error beyond 3 x stated"),
        plain("missions held on the way", sum(bool(flown.holds) for flown in flights), "", note=note),
    ]
    if claims:
        note = f"of {len(claims)} claims"
        found += [
            plain("truth in C95", sum(bool(flown.in_c95) for flown in claims), "", note=note),
            plain("error, median", statistics.median(flown.error_m or 0.0 for flown in claims), "m", note=note),
            plain("error, most", max(flown.error_m or 0.0 for flown in claims), "m", note=note),
            plain("error stated, median", statistics.median(flown.stated_m or 0.0 for flown in claims), "m", note=note),
        ]
    if bearings:
        rms = math.sqrt(statistics.fmean(error**2 for error in bearings))
        note = f"{len(bearings)} bearings"
        found += [
            plain("bearing error, RMS", rms, "deg", note=note),
            plain("bearing error, most", max(map(abs, bearings)), "deg", note=note),
        ]
    return found


async def run(given: argparse.Namespace) -> list[Flown]:
    flights = list[Flown]()
    for number in range(given.times):
        delay_s = given.delays[number % len(given.delays)] / 1e3
        flights.append(await one(given.vehicle, given.seed + number, delay_s))
        print(line(flights[-1]), flush=True)
        _write(given, flights)
    return flights


def _write(given: argparse.Namespace, flights: Sequence[Flown]) -> None:
    """After each mission: a run cut short leaves what it has flown."""
    tables = [missions_table(flights), texts_table(flights)]
    title = f"Whole missions of a real autopilot, {given.flavour}"
    page = "faults-in-flight.md#real-autopilots"
    write(given.out, f"missions_{given.flavour}", title, given.begun, figures(flights), tables=tables, page=page)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", help="its address, as `crossfix serve --vehicle` takes it")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--times", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1, help="of the first; each has its own emitter and planner")
    parser.add_argument("--delays", type=float, nargs="+", default=[0.0, 80.0, 250.0], help="ms each way, in turn")
    add_out(parser)
    given = parser.parse_args()
    given.begun = begin(__file__)
    flights = asyncio.run(run(given))
    print(json.dumps([figure.model_dump(exclude_defaults=True) for figure in figures(flights)], indent=2))
    sys.exit(any(flown.failed or flown.false for flown in flights))


if __name__ == "__main__":
    main()
