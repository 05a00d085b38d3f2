"""Is hover hover, and are headings those of their moment? On a real autopilot, by the delay of its link.

    python -m tests.strikes.steady udpin://127.0.0.1:14540 --flavour px4 --times 5 --delays 0 80 250

Each round flies a leg at 7 m/s and orders hold in the middle of it: how far does the vehicle still move after `hold()`
said that it hovers? And how far in as long a time once it has hovered for long? Then it turns once around: what the
program takes for the heading at a moment, minus what the autopilot said at its end of the link in that moment.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import statistics
import time
from bisect import bisect
from dataclasses import dataclass
from itertools import pairwise

from hardware.autopilot.connect import connect_vehicle
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import WallClock
from hardware.frame import LocalFrame
from hardware.ports import VehicleError
from hardware.readings import Place
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.strikes.proxy import ATTITUDE, GLOBAL_POSITION, KEPT, Proxy, proxied
from tests.strikes.strike import ready, until

SPEED_M_S, RATE_DEG_S, HEIGHT_M = 7.0, 30.0, 12.0
AFTERWARDS_S = 8.0


@dataclass(frozen=True, slots=True)
class Round:
    """moved_m: the farthest from where it was when `hold()` returned. wanders_m: the same later on, while it hovers
    anyway. arrived_m: the same after an arrival.

    Heading errors in degrees while turning: median (signed) and 95 % of their amounts. clock_rate: the autopilot's
    seconds in one wall-clock second, over the turn.
    """

    delay_s: float
    hold_s: float
    moved_m: float
    wanders_m: float
    arrived_m: float
    heading_median_deg: float
    heading_p95_deg: float
    clock_rate: float


async def one(vehicle: MavsdkVehicle, proxy: Proxy, clock: WallClock, east: float) -> Round:
    home, amsl = vehicle.telemetry().home, vehicle.telemetry().home_amsl_m
    assert home is not None
    assert amsl is not None
    flight = asyncio.create_task(vehicle.goto(LocalFrame(home).to_geo(east, 0.0), amsl + HEIGHT_M, SPEED_M_S))
    await until(lambda: flight.done() or _speed(vehicle) > 0.9 * SPEED_M_S, 30.0, "the speed")
    if flight.done():
        flight.result()
    began_s = time.monotonic()
    await vehicle.hold()
    hold_s = time.monotonic() - began_s
    await asyncio.gather(flight, return_exceptions=True)
    moved_m, wanders_m = await _moved(proxy), await _moved(proxy)
    await vehicle.goto(LocalFrame(home).to_geo(0.3 * east, 0.0), amsl + HEIGHT_M, SPEED_M_S)
    arrived_m = await _moved(proxy)

    began_s, began_utc = time.monotonic(), clock.now()
    await vehicle.turn(RATE_DEG_S)
    told = _told_headings(proxy, began_s)
    samples = [sample for sample in vehicle.headings(began_utc) if told.covers(_mono(sample.at_s, began_s, began_utc))]
    errors = [
        math.remainder(sample.heading_deg - told.at(_mono(sample.at_s, began_s, began_utc)), 360.0)
        for sample in samples
    ]
    amounts = sorted(map(abs, errors))
    p95 = amounts[int(0.95 * len(amounts))]
    return Round(proxy.delay_s, hold_s, moved_m, wanders_m, arrived_m, statistics.median(errors), p95, told.rate())


def _speed(vehicle: MavsdkVehicle) -> float:
    telemetry = vehicle.telemetry()
    return math.hypot(telemetry.velocity_north_m_s or 0.0, telemetry.velocity_east_m_s or 0.0)


def _mono(at_utc: float, began_s: float, began_utc: float) -> float:
    return at_utc - began_utc + began_s


async def _moved(proxy: Proxy) -> float:
    """Metres at most from the present place in the next seconds, by what the autopilot itself says."""
    began_s = time.monotonic()
    await asyncio.sleep(AFTERWARDS_S)
    places = [
        Place(passed.fields["lat"] / 1e7, passed.fields["lon"] / 1e7)
        for passed in proxy.since(began_s - 0.2)
        if passed.way == "from" and passed.number == GLOBAL_POSITION
    ]
    frame = LocalFrame(places[0])
    return max(math.hypot(*frame.to_enu(place)) for place in places)


class Told:
    """Headings at the autopilot's end of the link: (time.monotonic, degrees without jumps, boot seconds)."""

    def __init__(self, told: list[tuple[float, float, float]]) -> None:
        self._at = [at for at, _, _ in told]
        self._deg = [told[0][1]]
        for (_, before, _), (_, after, _) in pairwise(told):
            self._deg.append(self._deg[-1] + math.remainder(after - before, 360.0))
        self._boot = [boot for _, _, boot in told]

    def covers(self, at_s: float) -> bool:
        return self._at[0] <= at_s < self._at[-1]

    def at(self, at_s: float) -> float:
        after = bisect(self._at, at_s)
        t0, t1 = self._at[after - 1], self._at[after]
        share = 0.0 if t1 == t0 else (at_s - t0) / (t1 - t0)
        return self._deg[after - 1] + share * (self._deg[after] - self._deg[after - 1])

    def rate(self) -> float:
        return (self._boot[-1] - self._boot[0]) / (self._at[-1] - self._at[0])


