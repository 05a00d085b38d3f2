"""The facts of a mission, in the past tense. The journal stores them; state is a fold of them.

Every event has a `kind`, and the id of the craft or the emitter that it speaks of. A stored event is wrapped in
`Recorded` with its sequence number and UTC time. Bearings: degrees clockwise from true north. Rejected wishes are facts
too (`CommandRefused`): the review must show them. by: who ordered it, None when the mission did by itself.
"""

from __future__ import annotations

import math
from datetime import datetime
from typing import Annotated, Literal

from pydantic import BeforeValidator, ConfigDict, Field

from backend.reasons import Reason
from backend.spec import Area, Id, MissionSpec, Model, Place, SearchArea
from hardware.authority import Authority
from hardware.readings import CheckName

FIRST_CRAFT = "craft-1"
FORM = 2
"""Of these facts, as they are stored and exported; what was stored in form 1 is upgraded when it is read."""

Phase = Literal[
    "ground",  # not flying for this mission
    "taking_off",
    "planning",  # choosing the next place
    "waiting",  # a place is proposed, the operator must accept
    "flying",
    "measuring",
    "hold",  # hovering until an operator resumes
    "manual",  # the pilot has control
    "returning",
    "landing",
]
"""What a craft does."""
MissionPhase = Literal["draft", "ready", "searching", "done", "aborted", "failed"] | Phase
"""A mission in one word: what its craft does while one flies, else the stage of its search."""
Outcome = Literal["localized", "not_localized", "aborted", "failed"]
Link = Literal["vehicle", "receiver", "console", "payload"]
Topic = Literal[
    "vehicle",
    "receiver",
    "console",
    "payload",
    "pilot",
    "battery",
    "place",
    "heading",
    "failure",
    "safety",
    "ground",
    "storage",
]
"""What an alert is about: a later one on the same topic, of the same craft or emitter, takes its place."""


class Fact(Model):
    """A number that is not finite cannot be stored: it is refused where the fact is made."""

    model_config = ConfigDict(allow_inf_nan=False)


