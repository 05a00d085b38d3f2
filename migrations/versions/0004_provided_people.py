"""Who a person is at the sign-in provider."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("people", sa.Column("issuer", sa.String(255)))
    op.add_column("people", sa.Column("subject", sa.String(255)))
    op.create_index("people_provided", "people", ["issuer", "subject"], unique=True)


def downgrade() -> None:
    raise NotImplementedError("who came from the provider would be lost: restore the copy from before")
