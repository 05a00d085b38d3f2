"""Who may make which call: one table for every endpoint, websocket and command, and nothing besides.

A call that is not in it is refused. Roles rise: viewer < operator < pilot; the right to manage people (admin) stands
beside them. The tests are made from these tables: every call by every role.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Role = Literal["viewer", "operator", "pilot"]
Scope = Literal["payload", "exports", "metrics", "bearings"]
"""What a machine's token is for."""

ROLES: tuple[Role, ...] = ("viewer", "operator", "pilot")
"""From the least to the most."""


def at_least(role: Role, least: Role) -> bool:
    """Does the role reach up to another?"""
    return ROLES.index(role) >= ROLES.index(least)


@dataclass(frozen=True, slots=True)
class Need:
    """What a call takes.

    role: the least of a person, None when no person may make it. admin: the right to manage people besides. scope: a
    machine whose token has it may, too. anyone: no sign-in at all. audited: False for what only asks.
    """

    role: Role | None = None
    admin: bool = False
    scope: Scope | None = None
    anyone: bool = False
    audited: bool = False


ANYONE = Need(anyone=True)
ENTERING = Need(anyone=True, audited=True)
"""Sign-in and the like: open, bounded by their own limits, and audited."""
WATCH = Need("viewer")
OWN = Need("viewer", audited=True)
"""One's own account."""
EXPORT = Need("viewer", scope="exports")
PLAN = Need("operator", audited=True)
ASK = Need("operator")
"""Takes the planner's time and changes nothing."""
MANAGE = Need("viewer", admin=True, audited=True)
METRICS = Need("viewer", scope="metrics")
REPORT = Need("operator", scope="bearings", audited=True)
PAYLOAD = Need(scope="payload", audited=True)

