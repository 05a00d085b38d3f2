"""Values of the bias that a belief leaves nothing are weighed no more, and what it says stays the same."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from planner.belief import compiled_evidence, joint
from planner.belief.evidence import sightings
from planner.belief.grid import digest
from planner.belief.joint import JointBelief, heard_on_the_way, joint_prior, settled, update_joint
from planner.belief.source_errors import EVEN_STEP, ErrorPrior
from planner.types import Bearing
from tests.planner.belief.test_seen_on_the_way import CRAFT, PROBLEM, SIGMA, TARGET, heard_along

ALONG = (*heard_along((20.0, 60.0), (20.0, 180.0)), *heard_along((60.0, 280.0), (180.0, 280.0), leg="other"))


def around(errors_deg: Sequence[float]) -> list[Bearing]:
    """From places around the emitter, each off by so much."""
    found: list[Bearing] = []
    for k, error in enumerate(errors_deg):
        x, y = 150.0 + 120.0 * math.cos(2.4 * k), 150.0 + 120.0 * math.sin(2.4 * k)
        angle = math.atan2(TARGET[1] - y, TARGET[0] - x) + math.radians(error)
        found.append(Bearing(x, y, angle, SIGMA, source=CRAFT))
    return found


def believed(
    bearings: Sequence[Bearing], otherwise: ErrorPrior = joint.UNKNOWN_SOURCE
) -> tuple[JointBelief, JointBelief]:
    """By the bearings alone, and with what was heard on the way."""
    belief = joint_prior(PROBLEM, otherwise=otherwise)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return belief, heard_on_the_way(belief, ALONG)


@pytest.mark.parametrize(
    "errors_deg",
    [
        pytest.param((6.0, 7.0, 4.0, 8.0, 6.0, 5.0, 7.0, 6.0, 3.0, 6.0), id="a compass that is off"),
        pytest.param((1.0, -60.0, 2.0, -1.0, 140.0, 0.0, -2.0, 1.0, 90.0, 0.0, 1.0), id="with outliers"),
        pytest.param((16.0,) * 6 + (-3.0,) * 7, id="taken for off by much, until more say otherwise"),
    ],
)
def test_a_belief_is_the_same_as_over_all_values(
    errors_deg: tuple[float, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    few = believed(around(errors_deg))
    monkeypatch.setattr(joint, "_still_possible", lambda grid, *_: grid)
    (alone, ours), (all_alone, all_of_them) = few, believed(around(errors_deg))
    assert digest(alone) == digest(all_alone)
    assert (alone.errors[0].bias_mass == all_alone.errors[0].bias_mass).all()
    (ours_of, of_all) = ours.errors[0], all_of_them.errors[0]
    assert len(ours_of.nodes.bias) < len(of_all.nodes.bias)
    assert ours.bounds == all_of_them.bounds
    assert 0.5 * np.abs(ours.density - all_of_them.density).sum() < 1e-6
    assert (ours_of.bias, ours_of.bias_sd) == pytest.approx((of_all.bias, of_all.bias_sd), abs=1e-6)
    assert ours_of.outlier_rate == pytest.approx(of_all.outlier_rate, abs=1e-6)


def test_a_compass_that_changes_for_good_is_found_out_again() -> None:
    """Of a sensor that is taken to have hardly any outliers: each bearing more speaks for a value of the bias that the
    first ones had all but excluded by a hundred thousand."""
    errors_deg = (11.0,) * 6 + (-12.0,) * 8
    few_outliers = replace(ErrorPrior(), rate=np.array([0.003]), rate_weight=np.ones(1))
    sharp = [replace(one, sigma=math.radians(2.0)) for one in around(errors_deg)]
    alone, heard = believed(sharp, few_outliers)
    assert math.degrees(alone.errors[0].bias) == pytest.approx(-12.0, abs=1.0)
    whole = joint.error_nodes(few_outliers, sharp, ())
    x, y, log = joint.places_besides(alone, CRAFT)
    told = compiled_evidence.evidence(x, y, sightings(sharp), whole)
    mass = np.exp(log + told.log - (log + told.log).max())
    assert alone.errors[0].bias == pytest.approx(float(mass @ told.bias @ whole.bias / mass.sum()), abs=1e-3)
    assert len(heard.errors[0].nodes.bias) < len(joint.error_nodes(few_outliers, sharp, ALONG).bias)


def test_a_compass_that_is_off_by_something_else_on_the_way_leaves_nothing_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its bearings allow for a few degrees only; many stretches say so."""
    turned = [
        replace(one, front=tuple(np.array(one.front) + math.radians(20.0)))
        for leg in range(3)
        for one in heard_along((20.0, 40.0 + leg), (20.0, 260.0 + leg), leg=str(leg))
    ]
    belief, _ = believed(around((4.0,) * 12))
    ours = heard_on_the_way(belief, turned)
    monkeypatch.setattr(joint, "_still_possible", lambda grid, *_: grid)
    all_of_them = settled(replace(belief, stretches=tuple(turned)))
    assert digest(ours) == digest(all_of_them)
    assert ours.errors[0].bias == all_of_them.errors[0].bias


def test_a_belief_that_does_not_know_a_bearing_yet_bounds_nothing() -> None:
    """Stretches may be there before the bearing is."""
    *known, last = around((6.0, 7.0, 4.0, 8.0, 6.0, 5.0, 7.0, 6.0))
    _, heard = believed(known)
    after = update_joint(heard, last)
    assert len(after.errors[0].nodes.bias) == len(joint.error_nodes(joint.UNKNOWN_SOURCE, [*known, last], ALONG).bias)


def test_what_is_left_of_the_range_begins_at_a_whole_step() -> None:
    """Stretches are weighed there: the same values of the bias, whatever else was left out."""
    bearings = around((6.0, 7.0, 4.0, 8.0, 6.0, 5.0, 7.0, 6.0))
    belief, heard = believed(bearings)
    whole = joint.error_nodes(belief.prior_of(CRAFT), bearings, ALONG)
    steps = (heard.errors[0].nodes.bias[0] - whole.bias[0]) / EVEN_STEP
    assert steps > 1.0
    assert steps == pytest.approx(round(steps))


def test_a_source_that_has_told_nothing_yet_may_be_off_by_anything() -> None:
    belief = joint_prior(PROBLEM)
    (first,) = around((0.0,))
    first = replace(first, source="another")
    assert len(update_joint(belief, first).errors[0].nodes.bias) == len(
        joint.error_nodes(belief.prior_of("another"), [first], ()).bias
    )
