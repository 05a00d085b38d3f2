"""What is wrong with a file of ways and barriers, what was left out of it, and where no way leads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class NeitherWayNorBarrier:
    """As far as their properties say."""

    parts: int
    code: Literal["neither_way_nor_barrier"] = "neither_way_nor_barrier"
    english: ClassVar[Words] = Words(
        "{parts|part is|parts are} left out: nothing says whether it is a road, a path or a barrier."
    )


@dataclass(frozen=True, slots=True)
class FarFromSearch:
    parts: int
    most_m: float
    code: Literal["far_from_search"] = "far_from_search"
    english: ClassVar[Words] = Words("{parts|part is|parts are} left out, further than {most_m} from the search area.")


@dataclass(frozen=True, slots=True)
class NoWaysInFile:
    """parts: of other kinds."""

    parts: int
    code: Literal["no_ways_in_file"] = "no_ways_in_file"
    english: ClassVar[Words] = Words(
        "The file holds no road, path or barrier that could be told; {parts|other part|other parts} it has.",
        'Give each line or area a property "kind" that is "road", "path" or "barrier", or export them from '
        "OpenStreetMap with their tags.",
    )


@dataclass(frozen=True, slots=True)
class WaysTooFar:
    """nearest_m: from the middle of the search area."""

    nearest_m: float
    most_m: float
    code: Literal["ways_too_far"] = "ways_too_far"
    english: ClassVar[Words] = Words(
        "No road, path or barrier of the file lies within {most_m} of the search area: the nearest is at {nearest_m}.",
        "Use the file that belongs to this search. In GeoJSON longitude comes first.",
    )


@dataclass(frozen=True, slots=True)
class WaysTooMany:
    """Positions where roads meet count, too."""

    positions: int
    most: int
    code: Literal["ways_too_many"] = "ways_too_many"
    english: ClassVar[Words] = Words(
        "The roads, paths and barriers near the search area have {positions} positions; {most} are the most.",
        "Cut the file to the search and the ways there, or leave out what is not needed.",
    )


@dataclass(frozen=True, slots=True)
class NoRoadNear:
    """Of somebody who drives. nearest_m: whether it can be walked to or not."""

    nearest_m: float
    most_m: float
    code: Literal["no_road_near"] = "no_road_near"
    english: ClassVar[Words] = Words(
        "No road leads away from where you stand: the nearest one known is {nearest_m} away, and your car is looked "
        "for within {most_m}, on your side of what cannot be crossed.",
        "Say where the car stands, go on foot, or upload ways with the missing road.",
    )


@dataclass(frozen=True, slots=True)
class NoWayLeadsThere:
    """places: where one could listen, all of them out of reach."""

    places: int
    on_roads: bool
    code: Literal["no_way_leads_there"] = "no_way_leads_there"
    english: ClassVar[Words] = Words(
        "No way leads there: {places|place|places} to listen from, and none that can be reached from where you stand "
        "{on_roads?true=by the roads that are known|false=without crossing what cannot be crossed}.",
        "Start elsewhere, or upload ways with the missing road, bridge or gate.",
    )


WaysReason = (
    NeitherWayNorBarrier | FarFromSearch | NoWaysInFile | WaysTooFar | WaysTooMany | NoRoadNear | NoWayLeadsThere
)
