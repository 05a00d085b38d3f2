"""What the world tells us, as frozen data with units in the names.

Headings and bearings: degrees clockwise from true north, 0 <= b < 360. Positions: WGS84. Times: UTC epoch seconds.
Altitudes are always named: AMSL (above mean sea level), relative (above home), AGL (above ground).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class GeoPoint:
    """A place on the ground, WGS84 degrees."""

    lat_deg: float
    lon_deg: float


Controller = Literal["crossfix", "pilot", "nobody"]


@dataclass(frozen=True, slots=True)
class Telemetry:
    """The vehicle as last heard. A value that was never heard is None; each `*_at_s` is when it was heard (UTC).

    held_by_pilot: somebody else took control and has not given it back (the mode is still his): a command now would
    take it from him.
    """

    connected: bool
    at_s: float
    position: GeoPoint | None = None
    position_at_s: float | None = None
    altitude_amsl_m: float | None = None
    altitude_relative_m: float | None = None
    heading_deg: float | None = None
    heading_at_s: float | None = None
    velocity_north_m_s: float | None = None
    velocity_east_m_s: float | None = None
    velocity_down_m_s: float | None = None
    battery_percent: float | None = None
    battery_at_s: float | None = None
    gps_fix: str | None = None
    satellites: int | None = None
    armed: bool | None = None
    in_air: bool | None = None
    mode: str | None = None
    mode_at_s: float | None = None
    home: GeoPoint | None = None
    home_amsl_m: float | None = None
    controller: Controller = "nobody"
    held_by_pilot: bool = False
    autopilot: Literal["px4", "ardupilot", "unknown"] = "unknown"

    @property
    def heard_at_s(self) -> float | None:
        """When anything of this was last heard."""
        times = (self.position_at_s, self.heading_at_s, self.mode_at_s, self.battery_at_s)
        return max((at for at in times if at is not None), default=None)


@dataclass(frozen=True, slots=True)
class PreflightCheck:
    """One line of the checklist. `remedy` says how to mend it when not ok; a `blocking` one refuses the start."""

    name: str
    ok: bool
    detail: str
    remedy: str = ""
    blocking: bool = True


@dataclass(frozen=True, slots=True)
class Pulses:
    """What a pulsed tag sends: pulses of `width_s` every `period_s`, each straying by up to `jitter_s`."""

    width_s: float
    period_s: float
    jitter_s: float = 0.03


@dataclass(frozen=True, slots=True)
class PowerSample:
    """Received narrow-band power at one moment. `power_db` relative to the receiver's reference.

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
    position: GeoPoint | None = None
    displaced_m: float = 0.0


@dataclass(frozen=True, slots=True)
class Sweep:
    """Received power against the vehicle's heading over about one turn, as recorded (unbinned).

    at_s, heading_deg, power_db: (n,), one row a sample, in time order. `heading_deg` is the nose's; the antenna's
    offset to it belongs to the antenna pattern. drift_m: how far from `position` the vehicle may have been: it moved
    while it turned, or its reported position had jumped.
    """

    at_s: NDArray[np.float64]
    heading_deg: NDArray[np.float64]
    power_db: NDArray[np.float64]
    frequency_hz: float
    position: GeoPoint
    altitude_amsl_m: float
    drift_m: float = 0.0
    clipped_samples: int = 0
    noise_floor_db: float | None = None
    tag: str | None = None


@dataclass(frozen=True, slots=True)
class BearingPeak:
    """A weaker component of the same sweep: evidence of multipath or a second emitter. `weight` in (0, 1]."""

    bearing_deg: float
    weight: float


@dataclass(frozen=True, slots=True)
class BearingReading:
    """The direction finder's answer to one sweep.

    quality: cosine similarity of the sweep and the pattern shifted to the bearing, [0, 1].
    accepted: False when the sweep must be taken again; `reason` says why in the operator's words.
    binned_db: (180,) mean power a 2-degree bin of antenna heading (NaN: empty); fitted_db: (180,) the fit.
    heading_sigma_deg: the share of sigma_deg that a flight's bearings have in common, the heading's.
    """

    bearing_deg: float
    sigma_deg: float
    quality: float
    accepted: bool
    reason: str
    peaks: tuple[BearingPeak, ...]
    binned_db: NDArray[np.float64]
    fitted_db: NDArray[np.float64]
    snr_db: float | None = None
    heading_sigma_deg: float = 0.0
