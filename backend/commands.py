"""What a browser may ask: REST bodies. Commands are idempotent by the client-made `command_id`."""

from __future__ import annotations

from typing import Annotated, Literal
from uuid import UUID

from pydantic import Field

from backend.spec import Model, Place, SearchArea


class Start(Model):
    kind: Literal["start"] = "start"


class Hold(Model):
    kind: Literal["hold"] = "hold"


class Resume(Model):
    """Continue after hold, restart or a pilot's takeover (then it also releases the pilot latch)."""

    kind: Literal["resume"] = "resume"


class Return(Model):
    kind: Literal["return"] = "return"


class Abort(Model):
    """End the automatic mission at once: the vehicle holds, then returns home by its autopilot."""

    kind: Literal["abort"] = "abort"


class Override(Model):
    """Fly to this place next instead of the planner's choice."""

    kind: Literal["override"] = "override"
    place: Place


class ChangeArea(Model):
    """In hold: search here from now on. The bearings that were taken count on."""

    kind: Literal["change_area"] = "change_area"
    search: SearchArea


class Accept(Model):
    kind: Literal["accept"] = "accept"


class Veto(Model):
    kind: Literal["veto"] = "veto"


class SetAutomatic(Model):
    kind: Literal["set_automatic"] = "set_automatic"
    automatic: bool


class ExcludeBearing(Model):
    kind: Literal["exclude_bearing"] = "exclude_bearing"
    bearing_id: str
    reason: str = Field(default="", max_length=200)


class AcknowledgeAlert(Model):
    kind: Literal["acknowledge_alert"] = "acknowledge_alert"
    alert_id: str


Command = Annotated[
    Start
    | Hold
    | Resume
    | Return
    | Abort
    | Override
    | ChangeArea
    | Accept
    | Veto
    | SetAutomatic
    | ExcludeBearing
    | AcknowledgeAlert,
    Field(discriminator="kind"),
]


class CommandRequest(Model):
    command_id: UUID
    command: Command


class CommandReply(Model):
    """accepted False: `reason` says why, `remedy` what to do. seq: the journal's last number after the command."""

    command_id: UUID
    accepted: bool
    reason: str
    remedy: str
    seq: int
