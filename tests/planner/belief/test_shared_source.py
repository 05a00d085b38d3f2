"""Several emitters and one compass: what each tells of it counts for the others, exactly and once."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief import compiled_evidence, evidence, shared_source
from planner.belief.compiled_tables import RESCALED_EVERY
from planner.belief.evidence import sightings
from planner.belief.grid import digest
from planner.belief.joint import JointBelief, heard_on_the_way, joint_prior, log_prior, places_besides, update_joint
from planner.belief.shared_source import common_nodes, common_source, node_evidence, told_by_others, with_shared_errors
from planner.detection import Silence
from planner.observation import wrap
from planner.on_the_way import Stretch
from planner.types import Bearing, LinearMotion, Peak, Problem
from tests.planner.belief.test_seen_on_the_way import heard_along

SIGMA = np.deg2rad(5.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=10.0, measurement_time=10.0, motion=LinearMotion(5.0))
TARGETS = ((160.0, 170.0), (90.0, 210.0), (230.0, 120.0))
PLACES = ((150.0, -40.0), (330.0, 60.0), (20.0, 320.0), (-30.0, 100.0))
BIAS = np.deg2rad(8.0)


def heard(target, rng, count, bias=BIAS, source="craft", sigma=SIGMA, aside=0.0):
    """Bearings of one emitter, the compass wrong by `bias` in all of them. aside: m, the places all moved eastward."""
    found = []
    for x, y in PLACES[:count]:
        x += aside
        direction = np.arctan2(target[1] - y, target[0] - x)
        found.append(
            Bearing(x, y, float(wrap(direction + bias + 0.5 * sigma * rng.standard_normal())), sigma, source=source)
        )
    return found


def alone(bearings, problem=PROBLEM, **known):
    belief = joint_prior(problem, **known)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return belief


def few_cells(bearings, size=6):
    """A belief of size x size cells about which nothing is left out."""
    prior = joint_prior(PROBLEM)
    mass = np.arange(1.0, size * size + 1.0).reshape(size, size)
    mass /= mass.sum()
    return replace(
        prior, prior=mass, density=mass, x0=0.0, y0=0.0, h=300.0 / size, folded=tuple(bearings), bearings=len(bearings)
    )


def each_by_node(belief, source, grid):
    """(c, k, e, b) p(x) p(bearings | x, errors), node by node with the plain sums; other sources summed over theirs."""
    rows, columns = np.nonzero(belief.prior)
    x, y = (along[index] for along, index in zip(belief.centres(), (columns, rows), strict=True))
    log = np.exp(log_prior(belief, belief.prior[rows, columns], x, y))
    one = np.ones(1)
    found = np.empty((len(x), *grid.weight.shape))
    own = sightings([b for b in belief.folded if b.source == source])
    for k, scale in enumerate(grid.scale):
        for e, rate in enumerate(grid.rate):
            for b, bias in enumerate(grid.bias):
                only = replace(
                    grid,
                    bias=one * bias,
                    bias_weight=one,
                    scale=one * scale,
                    scale_weight=one,
                    rate=one * rate,
                    rate_weight=one,
                )
                found[:, k, e, b] = log * np.exp(evidence.evidence(x, y, own, only).log)
    for other in {b.source for b in belief.folded} - {source}:
        seen = sightings([b for b in belief.folded if b.source == other])
        of_other = common_nodes([belief], other)
        found *= np.exp(evidence.evidence(x, y, seen, of_other).log)[:, None, None, None]
    return found


@pytest.mark.long
def test_places_of_all_emitters_and_the_errors_multiplied_out_are_what_each_emitter_is_told():
    rng = np.random.default_rng(3)
    hand = Bearing(310.0, 310.0, -2.2, 0.2, source="ada")
    beliefs = [
        few_cells(heard(TARGETS[0], rng, 2), 3),
        few_cells([*heard(TARGETS[1], rng, 2), hand], 4),
        few_cells(heard(TARGETS[2], rng, 1), 3),
    ]
    grid = common_nodes(beliefs, "craft")
    a, b, c = (each_by_node(belief, "craft", grid) for belief in beliefs)
    # P(x_1, x_2, x_3, n), every combination of the three places and the errors
    whole = np.einsum("iked,jked,lked,ked->ijlked", a, b, c, grid.weight)
    whole /= whole.sum()
    evidences = [node_evidence(belief, "craft", grid) for belief in beliefs]
    for own, told, axes in zip((a, b, c), told_by_others(evidences), ((1, 2), (0, 2), (0, 1)), strict=True):
        known = grid.knowing(told).weight
        left = slice(0, known.shape[2])
        if known.shape != grid.weight.shape:
            first = int(np.argmin(np.abs(grid.bias - grid.knowing(told).bias[0])))
            left = slice(first, first + known.shape[2])
        marginal = own[..., left] * known
        marginal /= marginal.sum()
        assert marginal == pytest.approx(whole.sum(axis=axes)[..., left], rel=2e-3, abs=1e-7)


def test_the_belief_after_sharing_is_the_marginal_over_its_own_cells():
    rng = np.random.default_rng(4)
    beliefs = [alone(heard(target, rng, 3)) for target in TARGETS]
    shared = with_shared_errors(beliefs)
    grid = common_nodes(beliefs, "craft")
    for index, (own, found) in enumerate(zip(beliefs, shared, strict=True)):
        others = np.sum([node_evidence(one, "craft", grid) for j, one in enumerate(beliefs) if j != index], axis=0)
        cells = replace(own, prior=found.prior, density=found.density, x0=found.x0, y0=found.y0, h=found.h)
        plain = each_by_node(cells, "craft", grid) * grid.weight * np.exp(others - others.max())
        mass = plain.sum(axis=(1, 2, 3))
        assert 0.5 * np.abs(found.density[np.nonzero(found.prior)] - mass / mass.sum()).sum() < 5e-4
        of_bias = plain.sum(axis=(0, 1, 2))
        mean = float(of_bias @ grid.bias / of_bias.sum())
        assert found.errors[0].bias == pytest.approx(mean, abs=np.deg2rad(0.02))


@pytest.mark.parametrize("count", [1, 2, RESCALED_EVERY + 3])
def test_the_compiled_evidence_by_node_is_the_plain_one(count):
    rng = np.random.default_rng(count)
    bearings = [
        replace(
            one,
            angle=float(one.angle + rng.normal(0.0, 0.3)),
            peaks=(Peak(float(rng.uniform(-3.0, 3.0)), 0.4),) if i % 3 else (),
        )
        for i, one in enumerate([one for k in range(5) for one in heard(TARGETS[0], rng, 4, aside=12.0 * k)][:count])
    ]
    belief = few_cells(bearings)
    grid = common_nodes([belief], "craft")
    x, y = (axis.ravel() for axis in np.meshgrid(*belief.centres()))
    log, seen = np.log(belief.prior.ravel()), sightings(bearings)
    fast, plain = (way.node_evidence(x, y, log, seen, grid) for way in (compiled_evidence, evidence))
    assert fast == pytest.approx(plain, abs=3e-3)
    weighed = evidence.evidence(x, y, seen, grid)
    # summed over the nodes it is the evidence of the places, summed over these
    assert np.log((np.exp(plain) * grid.weight).sum()) == pytest.approx(np.log((np.exp(weighed.log + log)).sum()))


def test_weights_that_hang_together_count_as_the_plain_ones_do():
    rng = np.random.default_rng(8)
    bearings = heard(TARGETS[0], rng, 4)
    grid = common_nodes([few_cells(bearings)], "craft")
    x, y = np.array([160.0, 40.0]), np.array([170.0, 60.0])
    known = np.zeros(grid.weight.shape) + np.linspace(-1.0, 1.0, len(grid.bias))
    told = replace(grid, together=grid.weight * np.exp(known))
    fast, plain = (way.evidence(x, y, sightings(bearings), told) for way in (compiled_evidence, evidence))
    for one, other in zip(fast, plain, strict=True):
        assert one == pytest.approx(other, abs=2e-3)
    assert not np.allclose(fast.bias, compiled_evidence.evidence(x, y, sightings(bearings), grid).bias, atol=1e-2)


def test_several_emitters_find_the_compass_sooner_and_the_places_closer():
    rng = np.random.default_rng(5)
    beliefs = [alone(heard(target, rng, 3)) for target in TARGETS]
    shared = with_shared_errors(beliefs)
    for own, found in zip(beliefs, shared, strict=True):
        assert found.errors[0].bias_sd < 0.8 * own.errors[0].bias_sd
        assert abs(found.errors[0].bias - BIAS) < 3.0 * found.errors[0].bias_sd
        assert found.folded == own.folded
        assert found.errors[0].bearings == 3
    # given its own place, each says the same of the compass: nobody was told what it told itself
    means = [found.errors[0].bias for found in shared]
    assert np.ptp(means) < 1e-3
    assert np.ptp([found.errors[0].bias_sd for found in shared]) < 1e-3


@pytest.mark.parametrize("seed", range(4))
def test_errors_that_are_out_of_question_are_not_asked_for_and_nothing_changes(monkeypatch, seed):
    rng = np.random.default_rng(seed)
    sigma, bias = np.deg2rad(rng.uniform(1.0, 1.5)), np.deg2rad(rng.uniform(2.0, 8.0))
    beliefs = []
    for target in (*TARGETS, (70.0, 90.0)):
        taken = [one for k in range(3) for one in heard(target, rng, 4, bias=bias, sigma=sigma, aside=12.0 * k)]
        if seed % 2:
            taken[2] = replace(taken[2], angle=float(wrap(taken[2].angle + 1.0)))
        beliefs.append(alone(taken))
    asked = []

    def counted(belief, source, grid):
        asked.append(len(grid.bias))
        return node_evidence(belief, source, grid)

    monkeypatch.setattr(shared_source, "node_evidence", counted)
    fewer = with_shared_errors(beliefs, threads=2)
    every = len(common_nodes(beliefs, "craft").bias)
    assert max(asked) < 0.25 * every
    monkeypatch.setattr(shared_source, "_in_question", lambda grid, _: np.ones(len(grid.bias), dtype=bool))
    asked.clear()
    whole = with_shared_errors(beliefs)
    assert set(asked) == {every}
    for one, other in zip(fewer, whole, strict=True):
        assert (one.x0, one.y0, one.h) == (other.x0, other.y0, other.h)
        assert np.abs(one.density - other.density).max() < 1e-12
        assert one.errors[0].nodes.bias == pytest.approx(other.errors[0].nodes.bias)
        assert one.errors[0].bias_mass == pytest.approx(other.errors[0].bias_mass, abs=1e-9)


def test_emitters_that_leave_no_value_of_the_bias_to_all_of_them_are_asked_for_each_others():
    """A compass that is off by something else at every emitter; beliefs bounded by what was heard on the way."""
    rng = np.random.default_rng(3)
    beliefs = []
    for target, bias_deg in zip(TARGETS, (-12.0, 0.0, 12.0), strict=True):
        off, sigma = np.deg2rad(bias_deg), np.deg2rad(2.0)
        taken = [one for k in range(3) for one in heard(target, rng, 4, bias=off, sigma=sigma, aside=12.0 * k)]
        beliefs.append(heard_on_the_way(alone(taken), heard_along((20.0, 60.0), (20.0, 180.0), target)))
    own = [belief.errors[0].nodes.bias for belief in beliefs]
    assert own[0][-1] < own[2][0], "the case would show nothing"
    shared = with_shared_errors(beliefs)
    assert all(np.isfinite(found.density).all() for found in shared)
    for belief, found in zip(beliefs, shared, strict=True):
        before, after = belief.errors[0].nodes, found.errors[0].nodes
        assert (before.bias[0], before.bias[-1]) != (after.bias[0], after.bias[-1])


def test_one_emitter_and_what_the_compass_did_not_hear_stay_bit_for_bit():
    rng = np.random.default_rng(6)
    first, second = (heard(target, rng, 3) for target in TARGETS[:2])
    only = alone(first)
    assert with_shared_errors([only])[0] is only
    nothing = joint_prior(PROBLEM)
    assert with_shared_errors([only, nothing]) == (only, nothing)
    by_hand = alone([replace(one, source="ada") for one in second])
    assert with_shared_errors([only, by_hand]) == (only, by_hand)
    third = alone(heard(TARGETS[2], rng, 2))
    with_it, without = with_shared_errors([only, by_hand, third]), with_shared_errors([only, third])
    assert with_it[1] is by_hand
    assert [digest(one) for one in (with_it[0], with_it[2])] == [digest(one) for one in without]


def test_the_order_of_the_emitters_does_not_matter():
    rng = np.random.default_rng(7)
    beliefs = [alone(heard(target, rng, 2 + index)) for index, target in enumerate(TARGETS)]
    there, back = with_shared_errors(beliefs), with_shared_errors(beliefs[::-1])[::-1]
    for one, other in zip(there, back, strict=True):
        assert one.density == pytest.approx(other.density, rel=1e-9, abs=1e-15)


def test_the_source_that_tells_most_of_its_errors_is_shared_and_no_other():
    def taken(*sources):
        return replace(joint_prior(PROBLEM), folded=tuple(Bearing(0.0, 0.0, 0.5, SIGMA, source=one) for one in sources))

    assert common_source([taken("craft"), taken("craft", "ada", "ada", "ada")]) == "craft"
    assert common_source([taken("craft", "ada"), taken("craft", "ada", "ada"), taken("craft")]) == "craft"
    assert common_source([taken("craft", "ada"), taken("craft", "ada", "ada")]) == "ada"
    assert common_source([taken("craft"), taken("ada"), taken()]) is None
    # who names every emitter once does not put aside the compass that was measured on two of them
    flown = ["craft"] * 3
    assert common_source([taken(*flown, "ada"), taken(*flown, "ada"), taken("ada")]) == "craft"
    assert common_source([taken(*flown, "ada"), taken("ada"), taken("ada")]) == "ada"


def test_another_source_of_both_is_no_way_back_to_what_an_emitter_told():
    """Two emitters heard by the craft and by somebody else: the other one's errors are known as they were before."""
    rng = np.random.default_rng(9)
    beliefs = [
        alone([*heard(t, rng, 3), *heard(t, rng, 2, bias=0.0, source="ada", sigma=2.0 * SIGMA)]) for t in TARGETS[:2]
    ]
    shared = with_shared_errors(beliefs)
    for found in shared:
        assert set(found.narrowed) == {"craft"}
        hand = found.errors_of("ada")
        assert hand is not None
        assert hand.nodes.together is None


