"""What the operator asks for: the mission specification, validated once at the edge and stored with the mission.

Positions: WGS84, GeoJSON lon/lat order in geometries. Bearings: degrees clockwise from true north. Units in names.
Defaults: the field system of spec section 8.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator


class Model(BaseModel):
    """Base of everything that is stored or sent: frozen, no unknown fields, defaults always present on the wire."""

    model_config = ConfigDict(frozen=True, extra="forbid", json_schema_serialization_defaults_required=True)


Longitude = Annotated[float, Field(ge=-180, le=180, allow_inf_nan=False)]
Latitude = Annotated[float, Field(ge=-90, le=90, allow_inf_nan=False)]
LonLat = tuple[Longitude, Latitude]
Positive = Annotated[float, Field(gt=0, le=1e12, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, le=1e12, allow_inf_nan=False)]


class Place(Model):
    lat: Latitude
    lon: Longitude


class Polygon(Model):
    """GeoJSON Polygon: linear rings, the first the outline, the others holes."""

    type: Literal["Polygon"] = "Polygon"
    coordinates: list[list[LonLat]]


class MultiPolygon(Model):
    """GeoJSON MultiPolygon."""

    type: Literal["MultiPolygon"] = "MultiPolygon"
    coordinates: list[list[list[LonLat]]]


Area = Annotated[Polygon | MultiPolygon, Field(discriminator="type")]


class UniformPriorSpec(Model):
    kind: Literal["uniform"] = "uniform"


class GaussianPriorSpec(Model):
    """A Gaussian around `centre`; `major_axis_deg` is the compass bearing of the first axis."""

    kind: Literal["gaussian"] = "gaussian"
    centre: Place
    sigma_major_m: Positive
    sigma_minor_m: Positive
    major_axis_deg: float = Field(default=0.0, ge=0, lt=360)


class RingPriorSpec(Model):
    kind: Literal["ring"] = "ring"
    centre: Place
    inner_m: NonNegative
    outer_m: Positive


PriorSpec = Annotated[UniformPriorSpec | GaussianPriorSpec | RingPriorSpec, Field(discriminator="kind")]


class LinearMotionSpec(Model):
    kind: Literal["linear"] = "linear"
    speed_m_s: Positive = 7.0


class LinearConstantMotionSpec(Model):
    kind: Literal["linear_constant"] = "linear_constant"
    speed_m_s: Positive = 7.0
    constant_s: NonNegative = 11.2


class FullMotionSpec(Model):
    kind: Literal["full"] = "full"
    turn_rate_deg_s: Positive = 30.0
    acceleration_m_s2: Positive = 1.0
    speed_m_s: Positive = 8.0
    constant_s: NonNegative = 3.0


MotionSpec = Annotated[LinearMotionSpec | LinearConstantMotionSpec | FullMotionSpec, Field(discriminator="kind")]


class EmitterSpec(Model):
    """What is looked for. The pulses (width, period, how far one strays from it) count for kind "pulsed" only."""

    frequency_hz: Positive = 868_300_000.0
    kind: Literal["carrier", "pulsed"] = "carrier"
    label: str = Field(default="emitter", max_length=80)
    pulse_width_s: float = Field(default=0.02, gt=0, le=1, allow_inf_nan=False)
    pulse_period_s: float = Field(default=1.3, gt=0, le=10, allow_inf_nan=False)
    pulse_jitter_s: float = Field(default=0.03, ge=0, le=1, allow_inf_nan=False)

    @model_validator(mode="after")
    def pulses_have_pauses(self) -> EmitterSpec:
        if self.kind == "pulsed" and self.pulse_width_s + self.pulse_jitter_s >= self.pulse_period_s:
            raise ValueError("a pulse and its jitter must be shorter than the period")
        return self


class SensorSpec(Model):
    """The bearing sensor as the planner and the localizer assume it."""

    sigma_deg: float = Field(default=7.0, ge=0.1, le=60)
    outlier_probability: float = Field(default=0.1, ge=0, le=0.5)
    """A fielded system's flights had 9 outliers among 93 bearings."""
    measurement_time_s: Positive = 30.0
    turn_rate_deg_s: float = Field(default=30.0, ge=5, le=90)
    pulses_per_heading: int = Field(default=2, ge=1, le=20)
    """A sweep of a pulsed tag is complete when each sixteenth of the circle was listened to for so many pulses."""
    minimum_quality: float = Field(default=0.7, ge=0, le=1)
    maximum_retakes: int = Field(default=2, ge=0, le=10)


