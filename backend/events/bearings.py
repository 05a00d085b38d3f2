"""What a bearing says and where it comes from: sweeps, recordings, people. Degrees clockwise from true north."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field

from backend.events.fact import Fact, Known, KnownRow
from backend.reasons import Reason
from backend.spec import Id, Place

WHOLE_DEG = 355.0


class AntennaFact(Fact):
    """relative_bearing_deg: (n,) clockwise from the antenna's front, ascending. gain_db: (n,). offset_to_nose_deg: the
    front points so far clockwise of the nose. pointing_sigma_deg, borrowed: as in hardware's AntennaPattern."""

    name: str
    relative_bearing_deg: list[float]
    gain_db: list[float]
    offset_to_nose_deg: float
    frequency_hz: Known
    pointing_sigma_deg: Known = None
    borrowed: bool = False


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


class Peak(Fact):
    """A weaker direction of the same sweep: evidence of multipath or of a second emitter. weight: in (0, 1]."""

    bearing_deg: float
    weight: float


class SilenceFact(Fact):
    """The emitter was listened to and not heard. chances: (16,) to hear it, with the antenna pointing to 0, 22.5, ..
    degrees from north. gain_db: (36,) of the antenna, 0, 10, .. degrees clockwise of its front, below its maximum."""

    chances: Annotated[list[Annotated[float, Field(ge=0)]], Field(min_length=1, max_length=360)]
    gain_db: Annotated[list[Annotated[float, Field(le=0)]], Field(min_length=1, max_length=360)]


class TurnFact(Fact):
    """How far a craft turned for a sweep. begin_deg: antenna heading at which it began, clockwise from true north.

    planned_deg, turned_deg: clockwise from there. planned_because: why a sector of that width, or a whole turn.
    went_on_because: one a look that was not enough. stopped_because: why the last one was.
    """

    begin_deg: float
    planned_deg: float
    turned_deg: float
    planned_because: Reason
    went_on_because: list[Reason]
    stopped_because: Reason

    @property
    def partial(self) -> bool:
        """Whether it left a part of the circle out; a vehicle stops a few degrees short of a whole one."""
        return self.turned_deg < WHOLE_DEG


class SweepRejected(Fact):
    """No bearing came of this turn. quality: in [0, 1]. binned_db, fitted_db, likelihood, turn: as in
    BearingMeasured. silence: the emitter should have been heard, were it near; None: the turn says nothing of that."""

    kind: Literal["sweep_rejected"] = "sweep_rejected"
    emitter_id: Id
    source: BearingSource
    sweep_id: str
    place_number: int
    attempt: int
    quality: float
    reason: Reason
    place: Place
    binned_db: KnownRow
    fitted_db: KnownRow
    likelihood: str | None = None
    silence: SilenceFact | None = None
    turn: TurnFact | None = None


class BearingMeasured(Fact):
    """sweep_id None, binned_db and fitted_db empty: no sweep was kept (a person's bearing). binned_db, fitted_db: 180
    bins of 2 degrees of antenna heading (true), None where nothing was heard.

    measurement_time_s: from the order to turn to the bearing, by the mission's clock; None for an imported sweep.
    heading_sigma_deg, pattern_sigma_deg: the shares of sigma_deg that all bearings of a flight have in common, the
    heading's and the antenna's. remarks: what makes the bearing less certain.
    likelihood: what the sweep says of every direction (hardware's SweepLikelihood, packed); None: not kept.
    samples_without_heading: power samples that were left out, as no heading was heard near enough to them.
    taken_at_s: UTC epoch seconds of the middle of the turn; None: nobody said (imported, or before it was kept).
    turn: how far the craft turned and why; None: once all the way round, as in every mission without sector turns.
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
    binned_db: KnownRow
    fitted_db: KnownRow
    measurement_time_s: Known = None
    heading_sigma_deg: float = 0.0
    pattern_sigma_deg: float = 0.0
    remarks: list[Reason] = Field(default_factory=list[Reason])
    likelihood: str | None = None
    samples_without_heading: int = 0
    taken_at_s: Known = None
    turn: TurnFact | None = None


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
    """An operator's wish: the belief is folded again without it, the bearing stays in the journal. heard False: it is
    a turn that heard nothing, and bearing_id that of its sweep; or, on_the_way, a leg, and bearing_id its leg_id."""

    kind: Literal["bearing_excluded"] = "bearing_excluded"
    emitter_id: Id
    bearing_id: str
    by: str
    reason: str
    """In the operator's own words."""
    heard: bool = True
    on_the_way: bool = False


class BearingIncluded(Fact):
    """A bearing, or a turn that heard nothing, that was left out counts again, in its old place in the order. heard: as
    in BearingExcluded; True in facts of before, which did not tell."""

    kind: Literal["bearing_included"] = "bearing_included"
    emitter_id: Id
    bearing_id: str
    by: str
    heard: bool = True


class SourceMuteChanged(Fact):
    """muted: the source's bearings, those to come too, are kept and count for nothing; False: they count again, but for
    those that were left out one by one."""

    kind: Literal["source_mute_changed"] = "source_mute_changed"
    source: BearingSource
    muted: bool
    by: str
    reason: str = ""
    """In the operator's own words."""
