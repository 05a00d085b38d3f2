"""Several emitters that share a source's errors: what is believed, when it is stale, and that the facts retell it."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from search_walk import SearchWalk

from backend.api.beliefs import belief_frame
from backend.api.what_if import what_if
from backend.events import (
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BeliefUpdated,
    CraftSource,
    Event,
    MissionDrafted,
    MissionEdited,
    PersonSource,
    Recorded,
    ServerRestarted,
    SourceMuteChanged,
)
from backend.search.area import corner_of
from backend.search.importing import Upload
from backend.search.importing_bearings import bearing_facts
from backend.search.inputs import BearingsArrived, BeliefReady
from backend.search.lessons import knowing
from backend.search.localization import localization
from backend.search.state import SearchState, evolve
from backend.search.task import search_task
from backend.search.together import together
from backend.spec import EmitterSpec, MissionSpec, MovementSpec, Polygon, SensorSpec
from backend.wire.resources import WhatIfRequest
from hardware.direction_finding.bearings_file import RecordedBearing
from hardware.direction_finding.recordings import Recording
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.belief.joint import JointBelief, update_joint
from planner.types import Bearing

HOME = Place(lat=50.6, lon=7.2)
FRAME = LocalFrame(HOME)
TARGETS = {"a": (30.0, 120.0), "b": (-80.0, 60.0), "c": (90.0, 170.0)}
PLACES = ((0.0, -40.0), (150.0, 40.0), (-140.0, 190.0), (20.0, 230.0))
BIAS_DEG = 7.0


def corner(x: float, y: float) -> tuple[float, float]:
    point = FRAME.to_geo(x, y)
    return point.lon, point.lat


RING = [corner(-150, 0), corner(150, 0), corner(150, 200), corner(-150, 200), corner(-150, 0)]
EMITTERS = [EmitterSpec(emitter_id=name, frequency_hz=150e6 + 1e5 * k) for k, name in enumerate(TARGETS)]
SENSOR = SensorSpec(bearing_errors="joint", shared_errors=True)
SPEC = MissionSpec(name="meadow", area=Polygon(coordinates=[RING]), emitters=EMITTERS, sensor=SENSOR)
ALONE = SPEC.model_copy(update={"sensor": SENSOR.model_copy(update={"shared_errors": False})})


def bearing(name: str, number: int) -> BearingMeasured:
    """All of them turned by one compass."""
    (x, y), (east, north) = PLACES[number - 1], TARGETS[name]
    own = float(np.random.default_rng([number, *name.encode()]).normal(0.0, 2.0))
    return BearingMeasured(
        emitter_id=name,
        source=CraftSource(craft_id="craft-1"),
        bearing_id=f"{name}{number}",
        sweep_id=f"s-{name}{number}",
        place_number=number,
        place=FRAME.to_geo(x, y),
        altitude_amsl_m=0.0,
        bearing_deg=(math.degrees(math.atan2(east - x, north - y)) + BIAS_DEG + own) % 360.0,
        sigma_deg=math.hypot(3.0, 4.0),
        quality=0.95,
        peaks=[],
        snr_db=30.0,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
        heading_sigma_deg=4.0,
        measurement_time_s=16.0,
    )


def flown(spec: MissionSpec, turns: int) -> tuple[SearchState, list[Recorded]]:
    """Turn by turn: the bearings of all, then the beliefs as a mission records them."""
    state, records = SearchState(), list[Recorded]()

    def record(event: MissionDrafted | BearingMeasured | BeliefUpdated) -> None:
        nonlocal state
        at = datetime(2026, 11, 23, tzinfo=UTC) + timedelta(seconds=len(records))
        state = evolve(state, event, at.timestamp())
        records.append(Recorded(seq=len(records) + 1, mission_id="m", at_utc=at, event=event))

    record(MissionDrafted(spec=spec))
    task = search_task(spec, corner_of(SPEC.area), 0.0)
    for number in range(1, turns + 1):
        for name in TARGETS:
            record(bearing(name, number))
        for name in TARGETS:
            record(task.together.about(state, name).belief_fact(state.emitters[name].bearings)[0])
    return state, records


def test_beliefs_asked_for_at_once_are_those_asked_for_in_turn_each_folded_once(monkeypatch: pytest.MonkeyPatch):
    state, records = flown(SPEC, 3)
    folded: list[tuple[Bearing, ...]] = []

    def counted(belief: JointBelief, taken: Bearing) -> JointBelief:
        folded.append((*belief.folded, taken))
        return update_joint(belief, taken)

    monkeypatch.setattr("backend.search.localization.update_joint", counted)
    task = search_task(SPEC, corner_of(SPEC.area), 0.0)
    with ThreadPoolExecutor(len(TARGETS)) as pool:
        told = pool.map(
            lambda name: task.together.about(state, name).belief_fact(state.emitters[name].bearings)[0], TARGETS
        )
        assert [one.digest for one in told] == [digests(records, name)[-1] for name in TARGETS]
    assert len(folded) == len(set(folded)) == 3 * len(TARGETS)


def digests(records: list[Recorded], name: str) -> list[str]:
    return [r.event.digest for r in records if isinstance(r.event, BeliefUpdated) and r.event.emitter_id == name]


def test_a_specification_that_does_not_say_so_shares_nothing() -> None:
    assert not MissionSpec.model_validate({"name": "m", "area": SPEC.area}).sensor.shared_errors
    assert ALONE.sharing == ()
    assert SPEC.sharing == ("a", "b", "c")
    assert SPEC.model_copy(update={"emitters": EMITTERS[:1]}).sharing == ()
    independent = SENSOR.model_copy(update={"bearing_errors": "independent"})
    assert SPEC.model_copy(update={"sensor": independent}).sharing == ()
    walking = EMITTERS[0].model_copy(update={"movement": MovementSpec(kind="animal", speed_m_s=0.2)})
    assert SPEC.model_copy(update={"emitters": [walking, *EMITTERS[1:]]}).sharing == ("b", "c")


def test_one_compass_is_known_better_from_all_of_them_and_said_alike() -> None:
    (_, alone), (_, shared) = flown(ALONE, 3), flown(SPEC, 3)
    last_alone, last = ([r.event for r in records[-3:]] for records in (alone, shared))
    for before, after in zip(last_alone, last, strict=True):
        assert isinstance(before, BeliefUpdated)
        assert isinstance(after, BeliefUpdated)
        (own,), (told,) = before.sources, after.sources
        assert told.bias_std_error_deg < 0.8 * own.bias_std_error_deg
        assert abs(told.bias_deg - BIAS_DEG) < 3.0 * told.bias_std_error_deg
        assert told.bearings == 3
    assert len({round(event.sources[0].bias_deg, 2) for event in last if isinstance(event, BeliefUpdated)}) == 1


def test_one_emitter_is_believed_bit_for_bit_what_it_was() -> None:
    for spec in (SPEC, ALONE):
        one = spec.model_copy(update={"emitters": EMITTERS[:1]})
        state = SearchState()
        for event in (MissionDrafted(spec=one), *(bearing("a", number) for number in (1, 2, 3))):
            state = evolve(state, event, 0.0)
        told = together(one, HOME, "a").about(state, "a").belief_fact(state.emitters["a"].bearings)[0]
        assert told == localization(one, HOME, "a").belief_fact([bearing("a", number) for number in (1, 2, 3)])[0]


def test_the_facts_retell_each_belief_as_it_was_flown() -> None:
    state, records = flown(SPEC, 3)
    again = together(SPEC, corner_of(SPEC.area), "b").about(state, "b")
    fact, _ = again.belief_fact(state.emitters["b"].bearings)
    assert fact.digest == digests(records, "b")[-1] != digests(flown(ALONE, 3)[1], "b")[-1]
    asked = WhatIfRequest(bearings=3, emitter_id="b")
    told = what_if("m", records, asked)
    assert told is not None
    assert told.belief.digest == digests(records, "b")[-1]
    assert [step.expected_rmse_m for step in told.steps[1:]] == [step.flown_expected_rmse_m for step in told.steps[1:]]
    # left out of what the others were told, too
    without = what_if("m", records, WhatIfRequest(bearings=3, emitter_id="b", without=["a1", "a2", "a3"]))
    assert without is not None
    assert without.belief.digest not in (told.belief.digest, digests(flown(ALONE, 3)[1], "b")[-1])
    assert belief_frame("m", records, True, "b") != belief_frame("m", records[: 1 + 2 * 6], True, "b")


def test_bearings_from_a_file_are_believed_with_what_the_other_emitters_tell() -> None:
    state, _ = flown(SPEC, 2)
    read = RecordedBearing(line=1, place=FRAME.to_geo(140.0, 190.0), bearing_deg=240.0, sigma_deg=5.0)
    given = Upload("r", "station.csv", Recording((), (), (read,)), emitter_id="a")
    *facts, belief = bearing_facts("m", state, given, "anna", believed=True).facts
    assert bearing_facts("m", state, given, "anna", believed=False).facts == tuple(facts)
    for fact in facts:
        state = evolve(state, fact, 0.0)
    counted = state.emitters["a"].bearings
    assert belief == together(SPEC, corner_of(SPEC.area), "a").about(state, "a").belief_fact(counted)[0]
    assert belief != localization(SPEC, corner_of(SPEC.area), "a").belief_fact(counted)[0]


def test_a_bearing_of_one_outruns_what_is_believed_of_all() -> None:
    state, _ = flown(SPEC, 2)
    assert state.beliefs_current
    for event in (
        bearing("a", 3),
        BearingExcluded(emitter_id="a", bearing_id="a1", by="anna", reason="", heard=True),
    ):
        later = evolve(state, event, 0.0)
        assert not any(emitter.belief_current for emitter in later.emitters.values())
        assert later.behind("b") != state.behind("b")
        assert later.behind("b")[:2] == ("b1", "b2")
    alone, _ = flown(ALONE, 2)
    later = evolve(alone, bearing("a", 3), 0.0)
    assert [name for name, emitter in later.emitters.items() if emitter.belief_current] == ["b", "c"]
    assert later.behind("b") == ("b1", "b2")


def test_a_belief_that_another_emitters_bearing_outran_is_no_belief() -> None:
    walk = SearchWalk(SPEC)
    walk.give(BearingsArrived((bearing("a", 1), bearing("b", 1))))
    task = localization(SPEC, HOME, "a")
    fact, _ = task.belief_fact([bearing("a", 1)])
    before = walk.state.behind("a")
    walk.give(BearingsArrived((bearing("b", 2),)))
    walk.give(BeliefReady(before, fact))
    assert not walk.state.emitters["a"].belief_current
    walk.give(BeliefReady(walk.state.behind("a"), fact))
    assert walk.state.emitters["a"].belief_current


def test_who_was_not_heard_yet_is_told_nothing_and_waits_for_nobody() -> None:
    state = SearchState()
    for event in (MissionDrafted(spec=SPEC), bearing("a", 1)):
        state = evolve(state, event, 0.0)
    assert state.behind("a") == ("a1",)
    about = together(SPEC, HOME, "a")
    belief = about.about(state, "c").belief(())
    assert isinstance(belief, JointBelief)
    assert belief.density == pytest.approx(about.emitters["c"].prior.density)
    first, _ = about.about(state, "a").belief_fact(state.emitters["a"].bearings)
    assert first.digest == localization(SPEC, HOME, "a").belief_fact(state.emitters["a"].bearings)[0].digest


def test_a_task_that_was_told_of_others_does_not_teach_those_that_ask_later() -> None:
    state, _ = flown(SPEC, 2)
    tasks = together(SPEC, HOME, "a")
    told = tasks.about(state, "a")
    assert told.beside is not None
    assert tasks.emitters["a"].beside is None
    assert tasks.emitters["a"].after(()).beside is None
    assert (
        replace(told, beside=None).belief_fact([bearing("a", 1)])[0]
        == (localization(SPEC, HOME, "a").belief_fact([bearing("a", 1)])[0])
    )


def believed(state: SearchState, spec: MissionSpec = SPEC) -> dict[str, BeliefUpdated]:
    """By emitter, by a server that begins with nothing but the state."""
    task = search_task(spec, corner_of(SPEC.area), 0.0)
    return {
        name: task.together.about(state, name).belief_fact(emitter.bearings)[0]
        for name, emitter in state.emitters.items()
    }


def digest_of_each(state: SearchState, spec: MissionSpec = SPEC) -> dict[str, str]:
    return {name: fact.digest for name, fact in believed(state, spec).items()}


def after(state: SearchState, *events: Event) -> SearchState:
    for event in events:
        state = evolve(state, event, 0.0)
    return state


def by_ada(name: str, number: int, off_deg: float) -> BearingMeasured:
    """A person beside the place, whose hand compass is off."""
    true = bearing(name, number)
    wrong = {"bearing_deg": (true.bearing_deg - BIAS_DEG + off_deg) % 360.0, "heading_sigma_deg": 5.0}
    return true.model_copy(
        update={"source": PersonSource(name="Ada"), "bearing_id": f"ada-{name}{number}", "sigma_deg": 12.0, **wrong}
    )


def test_a_bearing_that_counts_again_brings_every_belief_back_bit_for_bit() -> None:
    state, _ = flown(SPEC, 3)
    before = digest_of_each(state)
    out = after(state, BearingExcluded(emitter_id="a", bearing_id="a2", by="anna", reason="", heard=True))
    left_out = digest_of_each(out)
    assert all(left_out[name] != before[name] for name in before)
    assert digest_of_each(after(out, BearingIncluded(emitter_id="a", bearing_id="a2", by="anna"))) == before


def test_a_wrong_bearing_that_is_muted_is_as_if_it_had_never_come() -> None:
    state, _ = flown(SPEC, 3)
    before, ada = digest_of_each(state), PersonSource(name="Ada")
    heard = after(state, by_ada("a", 4, 100.0), by_ada("b", 4, 100.0))
    muted = SourceMuteChanged(source=ada, muted=True, by="anna")
    assert digest_of_each(heard)["a"] != before["a"]
    assert digest_of_each(after(heard, muted)) == before
    # what the muted person sends later does not count either
    assert digest_of_each(after(heard, muted, by_ada("c", 4, 100.0))) == before
    back = after(heard, muted, SourceMuteChanged(source=ada, muted=False, by="anna"))
    assert digest_of_each(back) == digest_of_each(heard)


def test_somebody_elses_wrong_compass_is_not_taken_for_the_crafts() -> None:
    state, _ = flown(SPEC, 3)
    wrong = after(state, *(by_ada(name, number, 40.0) for name in TARGETS for number in (1, 2)))
    for fact in believed(wrong).values():
        craft, person = sorted(fact.sources, key=lambda one: one.source.kind)
        assert abs(craft.bias_deg - BIAS_DEG) < 3.0 * craft.bias_std_error_deg
        assert (craft.bearings, person.bearings) == (3, 2)


def test_a_search_that_leaves_an_emitter_leaves_what_it_told() -> None:
    state, _ = flown(SPEC, 3)
    fewer = SPEC.model_copy(update={"emitters": EMITTERS[:2]})
    left = after(state, MissionEdited(spec=fewer))
    assert set(left.emitters) == {"a", "b"}
    assert not any(emitter.belief_current for emitter in left.emitters.values())
    never = after(
        SearchState(), MissionDrafted(spec=fewer), *(bearing(name, k) for k in (1, 2, 3) for name in ("a", "b"))
    )
    assert digest_of_each(left, fewer) == digest_of_each(never, fewer)


def test_a_server_that_restarts_believes_what_it_did() -> None:
    state, records = flown(SPEC, 3)
    again = after(state, ServerRestarted())
    assert not any(emitter.belief_current for emitter in again.emitters.values())
    assert digest_of_each(again) == {name: digests(records, name)[-1] for name in TARGETS}
    told_back_to_front = {name: again.emitters[name] for name in reversed(TARGETS)}
    assert digest_of_each(replace(again, emitters=told_back_to_front)) == digest_of_each(state)


def test_an_emitter_first_heard_late_knows_the_compass_at_once() -> None:
    early = {name: [bearing(name, number) for number in (1, 2, 3)] for name in ("a", "b")}
    state = after(SearchState(), MissionDrafted(spec=SPEC), *early["a"], *early["b"], bearing("c", 4))
    (told,) = believed(state)["c"].sources
    assert told.bearings == 1
    assert abs(told.bias_deg - BIAS_DEG) < 3.0 * told.bias_std_error_deg
    alone = after(SearchState(), MissionDrafted(spec=SPEC), bearing("c", 4))
    assert told.bias_std_error_deg < 0.7 * believed(alone)["c"].sources[0].bias_std_error_deg
    # one bearing tells nothing of the compass that it was heard by: the others know what they did
    without = after(SearchState(), MissionDrafted(spec=SPEC), *early["a"], *early["b"])
    for name in ("a", "b"):
        (now,), (then,) = believed(state)[name].sources, believed(without)[name].sources
        assert now.bias_deg == pytest.approx(then.bias_deg, abs=0.5)
        assert now.bias_std_error_deg == pytest.approx(then.bias_std_error_deg, abs=0.3)


def test_what_a_compass_may_be_off_by_is_half_normal() -> None:
    """With the scale of fielded compasses, by the range that each value stands for; of one emitter as of several."""
    one = SPEC.model_copy(update={"emitters": EMITTERS[:1]})
    several, single = (knowing(spec, [], "craft-1", "yagi").sensor.learned for spec in (SPEC, one))
    assert several == single
    assert single is not None
    stands_for = np.array([0.75, 0.75, 1.25, 2.0, 3.25, 4.0])
    weight = stands_for * np.exp(-0.5 * (np.array([0.5, 1.0, 2.0, 3.5, 6.0, 10.0]) / 5.3) ** 2)
    assert single.spread_weight == pytest.approx(weight / weight.sum())
    # a mission keeps the weights that it was drafted with
    stored = SPEC.having_learned(single)
    assert MissionSpec.model_validate_json(stored.model_dump_json()).sensor.learned == single