class PlannerSpec(Model):
    """Which planner decides, and with how much work."""

    method: Literal["rollout", "base_policy"] = "rollout"
    base_policy: Literal["ellipse", "fisher"] = "fisher"
    selection: Literal["uniform", "sequential_halving"] = "sequential_halving"
    sampling: Literal["deterministic", "crn", "pmc"] = "crn"
    estimator: Literal["map", "expected_value", "geometric_median"] = "map"
    budget: int = Field(default=1000, ge=10, le=100_000)
    action_spacing_m: float = Field(default=15.0, ge=1, le=5000)
    standoff_m: float = Field(default=50.0, ge=0, le=5000)
    motion: MotionSpec = Field(default_factory=LinearConstantMotionSpec)
    seed: int = Field(default=1, ge=0, le=2**31 - 1)


class LocalizationSpec(Model):
    """When "localized" may be said (mission rule 6)."""

    expected_rmse_m: Positive = 10.0
    minimum_places: int = Field(default=2, ge=2, le=20)
    minimum_place_distance_m: NonNegative = 10.0
    minimum_crossing_angle_deg: float = Field(default=20.0, ge=0, le=90)
    maximum_bearings: int = Field(default=20, ge=2, le=200)


class FlightSpec(Model):
    """How and where the vehicle may fly. `fence` None: the target area with `fence_margin_m` around it."""

    altitude_relative_m: float = Field(default=40.0, ge=2, le=500)
    minimum_altitude_relative_m: float = Field(default=10.0, ge=0, le=500)
    maximum_altitude_relative_m: float = Field(default=120.0, ge=2, le=1000)
    speed_m_s: float = Field(default=7.0, gt=0, le=30)
    fence: Area | None = None
    fence_margin_m: float = Field(default=60.0, ge=0, le=5000)
    no_fly: list[Area] = Field(default_factory=list)
    reserve_battery_percent: float = Field(default=25.0, ge=5, le=90)
    battery_telemetry: bool = True
    """False: the vehicle is known to report no charge, and nothing but its own failsafe looks after its battery."""
    automatic: bool = True
    """True: the next place is flown to at once; False: it waits for the operator's accept, veto or override."""


class TimerSpec(Model):
    """What happens when links are lost. Seconds; the autopilot's own failsafes act besides."""

    console_lost_hold_s: Positive = 10.0
    console_lost_return_s: Positive = 60.0
    receiver_silent_s: Positive = 5.0
    vehicle_command_s: Positive = 60.0


class SearchArea(Model):
    """Where is searched and flown: what may still change in flight (in hold). Fields as in MissionSpec, FlightSpec."""

    area: Area
    prior: PriorSpec
    fence: Area | None
    fence_margin_m: float = Field(ge=0, le=5000)
    no_fly: list[Area]


class MissionSpec(Model):
    """Everything needed to fly one search; frozen when the mission starts, but for the search area (in hold)."""

    name: str = Field(min_length=1, max_length=120)
    area: Area
    prior: PriorSpec = Field(default_factory=UniformPriorSpec)
    emitter: EmitterSpec = Field(default_factory=EmitterSpec)
    sensor: SensorSpec = Field(default_factory=SensorSpec)
    planner: PlannerSpec = Field(default_factory=PlannerSpec)
    localization: LocalizationSpec = Field(default_factory=LocalizationSpec)
    flight: FlightSpec = Field(default_factory=FlightSpec)
    timers: TimerSpec = Field(default_factory=TimerSpec)

    def searching(self, where: SearchArea) -> MissionSpec:
        """The same mission elsewhere."""
        flying = {"fence": where.fence, "fence_margin_m": where.fence_margin_m, "no_fly": where.no_fly}
        flight = self.flight.model_copy(update=flying)
        return self.model_copy(update={"area": where.area, "prior": where.prior, "flight": flight})
