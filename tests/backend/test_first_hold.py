"""What the first second of a server knows of what was left in flight, from the journal's database alone."""

from __future__ import annotations

import logging
import sqlite3
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest
from facts import FAILSAFE, HOME, OURS, PILOT, SPEC

from backend.events import FORM, AuthorityChanged, Event, MissionDrafted, MissionEnded, MissionStarted, PhaseChanged
from backend.first_hold import FORMS, left_in_flight
from backend.reasons.flight import Ordered
from backend.settings import Settings
from backend.store.entries import EventsEntry, to_row
from backend.store.opening import open_journal
from backend.store.spool import Spool
from backend.store.upgrade import FIRST_FORM
from hardware.authority import NOBODY, Authority
from hardware.sim.autopilot.launch import free_port

STARTED = MissionStarted(craft_id="craft-1", by="anna", home=HOME, home_amsl_m=100.0, software="test")
ORDERED = Ordered("start", "anna")


def goes(after: str) -> PhaseChanged:
    return PhaseChanged(craft_id="craft-1", before="ground", after=after, reason=ORDERED)  # type: ignore[arg-type]


ABORTED = MissionEnded(outcome="aborted", reason=ORDERED, mission_time_s=1.0)


async def stored(settings: Settings, *facts: Event, mission_id: str = "m") -> None:
    async with open_journal(settings, time.time) as journal:
        await journal.append(mission_id, [MissionDrafted(spec=SPEC), *facts])


@pytest.fixture
def settings(tmp_path: Path, database_url: str) -> Settings:
    return Settings(data_dir=tmp_path, database_url=database_url)


@pytest.fixture
def sqlite(tmp_path: Path) -> Settings:
    return Settings(data_dir=tmp_path)


@pytest.mark.parametrize("authority", [OURS, PILOT, FAILSAFE])
async def test_a_mission_in_flight_is_found_with_who_flew_it(settings: Settings, authority: Authority) -> None:
    await stored(settings, STARTED, goes("flying"), AuthorityChanged(craft_id="craft-1", authority=authority))
    left = await left_in_flight(settings)
    assert left is not None
    assert left.authority == authority


async def test_of_a_mission_that_nobody_flew_yet_that_is_known(settings: Settings) -> None:
    await stored(settings, STARTED, goes("taking_off"))
    left = await left_in_flight(settings)
    assert left is not None
    assert left.authority == NOBODY


@pytest.mark.parametrize(
    ("facts", "found"),
    [
        ((), False),
        ((STARTED, goes("flying")), True),
        ((STARTED, goes("returning"), ABORTED), True),
        ((STARTED, goes("flying"), goes("ground"), ABORTED), False),
    ],
)
async def test_it_is_in_flight_until_its_craft_is_down(settings: Settings, facts: Sequence[Event], found: bool) -> None:
    await stored(settings, *facts)
    assert (await left_in_flight(settings) is not None) == found


async def test_a_database_that_does_not_answer_holds_nothing_up(settings: Settings, tmp_path: Path) -> None:
    await stored(settings, STARTED, goes("flying"))
    nowhere = {"database_url": f"postgresql://127.0.0.1:{free_port()}/name"}
    assert await left_in_flight(settings.model_copy(update=nowhere)) is None
    assert await left_in_flight(Settings(data_dir=tmp_path / "elsewhere")) is None


async def test_an_empty_postgresql_has_no_error_to_log(
    tmp_path: Path, postgresql_url: str, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.INFO, "crossfix"):
        assert await left_in_flight(Settings(data_dir=tmp_path, database_url=postgresql_url)) is None
    assert not caplog.messages


async def test_rows_of_another_form_are_left_to_the_journal(sqlite: Settings, tmp_path: Path) -> None:
    await stored(sqlite, STARTED, goes("flying"))
    connection = sqlite3.connect(tmp_path / "crossfix.sqlite")
    with connection:
        connection.execute("UPDATE events SET form = ? WHERE seq = 1", [FIRST_FORM])
    assert await left_in_flight(sqlite) is None
    connection.close()


def spooled(settings: Settings, *facts: Event, mission_id: str = "m", form: int = FORM) -> None:
    """As a server leaves them whose database was away when it was killed."""
    at_utc = datetime.fromtimestamp(time.time(), UTC)
    rows = tuple(replace(to_row(number, at_utc, fact), form=form) for number, fact in enumerate(facts, 10))
    spool = Spool(settings.spool_path, settings.spool_reserve_bytes)
    spool.append(EventsEntry(mission_id, rows).encode())
    spool.close()


def authority_is(authority: Authority) -> AuthorityChanged:
    return AuthorityChanged(craft_id="craft-1", authority=authority)


async def test_facts_that_wait_in_the_spool_come_after_those_that_are_stored(settings: Settings) -> None:
    await stored(settings, STARTED, goes("flying"), authority_is(OURS))
    spooled(settings, goes("measuring"), authority_is(PILOT))
    left = await left_in_flight(settings)
    assert left is not None
    assert left.authority == PILOT


@pytest.mark.parametrize(
    ("facts", "mission_id", "found"),
    [
        ((goes("landing"), goes("ground")), "m", False),
        ((goes("ground"), STARTED, goes("taking_off")), "m", True),
        ((STARTED, goes("taking_off")), "another", True),
        ((MissionDrafted(spec=SPEC),), "another", True),
    ],
)
async def test_a_flight_may_end_and_begin_in_the_spool(
    settings: Settings, facts: Sequence[Event], mission_id: str, found: bool
) -> None:
    await stored(settings, STARTED, goes("flying"))
    spooled(settings, *facts, mission_id=mission_id)
    assert (await left_in_flight(settings) is not None) == found


async def test_what_a_spool_holds_and_cannot_be_read_is_left_to_the_journal(settings: Settings) -> None:
    await stored(settings, STARTED, goes("flying"))
    spooled(settings, goes("measuring"), form=FIRST_FORM)
    assert await left_in_flight(settings) is None


async def test_the_vehicle_of_a_server_that_runs_is_left_alone(settings: Settings) -> None:
    await stored(settings, STARTED, goes("flying"))
    async with open_journal(settings, time.time):
        assert await left_in_flight(settings) is None
    assert await left_in_flight(settings) is not None


async def test_rows_of_the_form_before_say_the_same(sqlite: Settings, tmp_path: Path) -> None:
    await stored(sqlite, STARTED, goes("flying"), authority_is(PILOT))
    connection = sqlite3.connect(tmp_path / "crossfix.sqlite")
    with connection:
        connection.execute("UPDATE events SET form = ?", [FORMS[0]])
    connection.close()
    spooled(sqlite, goes("measuring"), form=FORMS[0])
    left = await left_in_flight(sqlite)
    assert left is not None
    assert left.authority == PILOT


BEFORE_THE_HOLD = """
import sys
import backend.cli.main, backend.cli.serve, backend.first_hold
heavy = ("numba", "numpy", "scipy", "shapely", "sqlalchemy", "fastapi", "viser", "planner.belief",
         "hardware.reasons.antenna", "hardware.reasons.pattern", "hardware.reasons.table")
print(*(name for name in heavy if name in sys.modules))
"""


def test_nothing_that_takes_long_to_load_comes_before_the_hold() -> None:
    loaded = subprocess.run([sys.executable, "-c", BEFORE_THE_HOLD], capture_output=True, text=True, check=True)

    assert loaded.stdout.split() == []
