"""Every viewer gets every event once and in order at its own pace; of values that go stale it gets the newest."""

from __future__ import annotations

import asyncio
import json
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.events import HoldOrdered, Recorded, SweepStarted
from backend.live.hub import FEEDS, RING, STALLED_S, Hub, Viewer, event_text, stored_event_text
from backend.live.viewer import ViewerStalled, serve
from backend.ports import CraftStatus, Status
from hardware.readings import Place, Telemetry
from planner.belief.grid import GridBelief

AT = datetime(2026, 1, 1, tzinfo=UTC)
TELEMETRY = Telemetry(connected=True, at_s=100.0, position=Place(50.6, 7.2), position_at_s=99.0)
CRAFT = CraftStatus("craft-1", "m", "flying", "ok", -60.0, 0.1, 12.0)
STATUS = Status("m", "flying", (CRAFT, CraftStatus("craft-2", None, "ground", "off", None, None, None)), "ok")


def fact(seq: int, mission_id: str = "m", event=None) -> Recorded:
    event = event or HoldOrdered(craft_id="craft-1", by=str(seq), reason=None)
    return Recorded(seq=seq, mission_id=mission_id, at_utc=AT, event=event)


class Bench:
    """A hub over a list of facts, and viewers whose link can be stopped."""

    def __init__(self) -> None:
        self.stored: list[Recorded] = []
        self.hub = Hub(self.read, lambda: 100.0)
        self.tasks: list[asyncio.Task[None]] = []

    async def read(self, mission_id: str, after: int) -> list[str]:
        await asyncio.sleep(0)
        return [
            record.model_dump_json() for record in self.stored if record.mission_id == mission_id and record.seq > after
        ]

    def happen(self, count: int, publish: bool = True) -> None:
        for _ in range(count):
            self.stored.append(fact(len(self.stored) + 1))
            if publish:
                self.hub.events(self.stored[-1:])

    def watch(self, mission_id: str | None = "m", after: int = 0, lite: bool = False) -> Link:
        link = Link(Viewer(mission_id, lite, after))
        self.hub.join(link.viewer, len(self.stored))
        self.tasks.append(asyncio.create_task(serve(self.hub, link.viewer, link.send)))
        return link


class Link:
    def __init__(self, viewer: Viewer) -> None:
        self.viewer = viewer
        self.open = asyncio.Event()
        self.open.set()
        self.got: list[str | bytes] = []

    async def send(self, content: str | bytes) -> None:
        await self.open.wait()
        self.got.append(content)

    def of(self, kind: str) -> list[dict]:
        read = [json.loads(content) for content in self.got if isinstance(content, str)]
        return [message for message in read if message["type"] == kind]

    def seqs(self) -> list[int]:
        return [message["recorded"]["seq"] for message in self.of("event")]


def test_an_event_out_of_the_journal_is_told_as_one_that_happens() -> None:
    assert stored_event_text(fact(3).model_dump_json()) == event_text(fact(3))


async def settle() -> None:
    for _ in range(200):
        await asyncio.sleep(0)


@pytest.fixture
async def bench():
    bench = Bench()
    yield bench
    for task in bench.tasks:
        task.cancel()
    await asyncio.gather(*bench.tasks, return_exceptions=True)


async def test_a_viewer_gets_what_was_stored_and_then_what_happens(bench):
    bench.happen(5, publish=False)
    link = bench.watch(after=2)
    await settle()
    bench.happen(3)
    await settle()
    assert link.seqs() == [3, 4, 5, 6, 7, 8]


async def test_a_viewer_far_behind_the_ring_is_served_from_the_journal(bench):
    link = bench.watch()
    link.open.clear()
    bench.happen(2 * RING + 7)
    await settle()
    bench.happen(3)
    link.open.set()
    for _ in range(20):
        await settle()
    assert link.seqs() == list(range(1, 2 * RING + 11))


async def test_an_event_stored_but_never_published_arrives_with_the_next(bench):
    link = bench.watch()
    bench.happen(2)
    bench.happen(1, publish=False)
    bench.happen(1)
    await settle()
    assert link.seqs() == [1, 2, 3, 4]


async def test_events_published_out_of_order_arrive_in_order_and_once(bench):
    link = bench.watch()
    bench.happen(4, publish=False)
    for seq in (1, 3, 2, 4, 4):
        bench.hub.events([bench.stored[seq - 1]])
        await settle()
    assert link.seqs() == [1, 2, 3, 4]