def test_silence_about_one_emitter_is_part_of_what_it_tells():
    rng = np.random.default_rng(10)
    quiet = Silence(60.0, 60.0, (1.0,) * 16, (0.0,) * 16)
    beliefs = [few_cells(heard(target, rng, 2)) for target in TARGETS[:2]]
    grid = common_nodes(beliefs, "craft")
    with_it = replace(beliefs[0], silences=(quiet,))
    assert isinstance(with_it, JointBelief)
    told = node_evidence(with_it, "craft", grid)
    assert told == pytest.approx(np.log(each_by_node(with_it, "craft", grid).sum(axis=0)), abs=5e-3)
    assert not np.allclose(told, node_evidence(beliefs[0], "craft", grid), atol=1e-3)


def stretch(seed, source="craft"):
    """Readings eastward, the antenna turning by 150 degrees meanwhile, whatever the emitter's direction."""
    rng = np.random.default_rng(seed)
    along, turned = np.linspace(0.0, 20.0, 14), np.deg2rad(np.linspace(10.0, 160.0, 14))
    gain = tuple((-np.minimum(12.0 * (((np.arange(36) + 18) % 36 - 18) / 6.5) ** 2, 15.0)).tolist())
    power = tuple((-60.0 + 6.0 * np.cos(turned - 1.0 - seed) + rng.standard_normal(14)).tolist())
    return Stretch(source, tuple(along + 150.0), (-40.0,) * 14, tuple(turned), power, gain, SIGMA)


