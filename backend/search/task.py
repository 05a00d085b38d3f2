"""What a search asks of those who fly or walk for it: places, and one localization per emitter, in one local frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from shapely.geometry.base import BaseGeometry

from backend.search import area
from backend.search.altitude import altitude_at, level_altitude
from backend.search.closed_by_ground import closed_by_ground
from backend.search.ground import Ground, Way
from backend.search.localization import Localization, localization
from backend.search.together import Together
from backend.spec import MissionSpec, Place
from backend.terrain import Terrain
from hardware.frame import LocalFrame


@dataclass(frozen=True, slots=True)
class SearchTask:
    """fence, no_fly: m ENU of `frame`, whose origin is the home. ground: below all of it. emitters: by id."""

    mission: MissionSpec
    frame: LocalFrame
    ground: Ground
    fence: BaseGeometry
    no_fly: tuple[BaseGeometry, ...]
    emitters: Mapping[str, Localization]
    together: Together

    @property
    def home(self) -> Place:
        """Degrees; (0, 0) of the frame."""
        return self.frame.origin

    @property
    def home_amsl_m(self) -> float:
        """As the autopilot says."""
        return self.ground.home_amsl_m

    @property
    def first(self) -> Localization:
        """What all emitters have in common (area, fence, frame) is read off the first."""
        return next(iter(self.emitters.values()))

    def place(self, x: float, y: float) -> Place:
        """(x, y) in m ENU to degrees."""
        return self.frame.to_geo(x, y)

    def altitude_at(self, place: Place) -> float:
        """Metres AMSL."""
        return altitude_at(place, self.ground, self.mission.flight)

    def level_altitude(self, way: Way, wanted_amsl_m: float | None = None) -> float:
        """Metres AMSL at which a way (m ENU) is flown. wanted_amsl_m None: the mission's altitude."""
        return level_altitude(way, self.ground, self.mission.flight, wanted_amsl_m)


def search_task(mission: MissionSpec, home: Place, home_amsl_m: float, terrain: Terrain | None = None) -> SearchTask:
    """terrain None: the ground is taken to be flat.

    Raises MissionInputError when the specification makes no sense as seen from `home`.
    """
    frame = LocalFrame(home)
    target = area.target_area(mission, frame)
    area.check_reach(target)
    fence, ground = area.fence(mission, target, frame), Ground(frame, home_amsl_m, terrain)
    closed = closed_by_ground(ground, mission.flight, fence)
    emitters = {
        emitter.emitter_id: localization(mission, home, emitter.emitter_id, closed) for emitter in mission.emitters
    }
    return SearchTask(mission, frame, ground, fence, area.no_fly(mission, frame), emitters, Together(emitters))