async def test_what_is_stored_while_a_viewer_joins_reaches_the_others_too(bench):
    first = bench.watch()
    await settle()
    bench.happen(1, publish=False)
    second = bench.watch()
    bench.hub.events(bench.stored)
    await settle()
    assert first.seqs() == second.seqs() == [1]


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.one_of(
            st.tuples(st.just("happen"), st.integers(1, 70)),
            st.tuples(st.just("unpublished"), st.integers(1, 3)),
            st.tuples(st.just("join"), st.integers(0, 50)),
            st.tuples(st.just("stop"), st.integers(0, 5)),
            st.tuples(st.just("go"), st.integers(0, 5)),
            st.tuples(st.just("settle"), st.just(0)),
        ),
        max_size=25,
    )
)
def test_no_event_is_lost_or_doubled_whatever_happens(steps):
    async def scenario() -> None:
        bench, links = Bench(), []
        for kind, number in steps:
            if kind == "happen":
                bench.happen(number)
            elif kind == "unpublished":
                bench.happen(number, publish=False)
            elif kind == "join":
                after = min(number, len(bench.stored))
                links.append((after, bench.watch(after=after)))
            elif kind in {"stop", "go"} and links:
                link = links[number % len(links)][1]
                (link.open.clear if kind == "stop" else link.open.set)()
            else:
                await settle()
        bench.happen(1)
        for _, link in links:
            link.open.set()
        for _ in range(10):
            await settle()
        for after, link in links:
            assert link.seqs() == list(range(after + 1, len(bench.stored) + 1))
        for task in bench.tasks:
            task.cancel()
        await asyncio.gather(*bench.tasks, return_exceptions=True)

    asyncio.run(scenario())


async def test_a_slow_viewer_gets_the_newest_telemetry_and_what_it_missed_is_counted(bench):
    link = bench.watch()
    bench.hub.telemetry("craft-1", TELEMETRY, 100.0)
    await settle()
    link.open.clear()
    for second in range(101, 110):
        bench.hub.telemetry("craft-1", replace(TELEMETRY, battery_percent=float(second)), float(second))
        await settle()
    link.open.set()
    await settle()
    first, caught, newest = link.of("telemetry")
    assert (first["dropped"], first["position_age_s"]) == (0, 1.0)
    assert caught["battery_percent"] == 101.0
    assert (newest["battery_percent"], newest["dropped"]) == (109.0, 7)


async def test_a_new_viewer_sees_the_present_at_once_and_missed_nothing(bench):
    for second in range(5):
        bench.hub.telemetry("craft-1", TELEMETRY, 100.0 + second)
        bench.hub.status(STATUS)
    link = bench.watch(None)
    await settle()
    assert [m["dropped"] for m in link.of("telemetry")] == [0]
    (status,) = link.of("status")
    assert (status["phase"], [(c["craft_id"], c["phase"]) for c in status["crafts"]]) == (
        "flying",
        [("craft-1", "flying"), ("craft-2", "ground")],
    )
    assert link.seqs() == []


async def test_telemetry_lives_while_a_long_journal_is_caught_up_with(bench):
    bench.happen(400, publish=False)
    bench.hub.telemetry("craft-1", TELEMETRY, 100.0)
    link = bench.watch()
    for _ in range(5):
        await settle()
    kinds = [json.loads(content)["type"] for content in link.got]
    assert kinds.index("telemetry") < 60
    assert kinds.count("event") == 400


async def test_the_belief_comes_in_the_viewers_encoding_and_only_for_its_mission(bench):
    belief = GridBelief(np.full((3, 2), 1 / 6), 0.0, 0.0, 1.0, (), (), 1, True)
    full, lite, other = bench.watch(), bench.watch(lite=True), bench.watch("n")
    bench.hub.belief("m", "emitter-1", 7, 1, belief, [(7.0, 50.0)] * 4)
    await settle()
    assert [b"f32-shuffle-zlib" in frame for frame in full.got] == [True]
    assert [b"u8-log-zlib" in frame for frame in lite.got] == [True]
    assert other.got == []


async def test_the_belief_of_an_event_goes_out_before_the_event(bench):
    belief = GridBelief(np.full((3, 2), 1 / 6), 0.0, 0.0, 1.0, (), (), 1, True)
    early = bench.watch()
    for seq in (1, 2):
        bench.happen(1)
        bench.hub.belief("m", "emitter-1", seq, seq, belief, [(7.0, 50.0)] * 4)
        await settle()
    late = bench.watch()
    await settle()
    kinds = [["belief" if isinstance(content, bytes) else "event" for content in link.got] for link in (early, late)]
    assert kinds == [["belief", "event"] * 2, ["belief", "event", "event"]]


