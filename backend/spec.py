"""What the operator asks for: the mission specification, validated once at the edge and stored with the mission.

Positions: WGS84, GeoJSON lon/lat order in geometries. Bearings: degrees clockwise from true north. Units in names.
Defaults: the field system of spec section 8.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, FailFast, Field, model_validator

from hardware.readings import Latitude, Longitude, Place
from planner.options import FIELD, BasePolicy, DiscreteSelection, Estimator, Method, PlannerOptions, Sampling


class Model(BaseModel):
    """Base of everything that is stored or sent: frozen, no unknown fields, defaults always present on the wire."""

    model_config = ConfigDict(frozen=True, extra="forbid", json_schema_serialization_defaults_required=True)


T = TypeVar("T")

LonLat = tuple[Longitude, Latitude]
Listed = Annotated[list[T], FailFast()]
"""Of thousands of wrong positions the first is named."""
Positive = Annotated[float, Field(gt=0, le=1e12, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, le=1e12, allow_inf_nan=False)]


class Polygon(Model):
    """GeoJSON Polygon: linear rings, the first the outline, the others holes."""

    type: Literal["Polygon"] = "Polygon"
    coordinates: Listed[Listed[LonLat]]


class MultiPolygon(Model):
    """GeoJSON MultiPolygon."""

    type: Literal["MultiPolygon"] = "MultiPolygon"
    coordinates: Listed[Listed[Listed[LonLat]]]


Area = Annotated[Polygon | MultiPolygon, Field(discriminator="type")]


class UniformPriorSpec(Model):
    """Anywhere in the area alike."""

    kind: Literal["uniform"] = "uniform"


class GaussianPriorSpec(Model):
    """A Gaussian around `centre`; `major_axis_deg` is the compass bearing of the first axis."""

    kind: Literal["gaussian"] = "gaussian"
    centre: Place
    sigma_major_m: Positive
    sigma_minor_m: Positive
    major_axis_deg: float = Field(default=0.0, ge=0, lt=360)


class RingPriorSpec(Model):
    """Between two distances from `centre`."""

    kind: Literal["ring"] = "ring"
    centre: Place
    inner_m: NonNegative
    outer_m: Positive


PriorSpec = Annotated[UniformPriorSpec | GaussianPriorSpec | RingPriorSpec, Field(discriminator="kind")]


class LinearMotionSpec(Model):
    """Time = distance / speed; turns and stops cost nothing."""

    kind: Literal["linear"] = "linear"
    speed_m_s: Positive = 7.0


class LinearConstantMotionSpec(Model):
    """Time = distance / speed + `constant_s` (both defaults: thesis 6.4.3)."""

    kind: Literal["linear_constant"] = "linear_constant"
    speed_m_s: Positive = 7.0
    constant_s: NonNegative = 11.2


class FullMotionSpec(Model):
    """Turn to the heading, accelerate, fly, brake, and `constant_s` to settle (defaults: thesis 6.4.3)."""

    kind: Literal["full"] = "full"
    turn_rate_deg_s: Positive = 30.0
    acceleration_m_s2: Positive = 1.0
    speed_m_s: Positive = 8.0
    constant_s: NonNegative = 3.0


MotionSpec = Annotated[LinearMotionSpec | LinearConstantMotionSpec | FullMotionSpec, Field(discriminator="kind")]


Id = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,40}$")]
"""Names a craft or an emitter within its mission."""
FIRST_EMITTER = "emitter-1"


MovementKind = Literal["still", "animal", "walking", "drifting"]


class MovementSpec(Model):
    """How what is looked for moves. speed_m_s: root mean square over its pauses and runs; of kind "still" it does not
    count. The kind says how soon the direction is forgotten: an animal that feeds turns every half minute, a person
    walks on for minutes, wind and water carry for a quarter of an hour."""

    kind: MovementKind = "still"
    speed_m_s: float = Field(default=0.2, ge=0.01, le=5, allow_inf_nan=False)


MOST_EMITTERS = 32
Priority = Annotated[int, Field(ge=1, le=MOST_EMITTERS)]
"""In the order of importance: 1 is looked for first; equal ones are alike."""


class EmitterSpec(Model):
    """What is looked for, and where it may be. The pulses (width, period, how far one strays from it) count for kind
    "pulsed" only. priority None: after all that have one; where none has, all are alike."""

    emitter_id: Id = FIRST_EMITTER
    frequency_hz: Positive = 868_300_000.0
    kind: Literal["carrier", "pulsed"] = "carrier"
    label: str = Field(default="emitter", max_length=80)
    pulse_width_s: float = Field(default=0.02, gt=0, le=1, allow_inf_nan=False)
    pulse_period_s: float = Field(default=1.3, gt=0, le=60, allow_inf_nan=False)
    """A 406 MHz distress beacon sends a burst of 0.44 s every 50 s, give or take 2.5."""
    pulse_jitter_s: float = Field(default=0.03, ge=0, le=5, allow_inf_nan=False)
    prior: PriorSpec = Field(default_factory=UniformPriorSpec)
    movement: MovementSpec = Field(default_factory=MovementSpec)
    priority: Priority | None = None

    @model_validator(mode="after")
    def pulses_have_pauses(self) -> EmitterSpec:
        """Else one pulse could not be told from the next."""
        if self.kind == "pulsed" and self.pulse_width_s + self.pulse_jitter_s >= self.pulse_period_s:
            raise ValueError("a pulse and its jitter must be shorter than the period")
        return self


ErrorModel = Literal["independent", "joint"]
"""What is believed of the bearings' errors: each has its own, or those of a source have a bias, a scale of their sigmas
and an outlier rate in common, which are estimated with the place (planner.belief.joint)."""

SweepEvidence = Literal["peak", "whole"]
"""What a joint belief takes of a sweep (planner.sweep_likelihood)."""


Weights = Annotated[list[Annotated[float, Field(ge=0, le=1)]], Field(min_length=1, max_length=12)]
"""Of the values they stand beside; only their ratios count."""


class LearnedErrors(Model):
    """What is known of the errors of the craft's bearings before the flight: values, and how probable each is.

    flights: of the craft with the antenna, from how many that was learned. spread_deg: standard deviations that the
    bias (compass and mounting) may have. scale: factors on the stated sigmas. rate: shares of bearings that are wrong
    altogether.
    """

    craft_id: Id
    antenna: str = Field(max_length=200)
    flights: int = Field(ge=0)
    spread_deg: list[Annotated[float, Field(gt=0, le=30)]] = Field(min_length=1, max_length=12)
    spread_weight: Weights
    scale: list[Annotated[float, Field(ge=0.2, le=5)]] = Field(min_length=1, max_length=12)
    scale_weight: Weights
    rate: list[Annotated[float, Field(gt=0, le=0.6)]] = Field(min_length=1, max_length=12)
    rate_weight: Weights

    @model_validator(mode="after")
    def every_value_has_a_weight(self) -> LearnedErrors:
        """And not all of them are zero."""
        for name in ("spread", "scale", "rate"):
            values = self.spread_deg if name == "spread" else getattr(self, name)
            weights: list[float] = getattr(self, f"{name}_weight")
            if len(values) != len(weights):
                raise ValueError(f"{name}: {len(values)} values, {len(weights)} weights; give each value one weight")
            if sum(weights) <= 0.0:
                raise ValueError(f"{name}_weight: all are zero; at least one value must be possible")
        return self


class SensorSpec(Model):
    """The bearing sensor as the planner and the localizer assume it.

    bearing_errors: a stored specification that does not name them means independent ones; a new mission that does not,
    and every suggested one, joint ones. learned: of joint errors, what the flights of this craft and antenna
    taught; the server writes it down when a mission is drafted, edited and started. sweep_evidence: of joint errors,
    what the belief takes of a sweep, its main peak and sigma or its likelihood over all directions; a stored
    specification that does not say so means peak and sigma, a new mission that does not the likelihood. shared_errors:
    of joint errors of several emitters, whether what the bearings of one tell of their source counts for the others; a
    stored specification that does not say so means that each is judged by itself, a new mission that it counts.
    sector_turns: a carrier's sweep turns only as far as its bearing needs; a stored specification that does not say so
    means whole turns, and where it never stops they are whole whatever it says. whole_turns: from how many places all
    directions are heard before sectors are.
    bearing_offset_deg: by how much bearings of the craft are known to read too large, clockwise (mounting and compass),
    beyond what its antenna's file says; it is taken off where they are made. listen_on_the_way: of joint errors, what
    is heard between places counts too; a stored specification that does not say so means that it does not.
    swing_on_the_way: the nose swings meanwhile, where it listens on the way. never_stop: after the first place's whole
    turn the craft turns at a place only where the way there told nothing, or against what is believed.
    """

    sigma_deg: float = Field(default=7.0, ge=0.1, le=60)
    outlier_probability: float = Field(default=0.1, ge=0, le=0.5)
    """A fielded system's flights had 9 outliers among 93 bearings."""
    measurement_time_s: Positive = 30.0
    turn_rate_deg_s: float = Field(default=30.0, ge=5, le=90)
    receiver_band_hz: float | None = Field(default=None, ge=1000, le=1e9, allow_inf_nan=False)
    """How wide a band the receiver hears at once; None: as wide as all emitters need. Of a narrower one they are heard
    in groups, a turn each."""
    pulses_per_heading: int = Field(default=2, ge=1, le=20)
    """A sweep of a pulsed tag is complete when each sixteenth of the circle was listened to for this many pulses."""
    minimum_quality: float = Field(default=0.7, ge=0, le=1)
    maximum_retakes: int = Field(default=2, ge=0, le=10)
    bearing_errors: ErrorModel = "independent"
    learned: LearnedErrors | None = None
    sector_turns: bool = False
    whole_turns: int = Field(default=1, ge=1, le=20)
    sweep_evidence: SweepEvidence = "peak"
    bearing_offset_deg: float = Field(default=0.0, ge=-180, le=180, allow_inf_nan=False)
    shared_errors: bool = False
    listen_on_the_way: bool = False
    swing_on_the_way: bool = False
    never_stop: bool = False

    @property
    def turns_in_sectors(self) -> bool:
        """A turn of a mission that never stops is made in order to look elsewhere than expected: once around."""
        return self.sector_turns and not self.never_stop


