"""What the database of people cannot hold is refused, and is no silence of it."""

from __future__ import annotations

import asyncio
from contextlib import AsyncExitStack, suppress
from uuid import uuid4

import pytest
from entrance import PASSWORD, Clocks, opened, with_admin
from refusals import refusing

from backend.auth.access import Visit
from backend.auth.keeping import Denied
from backend.auth.records import Records
from backend.ports import FactRefused, JournalUnavailable
from backend.reasons.access import CodeUnusable
from backend.store import engine
from backend.store.engine import migrate


@pytest.fixture
def narrow_url(postgres_cluster) -> str:
    """A database that has no letters but those of western Europe."""
    name = f"narrow_{uuid4().hex[:12]}"
    asyncio.run(postgres_cluster._ask(f"CREATE DATABASE {name} ENCODING 'LATIN1' TEMPLATE template0 LOCALE 'C'"))
    return postgres_cluster.url(name).replace("postgresql:", "postgresql+asyncpg:")


async def test_a_name_that_an_older_database_lacks_letters_for_is_refused(
    narrow_url: str, clocks: Clocks, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine, "_require_unicode", lambda _: None)
    await migrate(narrow_url)
    access = opened(narrow_url, clocks)
    await with_admin(access)
    code, _ = await access.invitations.make("operator", False, 3600, access.people.by_name[0].person_id)
    with pytest.raises(FactRefused, match="LATIN1"):
        await access.accept_invitation(code, "Ольга", PASSWORD, Visit("a", ""))
    await access.accept_invitation(code, "Olga", PASSWORD, Visit("a", ""))
    with refusing(CodeUnusable("used"), Denied):
        await access.accept_invitation(code, "Ольга", PASSWORD, Visit("a", ""))
    await access.close()


SLOW = """
CREATE FUNCTION slow() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    BEGIN PERFORM pg_sleep(1); EXCEPTION WHEN query_canceled THEN PERFORM pg_sleep(1); END;
    RETURN NULL;
END $$"""
SLOWLY = """
CREATE CONSTRAINT TRIGGER slowly AFTER UPDATE ON people
DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION slow()"""


async def test_what_postgresql_is_still_storing_counts_before_anybody_enters(
    postgresql_url: str, clocks: Clocks
) -> None:
    """As on a disk that stalls in the middle of a commit."""
    url, new = postgresql_url.replace("postgresql:", "postgresql+asyncpg:"), "another good one 5"
    await migrate(url)
    access, hasty = opened(url, clocks), opened(url, clocks, timeout_s=0.5)
    await with_admin(access)
    await hasty.load()
    database = engine.make_engine(url, 2.0)
    async with database.begin() as connection:
        await connection.exec_driver_sql(SLOW)
        await connection.exec_driver_sql(SLOWLY)
    with pytest.raises(JournalUnavailable):
        await hasty.change_password(hasty.people.by_name[0].person_id, PASSWORD, new, "a", None)
    with suppress(JournalUnavailable):
        await hasty.sign_in("Ada", PASSWORD, Visit("a", ""))
    secret = None
    async with asyncio.timeout(60.0):
        while secret is None:
            await asyncio.sleep(1.0)
            with suppress(JournalUnavailable):
                secret = await hasty.sign_in("Ada", new, Visit("a", ""))
    for one in (access, hasty):
        await one.close()
    await engine.dispose(database)


async def test_that_all_connections_are_taken_is_a_silence_of_the_database(postgresql_url: str) -> None:
    url = postgresql_url.replace("postgresql:", "postgresql+asyncpg:")
    await migrate(url)
    database = engine.make_engine(url, 0.5)
    async with AsyncExitStack() as taken:
        for _ in range(15):
            await taken.enter_async_context(database.connect())
        with pytest.raises(JournalUnavailable):
            await Records(database, 0.5).load()
    await engine.dispose(database)
