"""What the live websocket sends. JSON text for events and telemetry; binary for belief frames (see belief_frame.py).

Path: /api/live?mission=ID&after=SEQ. First `hello`, then every recorded event after SEQ (never dropped), then live.
Telemetry, sweep progress and status are newest-wins: a slow client skips old ones, and `dropped` counts what it missed.
"""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field

from backend.events import Level, MissionPhase, Phase, Recorded, Topic
from backend.reasons import Reason
from backend.reasons.flight import OrderName, Way
from backend.spec import Model
from hardware.authority import Who


class Hello(Model):
    """The first message. last_seq: of the mission when the websocket was opened."""

    type: Literal["hello"] = "hello"
    server_version: str
    mission_id: str | None
    last_seq: int
    time_factor: float
    """Seconds of mission time a second of real time (1 in the field, more in a simulated demo)."""


class EventMessage(Model):
    """Each event once, in order, without gaps."""

    type: Literal["event"] = "event"
    recorded: Recorded


class TelemetryMessage(Model):
    """Of one craft. `*_age_s`: how old each group of values was when sent; None: never heard. who: who flies it."""

    type: Literal["telemetry"] = "telemetry"
    craft_id: str
    at_utc: datetime
    connected: bool
    lat: float | None
    lon: float | None
    position_age_s: float | None
    altitude_amsl_m: float | None
    altitude_relative_m: float | None
    heading_deg: float | None
    heading_age_s: float | None
    ground_speed_m_s: float | None
    climb_m_s: float | None
    battery_percent: float | None
    battery_age_s: float | None
    gps_fix: str | None
    satellites: int | None
    armed: bool | None
    in_air: bool | None
    mode: str | None
    mode_age_s: float | None
    who: Who
    autopilot: Literal["px4", "ardupilot", "unknown"]
    dropped: int


class SectorMessage(Model):
    """What of the circle is turned through, as decided so far: clockwise from begin_deg (antenna heading, true).
    because: why that far."""

    begin_deg: float
    goal_deg: float
    because: Reason | None


class SweepProgress(Model):
    """The running sweep of a craft: antenna heading (true) and power of one emitter's samples so far, thinned to at
    most 360. sector None: once all the way round."""

    type: Literal["sweep_progress"] = "sweep_progress"
    mission_id: str
    craft_id: str
    emitter_id: str
    place_number: int
    heading_deg: list[float]
    power_db: list[float]
    turned_deg: float
    sector: SectorMessage | None = None


class OrderMessage(Model):
    """The order that a craft carries out: done only once telemetry has shown it. because: why what was tried of it
    before was not done."""

    order: OrderName
    way: Way
    stage: Literal["tried", "waits", "done"]
    because: Reason | None


class CraftAlertMessage(Model):
    """An open alert of a craft that flies for no mission; raised_at_s: UTC epoch seconds."""

    alert_id: str
    topic: Topic
    level: Level
    reason: Reason
    raised_at_s: float


class CraftStatusMessage(Model):
    """mission_id None: it flies for none; when its phase is not "ground" it is in the air all the same.
    resume_refused: while it holds or a pilot flies it, why resuming would be refused now. alerts: open ones of a craft
    that flies for no mission; a mission's alerts are its facts. settling_samples: left out, since the receiver was
    changing to other channels. receiver_lost_percent: of what its device took in the last seconds."""

    craft_id: str
    mission_id: str | None
    phase: Phase
    receiver: Literal["ok", "silent", "off", "lost"]
    receiver_power_db: float | None
    receiver_age_s: float | None
    battery_to_return_percent: float | None
    order: OrderMessage | None = None
    resume_refused: Reason | None = None
    alerts: tuple[CraftAlertMessage, ...] = ()
    settling_samples: int = 0
    receiver_lost_percent: float = 0.0


class StatusMessage(Model):
    """Once a second, and when an order goes on: the mission in the air, None when none is, every craft there is, and
    the server's own health. database: "unstored" while the mission's facts can be stored nowhere: they are kept in
    memory, and are shown once they are stored."""

    type: Literal["status"] = "status"
    at_utc: datetime
    mission_id: str | None
    phase: MissionPhase | None
    crafts: list[CraftStatusMessage]
    viewers: int
    database: Literal["ok", "slow", "lost", "unstored"]


LiveMessage = Annotated[
    Hello | EventMessage | TelemetryMessage | SweepProgress | StatusMessage, Field(discriminator="type")
]
