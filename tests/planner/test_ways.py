"""The shortest ways of a network, and a problem whose platform has no others."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csgraph

from planner.belief.grid import prior_belief
from planner.options import PlannerOptions
from planner.plan import plan
from planner.types import LinearMotion, Problem
from planner.ways import ways_from

# a square of 100 m, its west side missing, and a node that nothing leads to
NODES = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [50.0, 50.0]])
STRETCHES = np.array([[0, 1], [1, 2], [2, 3], [3, 2], [1, 1]])
LENGTHS = np.array([100.0, 100.0, 100.0, 140.0, 0.0])


def made():
    return ways_from(0, NODES, STRETCHES, LENGTHS, np.array([2, 3, 4]))


def test_a_place_that_nothing_leads_to_is_no_place() -> None:
    assert made().places.tolist() == [[100.0, 100.0], [0.0, 100.0]]


def test_ways_are_as_long_as_their_stretches_and_of_two_the_shorter_counts() -> None:
    ways = made()
    assert ways.to(ways.places).tolist() == [200.0, 300.0]
    assert ways.between(ways.places).tolist() == [[0.0, 100.0], [100.0, 0.0]]
    assert ways.path(0.0, 100.0).tolist() == NODES[:4].tolist()


def test_the_planner_chooses_among_the_places_that_are_reached_and_counts_the_whole_way() -> None:
    square = np.array([[30.0, 30.0], [70.0, 30.0], [70.0, 70.0], [30.0, 70.0]])
    straight = Problem((square,), sigma=0.1, threshold=8.0, measurement_time=1.0, motion=LinearMotion(5.0))
    problem = replace(straight, ways=made())
    options = PlannerOptions(base_policy="fisher", budget=60)
    found = plan(problem, prior_belief(problem), (), (0.0, 0.0), options, threads=1)
    assert {(one.x, one.y) for one in found.candidates} <= {(100.0, 100.0), (0.0, 100.0)}
    assert (found.x, found.y) == (100.0, 100.0), "the other one is three sides away, not one"
    assert found.times.min() == pytest.approx(200.0 / 5.0 + 1.0), "by two sides, not across"


def test_one_place_is_searched_from_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search holds the interpreter: a hundred in one call kept an abort waiting for seconds."""
    asked: list[int] = []
    search = csgraph.dijkstra

    def counted(network: Any, **how: Any) -> Any:
        asked.append(np.size(how["indices"]))
        return search(network, **how)

    ways = made()
    monkeypatch.setattr(csgraph, "dijkstra", counted)
    ways.between(ways.places)
    assert asked == [1, 1]
