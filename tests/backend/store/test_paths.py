"""A flown path takes less room when its mission is over, and is read as it was flown."""

from __future__ import annotations

import asyncio
import math
import zlib
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from facts import HOME, SPEC
from hypothesis import given, settings
from hypothesis import strategies as st
from sqlalchemy import func, select

from backend.events import MissionDrafted, MissionEnded, MissionStarted, Phase, PhaseChanged
from backend.ports import TrackPoint
from backend.reasons.flight import Ordered
from backend.reasons.search import Localized
from backend.store import retention
from backend.store.engine import engine_for_once
from backend.store.entries import TrackEntry
from backend.store.paths import MOST_BYTES, MOST_POINTS, packed_path, unpacked_path
from backend.store.retention import DELETED_DAYS, bury, pack_paths
from backend.store.tables import missions, paths, tracks

BEGAN_S = 1_795_444_578.745450
NOW = datetime.fromtimestamp(BEGAN_S, UTC) + timedelta(days=1)
PATIENCE_S = 60.0
MODES = ("HOLD", "OFFBOARD", None)


def flown(count: int, began_s: float = BEGAN_S) -> list[TrackPoint]:
    """In the steps of an autopilot: 1e-7 degree, a millimetre, a percent."""
    return [
        TrackPoint(
            round(began_s + 0.5 * n + 1e-3 * math.sin(n), 6),
            round(50.6 + 3e-5 * math.sin(n / 40), 7),
            round(7.2 - 4e-5 * math.cos(n / 50), 7),
            round(160.0 + 0.3 * math.sin(n / 3), 3),
            round(40.0 + 0.3 * math.sin(n / 3), 3),
            round((1.7 * n) % 360, 2),
            float(96 - n // 100),
            MODES[n // 50 % 2],
        )
        for n in range(count)
    ]


def craft(before: Phase, after: Phase) -> PhaseChanged:
    return PhaseChanged(craft_id="craft-1", before=before, after=after, reason=Ordered("abort", "operator"))


STARTED = [
    MissionDrafted(spec=SPEC),
    MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0"),
    craft("ground", "flying"),
]
OVER = [MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0), craft("flying", "ground")]


def test_a_path_comes_back_in_a_ninth_of_the_room() -> None:
    path = flown(MOST_POINTS)
    assert unpacked_path(packed_path(path)) == path
    assert len(packed_path(path)) < 10 * len(path)


_known = st.one_of(st.none(), st.floats(-1e4, 1e4).map(lambda value: round(value, 2)))
_points = st.builds(
    TrackPoint,
    st.integers(0, 10**16).map(lambda us: us / 1e6),
    st.floats(-90, 90).map(lambda deg: round(deg, 7)),
    st.floats(-180, 180).map(lambda deg: round(deg, 7)),
    _known,
    _known,
    _known,
    _known,
    st.one_of(st.none(), st.text(max_size=8)),
)


@settings(deadline=None)
@given(st.lists(_points, min_size=1, max_size=8))
def test_whatever_was_not_known_is_not_known_again(points: list[TrackPoint]) -> None:
    assert unpacked_path(packed_path(points)) == points


def test_a_heading_comes_back_to_the_hundredth_of_a_degree() -> None:
    (point,) = unpacked_path(packed_path([replace(flown(1)[0], heading_deg=37.02932833046887)]))
    assert point.heading_deg == 37.03


@pytest.mark.parametrize(
    "kept",
    [
        b"",
        b"no zlib",
        zlib.compress(b"no head"),
        zlib.compress(b'{"points": 2, "modes": []}\n' + b"0" * 64),
        zlib.compress(b'{"points": -1, "modes": []}\n' + b"0" * 64),
        zlib.compress(b'{"points": 1, "modes": []}\n' + b"\2" * 64),
        packed_path(flown(9))[:-30],
        zlib.compress(b'{"points": 1, "modes": []}\n' + b"0" * 2 * MOST_BYTES),
    ],
    ids=["nothing", "other bytes", "no head", "too short", "fewer than none", "a mode of no name", "cut off", "a bomb"],
)
def test_what_was_never_packed_here_is_refused_by_a_sentence(kept: bytes) -> None:
    with pytest.raises(ValueError, match="stored path"):
        unpacked_path(kept)


async def counted(engine) -> dict[str, tuple[int, int]]:
    """By mission: points in rows, and pieces."""
    found: dict[str, tuple[int, int]] = {}
    async with engine.connect() as connection:
        for mission_id in await connection.scalars(select(missions.c.mission_id)):
            both = [select(func.count()).where(table.c.mission_id == mission_id) for table in (tracks, paths)]
            found[mission_id] = tuple([(await connection.execute(query)).scalar_one() for query in both])
    return found


async def test_paths_are_packed_when_their_mission_is_over(bench) -> None:
    bench.now_s, bench.timeout_s = BEGAN_S, PATIENCE_S
    journal = await bench.open()
    await journal.append("over", [*STARTED, *OVER])
    await journal.append("flying", STARTED)
    long, other = flown(MOST_POINTS + 100), flown(30)
    for mission_id in ("over", "flying"):
        await journal.save_track(mission_id, "craft-1", long)
    await journal.save_track("over", "craft-2", other)
    before = await journal.tracks("over")
    assert before == {"craft-1": long, "craft-2": other}
    engine = engine_for_once(bench.url, PATIENCE_S)
    assert await pack_paths(engine, NOW) == 3
    assert await counted(engine) == {"over": (0, 3), "flying": (len(long), 0)}
    assert await journal.tracks("over") == before
    assert await pack_paths(engine, NOW) == 0
    await engine.dispose()


async def test_points_that_come_late_or_twice_count_once(bench) -> None:
    """A spool may be drained when the mission is long over, and writes again whatever it is not sure of."""
    bench.now_s, bench.timeout_s = BEGAN_S, PATIENCE_S
    journal = await bench.open()
    await journal.append("over", [*STARTED, *OVER])
    path = flown(200)
    await journal.save_track("over", "craft-1", path[50:])
    engine = engine_for_once(bench.url, PATIENCE_S)
    assert await pack_paths(engine, NOW) == 1
    await journal.save_track("over", "craft-1", path[:120])
    assert await journal.tracks("over") == {"craft-1": path}
    assert await pack_paths(engine, NOW) == 1
    await journal.save_track("over", "craft-1", path[50:51])
    assert await pack_paths(engine, NOW) == 0
    assert await counted(engine) == {"over": (0, 2)}
    assert await journal.tracks("over") == {"craft-1": path}
    await engine.dispose()


async def test_a_path_that_cannot_be_packed_holds_up_no_other(bench) -> None:
    """The packer comes by every few hours, for every mission, for ever."""
    bench.now_s, bench.timeout_s = BEGAN_S, PATIENCE_S
    journal = await bench.open()
    for mission_id in ("odd", "over"):
        await journal.append(mission_id, [*STARTED, *OVER])
    odd = [replace(point, mode=f"{n}" * 200) for n, point in enumerate(flown(300))]
    high = [replace(point, altitude_amsl_m=1e300, battery_percent=-1e30) for point in flown(3)]
    await journal.save_track("odd", "craft-1", odd)
    await journal.save_track("over", "craft-1", high)
    engine = engine_for_once(bench.url, PATIENCE_S)
    assert await pack_paths(engine, NOW) == 1
    assert await counted(engine) == {"odd": (300, 0), "over": (0, 1)}
    assert await journal.tracks("odd") == {"craft-1": odd}
    unknown = [replace(point, altitude_amsl_m=None, battery_percent=None) for point in high]
    assert await journal.tracks("over") == {"craft-1": unknown}
    await engine.dispose()


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_a_point_that_is_written_while_its_neighbours_are_packed_stays(bench, monkeypatch) -> None:
    """SQLite lets nobody write meanwhile."""
    bench.now_s, bench.timeout_s = BEGAN_S, PATIENCE_S
    journal = await bench.open()
    await journal.append("over", [*STARTED, *OVER])
    path = flown(20)
    await journal.save_track("over", "craft-1", [*path[:7], *path[8:]])

    def packed_meanwhile(points: list[TrackPoint]) -> bytes:
        monkeypatch.setattr(retention, "packed_path", packed_path)
        asyncio.run(late())
        return packed_path(points)

    async def late() -> None:
        other = engine_for_once(bench.url, PATIENCE_S)
        async with other.begin() as connection:
            await connection.run_sync(TrackEntry("over", "craft-1", (path[7],)).write)
        await other.dispose()

    monkeypatch.setattr(retention, "packed_path", packed_meanwhile)
    engine = engine_for_once(bench.url, PATIENCE_S)
    await pack_paths(engine, NOW)
    assert await journal.tracks("over") == {"craft-1": path}
    await engine.dispose()


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_two_servers_pack_a_path_once(bench) -> None:
    bench.now_s, bench.timeout_s = BEGAN_S, PATIENCE_S
    journal = await bench.open()
    await journal.append("over", [*STARTED, *OVER])
    path = flown(3000)
    await journal.save_track("over", "craft-1", path)
    engines = [engine_for_once(bench.url, PATIENCE_S) for _ in range(3)]
    assert sum(await asyncio.gather(*(pack_paths(engine, NOW) for engine in engines))) == 1
    assert await journal.tracks("over") == {"craft-1": path}
    for engine in engines:
        await engine.dispose()


async def test_a_deleted_mission_takes_its_packed_path_with_it(bench) -> None:
    bench.now_s, bench.timeout_s = BEGAN_S, PATIENCE_S
    journal = await bench.open()
    await journal.append("over", [*STARTED, *OVER])
    await journal.save_track("over", "craft-1", flown(20))
    engine = engine_for_once(bench.url, PATIENCE_S)
    await pack_paths(engine, NOW)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(missions.update().values(deleted_at_us=0))
    assert await bury(engine, DELETED_DAYS, NOW) == 1
    assert await counted(engine) == {}
    async with engine.connect() as connection:
        assert (await connection.execute(select(func.count()).select_from(paths))).scalar_one() == 0
    await engine.dispose()
