from __future__ import annotations

import math

import numpy as np
import pytest
from ground import AREA, FRAME, HOME, towards
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from backend.events import PersonSource
from backend.search.localization import Localization, localization
from backend.search.planner_bearings import source_name
from backend.search.planning import (
    SPECIFIED_COUNTS,
    cost_of,
    foreseen,
    foreseen_for,
    in_nine_of_ten,
    next_place,
    next_place_together,
    turned_at,
    way_to,
)
from backend.search.turn_schedule import turn_s
from backend.spec import EmitterSpec, FlightSpec, MissionSpec, MovementSpec, PlannerSpec, Polygon, SensorSpec
from hardware.readings import Place
from planner.policy.actions import OTHER_ECHOES_M, SAME_PLACE_M
from planner.reasons.choice import SoonestForFirst


def task(**more: object) -> Localization:
    planner = more.pop("planner", PlannerSpec(budget=200))
    return localization(MissionSpec(name="m", area=AREA, planner=planner, **more), HOME)  # type: ignore[arg-type]


def zone(*corners: tuple[float, float]) -> Polygon:
    places = [FRAME.to_geo(*corner) for corner in (*corners, corners[0])]
    return Polygon(coordinates=[[(p.lon, p.lat) for p in places]])


@pytest.mark.parametrize("method", ["rollout", "base_policy"])
def test_the_next_place_is_allowed_explained_and_repeatable(method: str) -> None:
    made = task(planner=PlannerSpec(budget=200, method=method))  # type: ignore[arg-type]
    seen = [towards(0.0, -20.0, (200.0, 80.0))]
    belief = made.planning_belief(made.planner_bearings(seen))
    first, again = (next_place(made, belief, seen, (0.0, -20.0), 2, (), 1) for _ in range(2))
    assert first.place == again.place
    assert (first.place_number, first.emitter_id) == (2, "emitter-1")
    assert first.reason
    assert first.plan_ms > 0
    x, y = FRAME.to_enu(first.place)
    assert -61 <= x <= 361
    assert -61 <= y <= 181
    if method == "rollout":
        assert first.expected_time_s is not None
        assert first.time_90_s is not None
        assert first.rollouts >= len(first.candidates) > 1
        assert sum(c.dropped_in_round is None for c in first.candidates) == 1


@pytest.mark.parametrize("method", ["rollout", "base_policy"])
def test_no_turn_is_made_where_another_heard_the_same_echoes(method: str) -> None:
    """A craft's; what a person on the ground heard, and of an emitter that moves, is another matter."""
    made = task(planner=PlannerSpec(method=method))  # type: ignore[arg-type]
    seen = [towards(x, y, (150.0, 90.0)) for x, y in ((0.0, -20.0), (300.0, 0.0), (20.0, 170.0))]
    belief = made.planning_belief(made.planner_bearings(seen))
    x, y = FRAME.to_enu(next_place(made, belief, seen, (20.0, 170.0), 4, (), 1).place)
    assert min(math.dist((x, y), FRAME.to_enu(one.place)) for one in seen) >= OTHER_ECHOES_M - 0.01
    on_foot = [one.model_copy(update={"source": PersonSource(name="ada")}) for one in seen]
    assert len(turned_at(made, seen)) == 3
    assert turned_at(made, on_foot) == ()
    moves = [EmitterSpec(emitter_id="emitter-1", movement=MovementSpec(kind="animal"))]
    assert turned_at(task(emitters=moves), seen) == ()


@pytest.mark.parametrize("method", ["rollout", "base_policy"])
def test_a_refused_place_is_not_chosen_again(method: str) -> None:
    made = task(planner=PlannerSpec(budget=200, method=method))  # type: ignore[arg-type]
    seen = [towards(0.0, -20.0, (200.0, 80.0))]
    belief = made.planning_belief(made.planner_bearings(seen))
    refused: list[Place] = []
    for _ in range(3):
        choice = next_place(made, belief, seen, (0.0, -20.0), 2, refused, 1).place
        assert all(math.dist(FRAME.to_enu(choice), FRAME.to_enu(place)) >= SAME_PLACE_M for place in refused)
        refused.append(choice)


