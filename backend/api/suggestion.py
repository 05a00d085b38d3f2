"""A mission to start from: a rectangle north of the home, large enough to be worth a search."""

from __future__ import annotations

from backend.spec import MissionSpec, PlannerSpec, Polygon, SensorSpec
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.options import CROSSFIX

WIDTH_M, HEIGHT_M = 313.0, 200.0
"""As wide as the field system's area, and deeper, so that a newcomer's search takes more than two places."""

NAME = "New search"

PLANNER = PlannerSpec(
    method=CROSSFIX.method,
    base_policy=CROSSFIX.base_policy,
    selection=CROSSFIX.selection,
    sampling=CROSSFIX.sampling,
    estimator=CROSSFIX.estimator,
    budget=CROSSFIX.budget,
)
"""`crossfix study run --planner crossfix` is the planner at these settings."""


SENSOR = SensorSpec(
    measurement_time_s=16.0,
    bearing_errors="joint",
    shared_errors=True,
    sweep_evidence="whole",
    sector_turns=True,
    listen_on_the_way=True,
    swing_on_the_way=True,
)
"""Once around at 30 degrees a second, and four seconds to begin and to settle (decision 64). Errors of bearings are
estimated with the place, from all that sweeps tell of all directions (decision 75). A turn goes only as far as its
bearing needs, and the nose swings between places so that what is heard there counts (decision 62)."""


def suggested_mission(home: Place) -> MissionSpec:
    """With our own planner and `SENSOR`; all other values are the specification's defaults. The home lies on the area's
    southern edge."""
    frame = LocalFrame(home)
    east = WIDTH_M / 2
    corners = [(-east, 0.0), (east, 0.0), (east, HEIGHT_M), (-east, HEIGHT_M), (-east, 0.0)]
    ring = [(point.lon, point.lat) for point in (frame.to_geo(x, y) for x, y in corners)]
    area = Polygon(coordinates=[[(round(x, 7), round(y, 7)) for x, y in ring]])
    return MissionSpec(name=NAME, area=area, sensor=SENSOR, planner=PLANNER)


ERRORS = ("bearing_errors", "shared_errors", "sweep_evidence")
"""What a specification says of the errors of bearings. A stored one that does not is from before they were estimated
with the places, and means independent ones."""


def with_errors_said(asked: MissionSpec, unsaid: SensorSpec = SENSOR) -> MissionSpec:
    """A request that does not say how the errors of bearings hang together, or what a sweep tells, takes that from
    `unsaid`: of the suggested mission, or of the draft that it edits."""
    taken = {name: getattr(unsaid, name) for name in ERRORS if name not in asked.sensor.model_fields_set}
    return asked.model_copy(update={"sensor": asked.sensor.model_copy(update=taken)}) if taken else asked
