"""What the REST API answers, apart from problems and the live messages. Positions WGS84, times UTC, units in names."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field, model_validator

from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    CandidateFact,
    CheckFact,
    EstimateFact,
    MissionPhase,
    Outcome,
    PlanChosen,
    Recorded,
    SweepRejected,
)
from backend.events.review import PatternUpload, Supposition
from backend.reasons import Reason
from backend.spec import Area, Id, MissionSpec, Model, Place
from backend.wire.library import Sketch


class Payload(Model):
    """A companion computer with a radio. `age_s`: since it was last heard. `receiver`: how it is, None until it has
    said so. `clock_offset_s`: server minus payload; its samples are corrected by it. `waiting`: samples on its disk
    that are still to come; `lost`: its disk was full.
    """

    name: str
    connected: bool
    age_s: float
    software: str
    receiver: Reason | None
    receiver_ok: bool
    temperature_c: float | None
    clock_offset_s: float | None
    round_trip_s: float | None
    clipped_percent: float
    waiting: int
    lost: int
    received: int


class PayloadList(Model):
    """`expected` False: this server takes no payload (it was given no tokens)."""

    expected: bool
    payloads: list[Payload]


class Defaults(Model):
    """A mission to start from. `home`: the vehicle's, None when it was never heard; the area is then around the
    configured fallback place."""

    spec: MissionSpec
    home: Place | None


class MissionSummary(Model):
    """One line of the list. `flying`: a craft is in the air for it, on its way home too. `started_at_utc`,
    `ended_at_utc`, `outcome`: None until it happened. `gone_at_utc`: until when a deleted one can be restored.
    `iq_bytes`: of the IQ that can be exported as SigMF, 0: none was kept."""

    mission_id: str
    name: str
    phase: MissionPhase
    flying: bool
    outcome: Outcome | None
    emitters: int
    drafted_at_utc: datetime
    started_at_utc: datetime | None
    ended_at_utc: datetime | None
    mission_time_s: float | None
    bearings: int
    rejected_sweeps: int
    last_seq: int
    tags: list[str]
    notes: str
    deleted_at_utc: datetime | None
    gone_at_utc: datetime | None
    sketch: Sketch
    iq_bytes: int


class EmitterFound(Model):
    """What is known of one emitter. `estimate`: of the last belief, None before the first bearing or when the bearings
    are inconsistent. `not_yet`: why "localized" is not said."""

    emitter_id: str
    bearings: int
    estimate: EstimateFact | None
    localized: bool
    not_yet: list[Reason]


class Mission(MissionSummary):
    """`editable`: the specification may still be replaced; `spec_seq`: of the fact that set it, which an edit begins
    from. `found`: in the order of the specification's emitters."""

    spec: MissionSpec
    spec_seq: int
    editable: bool
    home: Place | None
    localized: bool
    found: list[EmitterFound]
    outcome_reason: Reason | None


class MissionList(Model):
    """Newest first. next: what `after` asks for the missions that follow, None when these are the last."""

    missions: list[MissionSummary]
    next: str | None


class PreflightReply(Model):
    """passed: nothing that blocks has failed."""

    passed: bool
    checks: list[CheckFact]


class AntennaCheckRequest(Model):
    """A known emitter, by its place or by its bearing (degrees clockwise from true north). `wait_s`: at most so long
    is listened; the vehicle is turned once around by hand meanwhile."""

    place: Place | None = None
    bearing_deg: float | None = Field(default=None, ge=0, lt=360, allow_inf_nan=False)
    wait_s: float = Field(default=60.0, ge=1, le=300, allow_inf_nan=False)

    @model_validator(mode="after")
    def one_of_both(self) -> AntennaCheckRequest:
        """Both could contradict each other."""
        if (self.place is None) == (self.bearing_deg is None):
            raise ValueError("name the emitter's place or its bearing, one of both")
        return self


class EventPage(Model):
    """Events with seq > after, in order. `more`: ask again with after = the last seq."""

    events: list[Recorded]
    last_seq: int
    more: bool


def event_page(told: Sequence[str], last_seq: int, more: bool) -> bytes:
    """The JSON of an EventPage. told: of each Recorded; nothing is decoded to be encoded again."""
    return f'{{"events":[{",".join(told)}],"last_seq":{last_seq},"more":{str(more).lower()}}}'.encode()


class SweepRecord(Model):
    """One raw sweep. at_s (since the first sample), heading_deg (the nose, true), power_db: one value a sample; None
    where the receiver gave no number."""

    sweep_id: str
    mission_id: str
    craft_id: str | None
    emitter_id: str
    place_number: int
    attempt: int
    began_at_utc: datetime
    place: Place
    altitude_amsl_m: float | None
    frequency_hz: float
    drift_m: float | None
    clipped_samples: int
    noise_floor_db: float | None
    tag: str | None
    at_s: list[float | None]
    heading_deg: list[float | None]
    power_db: list[float | None]


class TrackFact(Model):
    """One point of a flown path, thinned. mode: the autopilot's name for it."""

    at_utc: datetime
    lat: float
    lon: float
    altitude_amsl_m: float | None
    altitude_relative_m: float | None
    heading_deg: float | None
    battery_percent: float | None
    mode: str | None


class Track(Model):
    """The flown path of a craft, thinned to 2 Hz, in time order."""

    mission_id: str
    craft_id: str
    points: list[TrackFact]


class ExportedMission(Model):
    """What an exported journal holds. Of the paths it keeps time, place, altitude and heading."""

    mission_id: str
    events: list[Recorded]
    tracks: list[Track]


