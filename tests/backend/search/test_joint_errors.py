"""A mission whose bearings' errors are estimated with the place, and one that does not name a model of them."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from facts import rejected
from ground import AREA, FRAME, HOME, towards

from backend.events import BearingMeasured, BeliefUpdated, PersonSource, SilenceFact, SweepRejected
from backend.reasons.search import BearingsCorrected
from backend.search.lessons import errors_now
from backend.search.localization import Localization, localization
from backend.search.machine import SearchStep, doubt_headings
from backend.search.planner_bearings import source_name
from backend.search.planning import ECHOES_AHEAD, foreseen, foreseen_for
from backend.search.source_priors import priors_of, unknown_errors
from backend.search.state import SearchState
from backend.spec import MissionSpec, Polygon, SensorSpec
from hardware.direction_finding.circle import SweepLikelihood
from hardware.readings import Place
from planner.belief.estimate import mass_within
from planner.belief.joint import JointBelief

TARGET = (120.0, 60.0)
AROUND = ((60.0, -40.0), (180.0, -40.0), (200.0, 100.0), (40.0, 110.0), (120.0, 160.0), (10.0, 20.0))


def task(**sensor: object) -> Localization:
    return localization(MissionSpec(name="m", area=AREA, sensor=SensorSpec.model_validate(sensor)), HOME)


JOINT = task(bearing_errors="joint")


def turned(degrees: float, count: int = 6) -> list[BearingMeasured]:
    """Bearings with 2 degrees of their own and a heading that is stated to be good to 4."""
    exact = [towards(x, y, TARGET, sigma=math.hypot(2.0, 4.0)) for x, y in AROUND[:count]]
    return [
        b.model_copy(update={"bearing_deg": (b.bearing_deg + degrees) % 360.0, "heading_sigma_deg": 4.0}) for b in exact
    ]


@pytest.mark.parametrize("heading_deg", [4.0, 5.0])
def test_a_bearing_whose_shares_leave_nothing_of_its_own_counts_with_the_smallest_sigma(heading_deg: float) -> None:
    """The planner knows no bearing without a sigma: the mission could not be folded any more."""
    crossing = [towards(x, y, TARGET, sigma=4.0) for x, y in AROUND[:3]]
    with_shares = [b.model_copy(update={"heading_sigma_deg": heading_deg}) for b in crossing]
    with_a_degree = [b.model_copy(update={"heading_sigma_deg": math.sqrt(15.0)}) for b in crossing]
    (nothing_left, _), (a_degree, _) = JOINT.belief_fact(with_shares), JOINT.belief_fact(with_a_degree)
    assert nothing_left.estimate is not None
    assert nothing_left.estimate == a_degree.estimate


def test_a_mission_that_names_no_model_is_what_it_was() -> None:
    bare = {"name": "m", "area": AREA.model_dump(mode="json")}
    stored = MissionSpec.model_validate(bare)
    assert stored.sensor.bearing_errors == "independent"
    assert not isinstance(localization(stored, HOME).prior, JointBelief)
    assert json.loads(stored.model_dump_json())["sensor"]["bearing_errors"] == "independent"


def with_echo(fact: BearingMeasured) -> BearingMeasured:
    """The strongest peak is an echo 90 degrees clockwise; the sweep knows of the direct way."""
    echo_deg = (fact.bearing_deg + 90.0) % 360.0
    both = np.logaddexp(
        SweepLikelihood.normal(echo_deg, 2.0).log_likelihood,
        SweepLikelihood.normal(fact.bearing_deg, 2.0).log_likelihood - 0.1,
    )
    return fact.model_copy(update={"bearing_deg": echo_deg, "likelihood": SweepLikelihood.of(both).packed()})


def test_a_mission_takes_of_a_sweep_what_its_specification_says() -> None:
    """A stored one that does not say it: the peak, so that old journals fold to the same belief."""
    seen = turned(0.0, 3)
    echoed = [with_echo(seen[0]), *seen[1:]]
    bare = [b.model_copy(update={"likelihood": None}) for b in echoed]
    peak, whole = task(bearing_errors="joint"), task(bearing_errors="joint", sweep_evidence="whole")
    assert SensorSpec.model_validate({"bearing_errors": "joint"}).sweep_evidence == "peak"
    assert peak.belief_fact(echoed)[0].digest == peak.belief_fact(bare)[0].digest == whole.belief_fact(bare)[0].digest
    (fact, _) = whole.belief_fact(echoed)
    assert fact.estimate is not None
    assert math.dist(FRAME.to_enu(Place(lat=fact.estimate.lat, lon=fact.estimate.lon)), TARGET) < 8.0
    damaged = [echoed[0].model_copy(update={"likelihood": "no likelihood"}), *echoed[1:]]
    assert whole.belief_fact(damaged)[0].digest == peak.belief_fact(bare)[0].digest
    independent = task(sweep_evidence="whole")
    assert independent.belief_fact(echoed)[0].digest == task().belief_fact(bare)[0].digest


def silence(x: float, y: float, sectors: tuple[int, ...] = tuple(range(16))) -> SweepRejected:
    """Heard nothing with an antenna that hears ahead only, while it pointed to these sectors, clockwise from north."""
    told = SilenceFact(
        chances=[5.0 if k in sectors else 0.0 for k in range(16)],
        gain_db=[0.0 if min(k, 36 - k) <= 4 else -40.0 for k in range(36)],
    )
    return rejected(1, int(x + y)).model_copy(update={"place": FRAME.to_geo(x, y), "silence": told})


def wide() -> Localization:
    """Two kilometres square about the home."""
    corners = [FRAME.to_geo(x, y) for x, y in ((-1e3, -1e3), (1e3, -1e3), (1e3, 1e3), (-1e3, 1e3), (-1e3, -1e3))]
    area = Polygon(coordinates=[[(c.lon, c.lat) for c in corners]])
    return localization(MissionSpec(name="m", area=area, sensor=SensorSpec(bearing_errors="joint")), HOME)


def mass_near(task_: Localization, x: float, y: float, reach_m: float = 100.0) -> float:
    return mass_within(task_.planning_belief(()), x, y, reach_m)


def test_what_was_not_heard_makes_places_less_likely_where_the_antenna_pointed() -> None:
    before = wide()
    all_round, east = before.after([silence(0.0, 0.0)]), before.after([silence(0.0, 0.0, sectors=(3, 4, 5))])
    assert mass_near(all_round, 0.0, 0.0) < 0.4 * mass_near(before, 0.0, 0.0)
    assert mass_near(all_round, 800.0, 0.0) > mass_near(before, 800.0, 0.0)
    assert mass_near(east, 150.0, 0.0) < 0.6 * mass_near(before, 150.0, 0.0)
    for x, y in ((-150.0, 0.0), (0.0, 200.0), (0.0, -200.0)):
        assert mass_near(east, x, y) > 0.95 * mass_near(before, x, y)


def test_silence_counts_with_bearings_in_any_order_of_calls_and_gives_way_to_them() -> None:
    seen, quiet = turned(0.0), [silence(*TARGET)]
    heard = JOINT.after(quiet)
    assert heard.after([]) is heard
    digests = [task(bearing_errors="joint").after(quiet).belief_fact(seen)[0].digest, heard.belief_fact(seen)[0].digest]
    assert digests[0] == digests[1] != JOINT.belief_fact(seen)[0].digest
    assert JOINT.after(quiet).belief_fact(seen[:3])[0].digest == heard.belief_fact(seen[:3])[0].digest
    found = heard.belief_fact(seen)[0].estimate
    assert found is not None
    assert math.dist(FRAME.to_enu(Place(lat=found.lat, lon=found.lon)), TARGET) < 6.0


def test_silence_tells_nothing_where_errors_are_independent_or_the_turn_says_not_what_it_listened_to() -> None:
    assert task().after([silence(*TARGET)]).belief_fact(turned(0.0))[0] == task().belief_fact(turned(0.0))[0]
    bare = silence(*TARGET).model_copy(update={"silence": None})
    assert JOINT.after([bare]) is JOINT


def test_a_turned_compass_is_found_used_and_said_clockwise() -> None:
    fact, belief = JOINT.belief_fact(turned(11.0))
    (errors,) = fact.sources
    assert isinstance(belief, JointBelief)
    assert errors.source == turned(0.0)[0].source
    assert errors.bias_deg == pytest.approx(11.0, abs=2.0)
    assert errors.bias_std_error_deg < 2.5
    assert fact.localized
    assert fact.heading_offset_deg is None
    assert fact.estimate is not None
    assert math.dist(FRAME.to_enu(Place(lat=fact.estimate.lat, lon=fact.estimate.lon)), TARGET) < 4.0
    blocked, _ = task().belief_fact(turned(11.0))
    assert not blocked.localized
    assert blocked.sources == []


def test_the_same_bearings_give_the_same_belief() -> None:
    seen = turned(4.0)
    grown = [JOINT.belief_fact(seen[:count])[0].digest for count in range(1, 7)]
    assert [task(bearing_errors="joint").belief_fact(seen[:count])[0].digest for count in (6, 3)] == [
        grown[5],
        grown[2],
    ]


def test_a_person_and_a_craft_are_wrong_each_in_their_own_way() -> None:
    person = PersonSource(name="Ada")
    by_hand = [b.model_copy(update={"source": person, "bearing_id": f"p{k}"}) for k, b in enumerate(turned(-9.0))]
    fact, _ = JOINT.belief_fact([*turned(8.0), *by_hand])
    craft, hand = fact.sources
    assert (craft.bias_deg > 4.0, hand.bias_deg < -4.0) == (True, True)
    assert hand.source == person
    assert source_name(person) != source_name(craft.source)


def test_a_large_bias_is_a_caution_that_says_it_is_used() -> None:
    for degrees, expected in ((0.0, []), (12.0, [BearingsCorrected])):
        fact, _ = JOINT.belief_fact(turned(degrees))
        step = SearchStep(SearchState(), 0.0)
        doubt_headings(step, fact)
        assert [type(alert.reason) for alert in step.state.open_alerts] == expected


def test_the_sigma_to_come_is_their_own_and_what_is_open_of_the_bias() -> None:
    seen = turned(5.0)
    belief = JOINT.planning_belief(JOINT.planner_bearings(seen))
    few = JOINT.planning_belief(JOINT.planner_bearings(seen[:1]))
    plain = foreseen(JOINT.problem, seen)
    assert foreseen(JOINT.problem, seen, belief).sigma < 0.8 * plain.sigma
    assert foreseen(JOINT.problem, seen[:1], few).sigma > foreseen(JOINT.problem, seen, belief).sigma
    assert foreseen(JOINT.problem, (), JOINT.prior).sigma == pytest.approx(JOINT.problem.sigma)


def test_a_place_told_by_its_way_too_is_worth_two_turns_that_share_the_compass() -> None:
    swinging = task(bearing_errors="joint", listen_on_the_way=True, swing_on_the_way=True)
    seen = turned(5.0)
    first = foreseen_for(swinging, (), JOINT.prior).sigma
    assert first == pytest.approx(JOINT.problem.sigma)
    never_stopping = task(
        bearing_errors="joint", listen_on_the_way=True, swing_on_the_way=True, sector_turns=True, never_stop=True
    )
    for not_both in (JOINT, never_stopping):
        assert foreseen_for(not_both, (), JOINT.prior).sigma == ECHOES_AHEAD * first
    told = seen[0].model_copy(update={"source": PersonSource(name="Ada")})
    reported = JOINT.planning_belief(JOINT.planner_bearings([told]))
    assert foreseen_for(JOINT, [told], reported).sigma == ECHOES_AHEAD * foreseen(JOINT.problem, [told], reported).sigma
    for measured in (seen[:1], seen):
        belief = JOINT.planning_belief(JOINT.planner_bearings(measured))
        turn, place = (foreseen_for(one, measured, belief).sigma for one in (JOINT, swinging))
        assert turn / math.sqrt(2.0) < place < turn
        assert foreseen(swinging.problem, measured, belief).sigma == turn
    unheard = task(bearing_errors="joint", listen_on_the_way=False, swing_on_the_way=True)
    assert foreseen_for(unheard, seen, belief).sigma == turn
    tag = swinging.mission.emitters[0].model_copy(update={"kind": "pulsed"})
    pulsed = localization(swinging.mission.model_copy(update={"emitters": [tag]}), HOME)
    assert foreseen_for(pulsed, seen, belief).sigma == turn
    assert foreseen_for(pulsed, (), JOINT.prior).sigma == first
    assert isinstance(belief, JointBelief)
    (errors,) = belief.errors
    own = [math.sqrt(sigma**2 - errors.bias_sd**2) for sigma in (turn, place)]
    assert own[1] == pytest.approx(own[0] / math.sqrt(2.0))


def test_what_a_person_errs_by_says_nothing_of_the_craft_that_measures_next() -> None:
    seen = turned(5.0)
    last, first = seen[-1], seen[:-1]
    told = last.model_copy(
        update={"source": PersonSource(name="Ada"), "bearing_deg": (last.bearing_deg + 60.0) % 360.0, "sigma_deg": 20.0}
    )
    of_others = JOINT.planning_belief(JOINT.planner_bearings([*first, told]))
    assert foreseen(JOINT.problem, [*first, told], of_others).sigma == foreseen(JOINT.problem, first, of_others).sigma
    only_told = JOINT.planning_belief(JOINT.planner_bearings([told]))
    assert foreseen(JOINT.problem, [told], only_told).sigma == pytest.approx(JOINT.problem.sigma)


def test_a_specification_of_before_has_the_priors_of_before() -> None:
    """Outliers were taken to be half or twice as frequent as specified."""
    for specified, rates in ((0.1, [0.05, 0.2]), (0.5, [0.25, 0.6]), (0.0, [0.01])):
        known, otherwise = priors_of(SensorSpec(outlier_probability=specified, bearing_errors="joint"))
        assert known == {}
        assert otherwise.rate == pytest.approx(rates)
        assert otherwise.scale == pytest.approx([0.7, 1.0, 1.45])


@pytest.mark.parametrize("errors", ["independent", "joint"])
@pytest.mark.parametrize("outliers", [5e-324, 1e-300, 1e-100])
def test_outliers_that_are_next_to_impossible_leave_a_belief_of_numbers(errors: str, outliers: float) -> None:
    """Bearings that contradict each other are then next to impossible, too, and the belief says where it can."""
    sensor = SensorSpec.model_validate({"bearing_errors": errors, "outlier_probability": outliers})
    if errors == "joint":
        sensor = sensor.model_copy(update={"learned": errors_now((), sensor, "craft-1", "yagi")})
    found = localization(MissionSpec(name="m", area=AREA, sensor=sensor), HOME)
    apart = [b.model_copy(update={"bearing_deg": (b.bearing_deg + 70.0 * k) % 360.0}) for k, b in enumerate(turned(0))]
    for measured in (apart[:3], apart, [*apart, *apart[:4]]):
        fact, belief = found.belief_fact(measured)
        assert belief.density.sum() == pytest.approx(1.0)
        assert fact.estimate is not None
        assert math.isfinite(fact.estimate.expected_rmse_m)


def test_nothing_learned_yet_has_about_the_mean_rate_that_is_specified() -> None:
    for specified in (0.05, 0.1, 0.25):
        unknown = unknown_errors(specified)
        assert unknown.rate @ unknown.rate_weight == pytest.approx(1.1 * specified, rel=0.1)
    assert unknown_errors(0.5).rate.max() < 1.0
    assert len(unknown_errors(0.0).rate) == 1


def test_a_belief_of_before_has_no_sources() -> None:
    fact, _ = task().belief_fact(turned(0.0))
    stored = json.loads(fact.model_dump_json())
    del stored["sources"]
    assert BeliefUpdated.model_validate(stored) == fact
