"""The facts of a mission, in the past tense. The journal stores them; state is a fold of them.

Every event has a `kind`, and the id of the craft or the emitter that it speaks of. A stored event is wrapped in
`Recorded` with its sequence number and UTC time. Bearings: degrees clockwise from true north. Rejected wishes are facts
too (`CommandRefused`): the review must show them. by: who ordered it, None when the mission did by itself.
"""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import Field

from backend.events.alerts import (
    AlertAcknowledged,
    AlertCleared,
    AlertRaised,
    Level,
    Link,
    LinkLost,
    LinkRestored,
    SafetyVetoed,
    Topic,
)
from backend.events.bearings import (
    AntennaFact,
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BearingSource,
    CraftSource,
    ImportSource,
    Peak,
    PersonSource,
    RecordingImported,
    SilenceFact,
    SourceMuteChanged,
    SweepRejected,
    TurnFact,
)
from backend.events.belief import BeliefUpdated, EstimateFact, LegSaid, SourceErrorsFact
from backend.events.checks import AntennaChecked, CheckFact, PreflightChecked
from backend.events.control import ControlAsked, ControlChanged, ControlKept, ControlWay, Holder
from backend.events.craft import (
    FIRST_CRAFT,
    AuthorityChanged,
    BatteryCountdownStarted,
    BatteryCountdownStopped,
    FlightStarted,
    GroundFact,
    MissionStarted,
    Phase,
    PhaseChanged,
    PlacePassed,
    PlaceReached,
    PlaceRefused,
    SweepStarted,
    TookOff,
)
from backend.events.fact import Fact, Known
from backend.events.mission import (
    AreaChanged,
    MissionDrafted,
    MissionEdited,
    MissionEnded,
    MissionPhase,
    Outcome,
    PrioritiesChanged,
    ServerRestarted,
)
from backend.events.nets import NetsHung, NetsNoted, NetsPutBack
from backend.events.on_the_way import HeardOnTheWay, StretchFact
from backend.events.orders import (
    AbortOrdered,
    AuthorFact,
    AutomaticChanged,
    CommandAccepted,
    CommandRefused,
    HoldOrdered,
    LandOrdered,
    OrderDone,
    OrderNotDone,
    OrderTried,
    ResumeOrdered,
    ReturnOrdered,
)
from backend.events.plans import CandidateFact, ForecastFact, PlanChosen, PlanVetoed, SetBackFact
from backend.events.review import (
    MissionBroughtIn,
    MissionDeleted,
    MissionLabelled,
    MissionRestored,
    Supposition,
    TruthNoted,
    VariantDropped,
    VariantKept,
)
from backend.spec import Model

__all__ = [
    "FIRST_CRAFT",
    "FORM",
    "AbortOrdered",
    "AlertAcknowledged",
    "AlertCleared",
    "AlertRaised",
    "AntennaChecked",
    "AntennaFact",
    "AreaChanged",
    "AuthorFact",
    "AuthorityChanged",
    "AutomaticChanged",
    "BatteryCountdownStarted",
    "BatteryCountdownStopped",
    "BearingExcluded",
    "BearingIncluded",
    "BearingMeasured",
    "BearingSource",
    "BeliefUpdated",
    "CandidateFact",
    "CheckFact",
    "CommandAccepted",
    "CommandRefused",
    "ControlAsked",
    "ControlChanged",
    "ControlKept",
    "ControlWay",
    "CraftSource",
    "EstimateFact",
    "Event",
    "Fact",
    "FlightStarted",
    "ForecastFact",
    "GroundFact",
    "HeardOnTheWay",
    "HoldOrdered",
    "Holder",
    "ImportSource",
    "Known",
    "LandOrdered",
    "LegSaid",
    "Level",
    "Link",
    "LinkLost",
    "LinkRestored",
    "MissionBroughtIn",
    "MissionDeleted",
    "MissionDrafted",
    "MissionEdited",
    "MissionEnded",
    "MissionLabelled",
    "MissionPhase",
    "MissionRestored",
    "MissionStarted",
    "NetsHung",
    "NetsNoted",
    "NetsPutBack",
    "OrderDone",
    "OrderNotDone",
    "OrderTried",
    "Outcome",
    "Peak",
    "PersonSource",
    "Phase",
    "PhaseChanged",
    "PlacePassed",
    "PlaceReached",
    "PlaceRefused",
    "PlanChosen",
    "PlanVetoed",
    "PreflightChecked",
    "PrioritiesChanged",
    "Recorded",
    "RecordingImported",
    "ResumeOrdered",
    "ReturnOrdered",
    "ReviewFact",
    "SafetyVetoed",
    "ServerRestarted",
    "SetBackFact",
    "SilenceFact",
    "SourceErrorsFact",
    "SourceMuteChanged",
    "StretchFact",
    "Supposition",
    "SweepRejected",
    "SweepStarted",
    "TookOff",
    "Topic",
    "TruthNoted",
    "TurnFact",
    "VariantDropped",
    "VariantKept",
]

FORM = 5
"""Of these facts, as they are stored and exported; a field more is a form more. See backend.store.upgrade."""

ReviewFact = TruthNoted | MissionLabelled | MissionDeleted | MissionRestored | VariantKept | VariantDropped

Event = Annotated[
    MissionDrafted
    | MissionEdited
    | AreaChanged
    | PrioritiesChanged
    | PreflightChecked
    | AntennaChecked
    | MissionStarted
    | NetsNoted
    | NetsHung
    | NetsPutBack
    | PhaseChanged
    | TookOff
    | PlanChosen
    | PlanVetoed
    | PlaceRefused
    | FlightStarted
    | PlaceReached
    | PlacePassed
    | SweepStarted
    | SweepRejected
    | HeardOnTheWay
    | BearingMeasured
    | RecordingImported
    | BearingExcluded
    | BearingIncluded
    | SourceMuteChanged
    | BeliefUpdated
    | HoldOrdered
    | ResumeOrdered
    | ReturnOrdered
    | LandOrdered
    | AbortOrdered
    | OrderTried
    | OrderNotDone
    | OrderDone
    | BatteryCountdownStarted
    | BatteryCountdownStopped
    | AutomaticChanged
    | AuthorityChanged
    | CommandAccepted
    | CommandRefused
    | ControlChanged
    | ControlAsked
    | ControlKept
    | SafetyVetoed
    | LinkLost
    | LinkRestored
    | AlertRaised
    | AlertAcknowledged
    | AlertCleared
    | ServerRestarted
    | MissionEnded
    | TruthNoted
    | MissionLabelled
    | MissionDeleted
    | MissionRestored
    | MissionBroughtIn
    | VariantKept
    | VariantDropped,
    Field(discriminator="kind"),
]


class Recorded(Model):
    """A stored event: `seq` counts from 1 without gaps within a mission."""

    seq: int
    mission_id: str
    at_utc: datetime
    event: Event
