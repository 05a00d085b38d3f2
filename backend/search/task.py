"""What a search asks of whoever flies or walks for it: where, and one localization an emitter, in one local frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from shapely.geometry.base import BaseGeometry

from backend.search import area
from backend.search.altitude import altitude_at
from backend.search.localization import Localization, localization
from backend.spec import MissionSpec, Place
from hardware.frame import LocalFrame


@dataclass(frozen=True, slots=True)
class SearchTask:
    """fence, no_fly: m ENU of `frame`, whose origin is the home. home_amsl_m: the altitude of that. emitters: by id."""

    mission: MissionSpec
    frame: LocalFrame
    home_amsl_m: float
    fence: BaseGeometry
    no_fly: tuple[BaseGeometry, ...]
    emitters: Mapping[str, Localization]

    @property
    def home(self) -> Place:
        """Degrees; (0, 0) of the frame."""
        return self.frame.origin

    @property
    def first(self) -> Localization:
        """What all emitters have in common (area, fence, frame) is read off the first."""
        return next(iter(self.emitters.values()))

    def place(self, x: float, y: float) -> Place:
        """(x, y) in m ENU to degrees."""
        return self.frame.to_geo(x, y)

    def altitude_at(self, place: Place) -> float:
        """Metres AMSL."""
        return altitude_at(place, self.home_amsl_m, self.mission.flight)


def search_task(mission: MissionSpec, home: Place, home_amsl_m: float) -> SearchTask:
    """Raises MissionInputError when the specification makes no sense as seen from `home`."""
    emitters = {emitter.emitter_id: localization(mission, home, emitter.emitter_id) for emitter in mission.emitters}
    frame = next(iter(emitters.values())).frame
    fence = area.fence(mission, area.target_area(mission, frame), frame)
    return SearchTask(mission, frame, home_amsl_m, fence, area.no_fly(mission, frame), emitters)