def test_the_place_for_several_emitters_is_allowed_explained_and_not_refused_before() -> None:
    emitters = [EmitterSpec(emitter_id=name, frequency_hz=150e6 + k) for k, name in enumerate(("a", "b"))]
    mission = MissionSpec(name="m", area=AREA, emitters=emitters, planner=PlannerSpec(budget=200))
    targets = {"a": (40.0, 80.0), "b": (260.0, 90.0)}
    wanted = [(localization(mission, HOME, name), [towards(0.0, -20.0, at)]) for name, at in targets.items()]
    refused: list[Place] = []
    for _ in range(3):
        choice, again = (next_place_together(wanted, (0.0, -20.0), 2, refused, 1) for _ in range(2))
        assert choice.place == again.place
        assert choice.place not in refused
        assert (choice.emitter_id, choice.place_number, choice.reason.code) == (None, 2, "soonest_together")
        x, y = FRAME.to_enu(choice.place)
        assert -61 <= x <= 361
        assert -61 <= y <= 181
        assert choice.expected_time_s is not None
        chosen = next(c for c in choice.candidates if (c.lat, c.lon) == (choice.place.lat, choice.place.lon))
        assert choice.expected_time_s > chosen.value_s, "the last of two is found later than they are on average"
        refused.append(choice.place)


def test_the_place_for_what_comes_first_says_for_whom_and_what_to_expect_of_each() -> None:
    emitters = [EmitterSpec(emitter_id=name, frequency_hz=150e6 + k, label="hare") for k, name in enumerate(("a", "b"))]
    mission = MissionSpec(name="m", area=AREA, emitters=emitters, planner=PlannerSpec(budget=200))
    targets = {"a": (40.0, 80.0), "b": (260.0, 90.0)}
    wanted = [(localization(mission, HOME, name), [towards(0.0, -20.0, at)]) for name, at in targets.items()]
    choice = next_place_together(wanted, (0.0, -20.0), 2, (), 1, ranks=[2, 1])
    assert isinstance(choice.reason, SoonestForFirst)
    assert (choice.reason.names, choice.reason.others) == (("hare 2",), 1)
    forecasts = {one.emitter_id: one.expected_time_s for one in choice.forecasts}
    assert forecasts["b"] == pytest.approx(choice.reason.first_time_s)
    assert choice.expected_time_s is not None
    assert max(time for time in forecasts.values() if time is not None) <= choice.expected_time_s


def test_the_way_goes_around_a_zone_and_straight_without_one() -> None:
    free = task()
    (end,) = way_to(free, (0.0, 0.0), (200.0, 0.0))
    assert end == pytest.approx((200.0, 0.0))
    blocked = task(flight=FlightSpec(no_fly=[zone((80, -30), (120, -30), (120, 60), (80, 60))]))
    way = way_to(blocked, (0.0, 0.0), (200.0, 0.0))
    assert len(way) > 1
    assert way[-1] == pytest.approx((200.0, 0.0))
    length = sum(math.dist(a, b) for a, b in zip([(0.0, 0.0), *way], way, strict=False))
    assert length > 205.0


def test_before_the_first_bearing_the_sensor_is_as_specified() -> None:
    problem = task().problem

    assert foreseen(problem, ()).sigma == pytest.approx(problem.sigma, rel=1e-12)


def test_bearings_to_come_are_expected_as_good_as_specified_and_as_those_that_came() -> None:
    problem = task().problem
    seen = [towards(0.0, -20.0, (200.0, 80.0), sigma=sigma) for sigma in (1.0, 1.0, 4.0)]

    expected = (math.degrees(problem.sigma) ** SPECIFIED_COUNTS * 1.0 * 1.0 * 4.0) ** (1.0 / (SPECIFIED_COUNTS + 3))

    assert math.degrees(foreseen(problem, seen).sigma) == pytest.approx(expected)


