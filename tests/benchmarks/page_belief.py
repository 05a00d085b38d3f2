"""From a bearing to its belief on the screen, stage by stage: one JSON object on standard output.

    python -m tests.benchmarks.page_belief --missions 4 --speedup 1.5
    python -m tests.benchmarks.page_belief --missions 1 --bearings 12 --speedup 1.5

Missions as they are suggested are flown, in a world of its own each, and their page watched; with --bearings, towards
a goal that is not reached, until enough are painted. Times in ms of wall time: `server` from the arrival of the
bearing's event in the browser to that of the belief or of its event, `frame` from there to that of the other, `page`
from there until the map has its picture (read, fold, colour), `drawn` from there until the map has drawn it; `whole` is
their sum. `repaints`: how often the map was drawn in `whole`. `work_ms` is what the server's parts need of one thread
when nothing else runs in it: comparable between machines under load. Without a graphics card the processor draws:
`drawn` is then an upper bound.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np

from backend.api.suggestion import suggested_mission
from backend.events import FIRST_CRAFT, BearingMeasured, CraftSource
from backend.search.localization import localization
from backend.spec import FIRST_EMITTER, Place
from backend.wire.belief_frame import encode_belief
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.watched_page import share, spread, watched_page
from tests.browser.conftest import serving
from tests.browser.screen import Screen

WATCH = """
window.stages = [];
let open = null;
const clear = WebGL2RenderingContext.prototype.clear;
WebGL2RenderingContext.prototype.clear = function (mask) {
  if (open && mask & this.COLOR_BUFFER_BIT) open.repaints += 1;
  clear.call(this, mask);
};
const Plain = window.WebSocket;
window.WebSocket = class extends Plain {
  constructor(...all) {
    super(...all);
    this.addEventListener('message', ({data}) => {
      const at = performance.now();
      if (typeof data === 'string' && data.includes('"kind":"bearing_measured"')) open = {bearing: at, repaints: 0};
      if (open && (typeof data !== 'string' || data.includes('"kind":"belief_updated"'))) {
        if (open.first) open.both = at; else open.first = at;
      }
    });
  }
};
let last;
Object.defineProperty(window, 'crossfixBeliefPainted', {
  get: () => last,
  set: (painted) => {
    last = painted;
    if (open && open.both && painted.givenMs >= open.both) {
      stages.push({...open, given: painted.givenMs, drawn: painted.atMs});
      open = null;
    }
  },
});
"""

STAGES = (
    ("server", "bearing", "first"),
    ("frame", "first", "both"),
    ("page", "both", "given"),
    ("drawn", "given", "drawn"),
    ("whole", "bearing", "drawn"),
)


def of_one_thread(work: Callable[[], Any], times: int = 9) -> float:
    taken = []
    for _ in range(times):
        began = time.thread_time()
        work()
        taken.append(1e3 * (time.thread_time() - began))
    return share(taken, 0.5) or 0.0


def own_work() -> dict[str, dict[str, float | None]]:
    """Thread milliseconds of the server's parts after one to six bearings of a typical search."""
    home = Place(lat=50.73, lon=7.1)
    task = localization(suggested_mission(home), home)
    noise = np.random.default_rng(1)
    measured: list[BearingMeasured] = []
    found: dict[str, list[float]] = {"update": [], "encode": [], "encode_lite": []}
    for number, (x, y) in enumerate(((0, 0), (100, 50), (-60, 120), (90, 150), (0, 100), (60, 190)), start=1):
        bearing = (90 - math.degrees(math.atan2(150.0 - y, 40.0 - x)) + noise.normal(0, 5)) % 360
        measured.append(
            BearingMeasured(
                emitter_id=FIRST_EMITTER,
                source=CraftSource(craft_id=FIRST_CRAFT),
                bearing_id=f"b{number}",
                sweep_id=f"s{number}",
                place_number=number,
                place=task.place(x, y),
                altitude_amsl_m=100.0,
                bearing_deg=bearing,
                sigma_deg=5.0,
                quality=0.9,
                peaks=[],
                snr_db=20.0,
                drift_m=0.0,
                binned_db=[-60.0] * 180,
                fitted_db=[-60.0] * 180,
            )
        )
        _, belief = task.belief_fact(measured)
        corners = task.corners_lon_lat(belief)
        found["update"].append(of_one_thread(lambda: task.belief_fact(measured)))
        for name, lite in (("encode", False), ("encode_lite", True)):
            work = lambda lite=lite: encode_belief("m", "e", 1, 1, belief.density, corners, lite=lite)  # noqa: B023, E731
            found[name].append(of_one_thread(work))
    return {name: {"median": share(values, 0.5), "worst": share(values, 1.0)} for name, values in found.items()}


def fly(seed: int, speedup: float, bearings: int | None) -> list[dict[str, float]]:
    """One mission, until it ends or that many bearings are painted."""
    endless = {"expected_rmse_m": 0.1, "maximum_bearings": 200}
    with (
        tempfile.TemporaryDirectory() as folder,
        serving(Path(folder), speedup, seed=seed) as server,
        watched_page(WATCH) as page,
    ):
        page.goto(server.url)
        screen = Screen(page, server.url)
        spec = server.get("/api/defaults")["spec"]
        spec["localization"] |= endless if bearings else {}
        mission = server.make(spec)
        screen.fly(mission)
        screen.map_ready()
        until = time.monotonic() + 60 + 90 * (bearings or 10)
        while time.monotonic() < until:
            page.wait_for_timeout(1000)
            ended = any(event["kind"] == "mission_ended" for event in server.events(mission))
            if ended or (bearings and len(screen.evaluate("stages")) >= bearings):
                break
        return cast(list[dict[str, float]], screen.evaluate("stages"))


def figures(stages: dict[str, Any], repaints: dict[str, Any], work: dict[str, Any]) -> list[Figure]:
    whole = stages["whole"]
    return [
        wanted("painted", whole["median"], note=f"{whole['of']} bearings"),
        plain("whole, 95 %", whole["p95"], "ms"),
        plain("whole, worst", whole["worst"], "ms"),
        *(plain(f"{name}, median", stages[name]["median"], "ms") for name, *_ in STAGES[:-1]),
        plain("repaints of the map, median", repaints["median"], ""),
        *(plain(f"{name.replace('_', ' ')}, one thread", taken["median"], "ms") for name, taken in work.items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--missions", type=int, default=4)
    parser.add_argument("--bearings", type=int)
    parser.add_argument("--speedup", type=float, default=1.5)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    flown = (fly(3 + number, arguments.speedup, arguments.bearings) for number in range(arguments.missions))
    seen = [stages for mission in flown for stages in mission]
    stages = {name: spread([one[end] - one[begin] for one in seen]) for name, begin, end in STAGES}
    repaints = spread([one["repaints"] for one in seen])
    if not seen:
        sys.exit("no bearing was painted in time")
    work = own_work()
    print(json.dumps({"stages_ms": stages, "repaints": repaints, "work_ms": work}))
    title, made = "A bearing's way to the screen", figures(stages, repaints, work)
    write(arguments.out, "page_belief", title, begun, made, page="page-speed.md#a-bearings-way-to-the-screen")


if __name__ == "__main__":
    main()
