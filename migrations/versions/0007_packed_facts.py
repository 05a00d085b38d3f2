"""Nothing changes in the tables: from here on long bodies of facts are kept compressed (backend.store.packed), and a
server from before must not open what it could not read. What lies there already stays plain text."""

from __future__ import annotations

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Both kinds of bodies are read."""


def downgrade() -> None:
    raise NotImplementedError("an earlier server cannot read packed facts: restore the copy from before")
