"""Missions, their events, raw sweeps and the thinned track."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "missions",
        sa.Column("mission_id", sa.String(64), primary_key=True),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("phase", sa.String(20), nullable=False),
        sa.Column("outcome", sa.String(20)),
        sa.Column("drafted_at_us", sa.BigInteger, nullable=False),
        sa.Column("started_at_us", sa.BigInteger),
        sa.Column("ended_at_us", sa.BigInteger),
        sa.Column("mission_time_s", sa.Double),
        sa.Column("bearings", sa.Integer, nullable=False),
        sa.Column("rejected_sweeps", sa.Integer, nullable=False),
        sa.Column("last_seq", sa.Integer, nullable=False),
    )
    op.create_table(
        "events",
        sa.Column("mission_id", sa.String(64), sa.ForeignKey("missions.mission_id"), nullable=False),
        sa.Column("seq", sa.Integer, nullable=False),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("kind", sa.String(40), nullable=False),
        sa.Column("body", sa.Text, nullable=False),
        sa.PrimaryKeyConstraint("mission_id", "seq"),
    )
    op.create_index("events_by_kind", "events", ["mission_id", "kind"])
    op.create_table(
        "sweeps",
        sa.Column("mission_id", sa.String(64), sa.ForeignKey("missions.mission_id"), nullable=False),
        sa.Column("sweep_id", sa.String(64), nullable=False),
        sa.Column("place_number", sa.Integer, nullable=False),
        sa.Column("attempt", sa.Integer, nullable=False),
        sa.Column("frequency_hz", sa.Double, nullable=False),
        sa.Column("lat_deg", sa.Double, nullable=False),
        sa.Column("lon_deg", sa.Double, nullable=False),
        sa.Column("altitude_amsl_m", sa.Double),
        sa.Column("drift_m", sa.Double),
        sa.Column("clipped_samples", sa.Integer, nullable=False),
        sa.Column("noise_floor_db", sa.Double),
        sa.Column("tag", sa.Text),
        sa.Column("samples", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("mission_id", "sweep_id"),
    )
    op.create_table(
        "track",
        sa.Column("mission_id", sa.String(64), sa.ForeignKey("missions.mission_id"), nullable=False),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("lat_deg", sa.Double, nullable=False),
        sa.Column("lon_deg", sa.Double, nullable=False),
        sa.Column("altitude_amsl_m", sa.Double),
        sa.Column("altitude_relative_m", sa.Double),
        sa.Column("heading_deg", sa.Double),
        sa.Column("battery_percent", sa.Double),
        sa.Column("mode", sa.Text),
        sa.PrimaryKeyConstraint("mission_id", "at_us"),
    )


def downgrade() -> None:
    for table in ("track", "sweeps", "events", "missions"):
        op.drop_table(table)