ENDPOINTS: Mapping[str, Need] = {
    # entering
    "GET /api/session": ANYONE,
    "POST /api/session": ENTERING,
    "DELETE /api/session": ENTERING,
    "POST /api/first-admin": ENTERING,
    "POST /api/recovery": ENTERING,
    "GET /api/provider/begin": ENTERING,
    "GET /api/provider/return": ENTERING,
    "POST /api/invitation/look": ENTERING,
    "POST /api/invitation/accept": ENTERING,
    # one's own account
    "GET /api/account/sessions": WATCH,
    "DELETE /api/account/sessions": OWN,
    "DELETE /api/account/sessions/{session_id}": OWN,
    "PUT /api/account/password": OWN,
    # people
    "GET /api/people": MANAGE,
    "PUT /api/people/{person_id}": MANAGE,
    "DELETE /api/people/{person_id}/sessions": MANAGE,
    "GET /api/invitations": MANAGE,
    "POST /api/invitations": MANAGE,
    "DELETE /api/invitations/{invitation_id}": MANAGE,
    "GET /api/tokens": MANAGE,
    "POST /api/tokens": MANAGE,
    "DELETE /api/tokens/{token_id}": MANAGE,
    # the server and its vehicle
    "GET /health": ANYONE,
    "GET /metrics": METRICS,
    "GET /api/health": WATCH,
    "GET /api/payloads": WATCH,
    "GET /api/defaults": WATCH,
    "GET /api/vehicle": WATCH,
    "WS /api/live": WATCH,
    "WS /api/payload": PAYLOAD,
    "POST /api/crafts/{craft_id}/commands": PLAN,
    "GET /api/crafts/{craft_id}/compass": WATCH,
    "DELETE /api/crafts/{craft_id}/compass": PLAN,
    # missions
    "GET /api/missions": EXPORT,
    "POST /api/missions": PLAN,
    "GET /api/missions/{mission_id}": EXPORT,
    "PUT /api/missions/{mission_id}/spec": PLAN,
    "POST /api/missions/{mission_id}/commands": PLAN,
    "POST /api/missions/{mission_id}/preflight": PLAN,
    "POST /api/missions/{mission_id}/antenna-check": PLAN,
    "POST /api/missions/{mission_id}/recordings": PLAN,
    "POST /api/missions/{mission_id}/bearings": REPORT,
    "POST /api/missions/{mission_id}/bearings/kraken": REPORT,
    "DELETE /api/missions/{mission_id}/bearings/{bearing_id}": REPORT,
    "POST /api/missions/{mission_id}/bearings/{bearing_id}/restore": REPORT,
    "PUT /api/missions/{mission_id}/reporter": REPORT,
    "PUT /api/missions/{mission_id}/labels": PLAN,
    "PUT /api/missions/{mission_id}/truth": PLAN,
    "DELETE /api/missions/{mission_id}": PLAN,
    "POST /api/missions/{mission_id}/restore": PLAN,
    "GET /api/calibration": WATCH,
    "POST /api/missions/{mission_id}/expected-time": ASK,
    "POST /api/missions/{mission_id}/area-outlook": ASK,
    "POST /api/missions/{mission_id}/advice": ASK,
    "GET /api/missions/{mission_id}/ways": WATCH,
    "POST /api/missions/{mission_id}/ways": PLAN,
    "DELETE /api/missions/{mission_id}/ways": PLAN,
    "POST /api/preview": ASK,
    "POST /api/areas": ASK,
    # review
    "GET /api/missions/{mission_id}/events": EXPORT,
    "GET /api/missions/{mission_id}/beliefs": EXPORT,
    "POST /api/missions/{mission_id}/what-if": WATCH,
    "GET /api/missions/{mission_id}/sweeps/{sweep_id}": EXPORT,
    "GET /api/missions/{mission_id}/track": EXPORT,
    "GET /api/missions/{mission_id}/export/{format}": EXPORT,
    "GET /api/missions/{mission_id}/antenna": WATCH,
    "GET /api/missions/{mission_id}/profile": WATCH,
    "GET /api/missions/{mission_id}/courses": WATCH,
    "PUT /api/missions/{mission_id}/variants/{name}": PLAN,
    "DELETE /api/missions/{mission_id}/variants/{name}": PLAN,
    "POST /api/recordings/read": WATCH,
    "POST /api/bundles": PLAN,
    # maps and terrain
    "GET /api/maps": WATCH,
    "POST /api/maps": PLAN,
    "POST /api/maps/coverage": WATCH,
    "GET /api/maps/{map_id}": WATCH,
    "DELETE /api/maps/{map_id}": PLAN,
    "GET /api/maps/{map_id}/layers": WATCH,
    "GET /api/maps/{map_id}/tiles.pmtiles": WATCH,
    "GET /api/basemap": WATCH,
    "GET /api/overlays": WATCH,
    "POST /api/overlays": PLAN,
    "GET /api/overlays/{overlay_id}": WATCH,
    "DELETE /api/overlays/{overlay_id}": PLAN,
    "GET /api/terrain": WATCH,
    "POST /api/terrain": PLAN,
    "DELETE /api/terrain/{terrain_id}": PLAN,
    "GET /api/terrain/tiles/{zoom}/{x}/{y}": WATCH,
    "GET /api/terrain/contours": WATCH,
    # the 3D scene
    "PUT /api/scene/views/{view_id}": WATCH,
    "GET /api/scene/views/{view_id}": WATCH,
    "GET /scene": WATCH,
    "GET /scene/": WATCH,
    "GET /scene/{view_id}/": WATCH,
    "WS /scene/{view_id}": WATCH,
}
"""Method (WS: a websocket) and path -> what it takes. The built page itself holds nothing and is open to everybody."""

BEFORE_PEOPLE = frozenset({"GET /health", "GET /api/session", "POST /api/first-admin"})
"""All that a server answers that waits for its first admin."""


@dataclass(frozen=True, slots=True)
class CommandNeed:
    """role: the least. control: only who holds the search's control lease."""

    role: Role
    control: bool


SAFETY = CommandNeed("operator", control=False)
"""Stops or lands the vehicle, or only says that something was seen: it never waits for a lease."""
STEERS = CommandNeed("operator", control=True)
LEASE = CommandNeed("operator", control=False)
"""About the lease itself; its machine decides (backend/mission/control.py)."""

COMMANDS: Mapping[str, CommandNeed] = {
    "hold": SAFETY,
    "return": SAFETY,
    "land": SAFETY,
    "abort": SAFETY,
    "acknowledge_alert": SAFETY,
    "start": STEERS,
    "resume": STEERS,
    "keep_holding": STEERS,
    "override": STEERS,
    "accept": STEERS,
    "veto": STEERS,
    "set_automatic": STEERS,
    "change_area": STEERS,
    "exclude_bearing": STEERS,
    "include_bearing": STEERS,
    "mute_source": STEERS,
    "set_priorities": STEERS,
    "take_control": LEASE,
    "ask_control": LEASE,
    "give_control": LEASE,
    "keep_control": LEASE,
    "release_control": LEASE,
}
"""Kind of a command -> what it takes."""
