"""A reported bearing as a fact: what is refused, and what it does to a search that flies."""

from __future__ import annotations

from dataclasses import replace

import pytest
from facts import FIRST_EMITTER, SECOND, SPEC, TWO_SPEC, WAITING_SPEC
from walks import Walk

from backend.events import PersonSource
from backend.reasons.refusals import NoSuchEmitter
from backend.reasons.search import BearingTimeImpossible, PlaceTooFar, TakenEarlier, WhichEmitter
from backend.search.errors import MissionInputError
from backend.search.inputs import BearingsArrived
from backend.search.planner_bearings import own_sigma_deg, source_name
from backend.search.reported import AHEAD_S, LATEST_S, ReportedBearing, reported_fact
from backend.search.state import SearchState
from backend.spec import Place

NOW_S = 1_000_000.0
REPORT = ReportedBearing("b-phone-1", "Ada", Place(50.0, 7.001), 359.5, 12.0, NOW_S)
SEARCH = SearchState(spec=SPEC)


def test_it_is_a_bearing_of_a_person_with_an_own_and_a_common_share() -> None:
    fact = reported_fact(SEARCH, REPORT, NOW_S)
    assert fact.source == PersonSource(name="Ada")
    assert source_name(fact.source) == "person:Ada"
    assert (fact.bearing_id, fact.emitter_id, fact.bearing_deg) == ("b-phone-1", FIRST_EMITTER, 359.5)
    assert (fact.sweep_id, fact.binned_db, fact.remarks) == (None, [], [])
    assert 0.0 < own_sigma_deg(fact) < fact.sigma_deg == 12.0
    assert own_sigma_deg(reported_fact(SEARCH, replace(REPORT, sigma_deg=1.0), NOW_S)) > 0.5
    assert reported_fact(SEARCH, replace(REPORT, bearing_deg=360.0), NOW_S).bearing_deg == 0.0


def test_one_that_was_kept_while_offline_says_how_old_it_is() -> None:
    fact = reported_fact(SEARCH, replace(REPORT, taken_at_s=NOW_S - 600.0), NOW_S)
    assert fact.remarks == [TakenEarlier(600.0)]


@pytest.mark.parametrize(
    ("changes", "reason", "field"),
    [
        ({"place": Place(51.0, 7.0)}, PlaceTooFar, "place"),
        ({"taken_at_s": NOW_S - LATEST_S - 1.0}, BearingTimeImpossible, "taken_at_utc"),
        ({"taken_at_s": NOW_S + AHEAD_S + 1.0}, BearingTimeImpossible, "taken_at_utc"),
        ({"emitter_id": "other"}, NoSuchEmitter, "emitter_id"),
    ],
)
def test_what_cannot_be_is_refused_with_its_field(changes: dict, reason: type, field: str) -> None:
    with pytest.raises(MissionInputError) as refused:
        reported_fact(SEARCH, replace(REPORT, **changes), NOW_S)
    assert isinstance(refused.value.reason, reason)
    assert refused.value.field == field


def test_of_several_emitters_the_one_that_was_heard_is_named() -> None:
    several = SearchState(spec=TWO_SPEC)
    with pytest.raises(MissionInputError) as refused:
        reported_fact(several, REPORT, NOW_S)
    assert refused.value.reason == WhichEmitter(2)
    assert reported_fact(several, replace(REPORT, emitter_id=SECOND), NOW_S).emitter_id == SECOND


@pytest.mark.parametrize("phase", ["flying", "measuring", "waiting"])
def test_it_uses_up_no_place_of_a_craft_that_flies(phase: str) -> None:
    walk = Walk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)
    number, chosen = walk.search.place_number, walk.craft.chosen
    for k in range(10):
        report = replace(REPORT, bearing_id=f"b-phone-{k}", taken_at_s=NOW_S)
        walk.give(BearingsArrived((reported_fact(walk.search, report, NOW_S),)))
    assert len(walk.search.emitters[FIRST_EMITTER].bearings) == 10
    assert (walk.search.place_number, walk.craft.chosen, walk.craft.phase) == (number, chosen, phase)