def test_the_bearings_to_come_are_the_crafts_whoever_took_those_that_came() -> None:
    problem = task().problem
    flown = towards(0.0, -20.0, (200.0, 80.0))
    told = flown.model_copy(update={"source": PersonSource(name="Ada")})

    assert foreseen(problem, [told]).next_source != source_name(told.source)
    assert foreseen(problem, [flown, told]).next_source == source_name(flown.source)
    vague = told.model_copy(update={"sigma_deg": 15.0})
    assert foreseen(problem, [flown, vague, vague]).sigma == foreseen(problem, [flown]).sigma


def test_measurements_to_come_are_expected_to_take_as_long_as_those_that_were_flown() -> None:
    problem = task().problem
    imported = towards(0.0, -20.0, (200.0, 80.0))
    flown = imported.model_copy(update={"measurement_time_s": 12.0})

    assert foreseen(problem, [imported]).measurement_time == problem.measurement_time
    assert foreseen(problem, [imported, flown, flown]).measurement_time == (problem.measurement_time + 24.0) / 3.0


def test_a_sharper_sensor_than_specified_shortens_the_forecast() -> None:
    made = task()
    said = [[towards(0.0, -20.0, (200.0, 80.0), sigma=sigma)] for sigma in (1.0, 7.0)]
    belief = made.planning_belief(made.planner_bearings(said[1]))

    sharp, blunt = (cost_of(made, belief, seen, (0.0, -20.0), (150.0, -30.0)).mean_s for seen in said)

    assert sharp is not None
    assert blunt is not None
    assert sharp < 0.8 * blunt


@given(arrays(np.float64, st.integers(1, 60), elements=st.floats(1.0, 5e3)))
def test_the_time_in_nine_of_ten_holds_for_nine_of_ten_and_is_never_below_the_mean(times: np.ndarray) -> None:
    bound = in_nine_of_ten(times)
    assert bound is not None
    assert bound >= times.mean()
    assert np.mean(times <= bound * (1 + 1e-12)) >= 0.9 - 1 / len(times)


def test_a_few_lost_searches_do_not_put_the_mean_above_the_time_in_nine_of_ten() -> None:
    assert in_nine_of_ten(np.array([60.0] * 19 + [3000.0])) == 207.0
    assert in_nine_of_ten(np.array([])) is None


def test_the_time_in_nine_of_ten_knows_of_what_no_rollout_simulates() -> None:
    assert in_nine_of_ten(np.linspace(50.0, 150.0, 101)) == pytest.approx(1.25 * 140.0)


def test_turns_to_come_take_as_long_as_those_still_looked_for_ask() -> None:
    """A narrow receiver goes round once for each group; what is found is not turned for any more."""
    tags = [
        EmitterSpec(emitter_id=f"tag-{k}", frequency_hz=150e6 + 1e5 * k, kind="pulsed", label=f"tag {k}")
        for k in range(4)
    ]
    narrow = task(emitters=tags, sensor=SensorSpec(receiver_band_hz=25e3, measurement_time_s=45.0))
    flown = towards(0.0, -20.0, (200.0, 80.0)).model_copy(update={"measurement_time_s": 200.0})
    all_s, one_s = (turn_s(narrow.mission, wanted) for wanted in ((), ["tag-3"]))
    assert one_s < all_s / 3
    last = narrow.turning_for(["tag-3"])
    belief = last.planning_belief(last.planner_bearings([flown]))
    assert foreseen_for(last, [flown], belief).measurement_time == one_s
    still_all = narrow.turning_for([tag.emitter_id for tag in tags])
    assert foreseen_for(still_all, [flown], belief).measurement_time == (all_s + 200.0) / 2.0
