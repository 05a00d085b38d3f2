"""Alembic's entry. The server passes its open connection; `alembic -x url=...` on the command line works as well."""

from __future__ import annotations

from alembic import context
from sqlalchemy import Connection, create_engine

from backend.store.tables import metadata


def run(connection: Connection) -> None:
    if connection.dialect.name == "postgresql":
        connection.exec_driver_sql("SELECT pg_advisory_xact_lock(4207849484)")
    context.configure(connection=connection, target_metadata=metadata, render_as_batch=True)
    with context.begin_transaction():
        context.run_migrations()


given = context.config.attributes.get("connection")
if given is not None:
    run(given)
else:
    with create_engine(context.get_x_argument(as_dictionary=True)["url"]).begin() as opened:
        run(opened)
