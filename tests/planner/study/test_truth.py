"""The truth study: seeded worlds with errors of their own, whole missions, honest counting."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.verdict import MOST_BEYOND
from planner.shares import wilson
from planner.study.error_worlds import ROWS, Row, Sensor, Wall
from planner.study.errors import StudyError
from planner.study.truth import Claim, Search, fly, missions, row_named, told, truth_of
from planner.types import LinearConstantMotion, LocalizationRule, Problem

AREA = np.array([[-156.0, 0.0], [156.0, 0.0], [156.0, 200.0], [-156.0, 200.0]])
PROBLEM = Problem(
    area=(AREA,),
    sigma=float(np.deg2rad(7.0)),
    threshold=25.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    standoff=50.0,
    action_spacing=30.0,
)
SEARCH = Search(PROBLEM, LocalizationRule(threshold=25.0), (0.0, 0.0))
WANTED = {"independent", "bias5", "bias10", "bias5_outliers8", "bias5_outliers20", "walls", "walls_bias5"} | {
    "squinted",
    "uneven",
    "foreign",
    "creeping",
    "jumping",
    "two_sources",
}


def seeded(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def errors(sensor: Sensor, count: int = 2000) -> np.ndarray:
    place = np.array([40.0, -30.0])
    true = np.arctan2(*(sensor.target - place)[::-1])
    found = np.array([sensor.bearing(place, k)[0] for k in range(count)])
    return np.rad2deg((found - true + np.pi) % (2 * np.pi) - np.pi)


def test_every_row_that_is_asked_for_exists_and_no_other():
    assert set(ROWS.by_name) >= WANTED
    with pytest.raises(StudyError, match="bias5_outliers8"):
        row_named("bias6")


def test_bearings_of_a_flight_share_its_bias_and_flights_differ_by_the_rows():
    target, row = np.array([0.0, 150.0]), Row("b", bias_sd=np.deg2rad(5.3))
    sensors = [row.sensor(target, np.random.default_rng(k)) for k in range(400)]
    assert np.rad2deg(np.std([s.bias for s in sensors])) == pytest.approx(5.3, rel=0.1)
    wrong = errors(sensors[0])
    assert wrong.mean() == pytest.approx(np.rad2deg(sensors[0].bias), abs=0.4)
    assert wrong.std() == pytest.approx(5.3, rel=0.1)


def test_outliers_come_from_anywhere_as_often_as_the_row_says():
    sensor = Row("o", outliers=0.2, own_sd=np.deg2rad(1.0)).sensor(np.array([0.0, 150.0]), np.random.default_rng(1))
    wrong = np.abs(errors(sensor, 4000))
    assert (wrong > 5.0).mean() == pytest.approx(0.2 * 350.0 / 360.0, abs=0.02)


def test_a_wall_bends_bearings_where_its_echo_arrives_and_not_elsewhere():
    quiet = Row("w", own_sd=0.0, walls=0).sensor(np.array([0.0, 150.0]), np.random.default_rng(1))
    assert np.abs(errors(quiet, 3)).max() < 1e-9
    quiet.walls = (Wall(np.array([60.0, 0.0]), np.array([60.0, 160.0])),)
    mirrored = errors(quiet, 60)
    assert 2.0 < np.abs(mirrored).max() < 60.0
    quiet.walls = (Wall(np.array([400.0, 400.0]), np.array([500.0, 400.0])),)
    assert np.abs(errors(quiet, 3)).max() < 0.5


@pytest.mark.parametrize(("antenna", "off"), [("measured", 0.0), ("squinted", 10.0), ("uneven", 7.5)])
def test_another_antenna_turns_all_its_bearings_by_one_angle(antenna, off):
    wrong = errors(Row("a", own_sd=0.0, antenna=antenna, walls=1).sensor(np.array([0.0, 150.0]), seeded(1)), 20)
    alone = errors(Row("a", own_sd=0.0, antenna=antenna).sensor(np.array([0.0, 150.0]), seeded(1)), 20)
    assert alone == pytest.approx(np.full(20, off), abs=0.5)
    assert np.median(wrong) == pytest.approx(off, abs=3.0)


def test_places_creep_away_or_jump_for_one_bearing():
    target = np.array([0.0, 150.0])
    creeping = [Row("c", own_sd=0.0, placing="creeping").sensor(target, seeded(k)) for k in range(60)]
    early, late = (np.std([errors(sensor, count)[-1] for sensor in creeping]) for count in (1, 12))
    assert late > 2.0 * early > 0.0
    jumps = np.abs(errors(Row("j", own_sd=0.0, placing="jumping").sensor(target, seeded(1)), 500)) > 1e-6
    assert jumps.mean() == pytest.approx(0.2, abs=0.05)


def test_two_sources_take_turns_and_each_has_its_own_bias():
    sensor = Row("t", bias_sd=np.deg2rad(5.3), own_sd=0.0, sources=2).sensor(np.array([0.0, 150.0]), seeded(3))
    wrong = errors(sensor, 6)
    assert sensor.other is not None
    assert wrong[::2] == pytest.approx(np.full(3, np.rad2deg(sensor.bias)))
    assert wrong[1::2] == pytest.approx(np.full(3, np.rad2deg(sensor.other.bias)))
    assert abs(wrong[0] - wrong[1]) > 0.1
    assert fly(SEARCH, row_named("two_sources"), 3).bearings >= 2


def test_a_mission_depends_on_its_seed_and_on_nothing_else():
    row = row_named("bias5_outliers8")
    one, again, other = (fly(SEARCH, row, seed) for seed in (7, 7, 8))
    assert one == again != other
    assert one.claimed
    assert one.bearings >= 2
    assert one.time_s > one.bearings * 30.0


@pytest.mark.parametrize("model", ["joint", "independent"])
def test_all_missions_of_a_right_sensor_are_claimed(model):
    claims = list(missions(SEARCH, row_named("right"), range(4), model))
    found = truth_of("right", model, claims)
    assert all(claim.rms_m < 1.5 * claim.stated_m for claim in claims)
    if model == "independent":
        assert all(claim.stated_m < claim.rms_m for claim in claims)
    else:
        assert all(claim.stated_m <= SEARCH.problem.threshold for claim in claims)
        assert 0.0 < max(claim.far_chance for claim in claims) <= MOST_BEYOND
    assert (found.missions, found.claimed) == (4, 1.0)
    assert found.in_c95_low < found.in_c95 <= 1.0
    assert (found.as_json()["bias_inside"] is None) == (model == "independent")


def test_a_mission_that_never_claims_is_counted_as_such_and_ends():
    hopeless = replace(SEARCH, rule=LocalizationRule(threshold=0.01), most_bearings=3)
    found = truth_of("bias5", "joint", [fly(hopeless, row_named("bias5"), 1)])
    assert (found.claimed, found.bearings_mean) == (0.0, 3.0)
    assert found.as_json()["in_c95"] is None


def test_what_a_search_is_told_is_what_the_row_draws_from():
    prior = told(row_named("bias5_outliers20"))
    assert np.rad2deg(prior.bias_sd) == pytest.approx(5.3)
    assert (prior.scale.tolist(), prior.rate.tolist()) == ([1.0], [0.2])
    right = told(row_named("right"))
    assert right.scale[0] == pytest.approx(1.2 / 2.5)
    assert (0.0 < right.bias_sd < np.deg2rad(0.5), 0.0 < right.rate[0] < 0.01) == (True, True)
    with pytest.raises(StudyError, match="walls"):
        told(row_named("walls"))


def test_shares_are_of_the_claims():
    claim = Claim(1, True, True, 5.0, 10.0, 12.0, 0.01, 4, 300.0, 1.0, 2.0)
    far = replace(claim, seed=2, in_c95=False, error_m=31.0, far_chance=0.04, bias_off_deg=5.0)
    never = replace(claim, seed=3, claimed=False, in_c95=False, error_m=99.0, far_chance=0.9)
    found = truth_of("bias5", "joint", [claim, far, never, replace(claim, seed=4)])
    assert found.claimed == 0.75
    assert found.in_c95 == pytest.approx(2.0 / 3.0)
    assert found.beyond_3x == pytest.approx(1.0 / 3.0)
    assert (found.beyond_low, found.beyond_high) == wilson(1, 3)
    assert found.beyond_believed == pytest.approx(0.02)
    assert found.beyond_seeds == (2,)
    assert found.beyond_3rms == 0.0
    assert truth_of("bias5", "joint", [replace(far, error_m=37.0)]).beyond_3rms == 1.0
    assert found.bias_inside == 0.75


def test_tags_of_one_mission_hang_together():
    """Whoever misses with one misjudged compass three tags of four knows no more than of one."""
    claim = Claim(1, True, True, 5.0, 10.0, 12.0, 0.01, 4, 300.0, 1.0, 2.0)
    tags = [replace(claim, seed=seed) for seed in range(1, 13) for _ in range(4)]
    together = [replace(one, in_c95=number not in (0, 1, 2, 4)) for number, one in enumerate(tags)]
    apart = [replace(one, in_c95=number not in (0, 4, 8, 12)) for number, one in enumerate(tags)]
    found, spread = truth_of("tags_4", "joint", together), truth_of("tags_4", "joint", apart)
    assert (found.missions, found.in_c95) == (12, spread.in_c95) == (12, pytest.approx(44 / 48))
    assert (spread.in_c95_low, spread.in_c95_high) == pytest.approx(wilson(44, 48))
    between = np.sqrt(12 / 11 * ((3 - 1 / 3) ** 2 + (1 - 1 / 3) ** 2 + 10 / 9)) / 48
    trials = found.in_c95 * (1.0 - found.in_c95) / between**2
    assert (found.in_c95_low, found.in_c95_high) == pytest.approx(wilson(found.in_c95 * trials, trials))
    assert found.in_c95_low < spread.in_c95_low
