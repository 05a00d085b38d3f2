"""The library of missions: small maps, labels, the ground truth of an emitter, and what many missions say together."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, StringConstraints

from backend.events.review import Tag, TruthWay
from backend.names import seen
from backend.spec import Id, Model, Place


def _each_once(tags: list[str]) -> list[str]:
    """The page writes them in one line, with commas between."""
    if any("," in tag for tag in tags):
        raise ValueError("a tag has no comma")
    return list(dict.fromkeys(tags))


LonLatPair = Annotated[list[float], Field(min_length=2, max_length=2)]


class Sketch(Model):
    """A small map of a mission, longitude and latitude: outline of its area (rings, thinned), places of bearings, and
    by emitter id the estimate and what is known since (None: looked for and not found)."""

    outline: list[list[LonLatPair]] = Field(default_factory=list[list[Any]])
    places: list[LonLatPair] = Field(default_factory=list[Any])
    found: dict[str, LonLatPair] = Field(default_factory=dict[str, Any])
    truth: dict[str, LonLatPair | None] = Field(default_factory=dict[str, Any])


class MissionLabels(Model):
    """The name in the list, and what people say about the mission."""

    name: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=120), AfterValidator(seen)]
    tags: Annotated[list[Annotated[Tag, AfterValidator(seen)]], Field(max_length=20), AfterValidator(_each_once)]
    notes: Annotated[str, StringConstraints(max_length=4000)] = ""


class MissionBrought(Model):
    """A mission out of a bundle. already: it was here before, and nothing was changed."""

    mission_id: str
    already: bool
    events: int
    sweeps: int


class TruthTold(Model):
    """Where the emitter was found; `place` None: it was looked for and not found. emitter_id None: the search's only
    one. accuracy_m: of the place, None when unknown."""

    emitter_id: Id | None = None
    place: Place | None
    accuracy_m: Annotated[float, Field(ge=0, le=10_000, allow_inf_nan=False)] | None = None
    how: TruthWay


class ShareFact(Model):
    """of: how often something was looked at; share: how often it held, with its 95 % interval (Wilson)."""

    of: int
    share: float
    low: float
    high: float


class CheckedFix(Model):
    """An emitter of a mission whose place is known since. error_m: from the estimate; stated_m: the expected error that
    was stated. inside: within the 95 % region."""

    mission_id: str
    name: str
    emitter_id: str
    error_m: float
    stated_m: float
    inside: bool
    localized: bool


class CheckedBearing(Model):
    """error_deg: clockwise of the truth. outlier: by more than its kind explains."""

    mission_id: str
    place: Place
    error_deg: float
    sigma_deg: float
    outlier: bool


class SuggestedSensor(Model):
    """For the next flight, in the fields of the specification. offset_deg: for its bearing_offset_deg, the whole of it:
    what missions had taken off their bearings already is in it."""

    sigma_deg: float
    outlier_probability: float
    offset_deg: float
    offset_std_error_deg: float
    speed_m_s: float | None
    constant_s: float | None


class Calibration(Model):
    """Of all checked missions of a craft and antenna, or of all. within_1_sigma and within_2_sigma: of bearings, offset
    not taken off (68 and 95 % when sigma is right). c95: of fixes. error_ratio: root mean square of error over stated
    error of the fixes. forecast_90: times that the 90 % figure held. Sharpness, all of them means of what was stated:
    sharpness_deg, sigma of bearings; sharpness_m, expected error of fixes; forecast_90_s, the 90 % figure, and
    forecast_took_s, what it took then. antennas: all there are, to choose from. suggested None: fewer than `needed`
    bearings."""

    missions: int
    not_found: int
    fixes: list[CheckedFix]
    bearings: list[CheckedBearing]
    within_1_sigma: ShareFact
    within_2_sigma: ShareFact
    outliers: ShareFact
    c95: ShareFact
    error_ratio: float | None
    forecast_90: ShareFact
    sharpness_deg: float | None
    sharpness_m: float | None
    forecast_90_s: float | None
    forecast_took_s: float | None
    antennas: list[str]
    crafts: list[str]
    needed: int
    suggested: SuggestedSensor | None


ResultName = Literal["", "localized", "not_localized", "aborted", "failed"]
