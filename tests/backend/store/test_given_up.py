"""A question that is given up does not keep PostgreSQL busy for long."""

from __future__ import annotations

import asyncio

import pytest
from sqlalchemy import text

from backend.ports import JournalUnavailable
from backend.store.engine import dispose, engine_for_once, make_engine
from backend.store.reading import StoredFacts

BUSY = text("SELECT count(*) FROM pg_stat_activity WHERE query LIKE '%pg_sleep(60)%' AND pid <> pg_backend_pid()")


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_a_question_that_is_given_up_ends_in_the_database_too(database_url: str) -> None:
    engine, beside = make_engine(database_url, 1.0), engine_for_once(database_url, 5.0)
    try:
        with pytest.raises(JournalUnavailable):
            await StoredFacts(engine, 0.4)._fetch(text("SELECT pg_sleep(60)"))
        async with asyncio.timeout(20.0), beside.connect() as connection:
            while (await connection.execute(BUSY)).scalar_one():
                await connection.rollback()
                await asyncio.sleep(0.1)
    finally:
        await dispose(engine)
        await dispose(beside)


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_whoever_has_the_connection_next_has_their_own_time(database_url: str) -> None:
    engine = make_engine(database_url, 5.0)
    try:
        await StoredFacts(engine, 5.0)._fetch(text("SELECT 1"))
        async with engine.connect() as connection:
            assert (await connection.execute(text("SHOW statement_timeout"))).scalar_one() == "0"
    finally:
        await dispose(engine)