def test_stretches_of_way_tell_of_the_compass_as_bearings_do():
    rng = np.random.default_rng(3)
    belief = replace(few_cells(heard(TARGETS[0], rng, 1)), stretches=(stretch(1), stretch(2)))
    grid = common_nodes([belief], "craft")
    rows, columns = np.nonzero(belief.prior)
    x, y = (along[index] for along, index in zip(belief.centres(), (columns, rows), strict=True))
    log = log_prior(belief, belief.prior[rows, columns], x, y)
    seen = sightings(belief.folded)
    fast = node_evidence(belief, "craft", grid)
    plain = evidence.node_evidence(x, y, log, seen, grid, belief.stretches)
    without = evidence.node_evidence(x, y, log, seen, grid)
    weight = grid.weight > 1e-6
    assert (fast - fast.max())[weight] == pytest.approx((plain - plain.max())[weight], abs=0.05)
    assert np.ptp((plain - without)[weight]) > 0.1


def test_a_source_that_was_only_heard_on_the_way_still_tells_of_the_place():
    rng = np.random.default_rng(4)
    belief = replace(few_cells(heard(TARGETS[0], rng, 1, source="other")), stretches=(stretch(1),))
    x, y, log = places_besides(belief, "other")
    *_, bare = places_besides(replace(belief, stretches=()), "other")
    assert len(x) == len(y) == len(log)
    assert np.ptp(log - bare) > 0.1
