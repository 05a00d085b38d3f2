"""Long bodies of facts are small on the disk and come back byte for byte; what was stored as plain text is read."""

from __future__ import annotations

import json
import zlib

import pytest
from sqlalchemy import text

from backend.backup.manifest import BackupError
from backend.backup.rows import lines_of, reflected, write_lines
from backend.events import AuthorityChanged, MissionDrafted, MissionEdited
from backend.spec import MissionSpec, Polygon
from backend.store.engine import make_engine
from backend.store.packed import DICTIONARY, LONG, MOST_BYTES, packed, unpacked
from hardware.authority import Authority

AREA = Polygon(coordinates=[[(7.2, 50.6), *((7.21, 50.6 + n / 1e4) for n in range(200)), (7.2, 50.6)]])
LONG_FACT = MissionEdited(spec=MissionSpec(name="a coast ä", area=AREA))
DRAFT = MissionDrafted(spec=MissionSpec(name="s", area=Polygon(coordinates=[[*AREA.coordinates[0][:3], (7.2, 50.6)]])))

DICTIONARY_ID = 0x977FF4F5
_other = zlib.compressobj(zdict=b"another")
OF_ANOTHER = _other.compress(b"another text") + _other.flush()


def test_the_dictionary_is_the_one_that_was_packed_with() -> None:
    """What lies in databases cannot be read with another."""
    assert zlib.adler32(DICTIONARY) == DICTIONARY_ID


def test_what_was_packed_without_a_dictionary_is_read() -> None:
    assert unpacked(zlib.compress(LONG_FACT.model_dump_json().encode())) == LONG_FACT.model_dump_json()


def test_who_flies_is_never_packed() -> None:
    """The first look at a start in flight reads it without this module."""
    tokens = tuple(range(10_000_000, 10_000_008))
    longest = Authority(
        "failsafe", "sticks", 1_795_444_611.206764, "M" * 40, under_way=tokens, commanded=tokens, tolerated=tokens,
        shown_before=tokens[0], heard=tokens[0], kind="return",
    )  # fmt: skip
    fact = AuthorityChanged(craft_id="c" * 40, authority=longest, by="p" * 40)
    assert len(fact.model_dump_json()) < LONG


@pytest.mark.parametrize("text", ["", "{}", "ä" * (LONG - 1), "ä" * LONG, '{"a": "b"}' * LONG])
@pytest.mark.parametrize("as_bytes", [True, False])
def test_a_text_comes_back_as_it_was(text: str, as_bytes: bool) -> None:
    kept = packed(text, as_bytes)
    assert unpacked(kept) == text
    assert (kept == text) == (len(text) < LONG)
    assert isinstance(kept, bytes) == (as_bytes and len(text) >= LONG)


@pytest.mark.parametrize(
    "kept",
    [
        b"no zlib",
        OF_ANOTHER,
        packed("x" * LONG, True)[:-4],
        packed("x" * (MOST_BYTES + 1), True),
        "zlib:%%",
        "zlib:AAAA",
    ],
    ids=["other bytes", "another dictionary", "cut off", "a bomb", "no base64", "no zlib"],
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
