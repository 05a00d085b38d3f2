"""The small mission, one with a second emitter that has a bearing and no estimate, and three points of path."""

from __future__ import annotations

import pytest
from small_missions import BEGAN, FOX, TAG, bearing, mission, numbered

from backend.events import BearingExcluded, BeliefUpdated, PrioritiesChanged, Recorded
from backend.ports import TrackPoint
from backend.wire.export import Tracks


@pytest.fixture(scope="module")
def recorded() -> list[Recorded]:
    return numbered(mission(FOX))


@pytest.fixture(scope="module")
def of_two_emitters() -> list[Recorded]:
    """The tag's bearing was taken in the same sweep as the fox's first."""
    of_tag = bearing(1, 50.622, 7.202, 90.0).model_copy(update={"emitter_id": "tag", "bearing_id": "t1"})
    return numbered([*mission(FOX, TAG), of_tag])


@pytest.fixture(scope="module")
def of_the_prior() -> list[Recorded]:
    """Both bearings were taken back, and the area is believed in again."""
    taken_back = [BearingExcluded(emitter_id="fox", bearing_id=f"b{n}", by="op", reason="echo") for n in (1, 2)]
    *before, belief, _, _ = mission(FOX)
    assert isinstance(belief, BeliefUpdated)
    return numbered([*before, *taken_back, belief.model_copy(update={"bearings": 0})])


@pytest.fixture(scope="module")
def fox_first(of_two_emitters: list[Recorded]) -> list[Recorded]:
    """The order was changed in flight, after all that the two of them have."""
    ordered = PrioritiesChanged(priorities={"fox": 1}, by="anna")
    return numbered([*(record.event for record in of_two_emitters), ordered])


@pytest.fixture(scope="module")
def tracks() -> Tracks:
    began_s, unknown = BEGAN.timestamp(), float("nan")
    return {
        "craft-1": [
            TrackPoint(began_s + 21, 50.6201, 7.205, 230.0, 30.0, 0.0, 90.0, "GUIDED"),
            TrackPoint(began_s + 21.5, 50.6202, 7.205, unknown, 31.0, unknown, None, None),
            TrackPoint(began_s + 22, unknown, 7.205, 230.0, 32.0, 0.0, 90.0, "GUIDED"),
        ]
    }
