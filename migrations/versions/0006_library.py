"""What the list of missions is searched by, and its small maps; of missions from before as far as their facts tell."""

from __future__ import annotations

import json
from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

EVENTS = sa.table("events", *(sa.column(name) for name in ("mission_id", "seq", "kind", "body")))
MISSIONS = sa.table(
    "missions",
    *(sa.column(name) for name in ("mission_id", "sought", "vehicles", "west", "south", "east", "north")),
    sa.column("sketch", sa.JSON),
)
KINDS = ("mission_drafted", "mission_edited", "area_changed", "mission_started", "bearing_measured", "belief_updated")


def upgrade() -> None:
    for name in ("tags", "notes", "sought", "vehicles"):
        op.add_column("missions", sa.Column(name, sa.Text, nullable=False, server_default=""))
    op.add_column("missions", sa.Column("deleted_at_us", sa.BigInteger))
    for name in ("west", "south", "east", "north"):
        op.add_column("missions", sa.Column(name, sa.Double))
    op.add_column("missions", sa.Column("truths", sa.Integer, nullable=False, server_default="0"))
    op.add_column("missions", sa.Column("sketch", sa.JSON, nullable=False, server_default="{}"))
    op.create_index("missions_in_order", "missions", ["drafted_at_us", "mission_id"])
    connection = op.get_bind()
    for (mission_id,) in connection.execute(sa.select(MISSIONS.c.mission_id)).all():
        wanted = (EVENTS.c.mission_id == mission_id) & EVENTS.c.kind.in_(KINDS)
        rows = connection.execute(sa.select(EVENTS.c.body).where(wanted).order_by(EVENTS.c.seq))
        values = described([json.loads(body) for (body,) in rows])
        connection.execute(MISSIONS.update().where(MISSIONS.c.mission_id == mission_id).values(values))


def described(facts: list[dict[str, Any]]) -> dict[str, Any]:
    """The new columns, as far as the facts tell: a later fact of the mission writes them whole."""
    values: dict[str, Any] = {"sketch": {}}
    places: list[list[float]] = []
    found: dict[str, list[float]] = {}
    vehicles: list[str] = []
    for fact in facts:
        area = fact.get("spec", fact.get("search", {})).get("area")
        if area:
            polygons = [area["coordinates"]] if area["type"] == "Polygon" else area["coordinates"]
            outline = [[[round(x, 6), round(y, 6)] for x, y in rings[0]] for rings in polygons]
            lons, lats = zip(*(corner for ring in outline for corner in ring), strict=True)
            values |= {"west": min(lons), "south": min(lats), "east": max(lons), "north": max(lats)}
            values["sketch"] = {"outline": [ring[:: max(1, -(-len(ring) // 24))] for ring in outline]}
        if "spec" in fact:
            values["sought"] = _sought(fact["spec"])
        if fact["kind"] == "mission_started":
            vehicles.append(str(fact.get("craft_id", "craft-1")).lower())
        if fact["kind"] == "bearing_measured" and "place" in fact and len(places) < 40:
            places.append([round(fact["place"]["lon"], 6), round(fact["place"]["lat"], 6)])
        if fact["kind"] == "belief_updated" and fact.get("estimate"):
            at = fact["estimate"]
            found[fact.get("emitter_id", "emitter-1")] = [round(at["lon"], 6), round(at["lat"], 6)]
    values["sketch"] |= {"places": places, "found": found}
    return values | {"vehicles": " ".join(dict.fromkeys(vehicles))}


def _sought(spec: dict[str, Any]) -> str:
    emitters = spec.get("emitters") or [spec.get("emitter", {})]
    said = (
        (one.get("emitter_id", ""), one.get("label", ""), f"{one.get('frequency_hz', 0) / 1e6:g}") for one in emitters
    )
    return " ".join(" ".join(words) for words in said).lower().strip().replace("\x00", "")


def downgrade() -> None:
    raise NotImplementedError("tags, notes and deletions would be lost: restore the copy from before")
