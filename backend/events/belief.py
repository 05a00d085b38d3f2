"""What is believed of an emitter after its bearings."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from backend.events.bearings import BearingSource
from backend.events.fact import Fact, Known
from backend.reasons import Reason
from backend.spec import Area, Id


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


class SourceErrorsFact(Fact):
    """What the bearings say of their own source. bias_deg: they all point this far clockwise of where they should; the
    belief has taken it off. sigma_scale: their errors are this many times what was stated of them. outlier_rate: share
    of them that is wrong altogether."""

    source: BearingSource
    bearings: int
    bias_deg: float
    bias_std_error_deg: float
    sigma_scale: float
    outlier_rate: float


class LegSaid(Fact):
    """Of a leg that may count as a place: by the natural logarithm of how much the emitter is likelier at the estimate
    than in a direction at random, as the leg heard it."""

    leg_id: str
    said: float


class BeliefUpdated(Fact):
    """The belief about one emitter after folding `bearings` bearings. `digest`: SHA-256 of the grid, so that a rebuilt
    belief can be compared bit for bit. `estimate` None when the bearings are inconsistent (never a made-up estimate).
    `contradicting`: ids of the bearings that do not point at the estimate; a claim that is made all the same stands
    against them. `heading_offset_deg`: what all bearings seem to be off by together, clockwise, when that is
    significant: then nothing is claimed. `sources`: of a joint belief, which estimates the errors of each source and
    uses them; empty of one that takes errors to be independent. `legs`: what those that may count as places say of the
    estimate, in a mission that never stops to turn. `goal_m`: what the expected error must fall below, where that is
    more than the specification asks: of an emitter that moves."""

    kind: Literal["belief_updated"] = "belief_updated"
    emitter_id: Id
    bearings: int
    estimate: EstimateFact | None
    consistent: bool
    localized: bool
    not_yet: list[Reason]
    contradicting: list[str] = Field(default_factory=list[str])
    goal_m: Known = None
    heading_offset_deg: Known = None
    heading_offset_std_error_deg: Known = None
    sources: list[SourceErrorsFact] = Field(default_factory=list[SourceErrorsFact])
    digest: str
    legs: list[LegSaid] = Field(default_factory=list[LegSaid])

    @property
    def measured_estimate(self) -> EstimateFact | None:
        """None also without a bearing that counts: the middle of the area is no finding."""
        return self.estimate if self.bearings > 0 else None
