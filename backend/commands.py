"""What a browser may ask: REST bodies. Commands are idempotent by the client-made `command_id`.

craft_id None: of hold, return, land and abort every craft of the mission; of all others its only craft.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from typing import Annotated, Literal
from uuid import UUID

from pydantic import Field

from backend.permissions import Role
from backend.reasons import Reason
from backend.spec import MOST_EMITTERS, Id, Model, Place, Priority, SearchArea


class CraftCommand(Model):
    """What is asked of a craft."""

    craft_id: Id | None = None


class Start(CraftCommand):
    """Runs the checklist first; refused unless every blocking check passes."""

    kind: Literal["start"] = "start"


class Hold(CraftCommand):
    """Brake and hover, whatever the craft does."""

    kind: Literal["hold"] = "hold"


class Resume(CraftCommand):
    """Continue after hold, restart or a pilot's takeover (then it also takes control back)."""

    kind: Literal["resume"] = "resume"


class Return(CraftCommand):
    """The autopilot's own return; on the way the craft may still be held, and the search resumed."""

    kind: Literal["return"] = "return"


class Land(CraftCommand):
    """Land where the vehicle is: the last resort, what is below is not known."""

    kind: Literal["land"] = "land"


class Abort(CraftCommand):
    """End the automatic mission at once: the vehicle holds, then returns home."""

    kind: Literal["abort"] = "abort"


class KeepHolding(CraftCommand):
    """Stop the countdown of a low battery in hold, once a flight."""

    kind: Literal["keep_holding"] = "keep_holding"


class Override(CraftCommand):
    """Fly to this place next instead of the planner's choice."""

    kind: Literal["override"] = "override"
    place: Place


class Accept(CraftCommand):
    """Of the proposed place: fly there."""

    kind: Literal["accept"] = "accept"


class Veto(CraftCommand):
    """Of the proposed place: the planner chooses again without it."""

    kind: Literal["veto"] = "veto"


class SetAutomatic(CraftCommand):
    """automatic: places are flown to without being accepted."""

    kind: Literal["set_automatic"] = "set_automatic"
    automatic: bool


class ChangeArea(Model):
    """In hold: search here from now on. The bearings that were taken count on."""

    kind: Literal["change_area"] = "change_area"
    search: SearchArea


class ExcludeBearing(Model):
    """The belief is folded again without it; it stays in the journal."""

    kind: Literal["exclude_bearing"] = "exclude_bearing"
    bearing_id: str
    reason: str = Field(default="", max_length=200)
    """In the operator's own words."""


class IncludeBearing(Model):
    """A bearing that was left out counts again."""

    kind: Literal["include_bearing"] = "include_bearing"
    bearing_id: str


class MuteSource(Model):
    """muted: no bearing of the source counts, whenever it comes; False: they count again. name: the person's, or the
    recording's id. A craft is not muted: it would go on flying and measuring for nothing."""

    kind: Literal["mute_source"] = "mute_source"
    of: Literal["person", "import"]
    name: str = Field(max_length=200)
    muted: bool
    reason: str = Field(default="", max_length=200)
    """In the operator's own words."""


class SetPriorities(Model):
    """The order of importance as a whole: 1 is looked for first, equal ones are alike, what is not named comes last. It
    steers the choice of the next place; no hold is needed. Said again, an emitter that stands back because the others
    waited for it for too long comes forward."""

    kind: Literal["set_priorities"] = "set_priorities"
    priorities: dict[Id, Priority] = Field(max_length=MOST_EMITTERS)


class AcknowledgeAlert(Model):
    """Somebody has seen it; it stays open until its cause is gone."""

    kind: Literal["acknowledge_alert"] = "acknowledge_alert"
    alert_id: str


class TakeControl(Model):
    """Steer this search from now on: free, given up, not answered for, or as a pilot at once."""

    kind: Literal["take_control"] = "take_control"


class AskControl(Model):
    """Of whoever controls the search."""

    kind: Literal["ask_control"] = "ask_control"


class GiveControl(Model):
    """To whoever asked for it."""

    kind: Literal["give_control"] = "give_control"


class KeepControl(Model):
    """Say no to whoever asked for it."""

    kind: Literal["keep_control"] = "keep_control"


class ReleaseControl(Model):
    """Nobody controls the search then."""

    kind: Literal["release_control"] = "release_control"


ForCraft = Start | Hold | Resume | Return | Land | Abort | KeepHolding | Override | Accept | Veto | SetAutomatic
ForSearch = ChangeArea | ExcludeBearing | IncludeBearing | MuteSource | SetPriorities | AcknowledgeAlert
ForControl = TakeControl | AskControl | GiveControl | KeepControl | ReleaseControl
Command = Annotated[ForCraft | ForSearch | ForControl, Field(discriminator="kind")]


@dataclass(frozen=True, slots=True)
class Author:
    """Who gives a command. person: the account's id, None for the one person of a server without accounts, whom no
    lease binds. address: where the request came from, None when it came from no network."""

    name: str
    person: str | None = None
    role: Role | None = None
    address: str | None = None


def order_of(command: Command) -> str:
    """What a command id is bound to: a digest of all that is ordered."""
    return sha256(command.model_dump_json().encode()).hexdigest()[:16]


Fence = Annotated[int | None, Field(ge=0, le=2**31 - 1)]


class Press(Model):
    """page: an id that it has for as long as it is open. number: of its orders so far. Hold, return, landing and resume
    are refused where the craft has accepted a later one of the same page: an order that a bad link has held up does not
    undo the next."""

    page: UUID
    number: int = Field(ge=1, le=2**31 - 1)


class CommandRequest(Model):
    """command_id: made by the client; sent twice, the command is carried out once. fence: of the control lease that it
    is given under, None where there are no accounts, or for what needs no control. press: None: it counts whenever it
    comes."""

    command_id: UUID
    command: Command
    fence: Fence = None
    press: Press | None = None


class CraftRequest(Model):
    """To a craft in the air, in a mission or in none. resume: take it back from a pilot who has given it back; in a
    mission that needs its control, hence the fence."""

    command_id: UUID
    command: Annotated[Hold | Return | Land | Resume, Field(discriminator="kind")]
    fence: Fence = None
    press: Press | None = None


class CommandReply(Model):
    """reason: why it was refused, None when it was accepted. seq: the journal's last number after the command."""

    command_id: UUID
    accepted: bool
    reason: Reason | None
    seq: int
