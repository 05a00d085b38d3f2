from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from ground import AREA, FRAME, HOME, bearing, towards
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.events import BearingMeasured, Peak
from backend.reasons.search import HeadingsAskew
from backend.search import localization as module
from backend.search.errors import MissionInputError
from backend.search.localization import Localization, localization
from backend.search.problem import KEEP_OFF_M
from backend.search.task import search_task
from backend.spec import (
    EmitterSpec,
    FlightSpec,
    GaussianPriorSpec,
    MissionSpec,
    MovementSpec,
    Polygon,
    PriorSpec,
    RingPriorSpec,
    SensorSpec,
    UniformPriorSpec,
)
from hardware.readings import Place
from planner.belief.grid import GridBelief, digest
from planner.reasons import ExpectedErrorTooLarge, PriorOutsideArea
from planner.types import Bearing, GaussianPrior, RingPrior

UNIFORM = UniformPriorSpec()


def task(outlier_probability: float = 0.0, prior: PriorSpec = UNIFORM) -> Localization:
    sensor = SensorSpec(outlier_probability=outlier_probability)
    return localization(MissionSpec(name="m", area=AREA, sensor=sensor, emitters=[EmitterSpec(prior=prior)]), HOME)


def test_north_is_up_and_east_is_right() -> None:
    (north,) = task().planner_bearings([bearing(10, 20, 0.0, peaks=(Peak(bearing_deg=90.0, weight=0.5),))])
    assert (north.x, north.y) == pytest.approx((10, 20), abs=1e-3)
    assert north.angle == pytest.approx(math.pi / 2)
    assert north.sigma == pytest.approx(math.radians(4))
    assert north.peaks[0].angle == pytest.approx(0.0)
    assert north.peaks[0].weight == 0.5


def test_crossing_bearings_localize_where_they_cross() -> None:
    target = (150.0, 60.0)
    seen = [towards(x, y, target, sigma=2.0) for x, y in ((90, -40), (210, -40), (150, -45), (60, 60))]
    fact, belief = task().belief_fact(seen)
    assert fact.localized
    assert fact.not_yet == []
    assert fact.estimate is not None
    x, y = FRAME.to_enu(Place(lat=fact.estimate.lat, lon=fact.estimate.lon))
    assert math.dist((x, y), target) < 5.0
    assert fact.digest == digest(belief)
    assert fact.estimate.c95_area_m2 < math.pi * (3 * fact.estimate.major_axis_m) ** 2
    assert fact.estimate.minor_axis_m <= fact.estimate.major_axis_m


def test_the_goal_of_an_emitter_that_moves_is_told_as_what_holds_a_claim_back() -> None:
    moves = EmitterSpec(movement=MovementSpec(kind="animal", speed_m_s=0.5))
    wanted = MissionSpec(name="m", area=AREA, emitters=[moves])
    seen = [towards(x, -40.0, (150.0, 60.0), sigma=15.0) for x in (60.0, 150.0, 240.0)]
    fact, _ = localization(wanted, HOME).belief_fact(seen)
    (held_back,) = [reason for reason in fact.not_yet if isinstance(reason, ExpectedErrorTooLarge)]
    assert fact.goal_m == held_back.threshold_m
    assert held_back.threshold_m > wanted.localization.expected_rmse_m
    assert task().belief_fact(seen)[0].goal_m is None, "the specification says it"


def test_one_bearing_is_never_a_fix_however_narrow() -> None:
    fact, _ = task().belief_fact([towards(0, 0, (5.0, 5.0), sigma=0.5)])
    assert not fact.localized
    assert fact.not_yet


def test_contradicting_bearings_give_no_estimate_but_a_belief_to_plan_with() -> None:
    seen = [bearing(50, -30, 0.0, 2.0), bearing(250, -30, 0.0, 2.0), bearing(150, 200, 180.0, 2.0)]
    fact, belief = task().belief_fact(seen)
    assert fact.estimate is None
    assert not fact.consistent
    assert not fact.localized
    assert belief.density.sum() == pytest.approx(1.0)
    tolerant, _ = task(outlier_probability=0.05).belief_fact(seen)
    assert tolerant.estimate is not None
    assert not tolerant.consistent


def test_a_claim_against_an_outlier_names_the_bearing_it_stands_against() -> None:
    """Decision 12: three crossing bearings carry the claim, the one that points elsewhere is reported with it."""
    target = (150.0, 60.0)
    seen = [
        bearing(x, y, math.degrees(math.atan2(target[0] - x, target[1] - y)) % 360.0, 2.0)
        for x, y in ((50, -20), (250, -20), (150, 0), (60, 120))
    ]
    wrong = bearing(240, 120, 200.0, 2.0).model_copy(update={"bearing_id": "wrong"})
    fact, _ = task(outlier_probability=0.05).belief_fact([*seen, wrong])
    assert fact.localized
    assert not fact.consistent
    assert fact.contradicting == ["wrong"]
    agreed, _ = task(outlier_probability=0.05).belief_fact(seen)
    assert agreed.localized
    assert agreed.contradicting == []


