"""The machine of a turn only as far as needed, walked through with sweeps of every kind."""

from __future__ import annotations

import math

import numpy as np
import pytest
from equipment import TWO_EMITTERS, spec
from hypothesis import given
from hypothesis import strategies as st

from backend.events import BearingMeasured, CraftSource, TurnFact
from backend.reasons.turning import (
    BearingUncertain,
    ElsewherePossible,
    MaximumAtEdge,
    MaximumSeen,
    NothingFoundYet,
    QualityPoor,
    SectorExpected,
    WholeCircleSeen,
    WholeTurn,
)
from backend.search.sector import (
    CIRCLE_DEG,
    RULE,
    GoOn,
    Stop,
    TurnPlan,
    look,
    must_be_whole,
    planned_turn,
    turn_fact,
    whole_turn,
)
from backend.spec import EmitterSpec, MissionSpec, Place, SensorSpec
from hardware.direction_finding.circle import SweepLikelihood
from hardware.readings import BearingReading

NOTHING = np.full(180, np.nan)
MOST_LOOKS = 8
MARGIN_DEG = math.degrees(RULE.margin)


def expected(middle_deg: float, sd_deg: float) -> np.ndarray:
    off = (np.arange(360) - middle_deg + 180.0) % 360.0 - 180.0
    mass = np.exp(-0.5 * (off / sd_deg) ** 2)
    return mass / mass.sum()


def heard(
    bearing_deg: float,
    sigma_deg: float = 2.0,
    quality: float = 0.95,
    accepted: bool = True,
    elsewhere: SweepLikelihood | None = None,
) -> BearingReading:
    likelihood = elsewhere or SweepLikelihood.normal(bearing_deg, sigma_deg)
    return BearingReading(
        bearing_deg % 360.0, sigma_deg, quality, accepted, None, (), NOTHING, NOTHING,
        likelihood=likelihood.packed(),
    )  # fmt: skip


def bearing(place_number: int, turned_deg: float | None = None) -> BearingMeasured:
    turn = None
    if turned_deg is not None:
        turn = turn_fact(whole_turn("first"), 0.0, turned_deg, (), Stop(WholeCircleSeen()))
    return BearingMeasured(
        emitter_id="emitter-1", source=CraftSource(craft_id="craft-1"), bearing_id=f"b{place_number}", sweep_id=None,
        place_number=place_number, place=Place(50.0, 7.0), altitude_amsl_m=100.0, bearing_deg=0.0, sigma_deg=5.0,
        quality=0.9, peaks=[], snr_db=None, drift_m=0.0, binned_db=[], fitted_db=[], turn=turn,
    )  # fmt: skip


def mission(**sensor: object) -> MissionSpec:
    return spec().model_copy(update={"sensor": SensorSpec(sector_turns=True, **sensor)})  # type: ignore[arg-type]


@given(st.floats(0.0, 359.9), st.floats(2.0, 25.0))
def test_a_sector_holds_the_expected_directions_with_a_margin_on_either_side(middle: float, sd: float) -> None:
    plan = planned_turn(expected(middle, sd))
    assert plan.begin_deg is not None
    assert plan.width_deg >= math.degrees(RULE.narrowest) - 1e-9
    after = (np.arange(360) - plan.begin_deg) % 360.0
    within = (after >= MARGIN_DEG - 1e-6) & (after <= plan.width_deg - MARGIN_DEG + 1e-6)
    assert expected(middle, sd)[within].sum() >= RULE.share - 1e-9
    assert isinstance(plan.why, SectorExpected)


def test_a_belief_that_points_anywhere_is_turned_whole() -> None:
    plan = planned_turn(np.full(360, 1.0 / 360.0))
    assert plan.whole
    assert plan.width_deg == CIRCLE_DEG
    assert plan.why == WholeTurn("wide")


@pytest.mark.parametrize(
    ("flown", "measured", "attempt", "because"),
    [
        (mission(), (), 1, "first"),
        (mission(), (bearing(1),), 2, "again"),
        (mission(), (bearing(1),), 1, None),
        (mission(), (bearing(1, 160.0),), 1, "second_place"),
        (mission(whole_turns=2), (bearing(1), bearing(1)), 1, "second_place"),
        (mission(whole_turns=2), (bearing(1), bearing(2, 360.0)), 1, None),
        (mission().model_copy(update={"emitters": list(TWO_EMITTERS)}), (bearing(1),), 1, "several"),
        (
            mission().model_copy(
                update={"emitters": [EmitterSpec(kind="pulsed", pulse_width_s=0.02, pulse_period_s=0.5)]}
            ),
            (bearing(1),),
            1,
            "pulsed",
        ),
    ],
)
def test_when_in_doubt_the_turn_is_whole(
    flown: MissionSpec, measured: tuple[BearingMeasured, ...], attempt: int, because: str | None
) -> None:
    assert must_be_whole(flown, measured, attempt) == because


