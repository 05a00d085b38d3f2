"""What the world tells us, as frozen data with units in the names.

Headings and bearings: degrees clockwise from true north, 0 <= b < 360. Positions: WGS84. Times: UTC epoch seconds.
Altitudes are always named: AMSL (above mean sea level), relative (above home), AGL (above ground).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

from annotated_types import Interval

from hardware.authority import NOBODY, Authority
from hardware.reasons.preflight import GpsFixName
from hardware.reasons.sweep import SweepReason, SweepRemark
from hardware.reasons.vehicle_news import VehicleNews
from planner.reason import Reason

if TYPE_CHECKING:  # a vehicle left in flight is held before numpy is loaded
    import numpy as np
    from numpy.typing import NDArray

Longitude = Annotated[float, Interval(ge=-180.0, le=180.0)]
Latitude = Annotated[float, Interval(ge=-90.0, le=90.0)]


@dataclass(frozen=True, slots=True)
class Place:
    """A place on the ground, WGS84 degrees. The only type for one, on the wire too."""

    lat: Latitude
    lon: Longitude


@dataclass(frozen=True, slots=True)
class Telemetry:
    """The vehicle as last heard. A value that was never heard is None; each `*_at_s` is when it was heard (UTC).

    position_lost_since_s: since when the vehicle itself says that it does not know where it is; what it reports as its
    position since then is a guess. odd_clock_rate: seconds of the autopilot's clock in one of ours, when that is so far
    from 1 that its headings cannot be dated; None: nothing of the kind is known.
    """

    connected: bool
    at_s: float
    position: Place | None = None
    position_at_s: float | None = None
    altitude_amsl_m: float | None = None
    altitude_relative_m: float | None = None
    heading_deg: float | None = None
    heading_at_s: float | None = None
    velocity_north_m_s: float | None = None
    velocity_east_m_s: float | None = None
    velocity_down_m_s: float | None = None
    push_north_m_s2: float | None = None
    push_east_m_s2: float | None = None
    """The horizontal part of the thrust per mass: by how much the vehicle leans, and where to."""
    battery_percent: float | None = None
    battery_at_s: float | None = None
    gps_fix: GpsFixName | None = None
    satellites: int | None = None
    position_lost_since_s: float | None = None
    odd_clock_rate: float | None = None
    armed: bool | None = None
    in_air: bool | None = None
    mode: str | None = None
    mode_at_s: float | None = None
    home: Place | None = None
    home_amsl_m: float | None = None
    authority: Authority = NOBODY
    autopilot: Literal["px4", "ardupilot", "unknown"] = "unknown"

    @property
    def heard_at_s(self) -> float | None:
        """When anything of this was last heard."""
        times = (self.position_at_s, self.heading_at_s, self.mode_at_s, self.battery_at_s)
        return max((at for at in times if at is not None), default=None)


@dataclass(frozen=True, slots=True)
class Announcement:
    """Something that the vehicle link noticed. at_s: UTC."""

    at_s: float
    reason: VehicleNews


CheckName = Literal[
    "vehicle_link",
    "gps",
    "position",
    "heading",
    "battery",
    "home",
    "ready_to_arm",
    "remote_id",
    "control",
    "failsafe",
    "nets",
    "receiver",
    "antenna",
    "pattern",
    "area",
    "terrain",
    "safety",
]


@dataclass(frozen=True, slots=True)
class PreflightCheck:
    """One line of the checklist. reason: what was found, and its remedy when not ok. blocking: refuses the start."""

    name: CheckName
    ok: bool
    reason: Reason
    blocking: bool = True


@dataclass(frozen=True, slots=True)
class ReturnAltitude:
    """What the autopilot climbs to for its own return, unless it is higher already (0: it stays as high as it is).

    parameter: where that is set. altitude_relative_m None: it could not be read. climb_m: by which it climbs at least,
    from however high it begins (`climb_parameter`); None: it could not be read. climb_parameter None: there is no such
    thing.
    """

    parameter: str
    altitude_relative_m: float | None
    climb_parameter: str | None = None
    climb_m: float | None = 0.0


@dataclass(frozen=True, slots=True)
class Pulses:
    """What a pulsed tag sends: pulses of `width_s` every `period_s`, each straying by up to `jitter_s`."""

    width_s: float
    period_s: float
    jitter_s: float = 0.03


@dataclass(frozen=True, slots=True)
class Channel:
    """What a receiver listens to: a carrier, or a tag's pulses, at the emitter's nominal frequency.

    others: the pulses of further tags that send there; the receiver then tells of every pulse, whoever sent it.
    """

    frequency_hz: float
    pulses: Pulses | None = None
    others: tuple[Pulses, ...] = ()

    @property
    def rhythms(self) -> tuple[Pulses, ...]:
        """Of every tag that is listened to here; none of a carrier."""
        return () if self.pulses is None else (self.pulses, *self.others)


@dataclass(frozen=True, slots=True)
class PowerSample:
    """Received narrow-band power at one moment. `power_db` relative to the receiver's reference.

    frequency_hz: of the channel it belongs to, exactly as the receiver was asked for it.
    detected False: a pulse was due and none was heard; `power_db` is the noise then. It shows that the receiver lives.
    """

    at_s: float
    frequency_hz: float
    power_db: float
    noise_floor_db: float | None = None
    clipped: bool = False
    detected: bool = True


@dataclass(frozen=True, slots=True)
class HeadingSample:
    """The vehicle's nose and place at one moment. displaced_m: how far jumps have carried its reported position."""

    at_s: float
    heading_deg: float
    position: Place | None = None
    displaced_m: float = 0.0


