"""An index over the sweeps that no craft took: what imported recordings take is known without the others."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    no_craft = sa.text("craft_id IS NULL")
    op.create_index("sweeps_imported", "sweeps", ["mission_id"], sqlite_where=no_craft, postgresql_where=no_craft)


def downgrade() -> None:
    op.drop_index("sweeps_imported", "sweeps")
