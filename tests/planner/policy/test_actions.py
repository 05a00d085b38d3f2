"""The action space and what removes places from it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import refusing

from planner.belief.estimate import confidence_region
from planner.belief.grid import fold, prior_belief
from planner.geometry import contains, distance_to_convex
from planner.policy.actions import (
    OTHER_ECHOES_M,
    action_space,
    belief_grid,
    constrained_actions,
    lattice,
    with_own_echoes,
    without_refused,
)
from planner.policy.fisher import fisher
from planner.reasons import NoPlaceToFly, TooManyPlaces, UnusableNumber
from planner.types import Bearing, GaussianPrior, LinearMotion, Problem


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


PROBLEM = Problem((rectangle(0, 0, 300, 300),), np.deg2rad(4), 5.0, 10.0, LinearMotion(5.0))
FIELD = replace(
    PROBLEM,
    area=(rectangle(0, 0, 313, 120),),
    flight_area=(rectangle(-60, -60, 373, 180),),
    action_spacing=15.0,
    standoff=50.0,
)
TWO = [Bearing(150.0, -40.0, 1.5, 0.1), Bearing(0.0, 60.0, 0.1, 0.1)]


def test_places_are_cell_centres_of_the_tripled_belief_rectangle():
    places = belief_grid(PROBLEM, prior_belief(PROBLEM))
    assert places.shape == (400, 2)
    assert places[0].tolist() == [-277.5, -277.5]
    assert places[1].tolist() == [-232.5, -277.5]
    assert places[-1].tolist() == [577.5, 577.5]


def test_the_grid_is_cut_with_the_flight_area():
    places = belief_grid(replace(PROBLEM, flight_area=(rectangle(0, -50, 300, 300),)), prior_belief(PROBLEM))
    assert places.min(axis=0).tolist() == [7.5, -41.25]


def test_a_lattice_of_more_places_than_can_be_compared_is_refused():
    with refusing(TooManyPlaces):
        lattice(replace(FIELD, action_spacing=0.5))


def test_a_lattice_fills_the_fence_and_never_stands_on_it():
    places = lattice(FIELD)
    assert len(places) == 28 * 16
    assert np.ptp(places, axis=0).tolist() == [27 * 15, 15 * 15]
    assert FIELD.flight_area is not None
    assert contains(FIELD.flight_area, places).all()


def test_no_fly_areas_and_the_fence_remove_places():
    blocked = replace(FIELD, no_fly=(rectangle(100, 0, 200, 100),))
    places = action_space(blocked, prior_belief(blocked))
    assert not contains(blocked.no_fly, places).any()
    assert 0 < len(places) < len(lattice(FIELD))


def test_no_place_is_nearer_to_c95_than_the_standoff():
    belief = fold(FIELD, TWO)
    places = constrained_actions(FIELD, belief)
    assert distance_to_convex(places, confidence_region(belief)).min() >= 50.0


def test_before_the_first_bearing_an_area_alone_keeps_no_place_away():
    """Its C95 is where the emitter is looked for: whoever kept off it would turn outside, across the area and back."""
    prior = prior_belief(FIELD)
    assert constrained_actions(FIELD, prior).tolist() == action_space(FIELD, prior).tolist()
    thought_of = replace(FIELD, prior=GaussianPrior(150.0, 60.0, np.diag([400.0, 400.0])))
    region = confidence_region(prior_belief(thought_of))
    places = constrained_actions(thought_of, prior_belief(thought_of))
    assert distance_to_convex(places, region).min() >= 50.0, "of a place that somebody thinks of it does"


def test_after_a_turn_in_vain_the_first_bearing_is_taken_a_standoff_away():
    """It may have been made above the emitter."""
    prior, vain = prior_belief(FIELD), (150.0, 60.0)
    places = without_refused(action_space(FIELD, prior), [vain], FIELD, prior)
    assert np.hypot(*(places - vain).T).min() >= FIELD.standoff == 50.0
    belief = fold(FIELD, TWO)
    assert np.hypot(*(without_refused(action_space(FIELD, belief), [vain], FIELD, belief) - vain).T).min() < 50.0
    here = np.array([[150.0, 80.0], [150.0, 62.0]])
    assert without_refused(here, [vain], FIELD, prior).tolist() == here[:1].tolist(), "where no place is so far"


def test_a_place_shares_its_echoes_with_those_nearby():
    """A second bearing from there is off by the same, and belief and rollouts take it for another."""
    belief, turned_at = fold(FIELD, TWO), ((150.0, 60.0), (40.0, 20.0))
    places = action_space(FIELD, belief)
    left = with_own_echoes(places, replace(FIELD, turned_at=turned_at))
    away = np.min([np.hypot(*(places - place).T) for place in turned_at], axis=0)
    assert left.tolist() == places[away >= OTHER_ECHOES_M].tolist()
    assert len(left) < len(places)
    near = np.array([[150.0, 61.0], [150.0, 70.0], [41.0, 20.0]])
    furthest = with_own_echoes(near, replace(FIELD, turned_at=turned_at))
    assert furthest.tolist() == near[1:2].tolist(), "where all are near, the furthest"


def test_every_policy_leaves_the_echoes_of_places_where_it_turned():
    """The base policy, flown alone, turned at one place until its battery was empty: there a belief learns no more."""
    belief = fold(FIELD, TWO)
    best = fisher(FIELD, belief, (0.0, 0.0))
    other = fisher(replace(FIELD, turned_at=((best.x, best.y),)), belief, (0.0, 0.0))
    assert math.hypot(other.x - best.x, other.y - best.y) >= OTHER_ECHOES_M


def test_the_standoff_shrinks_until_two_places_are_left():
    tight = replace(FIELD, flight_area=(rectangle(120, 40, 200, 100),))
    places = constrained_actions(replace(tight, standoff=500.0), fold(tight, TWO))
    assert len(places) == 2


def test_the_standoff_shrinks_before_a_refused_place_or_known_echoes_are_all_that_is_left():
    """In a small area r_min leaves two places: after a turn in vain at both of them the search was over."""
    tight = replace(FIELD, flight_area=(rectangle(120, 40, 200, 100),), standoff=500.0)
    belief = fold(tight, TWO)
    refused = [(float(x), float(y)) for x, y in constrained_actions(tight, belief)]
    left = constrained_actions(tight, belief, lambda places: without_refused(places, refused, tight, belief))
    assert len(without_refused(left, refused, tight, belief)) == 2
    turned = replace(tight, turned_at=tuple(refused))
    left = constrained_actions(turned, belief, lambda places: with_own_echoes(places, turned))
    assert np.min([np.hypot(*(left - place).T) for place in refused]) >= OTHER_ECHOES_M


def test_when_everything_is_forbidden_that_is_said():
    forbidden = replace(FIELD, no_fly=(rectangle(-100, -100, 400, 200),))
    with refusing(NoPlaceToFly()):
        constrained_actions(forbidden, prior_belief(forbidden))


@pytest.mark.parametrize("changes", [{"action_spacing": 0.0}, {"action_spacing": np.nan}, {"action_grid": (0, 5)}])
def test_unusable_grids_are_refused(changes):
    broken = replace(PROBLEM, **changes)
    with refusing(UnusableNumber):
        action_space(broken, prior_belief(broken))


def test_a_gaussian_prior_triples_the_whole_areas_rectangle():
    gaussian = replace(PROBLEM, prior=GaussianPrior(150.0, 150.0, np.diag([100.0, 1600.0])))
    assert (belief_grid(gaussian, prior_belief(gaussian)) == belief_grid(PROBLEM, prior_belief(PROBLEM))).all()