class PlannerSpec(Model):
    """Which planner decides, and with how much work."""

    method: Method = FIELD.method
    base_policy: BasePolicy = FIELD.base_policy
    selection: DiscreteSelection = FIELD.selection
    sampling: Sampling = FIELD.sampling
    estimator: Estimator = FIELD.estimator
    budget: int = Field(default=FIELD.budget, ge=10, le=100_000)
    action_spacing_m: float = Field(default=15.0, ge=1, le=5000)
    standoff_m: float = Field(default=50.0, ge=0, le=5000)
    motion: MotionSpec = Field(default_factory=LinearConstantMotionSpec)
    seed: int = Field(default=FIELD.seed, ge=0, le=2**31 - 1)

    @property
    def options(self) -> PlannerOptions:
        """The planner's own words for the same."""
        return PlannerOptions(
            self.method, self.base_policy, self.selection, self.sampling, self.estimator, self.budget, self.seed
        )


class LocalizationSpec(Model):
    """When "localized" may be said (mission rule 6)."""

    expected_rmse_m: Positive = 10.0
    minimum_places: int = Field(default=2, ge=2, le=20)
    minimum_place_distance_m: NonNegative = 10.0
    minimum_crossing_angle_deg: float = Field(default=20.0, ge=0, le=90)
    maximum_bearings: int = Field(default=20, ge=2, le=200)
    follow: bool = False
    """True: when all are localized, those that move are looked for on, until the battery rule brings the craft home."""


