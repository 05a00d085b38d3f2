"""What /health answers about the server and what it needs."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from backend.reasons import Reason
from backend.spec import Model

DatabaseState = Literal["ok", "slow", "lost"]


class DatabaseHealth(Model):
    """`reason`: why it is slow or lost. `spooled`: events kept on disk until the database is back. `refused`: entries
    that it will never take, kept in a file."""

    state: DatabaseState
    kind: Literal["sqlite", "postgresql"]
    reason: Reason | None
    spooled: int
    refused: int


class VehicleHealth(Model):
    """`reason`: why there is no vehicle."""

    craft_id: str
    connected: bool
    autopilot: Literal["px4", "ardupilot", "unknown"]
    reason: Reason | None


StockKind = Literal["overlays", "recordings"]


class StockHealth(Model):
    """What came from outside and is kept. number: of overlays, or of the raw sweeps of recordings. None: not counted
    yet."""

    what: StockKind
    number: int | None
    most: int
    size_bytes: int | None
    most_bytes: int
    full: bool


class RefusedSender(Model):
    """A sender of datagrams that were refused. name: what the last one calls itself, None when it was no bearing.
    reason: of the last."""

    address: str
    name: str | None
    refused: int
    reason: Reason
    at_utc: datetime


class BearingsUdpHealth(Model):
    """Bearings by UDP since the server's start. senders: of what was refused, the newest first; not all that there ever
    were."""

    host: str
    port: int
    taken: int
    refused: int
    senders: list[RefusedSender]


class Health(Model):
    """ok: everything answers; degraded: the server works, a part it needs does not. disk_free_bytes: None when the file
    system does not say. keep_sweeps_days: of missions that are over; None for ever. bearings_udp: None when no port is
    open."""

    state: Literal["ok", "degraded"]
    version: str
    uptime_s: float
    database: DatabaseHealth
    vehicles: list[VehicleHealth]
    viewers: int
    disk_free_bytes: int | None
    keep_sweeps_days: float | None
    stocks: list[StockHealth]
    bearings_udp: BearingsUdpHealth | None
    simulated: bool
    time_factor: float