AROUND = ((90, -40), (250, 20), (150, 160), (30, 60))


@pytest.mark.parametrize("off_deg", [0.0, 12.0])
def test_a_compass_that_is_off_is_told_from_bearings_of_all_sides(off_deg: float) -> None:
    seen = [towards(x, y, (150.0, 60.0), sigma=4.2) for x, y in AROUND]
    turned = [
        b.model_copy(update={"bearing_deg": (b.bearing_deg + off_deg) % 360.0, "heading_sigma_deg": 4.0}) for b in seen
    ]
    found = task().heading_offset(turned)
    assert found is not None
    assert found.offset_deg == pytest.approx(off_deg, abs=0.5)
    assert found.significant == (off_deg > 5.0)
    fact, _ = task().belief_fact(turned)
    assert fact.localized == (off_deg == 0.0)
    if off_deg:
        assert fact.not_yet == [HeadingsAskew(found.offset_deg, found.std_error_deg)]
        assert fact.heading_offset_deg == found.offset_deg
        assert fact.heading_offset_std_error_deg == found.std_error_deg
    else:
        assert fact.heading_offset_deg is None


def test_what_a_heading_may_be_off_by_is_taken_out_of_the_sigma() -> None:
    seen = [towards(x, y, (150.0, 60.0), sigma=5.0) for x, y in AROUND]
    known = task().heading_offset([b.model_copy(update={"heading_sigma_deg": 4.0}) for b in seen])
    unknown = task().heading_offset(seen)
    assert known is not None
    assert unknown is not None
    assert known.std_error_deg == pytest.approx(0.6 * unknown.std_error_deg, rel=0.02)


def test_without_bearings_the_belief_is_the_prior_over_the_area() -> None:
    fact, belief = task().belief_fact([])
    assert fact.bearings == 0
    assert not fact.localized
    corners = task().corners_lon_lat(belief)
    ground = [FRAME.to_enu(Place(lat, lon)) for lon, lat in corners]
    assert np.allclose(ground, [(0, 0), (300, 0), (300, 120), (0, 120)], atol=4.0)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.tuples(st.floats(-50, 350), st.floats(-50, 170), st.floats(0, 359)), max_size=4))
def test_the_same_facts_give_the_same_belief_bit_for_bit(places: list[tuple[float, float, float]]) -> None:
    seen = [bearing(*place) for place in places]
    again = [BearingMeasured.model_validate_json(fact.model_dump_json()) for fact in seen]
    first, _ = task(0.05).belief_fact(seen)
    second, _ = task(0.05).belief_fact(again)
    assert first == second


def test_the_ellipse_is_told_by_its_compass_direction() -> None:
    prior = GaussianPriorSpec(centre=_at(150, 60), sigma_major_m=20.0, sigma_minor_m=5.0, major_axis_deg=90.0)
    fact, _ = task(prior=prior).belief_fact([])
    assert fact.estimate is not None
    assert fact.estimate.major_axis_m == pytest.approx(20.0, rel=0.1)
    assert fact.estimate.minor_axis_m == pytest.approx(5.0, rel=0.1)
    assert fact.estimate.major_axis_deg == pytest.approx(90.0, abs=1.0)


def test_priors_become_the_planners() -> None:
    gaussian = task(
        prior=GaussianPriorSpec(centre=_at(10, 20), sigma_major_m=40.0, sigma_minor_m=10.0, major_axis_deg=0.0)
    ).problem.prior
    assert isinstance(gaussian, GaussianPrior)
    assert (gaussian.x, gaussian.y) == pytest.approx((10, 20), abs=1e-3)
    assert np.allclose(gaussian.covariance, np.diag([100.0, 1600.0]))
    ring = task(prior=RingPriorSpec(centre=_at(0, 0), inner_m=10.0, outer_m=100.0)).problem.prior
    assert ring == RingPrior(pytest.approx(0, abs=1e-6), pytest.approx(0, abs=1e-6), 10.0, 100.0)  # type: ignore[arg-type]


def test_a_prior_that_misses_the_area_is_refused() -> None:
    away = RingPriorSpec(centre=_at(5000, 0), inner_m=10.0, outer_m=100.0)
    with pytest.raises(MissionInputError) as refused:
        task(prior=away)
    assert isinstance(refused.value.reason, PriorOutsideArea)
    assert refused.value.field == "emitters.0.prior"
    second = EmitterSpec(emitter_id="tag", prior=away)
    with pytest.raises(MissionInputError) as refused:
        search_task(MissionSpec(name="m", area=AREA, emitters=[EmitterSpec(), second]), HOME, 100.0)
    assert refused.value.field == "emitters.1.prior"


