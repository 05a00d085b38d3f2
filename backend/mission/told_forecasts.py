"""What an operator was told of a place: the same words go into the record when the place is chosen after all.

An override must not wait for the planner, and a number that comes back from a browser is nobody's forecast.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from backend.craft.inputs import Foretold
from backend.search.state import SearchState
from backend.spec import Place

MOST_KEPT = 32

PlaceKey = tuple[float, float]
"""Latitude and longitude, as they came."""
Asked = tuple[int, tuple[str, ...]]
"""How many bearings counted, and what is looked for, in its order."""


@dataclass(slots=True)
class ToldForecasts:
    """Of a mission in flight. A forecast is void with the next bearing, and with another order of importance."""

    _told: dict[PlaceKey, tuple[Asked, Foretold]] = field(default_factory=dict[PlaceKey, tuple[Asked, Foretold]])

    def keep(self, search: SearchState, place: Place, told: Foretold) -> None:
        """The newest of them, so that somebody who tries many places fills no memory."""
        self._told.pop(_key(place), None)
        self._told[_key(place)] = (_asked(search), told)
        while len(self._told) > MOST_KEPT:
            del self._told[next(iter(self._told))]

    def of(self, search: SearchState, place: Place) -> Foretold | None:
        """None: nobody asked, or bearings or another order came since."""
        asked, told = self._told.get(_key(place), (None, None))
        return told if asked == _asked(search) else None


def _key(place: Place) -> PlaceKey:
    return place.lat, place.lon


def _asked(search: SearchState) -> Asked:
    bearings = sum(len(emitter.bearings) for emitter in search.emitters.values())
    return bearings, tuple(emitter.emitter_id for emitter in search.sought)
