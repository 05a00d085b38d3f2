"""A flight at 40 m above a flat home, with a zone inside its fence, for the mission rules."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from airspace import airspace
from shapely import box

from backend.craft.safety import Limits, Situation
from backend.reasons import Reason
from backend.search.ground import Ground
from backend.spec import FlightSpec
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry

HOME = Place(50.0, 7.0)
FRAME = LocalFrame(HOME)
FENCE, ZONE = box(-50, -50, 400, 200), box(100, 0, 150, 100)
LIMITS = Limits(
    frame=FRAME,
    fence=FENCE,
    no_fly=(ZONE,),
    problem=airspace(FENCE, ZONE),
    ground=Ground(FRAME, 100.0),
    flight=FlightSpec(),
    reserve_percent=25.0,
    battery_telemetry=True,
    speed_m_s=7.0,
    measurement_time_s=30.0,
)


def telemetry(east: float = 0.0, north: float = 0.0, **more: object) -> Telemetry:
    return replace(
        Telemetry(connected=True, at_s=1000.0, position=FRAME.to_geo(east, north), position_at_s=1000.0),
        **{"battery_percent": 90.0, "in_air": True, **more},  # type: ignore[arg-type]
    )


def situation(**more: object) -> Situation:
    return Situation(telemetry(**more), now_s=1000.5)  # type: ignore[arg-type]


def kinds(vetoes: Iterable[Reason]) -> list[type]:
    return [type(veto) for veto in vetoes]