def _known(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


Known = Annotated[float | None, BeforeValidator(_known)]
"""A number that may be unknown: NaN and infinity are None."""


class Peak(Fact):
    bearing_deg: float
    weight: float


class CandidateFact(Fact):
    """One candidate next place. `dropped_in_round` None: survived. `std_error_s` None: a single rollout has none."""

    lat: float
    lon: float
    value_s: float
    std_error_s: Known
    rollouts: int
    dropped_in_round: int | None


class CheckFact(Fact):
    """One line of the checklist. blocking: refuses the start unless it is ok."""

    name: CheckName
    ok: bool
    reason: Reason
    blocking: bool


class AntennaFact(Fact):
    """relative_bearing_deg: (n,) clockwise from the antenna's front, ascending. gain_db: (n,). offset_to_nose_deg: the
    front points so far clockwise of the nose."""

    name: str
    relative_bearing_deg: list[float]
    gain_db: list[float]
    offset_to_nose_deg: float
    frequency_hz: Known


class EstimateFact(Fact):
    """Axes: semi-axes of one standard deviation; `major_axis_deg` compass bearing of the longer, in [0, 180)."""

    lat: float
    lon: float
    expected_rmse_m: float
    c95: Area
    c95_area_m2: float
    major_axis_m: float
    minor_axis_m: float
    major_axis_deg: float


class CraftSource(Fact):
    """A craft's own sweep."""

    kind: Literal["craft"] = "craft"
    craft_id: Id


class ImportSource(Fact):
    """A sweep out of a recording."""

    kind: Literal["import"] = "import"
    recording_id: str


class PersonSource(Fact):
    """Somebody with an antenna in their hand."""

    kind: Literal["person"] = "person"
    name: str


BearingSource = Annotated[CraftSource | ImportSource | PersonSource, Field(discriminator="kind")]
"""Who took a bearing: each source has errors of its own."""


class MissionDrafted(Fact):
    kind: Literal["mission_drafted"] = "mission_drafted"
    spec: MissionSpec


class MissionEdited(Fact):
    kind: Literal["mission_edited"] = "mission_edited"
    spec: MissionSpec


class AreaChanged(Fact):
    """In hold, in flight: from here on this is searched. The bearings taken before count on."""

    kind: Literal["area_changed"] = "area_changed"
    search: SearchArea
    by: str


class PreflightChecked(Fact):
    kind: Literal["preflight_checked"] = "preflight_checked"
    passed: bool
    checks: list[CheckFact]


class AntennaChecked(Fact):
    """The antenna was turned before a known emitter. It stands in the checklist until the next one, or an edit."""

    kind: Literal["antenna_checked"] = "antenna_checked"
    check: CheckFact
    emitter: Place
    by: str


class MissionStarted(Fact):
    """A craft begins to fly for the mission. The first one's home is the origin of the mission's local frame. antenna
    None: nobody kept it."""

    kind: Literal["mission_started"] = "mission_started"
    craft_id: Id
    by: str
    home: Place
    home_amsl_m: float
    software: str
    antenna: AntennaFact | None = None


class PhaseChanged(Fact):
    kind: Literal["phase_changed"] = "phase_changed"
    craft_id: Id
    before: Phase
    after: Phase
    reason: Reason


class TookOff(Fact):
    kind: Literal["took_off"] = "took_off"
    craft_id: Id
    place: Place
    altitude_relative_m: float


class PlanChosen(Fact):
    """The next measurement place. `emitter_id`: the emitter it is to tell most of, None of an operator's.
    `place_number` counts places from 1. `expected_time_s`: mean time until localized by way of this place; `time_90_s`:
    not exceeded in 90 % of the rollouts (None when not sampled)."""

    kind: Literal["plan_chosen"] = "plan_chosen"
    craft_id: Id
    emitter_id: Id | None = None
    place_number: int
    place: Place
    source: Literal["planner", "operator"]
    reason: Reason
    expected_time_s: Known
    time_90_s: Known
    candidates: list[CandidateFact]
    rollouts: int
    plan_ms: float
    by: str | None = None


class PlanVetoed(Fact):
    """The operator refused the proposed place; the planner chooses again without it."""

    kind: Literal["plan_vetoed"] = "plan_vetoed"
    craft_id: Id
    place: Place
    by: str


class FlightStarted(Fact):
    kind: Literal["flight_started"] = "flight_started"
    craft_id: Id
    place_number: int
    place: Place
    altitude_amsl_m: float


class PlaceReached(Fact):
    kind: Literal["place_reached"] = "place_reached"
    craft_id: Id
    place_number: int
    place: Place
    distance_m: float
    flight_time_s: float


class SweepStarted(Fact):
    kind: Literal["sweep_started"] = "sweep_started"
    craft_id: Id
    place_number: int
    attempt: int


class SweepRejected(Fact):
    kind: Literal["sweep_rejected"] = "sweep_rejected"
    emitter_id: Id
    source: BearingSource
    sweep_id: str
    place_number: int
    attempt: int
    quality: float
    reason: Reason
    place: Place
    binned_db: list[Known]
    fitted_db: list[Known]


class BearingMeasured(Fact):
    """sweep_id None, binned_db and fitted_db empty: no sweep was kept (a person's bearing). binned_db, fitted_db: 180
    bins of 2 degrees of antenna heading (true), None where nothing was heard.

    measurement_time_s: from the order to turn to the bearing, by the mission's clock; None for an imported sweep.
    heading_sigma_deg: the share of sigma_deg that all bearings of a flight have in common, the heading's.
    """

    kind: Literal["bearing_measured"] = "bearing_measured"
    emitter_id: Id
    source: BearingSource
    bearing_id: str
    sweep_id: str | None
    place_number: int
    place: Place
    altitude_amsl_m: float
    bearing_deg: float
    sigma_deg: float
    quality: float
    peaks: list[Peak]
    snr_db: Known
    drift_m: float
    binned_db: list[Known]
    fitted_db: list[Known]
    measurement_time_s: Known = None
    heading_sigma_deg: float = 0.0


class RecordingImported(Fact):
    """Recorded sweeps of an emitter were brought in; their facts follow. recording_id: SHA-256 of the files and of what
    was said about them. recorded_at_utc: of the first sample, None when nobody told. remarks: what was not understood
    and why.
    """

    kind: Literal["recording_imported"] = "recording_imported"
    emitter_id: Id
    recording_id: str
    filename: str
    by: str
    recorded_at_utc: datetime | None
    sweep_ids: list[str]
    remarks: list[Reason]
    antenna: AntennaFact | None = None


class BearingExcluded(Fact):
    kind: Literal["bearing_excluded"] = "bearing_excluded"
    emitter_id: Id
    bearing_id: str
    by: str
    reason: str
    """In the operator's own words."""


class BeliefUpdated(Fact):
    """The belief about one emitter after folding `bearings` bearings. `digest`: SHA-256 of the grid, so that a rebuilt
    belief can be compared bit for bit. `estimate` None when the bearings are inconsistent (never a made-up estimate).
    `contradicting`: ids of the bearings that do not point at the estimate; a claim that is made all the same stands
    against them. `heading_offset_deg`: what all bearings seem to be off by together, clockwise, when that is
    significant: then nothing is claimed."""

    kind: Literal["belief_updated"] = "belief_updated"
    emitter_id: Id
    bearings: int
    estimate: EstimateFact | None
    consistent: bool
    localized: bool
    not_yet: list[Reason]
    contradicting: list[str] = Field(default_factory=list[str])
    heading_offset_deg: Known = None
    heading_offset_std_error_deg: Known = None
    digest: str


class HoldOrdered(Fact):
    kind: Literal["hold_ordered"] = "hold_ordered"
    craft_id: Id
    by: str | None
    reason: Reason | None


class ResumeOrdered(Fact):
    kind: Literal["resume_ordered"] = "resume_ordered"
    craft_id: Id
    by: str


class ReturnOrdered(Fact):
    kind: Literal["return_ordered"] = "return_ordered"
    craft_id: Id
    by: str | None
    reason: Reason | None


class AbortOrdered(Fact):
    kind: Literal["abort_ordered"] = "abort_ordered"
    craft_id: Id
    by: str


class AutomaticChanged(Fact):
    """ "Accept the next location automatically" was armed or disarmed."""

    kind: Literal["automatic_changed"] = "automatic_changed"
    craft_id: Id
    automatic: bool
    by: str


class AuthorityChanged(Fact):
    """Who flies the craft from now on. by: the operator whose deed it was, None when the vehicle showed it."""

    kind: Literal["authority_changed"] = "authority_changed"
    craft_id: Id
    authority: Authority
    by: str | None = None


class CommandAccepted(Fact):
    """What makes commands idempotent across restarts: a repeated `command_id` gets the first answer again."""

    kind: Literal["command_accepted"] = "command_accepted"
    command_id: str
    command: str
    by: str


class CommandRefused(Fact):
    kind: Literal["command_refused"] = "command_refused"
    command_id: str
    command: str
    by: str
    reason: Reason


class SafetyVetoed(Fact):
    kind: Literal["safety_vetoed"] = "safety_vetoed"
    craft_id: Id
    reason: Reason


class LinkLost(Fact):
    kind: Literal["link_lost"] = "link_lost"
    craft_id: Id
    link: Link
    reason: Reason


class LinkRestored(Fact):
    kind: Literal["link_restored"] = "link_restored"
    craft_id: Id
    link: Link
    outage_s: float


class AlertRaised(Fact):
    """craft_id, emitter_id: whom it concerns; None of both: the whole mission."""

    kind: Literal["alert_raised"] = "alert_raised"
    alert_id: str
    topic: Topic
    level: Literal["warning", "caution", "advisory"]
    reason: Reason
    craft_id: Id | None = None
    emitter_id: Id | None = None


class AlertAcknowledged(Fact):
    kind: Literal["alert_acknowledged"] = "alert_acknowledged"
    alert_id: str
    by: str


class AlertCleared(Fact):
    kind: Literal["alert_cleared"] = "alert_cleared"
    alert_id: str


class ServerRestarted(Fact):
    kind: Literal["server_restarted"] = "server_restarted"


class MissionEnded(Fact):
    """The search is over; a craft of it may still be on its way home."""

    kind: Literal["mission_ended"] = "mission_ended"
    outcome: Outcome
    reason: Reason
    mission_time_s: float


Event = Annotated[
    MissionDrafted
    | MissionEdited
    | AreaChanged
    | PreflightChecked
    | AntennaChecked
    | MissionStarted
    | PhaseChanged
    | TookOff
    | PlanChosen
    | PlanVetoed
    | FlightStarted
    | PlaceReached
    | SweepStarted
    | SweepRejected
    | BearingMeasured
    | RecordingImported
    | BearingExcluded
    | BeliefUpdated
    | HoldOrdered
    | ResumeOrdered
    | ReturnOrdered
    | AbortOrdered
    | AutomaticChanged
    | AuthorityChanged
    | CommandAccepted
    | CommandRefused
    | SafetyVetoed
    | LinkLost
    | LinkRestored
    | AlertRaised
    | AlertAcknowledged
    | AlertCleared
    | ServerRestarted
    | MissionEnded,
    Field(discriminator="kind"),
]


class Recorded(Model):
    """A stored event: `seq` counts from 1 without gaps within a mission."""

    seq: int
    mission_id: str
    at_utc: datetime
    event: Event
