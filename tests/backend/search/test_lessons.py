"""What flights teach of a craft's compass: from the bearings alone, into the next mission's specification."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import pytest
from ground import AREA, HOME, towards

from backend.events import FIRST_CRAFT, AntennaChecked, BearingMeasured, CheckFact, PersonSource, TruthNoted
from backend.ports import Lesson
from backend.search.emitter import EmitterState
from backend.search.lessons import errors_now, knowing, lesson, lesson_of_check, mean_bias
from backend.search.localization import localization
from backend.search.planning import foreseen
from backend.search.source_priors import prior_in, priors_of
from backend.search.state import SearchState
from backend.search.task import search_task
from backend.spec import FIRST_EMITTER, EmitterSpec, LearnedErrors, MissionSpec, MovementSpec, SensorSpec
from hardware.frame import LocalFrame
from hardware.reasons.antenna import AntennaAgrees

TARGET = (120.0, 60.0)
AROUND = ((60.0, -40.0), (180.0, -40.0), (200.0, 100.0), (40.0, 110.0), (120.0, 160.0), (10.0, 20.0))
WIGGLE = (0.4, -0.6, 0.2, 0.5, -0.5, -0.1)
ANTENNA = "yagi"
JOINT = SensorSpec(bearing_errors="joint")


def mission(sensor: SensorSpec = JOINT) -> MissionSpec:
    return MissionSpec(name="m", area=AREA, sensor=sensor)


def bearings(bias: float, count: int = 6) -> tuple[BearingMeasured, ...]:
    """Own errors of half a degree where 4 are stated."""
    return tuple(
        towards(x, y, TARGET, sigma=4.0).model_copy(
            update={
                "bearing_id": f"b{k}",
                "bearing_deg": (towards(x, y, TARGET).bearing_deg + bias + WIGGLE[k]) % 360.0,
            }
        )
        for k, (x, y) in enumerate(AROUND[:count])
    )


def taught(mission_id: str, measured: tuple[BearingMeasured, ...], spec: MissionSpec | None = None) -> Lesson | None:
    spec = spec or knowing(mission(), [], FIRST_CRAFT, ANTENNA)
    state = SearchState(spec=spec, emitters={FIRST_EMITTER: EmitterState(FIRST_EMITTER, measured)})
    return lesson(mission_id, search_task(spec, HOME, 0.0), state, FIRST_CRAFT)


@cache
def flown(bias: float) -> Lesson | None:
    return taught("m1", bearings(bias))


def lessons(bias: float, count: int) -> list[Lesson]:
    found = flown(bias)
    assert found is not None
    return [found] * count


def now(known: list[Lesson], sensor: SensorSpec = JOINT) -> LearnedErrors:
    return errors_now(known, sensor, FIRST_CRAFT, ANTENNA)


def test_a_flight_tells_its_bias_clockwise() -> None:
    found = taught("m1", bearings(7.0))
    assert found is not None
    assert found.bearings == 6
    assert found.bias_deg == pytest.approx(7.0, abs=1.5)
    assert 0.0 < found.bias_std_error_deg < 2.5


@pytest.mark.parametrize("found", [True, False])
def test_one_that_moved_does_not_keep_the_other_from_teaching(found: bool) -> None:
    """Its place was told, or most bearings were of it."""
    hare = EmitterSpec(emitter_id="hare", movement=MovementSpec(kind="animal"))
    spec = mission().model_copy(update={"emitters": [hare, EmitterSpec(emitter_id="still")]})
    chased = tuple(one.model_copy(update={"emitter_id": "hare"}) for one in bearings(20.0))
    truth = TruthNoted(emitter_id="hare", place=HOME, accuracy_m=5.0, how="map", by="x") if found else None
    states = {
        "hare": EmitterState("hare", chased, truth=truth),
        "still": EmitterState(
            "still", tuple(one.model_copy(update={"emitter_id": "still"}) for one in bearings(7.0, 5))
        ),
    }
    told = lesson("m1", search_task(spec, HOME, 0.0), SearchState(spec=spec, emitters=states), FIRST_CRAFT)
    assert told is not None
    assert (told.bearings, told.place_known) == (5, False)
    assert told.bias_deg == pytest.approx(7.0, abs=2.0)


def test_flights_of_a_right_compass_narrow_what_the_next_expects_and_never_exclude_anything() -> None:
    unknown, some, many = (prior_in(now(lessons(0.0, count))) for count in (0, 3, 30))
    assert unknown.bias_sd > some.bias_sd > many.bias_sd
    assert math.degrees(many.bias_sd) < 2.0
    assert many.scale_weight[0] > 0.5 > unknown.scale_weight[0]
    assert many.rate_weight @ many.rate < 0.2 * (unknown.rate_weight @ unknown.rate)
    for weights in (many.spread_weight, many.scale_weight, many.rate_weight):
        assert weights.min() > 1e-4


def test_flights_of_a_bad_compass_widen_it() -> None:
    assert prior_in(now(lessons(12.0, 10))).bias_sd > 1.3 * prior_in(now([])).bias_sd


def test_what_was_learned_decides_the_belief_of_the_craft_and_of_nobody_else() -> None:
    spec = knowing(mission(), lessons(0.0, 30), FIRST_CRAFT, ANTENNA)
    person = tuple(b.model_copy(update={"source": PersonSource(name="Ada")}) for b in bearings(0.0, 3))
    for measured, better in ((bearings(0.0, 3), True), (person, False)):
        known, unknown = (
            localization(one, HOME).belief_fact(measured)[0] for one in (spec, knowing(mission(), [], FIRST_CRAFT, ""))
        )
        assert known.estimate is not None
        assert unknown.estimate is not None
        assert (known.estimate.expected_rmse_m < 0.7 * unknown.estimate.expected_rmse_m) == better
        assert (known.digest == unknown.digest) == (not better)


def test_the_specification_holds_all_of_it_so_that_the_journal_folds_to_the_same_belief() -> None:
    spec = knowing(mission(), lessons(3.0, 5), FIRST_CRAFT, ANTENNA)
    again = MissionSpec.model_validate_json(spec.model_dump_json())
    digests = [localization(one, HOME).belief_fact(bearings(3.0))[0].digest for one in (spec, again)]
    assert digests[0] == digests[1]
    assert spec.sensor.learned is not None
    assert (spec.sensor.learned.flights, spec.sensor.learned.antenna) == (5, ANTENNA)


def test_the_first_forecast_knows_what_was_learned_and_nothing_learned_changes_nothing() -> None:
    def foreseen_deg(known: list[Lesson]) -> float:
        task = localization(knowing(mission(), known, FIRST_CRAFT, ANTENNA), HOME)
        return math.degrees(foreseen(task.problem, (), task.prior).sigma)

    assert foreseen_deg([]) == pytest.approx(JOINT.sigma_deg)
    assert foreseen_deg(lessons(0.0, 20)) < 0.6 * JOINT.sigma_deg < JOINT.sigma_deg < foreseen_deg(lessons(12.0, 20))


def test_independent_errors_learn_nothing_and_are_told_nothing() -> None:
    plain = mission(SensorSpec())
    assert knowing(plain, lessons(0.0, 3), FIRST_CRAFT, ANTENNA) == plain
    assert taught("m1", bearings(0.0), plain) is None


def told(place: tuple[float, float] | None, accuracy_m: float | None = 3.0) -> TruthNoted:
    at = None if place is None else LocalFrame(HOME).to_geo(*place)
    return TruthNoted(emitter_id=FIRST_EMITTER, place=at, accuracy_m=accuracy_m, how="map", by="anna")


def taught_with(truth: TruthNoted | None, measured: tuple[BearingMeasured, ...]) -> Lesson:
    spec = knowing(mission(), [], FIRST_CRAFT, ANTENNA)
    emitter = EmitterState(FIRST_EMITTER, measured, truth=truth)
    found = lesson(
        "m1", search_task(spec, HOME, 0.0), SearchState(spec=spec, emitters={FIRST_EMITTER: emitter}), FIRST_CRAFT
    )
    assert found is not None
    return found


def test_where_the_emitter_was_found_tells_the_bias_that_bearings_from_one_side_leave_open() -> None:
    one_side = bearings(9.0, 2)
    alone, known = taught_with(None, one_side), taught_with(told(TARGET), one_side)
    assert (alone.place_known, known.place_known) == (False, True)
    assert known.bias_deg == pytest.approx(9.0, abs=2.0 * known.bias_std_error_deg)
    assert known.bias_std_error_deg < 0.75 * alone.bias_std_error_deg
    assert prior_in(now([known] * 10)).bias_sd > 1.2 * prior_in(now([alone] * 10)).bias_sd


def test_a_place_that_is_known_badly_tells_less_and_one_that_was_not_found_tells_nothing() -> None:
    close, unsaid, vague = (taught_with(told(TARGET, accuracy), bearings(9.0, 2)) for accuracy in (0.0, None, 60.0))
    assert close.bias_std_error_deg < unsaid.bias_std_error_deg < vague.bias_std_error_deg
    assert taught_with(told(None), bearings(9.0, 2)) == taught_with(None, bearings(9.0, 2))


def test_outliers_show_at_the_place_where_the_emitter_was() -> None:
    """Three bearings of which one is wrong leave open which; the place does not."""
    honest = bearings(0.0, 3)
    wrong = (*honest[:2], honest[2].model_copy(update={"bearing_deg": (honest[2].bearing_deg + 80.0) % 360.0}))
    rates = [prior_in(now([taught_with(told(TARGET), some)] * 5)) for some in (honest, wrong)]
    found = [float(prior.rate @ prior.rate_weight) for prior in rates]
    assert found[1] > 2.0 * found[0]


def test_of_several_emitters_the_one_that_was_found_teaches() -> None:
    spec = knowing(mission(), [], FIRST_CRAFT, ANTENNA)
    spec = spec.model_copy(
        update={"emitters": [*spec.emitters, spec.emitters[0].model_copy(update={"emitter_id": "tag"})]}
    )
    found = EmitterState("tag", bearings(9.0, 2), truth=told(TARGET).model_copy(update={"emitter_id": "tag"}))
    emitters = {FIRST_EMITTER: EmitterState(FIRST_EMITTER, bearings(0.0)), "tag": found}
    said = lesson("m1", search_task(spec, HOME, 0.0), SearchState(spec=spec, emitters=emitters), FIRST_CRAFT)
    assert said is not None
    assert (said.place_known, said.bearings) == (True, 2)


def check(measured: float, ok: bool = True) -> AntennaChecked:
    agrees = AntennaAgrees(measured_deg=measured, true_deg=2.0, quality=0.98)
    return AntennaChecked(check=CheckFact(name="antenna", ok=ok, reason=agrees, blocking=True), emitter=HOME, by="ann")


def test_antenna_checks_before_a_known_emitter_narrow_the_bias_and_nothing_else() -> None:
    one = lesson_of_check("m1", check(358.0), JOINT)
    assert one is not None
    assert (one.bias_deg, one.bearings) == (pytest.approx(-4.0), 1)
    right = lesson_of_check("m1", check(2.5), JOINT)
    assert right is not None
    unknown, known, worse = (prior_in(now(some)) for some in ([], [right] * 8, [one] * 8))
    assert known.bias_sd < worse.bias_sd < unknown.bias_sd
    assert known.scale_weight == pytest.approx(unknown.scale_weight, abs=1e-3)
    assert known.rate_weight == pytest.approx(unknown.rate_weight, abs=1e-3)


def test_a_check_that_failed_teaches_nothing() -> None:
    assert lesson_of_check("m1", check(2.5, ok=False), JOINT) is None


def test_lessons_of_before_count_their_three_values_one_by_one() -> None:
    old = [replace(one, together=()) for one in lessons(0.0, 10)]
    known = prior_in(now(old))
    assert known.bias_sd < prior_in(now([])).bias_sd
    assert known.scale_weight[0] > 0.3


def test_other_sources_are_assumed_to_be_what_they_were_when_the_mission_was_written() -> None:
    learned = now([])
    first = learned.model_copy(update={"rate": [0.003, 0.02, 0.05, 0.2], "rate_weight": [0.07, 0.18, 0.42, 0.33]})
    second = learned.model_copy(update={"rate": learned.rate[:5], "rate_weight": [0.2] * 5})
    others = [priors_of(JOINT.model_copy(update={"learned": one}))[1] for one in (first, second, learned)]
    assert others[0].rate == pytest.approx([0.003, 0.02, 0.05, 0.2])
    assert others[1].rate == pytest.approx([0.003, 0.02, 0.05, 0.1, 0.2])
    assert others[2].rate == pytest.approx([0.003, 0.02, 0.05, 0.1, 0.2, 0.5])
    for before in others[:2]:
        assert before.spread_weight == pytest.approx([1 / 6] * 6)
    assert others[2].spread_weight == pytest.approx([w / 12 for w in (0.75, 0.75, 1.25, 2, 3.25, 4)])


def test_a_mission_of_before_without_outliers_assumes_the_same_of_others_as_it_did() -> None:
    """One rate then as now: it could not say which of the two it is, and keeps what its journal was folded with."""
    sensor = SensorSpec(bearing_errors="joint", outlier_probability=0.0)
    mine = sensor.model_copy(update={"learned": errors_now((), sensor, FIRST_CRAFT, ANTENNA)})
    others = priors_of(mine)[1]
    assert others.rate == pytest.approx([0.003])
    assert others.spread_weight == pytest.approx([1 / 6] * 6)


def test_a_flight_without_a_bearing_teaches_nothing() -> None:
    assert taught("m1", ()) is None
    assert mean_bias([]) is None


def test_another_outlier_probability_reads_the_same_flights() -> None:
    """The rates it compares lie between those that the flights compared."""
    usual, rarer = (now(lessons(0.0, 20), JOINT.model_copy(update={"outlier_probability": p})) for p in (0.1, 0.04))
    assert rarer.rate != usual.rate
    assert rarer.rate_weight[0] > 2.0 * now([]).rate_weight[0]
    assert sum(rarer.rate_weight) == pytest.approx(1.0)


def test_the_mean_of_the_flights_weighs_what_each_knew_and_says_how_they_differ() -> None:
    alike, apart = mean_bias([*lessons(6.0, 4)]), mean_bias([*lessons(6.0, 2), *lessons(-6.0, 2)])
    assert alike is not None
    assert apart is not None
    assert alike[0] == pytest.approx(6.0, abs=1.5)
    assert alike[1] < 2.0 < 5.0 < apart[1]
    assert apart[0] == pytest.approx(0.0, abs=1.5)


def taking_off(offset_deg: float) -> SensorSpec:
    return JOINT.model_copy(update={"bearing_offset_deg": offset_deg})


@cache
def corrected(bias: float, offset_deg: float) -> Lesson:
    """Of a flight with a compass that reads `bias` too large, which took `offset_deg` off its bearings."""
    spec = knowing(mission(taking_off(offset_deg)), [], FIRST_CRAFT, ANTENNA)
    found = taught("m2", bearings(bias - offset_deg), spec)
    assert found is not None
    return found


def sd_deg(known: list[Lesson], offset_deg: float) -> float:
    return math.degrees(prior_in(now(known, taking_off(offset_deg))).bias_sd)


def test_an_offset_is_the_profiles_and_only_how_far_the_bias_strays_from_it_is_learned() -> None:
    askew = lessons(7.0, 15)
    assert corrected(7.0, 7.0).taken_off_deg == 7.0
    assert corrected(7.0, 7.0).bias_deg == pytest.approx(0.0, abs=1.5)
    unknown = sd_deg([], 0.0)
    assert sd_deg(askew, 0.0) > unknown, "such a compass may be as wrong again"
    assert sd_deg(askew, 7.0) < 0.7 * unknown, "the same flights, once that is taken off"
    assert sd_deg(askew, 7.0) == pytest.approx(sd_deg([corrected(7.0, 7.0)] * 15, 7.0), rel=0.4)
    assert sd_deg(askew, 7.1) == pytest.approx(sd_deg(askew, 7.0), rel=0.1)


def test_an_offset_that_is_taken_back_is_not_made_up_for_by_what_was_learned_with_it() -> None:
    well = [corrected(7.0, 7.0)] * 15
    assert sd_deg(well, 7.0) < 2.0
    assert sd_deg(well, 0.0) > 5.0, "a compass that is right with 7 degrees off it is 7 degrees wrong without"
    assert sd_deg(well, 7.2) == sd_deg(well, 7.0)
    for offset_deg in (0.0, 7.0):
        left = mean_bias([*well, *lessons(7.0, 15)], offset_deg)
        assert left is not None
        assert left[0] == pytest.approx(7.0 - offset_deg, abs=1.5)


def test_scale_and_outliers_are_known_whatever_is_taken_off() -> None:
    for offset_deg in (0.0, 6.0, -90.0):
        prior = prior_in(now(lessons(0.0, 30), taking_off(offset_deg)))
        assert prior.scale_weight[0] > 0.5
        assert math.isfinite(prior.bias_sd)


def test_a_belief_with_the_offset_taken_off_does_not_look_for_it_again() -> None:
    """The bearings of such a mission are right; nothing that was learned may turn them back."""
    for known in (lessons(7.0, 15), [corrected(7.0, 7.0)] * 15):
        spec = knowing(mission(taking_off(7.0)), known, FIRST_CRAFT, ANTENNA)
        fact, _ = localization(spec, HOME).belief_fact(bearings(0.0, 4))
        (source,) = fact.sources
        assert source.bias_deg == pytest.approx(0.0, abs=1.0)


def test_a_check_says_what_its_mission_took_off() -> None:
    one = lesson_of_check("m1", check(358.0), taking_off(5.0))
    assert one is not None
    assert (one.bias_deg, one.taken_off_deg) == (pytest.approx(-4.0), 5.0)


def test_a_mission_of_before_takes_nothing_off_and_folds_to_what_it_was() -> None:
    spec = knowing(mission(), lessons(3.0, 5), FIRST_CRAFT, ANTENNA)
    before = spec.model_dump()
    del before["sensor"]["bearing_offset_deg"]
    again = MissionSpec.model_validate(before)
    assert again == spec
    assert again.sensor.bearing_offset_deg == 0.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"scale": [1.0]}, "scale: 1 values, 3 weights"),
        ({"rate_weight": [0.0] * 6}, "rate_weight: all are zero"),
        ({"rate": [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]}, "greater than 0"),
    ],
)
def test_knowledge_that_makes_no_sense_is_refused(change: dict[str, list[float]], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        LearnedErrors.model_validate({**now([]).model_dump(), **change})
