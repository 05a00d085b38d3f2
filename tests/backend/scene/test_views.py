"""Views follow the live mission or stand in the past, each window at its own pace."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import pytest
from narrowing import a, known
from viser import ClientHandle

from backend.events import Recorded
from backend.ports import TrackPoint
from backend.scene import views as views_module
from backend.scene.items import Scene, Surface
from backend.scene.views import MOST_VIEWS, SceneViews, TooManyViews
from backend.terrain import Terrain
from backend.wire.scene import SceneRequest
from hardware.readings import Place, Telemetry


class PaperSource:
    """A journal of one mission that may grow, and a vehicle."""

    def __init__(self, recorded: list[Recorded], track: list[TrackPoint]) -> None:
        self.recorded, self.points = list(recorded), track
        self.flies: str | None = None
        self.away = False
        self.heard = Telemetry(connected=True, at_s=0.0)
        self.reads = 0

    def flying(self) -> str | None:
        return self.flies

    def telemetry(self) -> Telemetry:
        return self.heard

    def now_s(self) -> float:
        return self.recorded[-1].at_utc.timestamp()

    async def last_seq(self, mission_id: str) -> int | None:
        if self.away:
            raise RuntimeError("the database is away")
        return len(self.recorded) if mission_id == "m1" else None

    async def read(self, mission_id: str) -> list[Recorded]:
        self.reads += 1
        return list(self.recorded)

    async def ground(self, digest: str) -> Terrain | None:
        return None

    async def track(self, mission_id: str) -> list[TrackPoint]:
        return self.points


class PaperDrawer:
    """Keeps the scenes it was given to draw; None when it was cleared."""

    def __init__(self, window: SimpleNamespace) -> None:
        self.shown: list[Scene | None] = window.shown

    def draw(self, scene: Scene) -> int:
        if not self.shown or self.shown[-1] is not scene:
            self.shown.append(scene)
        return 0

    def clear(self) -> None:
        if self.shown and self.shown[-1] is not None:
            self.shown.append(None)


@pytest.fixture
def source(recorded, track) -> PaperSource:
    return PaperSource(recorded, track)


@pytest.fixture
async def views(source: PaperSource, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[SceneViews]:
    monkeypatch.setattr(views_module, "Drawer", PaperDrawer)
    monkeypatch.setattr(views_module, "LIVE_TICK_S", 0.01)
    monkeypatch.setattr(views_module, "TICK_S", 0.01)
    views = SceneViews(source)
    yield views
    await views.close()


def open_window(views: SceneViews, view_id: str, number: int = 1) -> list[Scene | None]:
    window = SimpleNamespace(client_id=number, shown=[])
    views._opened(view_id, cast(ClientHandle, window))
    return window.shown


async def until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(60):
        while not condition():  # noqa: ASYNC110 (scenes are drawn by a task of the views)
            await asyncio.sleep(0.005)


def names(scene: Scene | None) -> set[str]:
    return {item.name for item in scene.items} if scene else set()


async def test_a_window_gets_the_scene_of_its_view(views: SceneViews, recorded) -> None:
    told = views.show("view-one", SceneRequest(mission_id="m1"))
    assert (told.url, told.shown_seq, told.watchers) == ("/scene/view-one/", 0, 0)
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    assert "sweeps/3/rose" in names(shown[-1])
    told = known(views.view("view-one"))
    assert (told.shown_seq, told.watchers, told.mission_id) == (len(recorded), 1, "m1")


async def test_scrubbing_changes_the_open_window(views: SceneViews) -> None:
    views.show("view-one", SceneRequest(mission_id="m1"))
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    views.show("view-one", SceneRequest(mission_id="m1", seq=3))
    await until(lambda: len(shown) == 2)
    assert "sweeps/0/bearing" in names(shown[-1])
    assert "sweeps/1/rose" not in names(shown[-1])
    assert known(views.view("view-one")).shown_seq == 3


async def test_two_viewers_watch_different_moments(views: SceneViews, recorded) -> None:
    views.show("view-one", SceneRequest(mission_id="m1"))
    views.show("view-two", SceneRequest(mission_id="m1", seq=1))
    one, two = open_window(views, "view-one", 1), open_window(views, "view-two", 2)
    await until(lambda: bool(one) and bool(two))
    assert known(views.view("view-one")).shown_seq == len(recorded)
    assert known(views.view("view-two")).shown_seq == 1
    assert not any(name.startswith("sweeps") for name in names(two[-1]))


async def test_it_follows_new_events(views: SceneViews, source: PaperSource, recorded) -> None:
    source.recorded = recorded[:4]
    views.show("view-one", SceneRequest(mission_id="m1"))
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    assert known(views.view("view-one")).shown_seq == 4
    source.recorded = list(recorded)
    await until(lambda: known(views.view("view-one")).shown_seq == len(recorded))
    await until(lambda: "sweeps/3/rose" in names(shown[-1]))


async def test_the_vehicle_moves_without_reading_the_journal_again(views: SceneViews, source: PaperSource) -> None:
    source.flies = "m1"
    source.heard = replace(source.heard, position=Place(50.6240, 7.2046), altitude_relative_m=40.0, heading_deg=10.0)
    views.show("view-one", SceneRequest())
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    reads = source.reads
    source.heard = replace(source.heard, position=Place(50.6250, 7.2046), altitude_relative_m=45.0)

    def height() -> float:
        (body,) = [item for item in known(shown[-1]).items if item.name == "vehicle/body"]
        return a(Surface, body).position[2]

    await until(lambda: height() == 45.0)
    assert source.reads == reads
    assert known(views.view("view-one")).mission_id == "m1"


async def test_after_the_flight_the_mission_stays_in_view(views: SceneViews, source: PaperSource) -> None:
    source.flies = "m1"
    views.show("view-one", SceneRequest())
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    source.flies = None
    await until(lambda: source.reads >= 2)
    assert shown[-1] is not None
    assert known(views.view("view-one")).mission_id == "m1"


async def test_an_unknown_mission_is_an_empty_window(views: SceneViews) -> None:
    views.show("view-one", SceneRequest(mission_id="m1"))
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    assert names(shown[-1])
    views.show("view-one", SceneRequest(mission_id="gone"))
    await until(lambda: shown[-1] is None)
    told = known(views.view("view-one"))
    assert (told.mission_id, told.shown_seq) == ("gone", 0)


async def test_the_scene_stays_while_the_database_is_away(views: SceneViews, source: PaperSource, recorded) -> None:
    source.recorded = recorded[:4]
    views.show("view-one", SceneRequest(mission_id="m1"))
    shown = open_window(views, "view-one")
    await until(lambda: bool(shown))
    source.away = True
    views.show("view-one", SceneRequest(mission_id="m1", seq=2))
    await until(lambda: views._views["view-one"].faults > 2)
    assert known(views.view("view-one")).shown_seq == 4
    source.away = False
    await until(lambda: known(views.view("view-one")).shown_seq == 2)
    assert shown[-1] is not None


async def test_a_window_that_comes_back_is_served_again(views: SceneViews) -> None:
    views.show("view-one", SceneRequest(mission_id="m1"))
    first = open_window(views, "view-one", 1)
    await until(lambda: bool(first))
    views._closed("view-one", 1)
    assert known(views.view("view-one")).watchers == 0
    again = open_window(views, "view-one", 2)
    await until(lambda: bool(again))


async def test_views_nobody_watches_make_room(views: SceneViews) -> None:
    for number in range(MOST_VIEWS + 5):
        views.show(f"view-{number:04}", SceneRequest())
    assert views.view("view-0000") is None
    assert views.view(f"view-{MOST_VIEWS + 4:04}") is not None


async def test_too_many_watched_views_are_refused(views: SceneViews) -> None:
    for number in range(MOST_VIEWS):
        views.show(f"view-{number:04}", SceneRequest())
        open_window(views, f"view-{number:04}", number)
    with pytest.raises(TooManyViews):
        views.show("one-more", SceneRequest())