class ExpectedTimeRequest(Model):
    """What if the vehicle measured here next? instead_of: a place to compare it with, usually the planner's."""

    place: Place
    instead_of: Place | None = None


class PlacesCompared(Model):
    """The place beside another, on the same simulated flights by the planner's own measure.

    difference_s: by which it takes longer, negative when it is quicker. quicker: by more than chance. rules: then why
    the planner may not choose it all the same.
    """

    difference_s: float
    std_error_s: float
    quicker: bool
    rules: list[Reason]


class ExpectedTime(Model):
    """allowed False: the vehicle may not go there, `reason` says why (the times may still be known).

    expected_time_s: mean time until localized by way of the place; time_90_s: not exceeded by nine of ten searches.
    """

    place: Place
    allowed: bool
    reason: Reason | None
    expected_time_s: float | None
    std_error_s: float | None
    time_90_s: float | None
    rollouts: int
    compared: PlacesCompared | None = None


class Preview(Model):
    """A mission before take-off: where it would begin, where it would measure first and how long it may take."""

    start: Place
    first_place: Place
    reason: Reason
    expected_time_s: float | None
    time_90_s: float | None
    times_s: list[float]
    candidates: list[CandidateFact]
    rollouts: int
    plan_ms: float


class AreaOutlook(Model):
    """Another search area in flight: what the bearings so far would say there, and the next place (None: `no_plan` says
    why). allowed False: it cannot be searched from where the vehicle is, `reason` says why."""

    allowed: bool
    reason: Reason | None
    belief: BeliefUpdated
    plan: PlanChosen | None
    no_plan: Reason | None


class AreaUpload(Model):
    """The text of a GeoJSON or KML file that holds one or more polygons."""

    text: str = Field(min_length=1, max_length=5_000_000)
    filename: str = Field(default="", max_length=255)


class AreaImport(Model):
    """`notes`: what was changed or left out while reading."""

    area: Area
    format: Literal["geojson", "kml"]
    area_m2: float
    vertices: int
    notes: list[Reason]


class ImportedSweep(Model):
    """One sweep of a recording. `bearing_deg`, `sigma_deg`: None when it was rejected; `reason` says why."""

    sweep_id: str
    place_number: int
    place: Place
    accepted: bool
    bearing_deg: float | None
    sigma_deg: float | None
    quality: float
    reason: Reason | None


class RecordingImport(Model):
    """`already`: the same recording was imported before, nothing was added. `remarks`: what was left out and why,
    each naming file and line. `iq_kept`: the recording can be exported as SigMF."""

    recording_id: str
    filename: str
    already: bool
    iq_kept: bool
    sweeps: list[ImportedSweep]
    remarks: list[Reason]
    last_seq: int


SweepFact = Annotated[BearingMeasured | SweepRejected, Field(discriminator="kind")]


class AntennaReview(Model):
    """What a mission's own sweeps of an emitter say of its antenna. `sweeps`: how many were compared. `repeats_db`:
    what they deviate from the flown pattern by alike, None: too few. `doubt`: that this is not the antenna which was
    measured, or that all its bearings are turned (it may point beside, or the compass is off). `proposed`: the pattern
    that they show, once the emitter is localized; the what-if takes it as it is."""

    sweeps: int
    repeats_db: float | None
    doubt: Reason | None
    proposed: PatternUpload | None


class CompassKnown(Model):
    """What the flights of a craft with an antenna taught of its bearings' errors, and what its next mission expects.

    flights, bearings: that were learned from; places_known: flights whose emitter was found. bias_deg: mean of the
    flights, clockwise, of what is left after what the next mission takes off its bearings, and bias_spread_deg: its
    standard deviation from flight to flight; None without a flight.
    expected_bias_deg: standard deviation of the next flight's bias. sigma_scale: factor on the stated sigmas.
    outlier_rate: share of bearings."""

    craft_id: Id
    antenna: str
    flights: int
    bearings: int
    places_known: int
    bias_deg: float | None
    bias_spread_deg: float | None
    expected_bias_deg: float
    sigma_scale: float
    outlier_rate: float


class WhatIfRequest(Supposition):
    """The decision after this many of the flown bearings that count, taken again.

    until: number of the last event that had happened by then, since legs are heard between bearings; those that the
    last belief by then was told count. None: all until the next bearing.
    """

    bearings: int = Field(ge=0, le=200)
    until: int | None = Field(default=None, ge=0)


class WhatIfStep(Model):
    """After this many flown bearings: what would have been said, and what was (None: nothing was said then)."""

    bearings: int
    expected_rmse_m: float | None
    localized: bool
    flown_expected_rmse_m: float | None
    flown_localized: bool | None


class WhatIfAntenna(Model):
    """Which antenna the answer was computed for."""

    name: str
    offset_to_nose_deg: float


class WhatIf(Model):
    """`belief`, `plan`: as the events would have been; plan None: `no_plan` says why. `frame_base64`: the belief's
    binary frame (lite). `sweeps`: what each would have told, in order, without those left out or not taken then.
    `antenna`: through which the sweeps were taken again, None: they were not. `legs_left_out`: legs that were heard in
    flight, and not through that antenna: their samples were not kept."""

    steps: list[WhatIfStep]
    belief: BeliefUpdated
    plan: PlanChosen | None
    no_plan: Reason | None
    frame_base64: str
    sweeps: list[SweepFact]
    antenna: WhatIfAntenna | None
    legs_left_out: int = 0
