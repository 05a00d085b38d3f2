"""The migrations make the very tables that the code uses, and SQLite is set to keep what it acknowledged."""

from __future__ import annotations

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import Connection

from backend.store.engine import make_engine, migrate
from backend.store.tables import metadata


async def test_the_migrated_schema_is_the_one_the_code_uses(database_url):
    await migrate(database_url)
    engine = make_engine(database_url, 1.0)

    def differences(connection: Connection) -> list:
        return compare_metadata(MigrationContext.configure(connection, opts={"compare_type": True}), metadata)

    async with engine.connect() as connection:
        assert await connection.run_sync(differences) == []
    await engine.dispose()


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_a_commit_on_sqlite_is_on_the_disk(database_url):
    engine = make_engine(database_url, 1.0)
    async with engine.connect() as connection:
        for pragma, value in (("journal_mode", "wal"), ("synchronous", 2), ("foreign_keys", 1), ("busy_timeout", 600)):
            assert (await connection.exec_driver_sql(f"PRAGMA {pragma}")).scalar() == value
    await engine.dispose()
