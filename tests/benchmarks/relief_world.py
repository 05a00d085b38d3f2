"""Ground as it is, and a made-up vehicle whose every metre is held against clearance, ceiling and no-fly areas.

The relief is SRTM's of the Jacksboro fault in Tennessee, which matplotlib ships (a height every 90 m), and the same
with finer, steeper ground laid over it.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from matplotlib import cbook
from numpy.typing import NDArray
from shapely import LineString
from shapely.geometry.base import BaseGeometry

from backend.search.ground import LATERAL_TOLERANCE_M, VERTICAL_TOLERANCE_M
from backend.spec import FlightSpec
from backend.terrain import Terrain
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry
from hardware.yaw_swings import Swinging

STEP_M = 2.0
CLIMB_M_S = 3.0
EDGE_M = 0.1
"""Of a no-fly area: as far a way along its edge may be rounded into it."""


def real_relief() -> Terrain:
    """Heights of 236 to 1076 m over 30 x 32 km."""
    found = np.load(cbook.get_sample_data("jacksboro_fault_dem.npz", asfileobj=False))
    north = max(float(found["ymin"]), float(found["ymax"]))
    heights = found["elevation"].astype(np.float32)
    return Terrain(north, float(found["xmin"]), float(found["dy"]), float(found["dx"]), heights, ("SRTM, Jacksboro",))


def finer(terrain: Terrain, random: np.random.Generator) -> Terrain:
    """Three times as many heights, with rough ground of up to some ten metres laid over them."""
    rows, columns = terrain.heights.shape
    lat = terrain.north_deg - np.arange(3 * rows - 2) * terrain.lat_step_deg / 3
    lon = terrain.west_deg + np.arange(3 * columns - 2) * terrain.lon_step_deg / 3
    smooth = terrain.at(*(axis.ravel() for axis in np.meshgrid(lat, lon, indexing="ij"))).reshape(len(lat), len(lon))
    rough = np.fft.irfft2(_pink(smooth.shape, random), smooth.shape)
    heights = smooth + 8.0 * rough / rough.std()
    return Terrain(
        terrain.north_deg,
        terrain.west_deg,
        terrain.lat_step_deg / 3,
        terrain.lon_step_deg / 3,
        heights.astype(np.float32),
        ("made finer",),
    )


def _pink(shape: tuple[int, ...], random: np.random.Generator) -> NDArray[np.complex128]:
    """Noise whose amplitude falls with the 1.2th power of its frequency; waves longer than 16 nodes are left out."""
    frequency = np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :])
    amplitude = np.where(frequency > 1 / 16, np.maximum(frequency, 1e-9) ** -1.2, 0.0)
    return amplitude * np.exp(2j * math.pi * random.random(frequency.shape))


class CalledOff(Exception):
    """As an abort ends a flight to a place."""


@dataclass
class WanderingVehicle:
    """Flies at once; `lowest`, `highest`: of its height above the ground so far. measuring: past the take-off.

    no_fly: m ENU. ends_at: share of the next way along the ground after which it is called off. landed_m: from home.
    """

    terrain: Terrain
    frame: LocalFrame
    flight: FlightSpec
    no_fly: tuple[BaseGeometry, ...]
    random: np.random.Generator
    state: Telemetry
    measuring: bool = False
    lowest_m: float = math.inf
    highest_m: float = -math.inf
    flown_m: float = 0.0
    points: int = 0
    ends_at: float = 1.0
    landed_m: float = math.nan
    violations: Counter[str] = field(default_factory=Counter[str])

    def telemetry(self) -> Telemetry:
        return self.state

    async def take_off(self, altitude_relative_m: float) -> None:
        home = self.state.home_amsl_m or 0.0
        self.state = replace(
            self.state,
            in_air=True,
            armed=True,
            altitude_amsl_m=home + altitude_relative_m,
            altitude_relative_m=altitude_relative_m,
        )
        self.measuring = True
        self._held(*self.frame.to_enu(self._here()), home + altitude_relative_m)

    async def goto(
        self,
        place: Place,
        altitude_amsl_m: float,
        speed_m_s: float,
        heading_deg: float | None = None,
        swinging: Swinging | None = None,
    ) -> None:
        """Sideways and upwards at once, each at its own speed, as autopilots do."""
        (x0, y0), (x1, y1) = self.frame.to_enu(self._here()), self.frame.to_enu(place)
        called_off = self.ends_at < 1.0 and math.hypot(x1 - x0, y1 - y0) > STEP_M
        if called_off:
            x1, y1 = x0 + self.ends_at * (x1 - x0), y0 + self.ends_at * (y1 - y0)
            self.ends_at = 1.0
        flown = LineString([(x0, y0), (x1, y1)])
        self.violations["no-fly"] += any(flown.intersection(zone).length > EDGE_M for zone in self.no_fly)
        length, before = math.hypot(x1 - x0, y1 - y0), self.state.altitude_amsl_m or 0.0
        seconds = max(length / speed_m_s, abs(altitude_amsl_m - before) / CLIMB_M_S)
        count = max(2, math.ceil(max(length, abs(altitude_amsl_m - before)) / STEP_M))
        t = np.linspace(0.0, max(seconds, 1e-6), count)
        share = np.minimum(1.0, t * speed_m_s / max(length, 1e-6))
        climbed = np.clip(t * CLIMB_M_S, 0.0, abs(altitude_amsl_m - before))
        altitude = before + math.copysign(1.0, altitude_amsl_m - before) * climbed
        side = self._wander(count, 0.9 * LATERAL_TOLERANCE_M)
        ahead = np.array([x1 - x0, y1 - y0]) / max(length, 1e-6)
        x = x0 + share * (x1 - x0) - side * ahead[1]
        y = y0 + share * (y1 - y0) + side * ahead[0]
        self._held(x, y, altitude + self._wander(count, 0.6 * VERTICAL_TOLERANCE_M))
        self.flown_m += length
        self.state = replace(
            self.state,
            position=self.frame.to_geo(x1, y1),
            altitude_amsl_m=float(altitude[-1]),
            altitude_relative_m=float(altitude[-1]) - (self.state.home_amsl_m or 0.0),
        )
        if called_off:
            raise CalledOff

    async def land(self) -> None:
        """On the spot."""
        self.landed_m = math.hypot(*self.frame.to_enu(self._here()))
        self.state = replace(self.state, in_air=False, armed=False)

    async def return_home(self) -> None:
        """The autopilot's own: straight, as high as it is."""
        assert self.state.altitude_amsl_m is not None
        await self.goto(self.frame.origin, self.state.altitude_amsl_m, self.flight.speed_m_s)
        await self.land()

    def _here(self) -> Place:
        assert self.state.position is not None
        return self.state.position

    def _wander(self, count: int, most: float) -> NDArray[np.float64]:
        phase, waves = self.random.uniform(0.0, 2 * math.pi), self.random.uniform(0.5, 6.0)
        return most * np.sin(phase + np.linspace(0.0, waves * 2 * math.pi, count))

    def _held(self, x: Any, y: Any, altitude: Any) -> None:
        """Against the ground as it is, not as the product reckons with it."""
        east, north = np.atleast_1d(x), np.atleast_1d(y)
        lon_lat = np.array(self.frame.to_lon_lat(np.column_stack((east, north))))
        above = np.atleast_1d(altitude) - self.terrain.at(lon_lat[:, 1], lon_lat[:, 0])
        self.points += len(above)
        self.violations["unknown"] += int(np.isnan(above).any())
        self.violations["clearance"] += int((above < self.flight.minimum_clearance_m).any())
        self.violations["ceiling"] += int((above > self.flight.maximum_above_ground_m).any())
        self.lowest_m = min(self.lowest_m, float(np.nanmin(above)))
        self.highest_m = max(self.highest_m, float(np.nanmax(above)))