PLAN = planned_turn(expected(180.0, 10.0))
BEGIN = PLAN.begin_deg or 0.0


def test_it_stops_when_the_maximum_lies_well_within_and_little_speaks_for_another_direction() -> None:
    decided = look(PLAN, BEGIN, PLAN.width_deg, heard(180.0))
    assert isinstance(decided, Stop)
    assert isinstance(decided.why, MaximumSeen)
    assert decided.why.inside_deg == pytest.approx(PLAN.width_deg / 2, abs=1.5)
    assert decided.why.elsewhere_percent < 5.0


def test_an_uncertain_bearing_alone_is_no_reason_to_turn_on() -> None:
    assert isinstance(look(PLAN, BEGIN, PLAN.width_deg, heard(180.0, sigma_deg=6.0)), Stop)


def test_a_maximum_at_the_end_is_followed_and_one_at_the_beginning_takes_the_whole_circle() -> None:
    at_end = look(PLAN, BEGIN, 160.0, heard(BEGIN + 150.0))
    at_beginning = look(PLAN, BEGIN, 160.0, heard(BEGIN + 10.0))
    assert at_end == GoOn(45.0, MaximumAtEdge("end", 45.0))
    assert at_beginning == GoOn(200.0, MaximumAtEdge("beginning", 200.0))


@pytest.mark.parametrize(
    ("reading", "why"),
    [
        (None, NothingFoundYet),
        (heard(180.0, accepted=False), NothingFoundYet),
        (heard(180.0, quality=0.75), QualityPoor),
        (heard(180.0, sigma_deg=12.0), BearingUncertain),
        (heard(180.0, elsewhere=SweepLikelihood(np.zeros(360))), ElsewherePossible),
    ],
)
def test_it_goes_on_and_says_why(reading: BearingReading | None, why: type) -> None:
    # with a flat likelihood the expected directions decide: a broad expectation leaves others possible
    plan = TurnPlan(BEGIN, 160.0, PLAN.why, expected(180.0, 60.0)) if why is ElsewherePossible else PLAN
    decided = look(plan, BEGIN, 160.0, reading)
    assert isinstance(decided, GoOn)
    assert isinstance(decided.why, why)


def test_the_back_lobe_of_the_expected_direction_is_not_ruled_out_by_a_likelihood_with_two_peaks() -> None:
    two = np.logaddexp(
        SweepLikelihood.normal(180.0, 3.0).log_likelihood, SweepLikelihood.normal(0.0, 3.0).log_likelihood
    )
    twofold = heard(180.0, elsewhere=SweepLikelihood.of(two))
    where = 0.5 * expected(180.0, 10.0) + 0.5 * expected(0.0, 10.0)
    decided = look(TurnPlan(BEGIN, 160.0, PLAN.why, where), BEGIN, 160.0, twofold)
    assert isinstance(decided, GoOn)
    assert isinstance(decided.why, ElsewherePossible)
    assert decided.why.elsewhere_percent == pytest.approx(50.0, abs=3.0)


READINGS = st.one_of(
    st.none(),
    st.tuples(st.floats(0.0, 359.9), st.floats(0.3, 60.0), st.floats(0.0, 1.0), st.booleans()),
)


@given(st.floats(0.0, 359.9), st.floats(2.0, 60.0), st.lists(READINGS, min_size=MOST_LOOKS, max_size=MOST_LOOKS))
def test_whatever_is_heard_it_ends_within_the_circle_and_has_a_reason_for_every_step(
    middle: float, sd: float, sweeps: list[tuple[float, float, float, bool] | None]
) -> None:
    plan = planned_turn(expected(middle, sd))
    if plan.begin_deg is None:
        assert isinstance(look(plan, 0.0, CIRCLE_DEG, None), Stop)
        return
    turned, steps = plan.width_deg, list[GoOn]()
    for sweep in sweeps:
        reading = None
        if sweep is not None:
            at, sigma, quality, accepted = sweep
            reading = heard(at, sigma, quality, accepted)
        decided = look(plan, plan.begin_deg, turned, reading)
        if isinstance(decided, Stop):
            break
        assert 0.0 < decided.by_deg <= CIRCLE_DEG - turned + 1e-9
        assert decided.why.by_deg == decided.by_deg
        steps.append(decided)
        turned += decided.by_deg
    else:
        pytest.fail("it never stopped")
    fact = turn_fact(plan, plan.begin_deg, turned, steps, decided)
    assert len(fact.went_on_because) == len(steps)
    assert TurnFact.model_validate_json(fact.model_dump_json()) == fact


def test_a_turn_wider_than_the_widest_sector_is_whole_and_never_in_between() -> None:
    widths = [planned_turn(expected(10.0, sd)).width_deg for sd in np.linspace(1.0, 200.0, 60)]
    assert all(width <= math.degrees(RULE.widest) or width == CIRCLE_DEG for width in widths)
    assert {width == CIRCLE_DEG for width in widths} == {True, False}
