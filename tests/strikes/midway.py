"""New missions on a real autopilot, struck while the nose swings on the way and while it turns through a sector.

    python -m tests.strikes.midway udpin://127.0.0.1:14540 --flavour px4 --rounds 1 --delays 0 250

A server flies the suggested mission (nothing of how it turns is said here) with a claim so strict that it goes on. A
pilot takes the vehicle over, an operator holds it, and in the end aborts: each once the nose turns at more than
`TURNS_DEG_S`, a moment later. After a hold and a takeover the search is resumed. Prints a line a strike, then one JSON
object; ends with status 1 when a takeover was undone or not shown, the nose turned on, or the vehicle was steered on.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path

from backend.cli.running import RunningServer, running_server
from backend.events import FIRST_CRAFT
from backend.search import sector
from backend.settings import Settings
from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.px4 import PX4
from hardware.ports import VehicleError
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.strikes.__main__ import vars_of
from tests.strikes.missions import witness
from tests.strikes.moments import MOMENTS, SEARCHES, moment
from tests.strikes.nose import (
    Deed,
    Struck,
    While,
    came_to_rest,
    mode_ordered,
    rate_deg_s,
    steered_after,
    stop_ordered,
    way_home,
)
from tests.strikes.pilot import Pilot, piloted
from tests.strikes.proxy import ATTITUDE, GLOBAL_POSITION, KEPT, Proxy, proxied
from tests.strikes.strike import STICKS_S, left_for, story, until
from tests.system.console import Console, console

STRICT = {"localization": {"expected_rmse_m": 0.5, "maximum_bearings": 120}}
WATCHED_S = 6.0
BEFORE_S = 0.01
"""An order of the way home is no part of what its abort is judged by."""
SHOWS: dict[Deed, tuple[str, ...]] = {"pilot": ("manual",), "hold": ("hold",), "abort": ("hold", "returning")}
RETURNS = {"px4": PX4.return_home.custom, "ardupilot": ARDUPILOT.return_home.custom}


@dataclass(frozen=True, slots=True)
class Blow:
    during: While
    deed: Deed
    means: str = ""


@dataclass(slots=True)
class Search:
    """One mission under strikes."""

    running: RunningServer
    proxy: Proxy
    pilot: Pilot
    shown: Console
    chance: random.Random
    flavour: str

    async def begin(self, delay_s: float, loss: float) -> None:
        """In the air; the link is as slow and as bad as wanted from then on."""
        self.proxy.delay_s = self.proxy.loss = 0.0
        await self.shown.close()
        self.shown.events.clear()
        self.shown.messages.clear()
        await self._knows_where_it_is()
        await self.shown.draft(**STRICT)
        await self.shown.ready(90)
        await self.shown.watch()
        await self.shown.start(90)
        await self.shown.until(lambda: self.shown.phases[-1:] == ["flying"], 120)
        self.proxy.delay_s, self.proxy.loss = delay_s, loss

    async def _knows_where_it_is(self) -> None:
        """A mission is suggested around the vehicle, which may just have been switched on."""
        async with asyncio.timeout(90):
            while (await self.shown.client.get("/api/vehicle")).json().get("lat") is None:  # noqa: ASYNC110 (another's)
                await asyncio.sleep(0.3)

    async def strike(self, blow: Blow) -> Struck:
        """Raises TimeoutError or AssertionError when the moment does not come."""
        with every_look_unsure() if blow.during == "extension" else contextlib.nullcontext():
            await moment(self.shown, self.proxy, self.chance, blow.during)
        rate, known = rate_deg_s(self.proxy.record), len(self.shown.phases)
        at_s, ordered = time.monotonic(), None
        match blow.deed:
            case "pilot":
                at_s = self.pilot.take_by_sticks() if blow.means == "sticks" else self.pilot.take_by_mode()
            case "hold" | "abort":
                ordered = asyncio.create_task(self.shown.order(blow.deed))
        shown_s = await self._watched(at_s, known, SHOWS[blow.deed])
        if ordered is not None:
            assert (await ordered)["accepted"], blow
        struck = self._judge(blow, at_s, rate, shown_s)
        return replace(struck, went_on=await self._recover(blow.deed))

    async def _watched(self, at_s: float, known: int, shows: tuple[str, ...]) -> float | None:
        shown_s = None
        while (now_s := time.monotonic()) < at_s + WATCHED_S + 2.0 * self.proxy.delay_s:
            if now_s > at_s + STICKS_S:
                self.pilot.release_sticks()
            if shown_s is None and any(phase in shows for phase in self.shown.phases[known:]):
                shown_s = now_s - at_s
            await asyncio.sleep(0.02)
        return shown_s

    def _judge(self, blow: Blow, at_s: float, rate: float, shown_s: float | None) -> Struck:
        record, end_s = self.proxy.since(at_s), time.monotonic()
        undone = False
        if blow.deed == "pilot":
            took_at_s = self.pilot.took(at_s)
            undone = took_at_s is not None and left_for(self.proxy, self.pilot, took_at_s) is not None
            steered_from_s = (took_at_s or at_s) + 2.0 * self.proxy.delay_s + STICKS_S
        else:
            took_at_s = stop_ordered(record)
            steered_from_s = took_at_s or at_s
        if blow.deed == "abort":  # then it flies home, or the autopilot returns: the nose turns there
            begun = (way_home(record), mode_ordered(record, RETURNS[self.flavour]))
            end_s = min((one - BEFORE_S for one in begun if one is not None), default=end_s)
        still_s, turned = came_to_rest(record, took_at_s or at_s, end_s)
        if blow.deed == "abort" and still_s is None:
            still_s = end_s - (took_at_s or at_s)
        struck = Struck(
            during=blow.during,
            deed=blow.deed,
            means=blow.means,
            delay_s=self.proxy.delay_s,
            rate_deg_s=rate,
            took_s=None if took_at_s is None else took_at_s - at_s,
            shown_s=shown_s,
            still_s=still_s,
            turned_deg=turned,
            steered=steered_after([p for p in record if p.at_s <= end_s], steered_from_s),
            undone=undone,
        )
        return replace(struck, story=tuple(story(self.proxy.since(at_s - 2.0), at_s))) if struck.wrong else struck

    async def _recover(self, deed: Deed) -> bool | None:
        """Whether the search goes on; None after an abort, when the vehicle is down again."""
        if deed == "abort":
            self.proxy.delay_s = self.proxy.loss = 0.0
            await self.shown.until(lambda: self.shown.phases[-1] == "ground", 300)
            return None
        if deed == "pilot":
            self.pilot.give_back()
        with contextlib.suppress(TimeoutError, AssertionError):
            async with asyncio.timeout(30):
                while not (await self.shown.order("resume"))["accepted"]:  # noqa: ASYNC110 (as a person would)
                    await asyncio.sleep(0.2)
                await self.shown.until(lambda: self.shown.phases[-1] in SEARCHES, 30)
                return True
        return False


@contextlib.contextmanager
def every_look_unsure() -> Iterator[None]:
    """Each sector is extended, as by a sweep that hardly shows a lobe."""
    sure, sector.SURE_QUALITY = sector.SURE_QUALITY, math.inf
    try:
        yield
    finally:
        sector.SURE_QUALITY = sure


def blows(number: int, flavour: str) -> list[Blow]:
    """Of one mission, ended by an abort: in a swing, at its end, in a sector and in its extension in turn."""
    sticks = "sticks" if flavour == "px4" else "mode"
    return [
        Blow("swing", "hold"),
        Blow("swing", "pilot", "mode"),
        Blow("sector", "hold"),
        Blow("turn back", "hold"),
        Blow("extension", "pilot", "mode"),
        Blow("swing", "pilot", sticks),
        Blow("sector", "pilot", "mode"),
        Blow("turn back", "pilot", "mode"),
        Blow("extension", "hold"),
        Blow("sector", "pilot", sticks),
        Blow(MOMENTS[number % len(MOMENTS)], "abort"),
    ]


async def run(given: argparse.Namespace) -> list[Struck]:
    struck, missions, begun_s = list[Struck](), count(), time.monotonic()
    async with proxied(given.vehicle) as proxy, piloted(proxy, given.flavour) as pilot:
        proxy.kept = KEPT | {ATTITUDE, GLOBAL_POSITION}
        for _ in range(given.rounds):
            for delay_ms in given.delays:
                for _ in range(2):
                    if time.monotonic() - begun_s > 60.0 * given.minutes:
                        return struck
                    await _mission(given, proxy, pilot, delay_ms / 1e3, next(missions), struck)
    return struck


async def _mission(
    given: argparse.Namespace, proxy: Proxy, pilot: Pilot, delay_s: float, number: int, struck: list[Struck]
) -> None:
    proxy.record.clear()
    seed = given.seed + len(struck)
    with tempfile.TemporaryDirectory(prefix="crossfix-midway-") as folder:
        settings = Settings(port=0, data_dir=Path(folder), vehicle_url=proxy.url, seed=seed, live_ping_timeout_s=60.0)
        async with running_server(settings) as running, console(running.url) as shown:
            assert running.receiver is not None
            running.receiver.follow(witness(proxy))
            search = Search(running, proxy, pilot, shown, random.Random(seed), given.flavour)
            try:
                await search.begin(delay_s, given.loss)
                for blow in blows(number, given.flavour):
                    struck.append(await search.strike(blow))
                    print(line(struck[-1]), flush=True)
                    _write(given, struck)
            except (TimeoutError, AssertionError) as error:
                print(f"seed {seed}: did not come about: {str(error)[-2000:]}", flush=True)
            finally:
                proxy.delay_s = proxy.loss = 0.0
                await _down(running)
                if given.record is not None:
                    with given.record.open("a") as record:
                        record.writelines(f"{json.dumps(vars_of(passed))}\n" for passed in proxy.record)


async def _down(running: RunningServer) -> None:
    vehicle = running.services.missions.equipment.crafts[FIRST_CRAFT].vehicle
    with contextlib.suppress(VehicleError, TimeoutError):
        if vehicle.telemetry().armed:
            vehicle.take_control()
            await vehicle.land()
            await until(lambda: vehicle.telemetry().armed is False, 120.0, "the landing")
    with contextlib.suppress(TimeoutError):
        await until(lambda: not running.services.missions.flights.nets.owed, 60.0, "the owner's fence")


def line(one: Struck) -> str:
    """For a person who watches the run."""
    still = "TURNS ON" if one.still_s is None else f"still after {one.still_s:.2f} s"
    shown = "NEVER SHOWN" if one.shown_s is None else f"shown after {one.shown_s:.2f} s"
    took = "did not take" if one.took_s is None else f"took {one.took_s:.2f} s"
    after = {True: "went on", False: "DID NOT GO ON", None: "ended"}[one.went_on]
    return (
        f"{one.deed:5} {one.means:6} in a {one.during:6} {one.delay_s * 1e3:4.0f} ms, "
        f"nose at {one.rate_deg_s:+.0f} deg/s: "
        f"{took}{', UNDONE' if one.undone else ''}, {shown}, {still} and {one.turned_deg:.0f} deg, "
        f"{one.steered} orders of place or nose afterwards, {after}" + "".join(f"\n    {told}" for told in one.story)
    )


def table(struck: list[Struck]) -> Table:
    groups: dict[tuple[str, str, str, float], list[Struck]] = {}
    for one in struck:
        groups.setdefault((one.during, one.deed, one.means, one.delay_s), []).append(one)
    rows = [
        (
            during,
            deed if not means else f"{deed}, by {means}",
            round(delay_s * 1e3),
            len(group),
            sum(one.undone for one in group),
            max((one.shown_s for one in group if one.shown_s is not None), default=None),
            max((one.still_s for one in group if one.still_s is not None), default=None),
            max(one.turned_deg for one in group),
            sum(one.still_s is None for one in group),
            sum(one.steered for one in group),
        )
        for (during, deed, means, delay_s), group in sorted(groups.items())
    ]
    columns = (
        Column(name="in a"),
        Column(name="struck by"),
        Column(name="delay each way, ms"),
        Column(name="strikes"),
        Column(name="undone"),
        Column(name="shown, s at most", decimals=2),
        Column(name="nose still, s at most", decimals=2),
        Column(name="turned meanwhile, deg at most", decimals=0),
        Column(name="turned on"),
        Column(name="steered afterwards"),
    )
    return Table(name="strikes", columns=columns, rows=tuple(rows))


def figures(struck: list[Struck]) -> list[Figure]:
    note = f"of {len(struck)}"
    rested = [one.still_s for one in struck if one.still_s is not None]
    return [
        plain("strikes while the nose turned", len(struck), ""),
        plain("takeovers undone", sum(one.undone for one in struck), "", note=note),
        plain("never shown", sum(one.shown_s is None for one in struck), "", note=note),
        plain("nose turned on", sum(one.still_s is None for one in struck), "", note=note),
        plain("orders of a place or of the nose afterwards", sum(one.steered for one in struck), "", note=note),
        plain("search not resumed", sum(one.went_on is False for one in struck), "", note=note),
        plain("that did not take", sum(one.took_s is None for one in struck), "", note=note),
        plain("nose still, at most", max(rested, default=0.0), "s", note=note),
        plain("nose turned meanwhile, at most", max((one.turned_deg for one in struck), default=0.0), "deg", note=note),
    ]


def _write(given: argparse.Namespace, struck: list[Struck]) -> None:
    """After each strike: a run cut short leaves what it has flown."""
    title = f"New missions struck while the nose turns, on a real autopilot, {given.flavour}"
    page = "faults-in-flight.md#real-autopilots"
    name = f"midway_{given.flavour}"
    write(given.out, name, title, given.begun, figures(struck), tables=[table(struck)], page=page)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", help="its address, as `crossfix serve --vehicle` takes it")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--rounds", type=int, default=1, help="each flies two missions at each delay, of eleven blows")
    parser.add_argument("--delays", type=float, nargs="+", default=[0.0, 250.0], help="ms each way")
    parser.add_argument("--loss", type=float, default=0.0, help="share of frames that is lost each way")
    parser.add_argument("--minutes", type=float, default=600.0, help="begin no mission after so long")
    parser.add_argument("--seed", type=int, default=1, help="of the first mission")
    parser.add_argument("--record", type=Path, help="write what passed, a JSON line each")
    add_out(parser)
    given = parser.parse_args()
    given.begun = begin(__file__)
    struck = asyncio.run(run(given))
    print(json.dumps([figure.model_dump(exclude_defaults=True) for figure in figures(struck)], indent=2))
    sys.exit(any(one.wrong for one in struck))


if __name__ == "__main__":
    main()