async def test_of_several_craft_and_emitters_each_has_its_newest_value(bench):
    belief = GridBelief(np.full((3, 2), 1 / 6), 0.0, 0.0, 1.0, (), (), 1, True)
    link = bench.watch()
    link.open.clear()
    await settle()
    for second in range(3):
        for craft_id in ("craft-1", "craft-2"):
            heard = replace(TELEMETRY, battery_percent=float(second))
            bench.hub.telemetry(craft_id, heard, 100.0 + second)
        for emitter_id in ("emitter-1", "emitter-2"):
            bench.hub.belief("m", emitter_id, 7 + second, second, belief, [(7.0, 50.0)] * 4)
    link.open.set()
    await settle()
    newest = {m["craft_id"]: m["battery_percent"] for m in link.of("telemetry")}
    assert newest == {"craft-1": 2.0, "craft-2": 2.0}
    frames = [frame for frame in link.got if isinstance(frame, bytes)]
    assert [b'"seq":9' in frame for frame in frames] == [True, True]
    assert [name in frame for frame, name in zip(frames, (b"emitter-1", b"emitter-2"), strict=True)] == [True, True]


async def test_the_running_sweep_is_thinned_and_forgotten_when_a_new_one_begins(bench):
    link = bench.watch()
    bench.hub.sweep_progress("m", "craft-1", "emitter-1", 1, [float(n) for n in range(1000)], [0.0] * 1000, 100.0)
    await settle()
    (progress,) = link.of("sweep_progress")
    assert 300 <= len(progress["heading_deg"]) == len(progress["power_db"]) <= 360
    bench.stored.append(fact(1, event=SweepStarted(craft_id="craft-1", place_number=1, attempt=2)))
    bench.hub.events(bench.stored)
    late = bench.watch()
    await settle()
    assert late.of("sweep_progress") == []


async def test_a_lite_viewer_gets_telemetry_once_a_second_the_last_value_too_and_every_event(bench, monkeypatch):
    loop, began = asyncio.get_running_loop(), asyncio.get_running_loop().time()
    full, lite = bench.watch(), bench.watch(lite=True)
    for tick in range(26):
        monkeypatch.setattr(loop, "time", lambda tick=tick: began + tick / 10)
        bench.hub.telemetry("craft-1", replace(TELEMETRY, battery_percent=float(tick)), 100.0 + tick / 10)
        bench.happen(1)
        await settle()
    assert len(full.of("telemetry")) == 26
    assert [m["battery_percent"] for m in lite.of("telemetry")] == [0.0, 10.0, 20.0]
    monkeypatch.setattr(loop, "time", lambda: began + 3.1)
    await settle()
    assert [m["battery_percent"] for m in lite.of("telemetry")] == [0.0, 10.0, 20.0, 25.0]
    assert {m["dropped"] for m in lite.of("telemetry")} == {0}, "what is left out on purpose was not missed"
    assert lite.seqs() == full.seqs() == list(range(1, 27))


async def test_a_lite_viewer_is_told_at_once_that_the_sweep_is_over(bench):
    lite = bench.watch(lite=True)
    bench.hub.sweep_progress("m", "craft-1", "emitter-1", 1, [1.04], [-60.06], 10.0)
    await settle()
    bench.hub.sweep_progress("m", "craft-1", "emitter-1", 1, [1.0, 2.0], [-60.0, -61.0], 20.0)
    bench.stored.append(fact(1, event=SweepStarted(craft_id="craft-1", place_number=1, attempt=2)))
    bench.hub.events(bench.stored)
    bench.hub.status(STATUS)
    await settle()
    assert [(m["heading_deg"], m["power_db"]) for m in lite.of("sweep_progress")] == [([1.0], [-60.1])]
    assert lite.seqs() == [1]


async def test_a_viewer_that_stands_still_is_no_watcher_and_is_let_go(bench, monkeypatch):
    link, awake = bench.watch(), bench.watch()
    now = asyncio.get_running_loop().time()
    link.open.clear()
    bench.hub.telemetry("craft-1", TELEMETRY, 100.0)
    await settle()
    assert bench.hub.watchers() == 2
    monkeypatch.setattr(asyncio.get_running_loop(), "time", lambda: now + STALLED_S + 1)
    assert bench.hub.watchers() == 1
    assert len(awake.of("telemetry")) == 1
    monkeypatch.setattr(asyncio.get_running_loop(), "time", lambda: now + 1000)
    with pytest.raises(ViewerStalled):
        await bench.tasks[0]


async def test_missions_nobody_watches_are_forgotten(bench):
    link = bench.watch("watched")
    bench.hub.events([fact(1, "watched")])
    for n in range(3 * FEEDS):
        bench.hub.events([fact(1, f"m{n}")])
    await settle()
    bench.hub.events([fact(2, "watched")])
    await settle()
    assert link.seqs() == [1, 2]
    assert bench.hub.feeds() <= FEEDS
