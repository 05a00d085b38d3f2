from __future__ import annotations

from collections.abc import Sequence

import pytest
from ground import AREA, FRAME, HOME, towards

from backend.reasons import Reason
from backend.reasons.safety import OutsideFence
from backend.search.forecast import forecast, preview
from backend.search.localization import Localization, localization
from backend.spec import FlightSpec, MissionSpec, PlannerSpec, Polygon
from hardware.readings import Place

SEEN = [towards(0.0, -20.0, (200.0, 80.0))]


def task(flight: FlightSpec | None = None) -> Localization:
    spec = MissionSpec(name="m", area=AREA, planner=PlannerSpec(budget=200), flight=flight or FlightSpec())
    return localization(spec, HOME)


def at(x: float, y: float) -> Place:
    return FRAME.to_geo(x, y)


class Asked:
    """Vetoes that answer the same and remember what they were asked about."""

    def __init__(self, *answer: Reason) -> None:
        self.answer = answer
        self.about: list[tuple[Place, list[tuple[float, float]]]] = []

    def __call__(self, place: Place, way: Sequence[tuple[float, float]]) -> tuple[Reason, ...]:
        self.about.append((place, list(way)))
        return self.answer


def test_a_place_that_may_be_flown_to_has_its_time_and_no_reason_against_it() -> None:
    asked = Asked()
    found = forecast(task(), SEEN, at(0, -20), at(150, -30), asked)
    assert found.reason is None
    assert found.mean_s is not None
    assert found.mean_s > 30.0
    assert found.p90_s is not None
    assert found.p90_s >= found.mean_s
    assert asked.about == [(at(150, -30), [])]


def test_what_safety_has_against_a_place_is_told_and_its_time_all_the_same() -> None:
    against = (OutsideFence("place", 20.0), OutsideFence("place", 30.0))
    found = forecast(task(), SEEN, at(0, -20), at(150, -30), Asked(*against))
    assert found.reason == against[0]
    assert found.mean_s is not None


def test_safety_is_asked_about_the_way_around_a_zone() -> None:
    ring = [at(x, y) for x, y in ((80, -30), (120, -30), (120, 60), (80, 60), (80, -30))]
    zone = Polygon(coordinates=[[(p.lon, p.lat) for p in ring]])
    asked = Asked()
    forecast(task(FlightSpec(no_fly=[zone])), SEEN, at(0, 0), at(200, 0), asked)
    ((_, way),) = asked.about
    assert way
    assert all(80 - 4 <= x <= 120 + 4 for x, _ in way)


def test_a_preview_plans_from_the_prior() -> None:
    seen = preview(task(), at(0, 0), threads=1)
    assert seen.candidates
    assert seen.mean_s == pytest.approx(sum(seen.times_s) / len(seen.times_s))
    assert seen.rollouts <= 200