class FlightSpec(Model):
    """How and where the vehicle may fly. `fence` None: the target area with `fence_margin_m` around it."""

    altitude_relative_m: float = Field(default=40.0, ge=2, le=500)
    minimum_altitude_relative_m: float = Field(default=10.0, ge=0, le=500)
    maximum_altitude_relative_m: float = Field(default=120.0, ge=2, le=1000)
    minimum_clearance_m: float = Field(default=20.0, ge=0, le=500)
    """Above the ground, wherever terrain tells of it; the band of altitudes is above home."""
    maximum_above_ground_m: float = Field(default=120.0, ge=2, le=1000)
    """As above: the ceiling."""
    speed_m_s: float = Field(default=7.0, gt=0, le=30)
    fence: Area | None = None
    fence_margin_m: float = Field(default=60.0, ge=0, le=5000)
    no_fly: list[Area] = Field(default_factory=list[Area])
    reserve_battery_percent: float = Field(default=25.0, ge=5, le=90)
    battery_telemetry: bool = True
    """False: the vehicle is known to report no charge, and nothing but its own failsafe looks after its battery."""
    automatic: bool = True
    """True: the next place is flown to at once; False: it waits for the operator's accept, veto or override."""


LONGEST_S = {"console_lost_hold_s": 120.0, "console_lost_return_s": 600.0, "receiver_silent_s": 60.0}


