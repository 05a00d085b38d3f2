"""Missions with several tags: seeded, each tag a claim, one time for all."""

import numpy as np
import pytest

from planner.options import PlannerOptions
from planner.study.errors import StudyError
from planner.study.scenarios import scenario
from planner.study.tags import TAGS, fly_tags, tags_missions

QUICK = PlannerOptions(budget=60)


def test_the_rows_that_are_asked_for_exist_and_no_other():
    several = {"tags_4": 4, "tags_8": 8}
    assert several | {f"{row}_{more}": tags for row, tags in several.items() for more in ("bias5", "first")} == TAGS
    with pytest.raises(StudyError, match="tags_8"):
        next(tags_missions("tags_5", [1], "independent"))


def test_a_mission_depends_on_its_seed_and_finds_every_tag_sooner_than_one_after_another():
    world = scenario("field")
    claims, again, other = (fly_tags(world, 3, seed, "independent", QUICK) for seed in (5, 5, 6))
    assert repr(claims) == repr(again) != repr(other)  # NaN equals nothing
    assert [claim.claimed for claim in claims] == [True] * 3
    assert {claim.time_s for claim in claims} == {claims[0].time_s}
    alone = [fly_tags(world, 1, seed, "independent", QUICK)[0] for seed in (5, 6, 7)]
    assert claims[0].time_s < sum(claim.time_s for claim in alone)
    assert all(2 <= claim.bearings <= max(c.bearings for c in claims) for claim in claims)


def test_a_wrong_compass_is_one_compass_for_all_tags_and_shared_it_is_known_better():
    world, bias_sd = scenario("field"), np.deg2rad(12.0)
    shared, alone = (fly_tags(world, 3, 4, "joint", QUICK, shared=some, bias_sd=bias_sd) for some in (True, False))
    assert all(claim.claimed for claim in shared)
    assert np.mean([claim.bias_sd_deg for claim in shared]) < np.mean([claim.bias_sd_deg for claim in alone])
    assert all(abs(claim.bias_off_deg) <= 3.0 * claim.bias_sd_deg for claim in shared)


def test_the_tag_that_comes_first_is_flown_for_and_every_claim_says_when_it_was_made():
    world = scenario("field")
    seeds = (5, 6, 7, 8)
    alike, ordered = (
        [fly_tags(world, 3, seed, "independent", QUICK, first=some) for seed in seeds] for some in (False, True)
    )
    found = [np.mean([claims[0].found_s or np.nan for claims in missions]) for missions in (alike, ordered)]
    assert found[1] < found[0]
    for claims in (*alike, *ordered):
        times = [claim.found_s for claim in claims if claim.found_s is not None]
        assert (len(times), max(times)) == (3, claims[0].time_s)


def test_the_independent_model_has_no_errors_to_share():
    world = scenario("field")
    assert repr(fly_tags(world, 2, 5, "independent", QUICK)) == repr(
        fly_tags(world, 2, 5, "independent", QUICK, shared=True)
    )