def _told_headings(proxy: Proxy, since_s: float) -> Told:
    return Told(
        [
            (passed.at_s, math.degrees(passed.fields["yaw"]), passed.fields["time_boot_ms"] / 1e3)
            for passed in proxy.since(since_s)
            if passed.way == "from" and passed.number == ATTITUDE
        ]
    )


async def run(url: str, times: int, delays_ms: list[float]) -> list[Round]:
    rounds, clock = list[Round](), WallClock()
    async with proxied(url) as proxy:
        proxy.kept = KEPT | {ATTITUDE, GLOBAL_POSITION}
        vehicle = await connect_vehicle(proxy.url, clock)
        try:
            await ready(vehicle)
            vehicle.take_control()
            await vehicle.take_off(HEIGHT_M)
            for _ in range(times):
                for delay_ms in delays_ms:
                    proxy.delay_s = delay_ms / 1e3
                    await asyncio.sleep(2.0)
                    proxy.record.clear()
                    try:
                        rounds.append(await one(vehicle, proxy, clock, 100.0 if len(rounds) % 2 else -100.0))
                        print(rounds[-1], flush=True)
                    except VehicleError as error:
                        print(f"a round at {delay_ms:g} ms did not come about: {error}", flush=True)
        finally:
            with contextlib.suppress(VehicleError):
                await vehicle.land()
            await vehicle.close()
    return rounds


def table(rounds: list[Round]) -> Table:
    columns = (
        Column(name="delay each way, ms"),
        Column(name="rounds"),
        Column(name="moved after hold, m: median", decimals=1),
        Column(name="moved after hold, m: most", decimals=1),
        Column(name="while it hovers anyway, m: median", decimals=1),
        Column(name="while it hovers anyway, m: most", decimals=1),
        Column(name="moved after arrival, m: most", decimals=1),
        Column(name="hold took, s: median", decimals=1),
        Column(name="heading error in a turn, deg: median", decimals=1),
        Column(name="95 % of amounts, worst turn", decimals=1),
        Column(name="clock rate: least", decimals=3),
        Column(name="clock rate: most", decimals=3),
    )
    rows = list[tuple[float, ...]]()
    for delay_s in sorted({one.delay_s for one in rounds}):
        of = [one for one in rounds if one.delay_s == delay_s]
        rows.append(
            (
                round(delay_s * 1e3),
                len(of),
                statistics.median(one.moved_m for one in of),
                max(one.moved_m for one in of),
                statistics.median(one.wanders_m for one in of),
                max(one.wanders_m for one in of),
                max(one.arrived_m for one in of),
                statistics.median(one.hold_s for one in of),
                statistics.median(one.heading_median_deg for one in of),
                max(one.heading_p95_deg for one in of),
                min(one.clock_rate for one in of),
                max(one.clock_rate for one in of),
            )
        )
    return Table(name="rounds", columns=columns, rows=tuple(rows))


def figures(rounds: list[Round]) -> list[Figure]:
    return [
        plain("rounds of hold, arrival and turn", len(rounds), ""),
        plain("moved after hold said it hovers, most", max(one.moved_m for one in rounds), "m"),
        plain("moved while it hovers anyway, most", max(one.wanders_m for one in rounds), "m"),
        plain("moved after an arrival, most", max(one.arrived_m for one in rounds), "m"),
        plain("heading error in a turn, 95 % of amounts, worst", max(one.heading_p95_deg for one in rounds), "deg"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", help="its address, as `crossfix serve --vehicle` takes it")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--delays", type=float, nargs="+", default=[0.0, 80.0, 250.0], help="ms each way")
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    rounds = asyncio.run(run(given.vehicle, given.times, given.delays))
    shown = table(rounds)
    print(json.dumps([dict(zip((c.name for c in shown.columns), row, strict=True)) for row in shown.rows], indent=2))
    title = f"Hover and heading of a real autopilot, {given.flavour}"
    name = f"steady_{given.flavour}"
    write(given.out, name, title, begun, figures(rounds), tables=[shown], page="faults-in-flight.md#real-autopilots")


if __name__ == "__main__":
    main()
