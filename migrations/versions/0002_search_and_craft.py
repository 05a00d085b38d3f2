"""Events say the form of their body; sweeps, tracks and the list of missions say which craft and emitter."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None

CRAFT, EMITTER = "craft-1", "emitter-1"
"""Of missions from before: they had one of each."""
TRACK = (
    "at_us", "lat_deg", "lon_deg", "altitude_amsl_m", "altitude_relative_m", "heading_deg", "battery_percent", "mode",
)  # fmt: skip
MISSIONS = sa.table(
    "missions",
    sa.column("phase"),
    sa.column("started_at_us"),
    sa.column("ended_at_us"),
    sa.column("flying"),
    sa.column("crafts", sa.JSON),
)


def upgrade() -> None:
    op.add_column("events", sa.Column("form", sa.Integer, nullable=False, server_default="1"))
    op.add_column("missions", sa.Column("crafts", sa.JSON, nullable=False, server_default="{}"))
    op.add_column("missions", sa.Column("flying", sa.Boolean, nullable=False, server_default=sa.false()))
    op.add_column("missions", sa.Column("emitters", sa.Integer, nullable=False, server_default="1"))
    op.add_column("sweeps", sa.Column("craft_id", sa.String(40)))
    op.add_column("sweeps", sa.Column("emitter_id", sa.String(40), nullable=False, server_default=EMITTER))
    # the id of an imported sweep was a UUID of version 5, of a flown one of version 4
    op.execute(f"UPDATE sweeps SET craft_id = '{CRAFT}' WHERE substr(sweep_id, 15, 1) <> '5'")
    _crafts_in_flight()
    _tracks_by_craft()


def _crafts_in_flight() -> None:
    """Missions that a restart brings back to hold."""
    in_flight = MISSIONS.c.started_at_us.is_not(None) & MISSIONS.c.ended_at_us.is_(None)
    for (phase,) in op.get_bind().execute(sa.select(MISSIONS.c.phase).where(in_flight).distinct()).all():
        now = {"crafts": {CRAFT: phase}, "flying": True}
        op.execute(MISSIONS.update().where(in_flight & (MISSIONS.c.phase == phase)).values(now))


def _tracks_by_craft() -> None:
    """A new table: SQLite cannot change a primary key."""
    op.create_table(
        "tracks",
        sa.Column("mission_id", sa.String(64), sa.ForeignKey("missions.mission_id"), nullable=False),
        sa.Column("craft_id", sa.String(40), nullable=False),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("lat_deg", sa.Double, nullable=False),
        sa.Column("lon_deg", sa.Double, nullable=False),
        sa.Column("altitude_amsl_m", sa.Double),
        sa.Column("altitude_relative_m", sa.Double),
        sa.Column("heading_deg", sa.Double),
        sa.Column("battery_percent", sa.Double),
        sa.Column("mode", sa.Text),
        sa.PrimaryKeyConstraint("mission_id", "craft_id", "at_us"),
    )
    points = ", ".join(TRACK)
    op.execute(f"INSERT INTO tracks (mission_id, craft_id, {points}) SELECT mission_id, '{CRAFT}', {points} FROM track")
    op.drop_table("track")


def downgrade() -> None:
    raise NotImplementedError("what was stored since cannot be said in the form of before: restore the copy from then")
