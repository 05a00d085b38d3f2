"""A table for the flown paths of missions that are over, packed (backend.store.paths). Retention fills it; from here on
long bodies of facts are packed with a dictionary too, which a server from before cannot read."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "paths",
        sa.Column("mission_id", sa.String(64), sa.ForeignKey("missions.mission_id"), nullable=False),
        sa.Column("craft_id", sa.String(40), nullable=False),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("points", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("mission_id", "craft_id", "at_us"),
    )


def downgrade() -> None:
    raise NotImplementedError("an earlier server cannot read packed paths: restore the copy from before")