class TimerSpec(Model):
    """What happens when links are lost. Seconds; the autopilot's own failsafes act besides.

    Bounded: a timer that outlasts a battery protects nobody.
    """

    console_lost_hold_s: float = Field(default=10.0, gt=0, le=LONGEST_S["console_lost_hold_s"])
    console_lost_return_s: float = Field(default=60.0, gt=0, le=LONGEST_S["console_lost_return_s"])
    receiver_silent_s: float = Field(default=5.0, gt=0, le=LONGEST_S["receiver_silent_s"])


class SearchArea(Model):
    """Where is searched and flown: what may still change in flight (in hold). Fields as in MissionSpec, FlightSpec.

    priors: by emitter id; an emitter that is not named keeps its own.
    """

    area: Area
    priors: dict[Id, PriorSpec]
    fence: Area | None
    fence_margin_m: float = Field(ge=0, le=5000)
    no_fly: list[Area]


class MissionSpec(Model):
    """Everything needed to search; frozen when the mission starts, but for the search area (in hold) and the order of
    importance."""

    name: str = Field(min_length=1, max_length=120)
    area: Area
    emitters: list[EmitterSpec] = Field(default_factory=lambda: [EmitterSpec()], min_length=1, max_length=MOST_EMITTERS)
    sensor: SensorSpec = Field(default_factory=SensorSpec)
    planner: PlannerSpec = Field(default_factory=PlannerSpec)
    localization: LocalizationSpec = Field(default_factory=LocalizationSpec)
    flight: FlightSpec = Field(default_factory=FlightSpec)
    timers: TimerSpec = Field(default_factory=TimerSpec)

    @model_validator(mode="after")
    def emitters_are_told_apart(self) -> MissionSpec:
        """Facts name an emitter by its id only."""
        ids = [emitter.emitter_id for emitter in self.emitters]
        if len(set(ids)) < len(ids):
            raise ValueError("two emitters have the same emitter_id; give each its own")
        return self

    def emitter(self, emitter_id: str) -> EmitterSpec:
        """Raises KeyError for an emitter that is not looked for."""
        for emitter in self.emitters:
            if emitter.emitter_id == emitter_id:
                return emitter
        raise KeyError(emitter_id)

    @property
    def sharing(self) -> tuple[str, ...]:
        """The emitters, by id, about which one belief tells the others what their source is wrong by: those that stand
        still, when errors are joint and shared and there are two. One that moves is followed by itself."""
        if not self.sensor.shared_errors or self.sensor.bearing_errors != "joint":
            return ()
        still = tuple(one.emitter_id for one in self.emitters if one.movement.kind == "still")
        return still if len(still) > 1 else ()

    def having_learned(self, learned: LearnedErrors | None) -> MissionSpec:
        """The same mission with another knowledge of its bearings' errors."""
        return self.model_copy(update={"sensor": self.sensor.model_copy(update={"learned": learned})})

    def in_order(self, priorities: Mapping[str, int]) -> MissionSpec:
        """The same mission with another order of importance: by emitter id; those not named have no priority."""
        emitters = [one.model_copy(update={"priority": priorities.get(one.emitter_id)}) for one in self.emitters]
        return self.model_copy(update={"emitters": emitters})

    def name_of(self, emitter_id: str) -> str:
        """Its label; with its number when another one has the same. Raises KeyError for one that is not looked for."""
        found = self.emitter(emitter_id)
        alike = sum(one.label == found.label for one in self.emitters) > 1
        return f"{found.label} {self.emitters.index(found) + 1}" if alike else found.label or emitter_id

    @property
    def priorities(self) -> dict[str, int]:
        """Of the emitters that have one, by id."""
        return {one.emitter_id: one.priority for one in self.emitters if one.priority is not None}

    def searching(self, where: SearchArea) -> MissionSpec:
        """The same mission elsewhere."""
        flying = {"fence": where.fence, "fence_margin_m": where.fence_margin_m, "no_fly": where.no_fly}
        flight = self.flight.model_copy(update=flying)
        emitters = [
            emitter.model_copy(update={"prior": where.priors.get(emitter.emitter_id, emitter.prior)})
            for emitter in self.emitters
        ]
        return self.model_copy(update={"area": where.area, "emitters": emitters, "flight": flight})