def test_each_emitter_has_its_own_prior_and_belief_in_one_frame() -> None:
    near = GaussianPriorSpec(centre=_at(50, 60), sigma_major_m=20.0, sigma_minor_m=20.0)
    emitters = [EmitterSpec(), EmitterSpec(emitter_id="tag", frequency_hz=150e6, prior=near)]
    made = search_task(MissionSpec(name="m", area=AREA, emitters=emitters), HOME, 100.0)
    first, tag = made.emitters["emitter-1"], made.emitters["tag"]
    assert made.first is first
    assert first.frame == tag.frame == made.frame
    seen = [towards(x, y, (250.0, 60.0), sigma=2.0) for x, y in ((190, -40), (300, -40), (250, -45), (160, 60))]
    fact, _ = first.belief_fact(seen)
    untouched, _ = tag.belief_fact([])
    assert (fact.emitter_id, fact.localized) == ("emitter-1", True)
    assert (untouched.emitter_id, untouched.bearings, untouched.localized) == ("tag", 0, False)
    assert untouched.estimate is not None
    middle = Place(lat=untouched.estimate.lat, lon=untouched.estimate.lon)
    assert FRAME.to_enu(middle) == pytest.approx((50, 60), abs=5.0)


def test_flight_area_and_zones_reach_the_planner_and_whoever_flies() -> None:
    zone = Polygon(
        coordinates=[[(c.lon, c.lat) for c in (FRAME.to_geo(x, y) for x, y in ((10, 10), (40, 10), (40, 40)))]]
    )
    mission = MissionSpec(name="m", area=AREA, flight=FlightSpec(no_fly=[zone], fence_margin_m=10.0))
    made = search_task(mission, HOME, 100.0)
    problem = made.first.problem
    assert len(problem.no_fly) == 1
    assert made.no_fly[0].area == pytest.approx(450, rel=1e-2)
    assert problem.flight_area is not None
    assert made.fence.area == pytest.approx(shapely.Polygon(problem.flight_area[0]).area)
    kept_off = shapely.Polygon(problem.no_fly[0]).exterior.distance(made.no_fly[0])
    assert kept_off == pytest.approx(KEEP_OFF_M)


def _at(x: float, y: float) -> Place:
    point = FRAME.to_geo(x, y)
    return point


def test_a_belief_that_goes_on_from_the_one_before_is_the_same_bit_for_bit() -> None:
    grown, fresh = task(0.1), task(0.1)
    measured = [towards(40 * n, 15 * n, (150, 60)) for n in range(5)]
    for count in range(len(measured)):
        grown.belief_fact(measured[:count])
    fact, _ = grown.belief_fact(measured)
    assert fact == fresh.belief_fact(measured)[0]
    without = [b for b in measured if b is not measured[2]]
    assert grown.belief_fact(without)[0] == fresh.belief_fact(without)[0] != fact


def test_beliefs_that_are_kept_take_no_more_room_than_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """And are made again where they were given up."""
    seen = [towards(x, y, (150.0, 60.0), sigma=6.0) for x, y in ((90, -40), (210, -40), (150, -45), (60, 60))]
    _, roomy = task(0.1).belief_fact(seen)
    monkeypatch.setattr(module, "CELLS_KEPT", 1)
    narrow = task(0.1)
    _, again = narrow.belief_fact(seen)
    assert len(narrow._folds) == 1  # pyright: ignore[reportPrivateUsage]
    assert np.array_equal(again.density, roomy.density)


def test_a_file_of_thousands_of_bearings_is_no_deeper_than_the_stack(monkeypatch: pytest.MonkeyPatch) -> None:
    made, folded = task(0.1), list[int]()

    def counted(_: Localization, before: GridBelief, bearings: tuple[Bearing, ...]) -> GridBelief:
        folded.append(len(bearings))
        return before

    monkeypatch.setattr(Localization, "_with", counted)
    bearings = made.planner_bearings([towards(40 * n, -40, (150, 60)) for n in range(4)]) * 500
    made.belief(bearings)
    made.belief((*bearings, bearings[0]))
    assert folded == list(range(1, 2002))


def joint_task() -> Localization:
    return localization(MissionSpec(name="m", area=AREA, sensor=SensorSpec(bearing_errors="joint")), HOME)


def test_many_bearings_are_folded_at_once_and_grow_as_they_begin(monkeypatch: pytest.MonkeyPatch) -> None:
    """As after a restart: a belief does not depend on when its bearings became known."""
    monkeypatch.setattr(module, "AT_ONCE", 4)
    grown, measured = joint_task(), [towards(37 * n - 90, -40 - 9 * n, (150, 60), sigma=6.0) for n in range(10)]
    for count in range(len(measured)):
        grown.belief_fact(measured[:count])
    assert grown.belief_fact(measured)[0] == joint_task().belief_fact(measured)[0]
    folded, one_more = list[int](), Localization._with  # pyright: ignore[reportPrivateUsage]

    def counted(self: Localization, before: GridBelief, bearings: tuple[Bearing, ...]) -> GridBelief:
        folded.append(len(bearings))
        return one_more(self, before, bearings)

    monkeypatch.setattr(Localization, "_with", counted)
    joint_task().belief_fact(measured)
    assert folded == [8, 9, 10]
