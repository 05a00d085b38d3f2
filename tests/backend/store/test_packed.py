"""Long bodies of facts are small on the disk and come back byte for byte; what was stored as plain text is read."""

from __future__ import annotations

import json

import pytest
from sqlalchemy import text

from backend.backup.manifest import BackupError
from backend.backup.rows import lines_of, reflected, write_lines
from backend.events import MissionDrafted, MissionEdited
from backend.spec import MissionSpec, Polygon
from backend.store.engine import make_engine
from backend.store.packed import LONG, MOST_BYTES, packed, unpacked

AREA = Polygon(coordinates=[[(7.2, 50.6), *((7.21, 50.6 + n / 1e4) for n in range(200)), (7.2, 50.6)]])
LONG_FACT = MissionEdited(spec=MissionSpec(name="a coast ä", area=AREA))
DRAFT = MissionDrafted(spec=MissionSpec(name="s", area=Polygon(coordinates=[[*AREA.coordinates[0][:3], (7.2, 50.6)]])))


@pytest.mark.parametrize("text", ["", "{}", "ä" * (LONG - 1), "ä" * LONG, '{"a": "b"}' * LONG])
@pytest.mark.parametrize("as_bytes", [True, False])
def test_a_text_comes_back_as_it_was(text: str, as_bytes: bool) -> None:
    kept = packed(text, as_bytes)
    assert unpacked(kept) == text
    assert (kept == text) == (len(text) < LONG)
    assert isinstance(kept, bytes) == (as_bytes and len(text) >= LONG)


@pytest.mark.parametrize(
    "kept",
    [b"no zlib", packed("x" * LONG, True)[:-4], packed("x" * (MOST_BYTES + 1), True), "zlib:%%", "zlib:AAAA"],
    ids=["other bytes", "cut off", "a bomb", "no base64", "no zlib"],
)
def test_what_was_never_packed_here_is_refused_by_a_sentence(kept: str | bytes) -> None:
    with pytest.raises(ValueError, match="stored text"):
        unpacked(kept)


async def test_an_archive_whose_facts_are_packed_already_is_refused(bench) -> None:
    """They would be unpacked later, by whoever reads them, as large as they like."""
    await bench.open()
    engine = make_engine(bench.url, 5.0)
    async with engine.execution_options(write=True).begin() as connection:
        table = (await connection.run_sync(reflected)).tables["events"]
        names = [column.name for column in table.c]
        row = ["zlib:AAAA" if name == "body" else 1 for name in names]
        with pytest.raises(BackupError, match="packed"):
            await write_lines(connection, table, [json.dumps(names).encode(), json.dumps(row).encode()])
    await engine.dispose()


async def test_a_long_fact_takes_less_room_and_is_read_beside_one_from_before(bench) -> None:
    written = await (await bench.open()).append("m", [DRAFT, LONG_FACT])
    body = LONG_FACT.model_dump_json()
    engine = make_engine(bench.url, 5.0)
    async with engine.execution_options(write=True).begin() as connection:
        stored = (await connection.execute(text("SELECT body FROM events WHERE seq = 2"))).scalar_one()
        assert len(stored) < len(body) / 2
        assert unpacked(stored) == body
        await connection.execute(text("UPDATE events SET body = :body WHERE seq = 2"), {"body": body})
    await engine.dispose()
    assert await (await bench.open("other.spool")).read("m") == written


async def test_a_backup_says_the_whole_text(bench) -> None:
    await (await bench.open()).append("m", [DRAFT, LONG_FACT])
    engine = make_engine(bench.url, 5.0)
    async with engine.connect() as connection:
        metadata = await connection.run_sync(reflected)
        lines = [line async for line in lines_of(connection, metadata.tables["events"])]
    await engine.dispose()
    assert len(lines) == 3
    assert str(LONG_FACT.spec.area.coordinates[0][50][1]).encode() in lines[2]