@dataclass(frozen=True, slots=True)
class Sweep:
    """Received power against the vehicle's heading over about one turn, as recorded (unbinned).

    at_s, heading_deg, power_db: (n,), one row a sample, in time order. `heading_deg` is the nose's; the antenna's
    offset to it belongs to the antenna pattern. drift_m: how far from `position` the vehicle may have been: it moved
    while it turned, or its reported position had jumped. samples_without_heading: power samples that were left out,
    because the headings before and after them were too far apart. partial: only a part of the circle was meant to be
    turned through.
    """

    at_s: NDArray[np.float64]
    heading_deg: NDArray[np.float64]
    power_db: NDArray[np.float64]
    frequency_hz: float
    position: Place
    altitude_amsl_m: float
    drift_m: float = 0.0
    clipped_samples: int = 0
    noise_floor_db: float | None = None
    tag: str | None = None
    samples_without_heading: int = 0
    partial: bool = False


@dataclass(frozen=True, slots=True)
class BearingPeak:
    """A weaker component of the same sweep: evidence of multipath or a second emitter. `weight` in (0, 1]."""

    bearing_deg: float
    weight: float


@dataclass(frozen=True, slots=True)
class BearingReading:
    """The direction finder's answer to one sweep.

    quality: cosine similarity of the sweep and the pattern shifted to the bearing, [0, 1].
    accepted: False when the sweep must be taken again; `reason` says why.
    binned_db: (180,) mean power a 2-degree bin of antenna heading (NaN: empty); fitted_db: (180,) the fit.
    heading_sigma_deg, pattern_sigma_deg: the shares of sigma_deg that a flight's bearings have in common, the heading's
    and the antenna's (mounted or shaped otherwise than measured). remarks: what makes the bearing doubtful.
    likelihood: what the sweep says of every direction, circle.SweepLikelihood packed; None: nothing.
    """

    bearing_deg: float
    sigma_deg: float
    quality: float
    accepted: bool
    reason: SweepReason | None
    peaks: tuple[BearingPeak, ...]
    binned_db: NDArray[np.float64]
    fitted_db: NDArray[np.float64]
    snr_db: float | None = None
    heading_sigma_deg: float = 0.0
    pattern_sigma_deg: float = 0.0
    remarks: tuple[SweepRemark, ...] = ()
    likelihood: str | None = None
