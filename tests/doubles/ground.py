"""A field of 300 x 120 m east and north of home, and bearings taken around it."""

from __future__ import annotations

import math

from backend.events import FIRST_CRAFT, BearingMeasured, CraftSource, Peak
from backend.spec import FIRST_EMITTER, Polygon
from hardware.frame import LocalFrame
from hardware.readings import Place

HOME = Place(lat=50.0, lon=7.0)
FRAME = LocalFrame(Place(50.0, 7.0))
CORNERS = [FRAME.to_geo(x, y) for x, y in ((0, 0), (300, 0), (300, 120), (0, 120), (0, 0))]
AREA = Polygon(coordinates=[[(c.lon, c.lat) for c in CORNERS]])


def bearing(x: float, y: float, compass: float, sigma: float = 4.0, peaks: tuple[Peak, ...] = ()) -> BearingMeasured:
    place = FRAME.to_geo(x, y)
    return BearingMeasured(
        emitter_id=FIRST_EMITTER,
        source=CraftSource(craft_id=FIRST_CRAFT),
        bearing_id=f"{x}-{y}-{compass}",
        sweep_id="s",
        place_number=1,
        place=place,
        altitude_amsl_m=140.0,
        bearing_deg=compass,
        sigma_deg=sigma,
        quality=0.9,
        peaks=list(peaks),
        snr_db=None,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
    )


def towards(x: float, y: float, target: tuple[float, float], **more: object) -> BearingMeasured:
    compass = math.degrees(math.atan2(target[0] - x, target[1] - y)) % 360
    return bearing(x, y, compass, **more)  # type: ignore[arg-type]
