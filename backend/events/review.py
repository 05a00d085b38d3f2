"""After the flight: where the emitter really was, and how the mission is kept in the library."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from backend.events.fact import Fact
from backend.spec import ErrorModel, Id, Model, Place, SweepEvidence
from planner.options import BasePolicy, DiscreteSelection, Estimator, Method

Tag = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=40, pattern=r"^[^\x00-\x1f]*$")]
VariantName = Annotated[
    str, StringConstraints(strip_whitespace=True, min_length=1, max_length=60, pattern=r"^[^\x00-\x1f/]*$")
]
BearingName = Annotated[str, StringConstraints(min_length=1, max_length=64)]
TruthWay = Literal["map", "typed", "phone"]
"""How a place was told: tapped on the map, written or pasted, taken from the position of a phone standing there."""


class TruthNoted(Fact):
    """Somebody found the emitter, or looked for it and did not (`place` None); the last word on an emitter counts.

    accuracy_m: of the place as its teller knows it, None when nobody said.
    """

    kind: Literal["truth_noted"] = "truth_noted"
    emitter_id: Id
    place: Place | None
    accuracy_m: Annotated[float, Field(ge=0, le=10_000)] | None
    how: TruthWay
    by: str


class MissionLabelled(Fact):
    """Its name in the list, and what people say about it; the specification stays as it was flown."""

    kind: Literal["mission_labelled"] = "mission_labelled"
    name: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=120)]
    tags: Annotated[list[Tag], Field(max_length=20)]
    notes: Annotated[str, StringConstraints(max_length=4000)]
    by: str


class MissionBroughtIn(Fact):
    """All facts before this one are of another installation, brought in with a bundle.

    software: that wrote the bundle, "" when it named none.
    """

    kind: Literal["mission_brought_in"] = "mission_brought_in"
    software: Annotated[str, StringConstraints(max_length=80)]
    by: str


class PatternUpload(Model):
    """The text of an antenna pattern: JSON, or a turntable table when `filename` ends in .csv, .tsv or .txt."""

    text: str = Field(min_length=1, max_length=500_000)
    filename: str = Field(min_length=1, max_length=255)


class Supposition(Model):
    """What is to be otherwise in a flown mission; None, and no bearing named in `without`: as it was flown.

    emitter_id None: the first one's. without: ids of bearings that are left out. sigma_deg: of every bearing, those
    taken and those the planner expects. sweep_evidence: of joint errors, as in SensorSpec. pattern, offset_to_nose_deg
    (clockwise, instead of the pattern's own): the stored sweeps are taken through this antenna; None of both: their
    bearings stay. budget: simulated flights a decision.
    """

    emitter_id: Id | None = None
    without: Annotated[list[BearingName], Field(max_length=200)] = Field(default_factory=list[str])
    sigma_deg: float | None = Field(default=None, ge=0.1, le=60)
    outlier_probability: float | None = Field(default=None, ge=0, le=0.5)
    bearing_errors: ErrorModel | None = None
    sweep_evidence: SweepEvidence | None = None
    pattern: PatternUpload | None = None
    offset_to_nose_deg: float | None = Field(default=None, ge=-360, le=360, allow_inf_nan=False)
    method: Method | None = None
    base_policy: BasePolicy | None = None
    selection: DiscreteSelection | None = None
    estimator: Estimator | None = None
    budget: int | None = Field(default=None, ge=10, le=100_000)


class VariantKept(Fact):
    """A supposition kept by name beside the mission, which stays as it was flown; the same name takes its place."""

    kind: Literal["variant_kept"] = "variant_kept"
    name: VariantName
    wanted: Supposition
    by: str


class VariantDropped(Fact):
    """Nobody needs it any longer."""

    kind: Literal["variant_dropped"] = "variant_dropped"
    name: VariantName
    by: str


class MissionDeleted(Fact):
    """Out of the list; everything of it is kept for some days more."""

    kind: Literal["mission_deleted"] = "mission_deleted"
    by: str


class MissionRestored(Fact):
    """Back in the list."""

    kind: Literal["mission_restored"] = "mission_restored"
    by: str
