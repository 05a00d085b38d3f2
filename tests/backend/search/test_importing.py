"""Recorded sweeps as facts: like flown ones, once, all or nothing, with every doubt said."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import get_args
from uuid import uuid4

import numpy as np
import pytest
from equipment import FRAME, PATTERN, TWO_EMITTERS, PointingFinder, spec
from flights import order, stuck
from refusals import near
from stage import Stage

from backend import commands
from backend.commands import CommandRequest
from backend.events import BearingMeasured, BeliefUpdated, Event, ImportSource, MissionDrafted, RecordingImported
from backend.ports import JournalUnavailable
from backend.reasons.refusals import NoSuchEmitter
from backend.reasons.search import (
    HeardElsewhere,
    ImportRemark,
    OtherFrequency,
    RecordingTooFar,
    RecordingTooLong,
    WhichEmitter,
)
from backend.search.errors import MissionInputError
from backend.search.importing import MOST_SWEEPS, OF_IMPORTS, Import, Upload, import_facts
from backend.search.state import SearchState, evolve
from backend.spec import EmitterSpec, MissionSpec, MovementSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.direction_finding.recordings import RecordedSweep, Recording
from hardware.readings import BearingReading, Place, Sweep
from hardware.reasons.pattern import PatternOfOtherFrequency
from hardware.reasons.table import CellUnusable, OneTagOnly, PlaceNotStated

TARGET = (30.0, 60.0)
REMARK = CellUnusable("turn.csv", 7, 1, "north", "heading")


def recorded(x: float, y: float, at_s: float = 0.0, place_known: bool = True) -> RecordedSweep:
    n = 90
    position = FRAME.to_geo(x, y)
    times, headings = np.linspace(at_s, at_s + 9.0, n), np.linspace(0.0, 356.0, n)
    sweep = Sweep(times, headings, np.full(n, -60.0), 868.3e6, position, 140.0)
    return RecordedSweep(sweep, None, place_known)


def upload(*sweeps: RecordedSweep, name: str = "a", **words: object) -> Upload:
    recording = Recording(sweeps, (REMARK,))
    return Upload(recording_id=name, filename="turn.csv", recording=recording, **words)  # type: ignore[arg-type]


def drafted(mission: MissionSpec | None = None) -> SearchState:
    return evolve(SearchState(), MissionDrafted(spec=mission or spec()), 0.0)


def imported(given: Upload, finder: PointingFinder | None = None, mission: MissionSpec | None = None) -> Import:
    return import_facts("m", drafted(mission), given, finder or PointingFinder(TARGET), PATTERN, "ann")


def facts(given: Upload, finder: PointingFinder | None = None) -> list[Event]:
    return list(imported(given, finder).facts)


def what_was_imported(given: Upload) -> RecordingImported:
    first = facts(given)[0]
    assert isinstance(first, RecordingImported)
    return first


def test_every_sweep_leaves_the_facts_of_a_flown_one() -> None:
    found = imported(upload(recorded(-80.0, 10.0), recorded(80.0, 10.0)))
    assert [f.kind for f in found.facts] == ["recording_imported", *["bearing_measured", "belief_updated"] * 2]
    first, bearings = found.facts[0], [f for f in found.facts if isinstance(f, BearingMeasured)]
    assert isinstance(first, RecordingImported)
    assert first.sweep_ids == [b.sweep_id for b in bearings] == [k.sweep_id for k in found.sweeps]
    assert first.remarks[0] == REMARK
    assert {(b.emitter_id, b.source) for b in bearings} == {("emitter-1", ImportSource(recording_id="a"))}
    assert [b.place_number for b in bearings] == [1, 2]
    assert [b.bearings for b in found.facts if isinstance(b, BeliefUpdated)] == [1, 2]


def test_a_recording_is_of_the_emitter_that_is_named() -> None:
    mission = spec(TWO_EMITTERS)
    given = upload(recorded(-80.0, 10.0), emitter_id="emitter-2")
    found = imported(given, mission=mission)
    assert {fact.emitter_id for fact in found.facts} == {"emitter-2"}  # type: ignore[union-attr]
    assert [kept.emitter_id for kept in found.sweeps] == ["emitter-2"]
    state = drafted(mission)
    for fact in found.facts:
        state = evolve(state, fact, 0.0)
    assert {name: len(emitter.bearings) for name, emitter in state.emitters.items()} == {"emitter-1": 0, "emitter-2": 1}
    with pytest.raises(MissionInputError) as refused:
        imported(upload(recorded(-80.0, 10.0), emitter_id="fox"), mission=mission)
    assert (refused.value.reason, refused.value.field) == (NoSuchEmitter("fox"), "emitter_id")


def of(tag: str | None = None, frequency_hz: float = 0.0) -> RecordedSweep:
    one = recorded(-80.0, 10.0)
    return replace(one, sweep=replace(one.sweep, tag=tag, frequency_hz=frequency_hz))


def test_turns_of_several_tags_are_refused_until_one_is_named() -> None:
    with pytest.raises(MissionInputError) as refused:
        imported(upload(of("lynx"), of(None), of("hare"), of("lynx")))
    assert (refused.value.reason, refused.value.field) == (OneTagOnly("turn.csv", ("hare", "lynx")), "tag")
    assert len(imported(upload(of("lynx"), of(None), of("Lynx"))).sweeps) == 3


def test_turns_named_by_frequencies_of_one_channel_are_of_one_emitter() -> None:
    tuned = [of("150.1", 150.1e6), of("150.106", 150.106e6)]
    assert len(imported(upload(*tuned)).sweeps) == 2
    for others in ([of("150.1", 150.1e6), of("150.2", 150.2e6)], [of("7", 150.1e6), of("8", 150.1e6)]):
        with pytest.raises(MissionInputError) as refused:
            imported(upload(*others))
        assert refused.value.field == "tag"


def test_of_several_emitters_the_recordings_frequency_or_whoever_sends_it_says_which() -> None:
    first, second = spec(TWO_EMITTERS).emitters
    apart = spec([first, second.model_copy(update={"frequency_hz": first.frequency_hz + 100e3})])
    near = [of(frequency_hz=first.frequency_hz + 120e3), of(frequency_hz=first.frequency_hz + 110e3)]
    assert {kept.emitter_id for kept in imported(upload(*near), mission=apart).sweeps} == {"emitter-2"}
    alike = spec([first, second.model_copy(update={"frequency_hz": first.frequency_hz})])
    for mission, frequency_hz in ((apart, 0.0), (alike, first.frequency_hz)):
        with pytest.raises(MissionInputError) as refused:
            imported(upload(of(frequency_hz=frequency_hz)), mission=mission)
        assert (refused.value.reason, refused.value.field) == (WhichEmitter(2), "emitter_id")
    with pytest.raises(MissionInputError) as refused:
        imported(upload(of(frequency_hz=433e6)), mission=apart)
    assert refused.value.reason == HeardElsewhere(433e6)
    named = upload(of(frequency_hz=first.frequency_hz + 100e3), emitter_id="emitter-1")
    (told,) = [one for one in imported(named, mission=apart).facts if isinstance(one, RecordingImported)]
    assert OtherFrequency("turn.csv", first.frequency_hz + 100e3, first.frequency_hz) in told.remarks


def test_another_antennas_sweeps_are_heard_through_its_own_pattern() -> None:
    heard_with: list[str] = []

    class Listening(PointingFinder):
        def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
            heard_with.append(pattern.name)
            return super().estimate(sweep, pattern)

    loop = replace(PATTERN, name="loop", frequency_hz=868.3e6)
    other = replace(loop, frequency_hz=150e6)
    found = imported(upload(recorded(-80.0, 10.0), pattern=loop), Listening(TARGET))
    first = found.facts[0]
    assert isinstance(first, RecordingImported)
    assert first.antenna is not None
    assert (heard_with, first.antenna.name) == (["loop"], "loop")
    with pytest.raises(MissionInputError) as refused:
        imported(upload(recorded(-80.0, 10.0), pattern=other))
    assert (refused.value.field, refused.value.reason) == ("antenna", PatternOfOtherFrequency("loop", 150e6, 868.3e6))


def test_a_rejected_sweep_is_a_fact_and_changes_no_belief() -> None:
    kinds = [f.kind for f in facts(upload(recorded(0.0, 10.0)), PointingFinder(TARGET, rejected=1))]
    assert kinds == ["recording_imported", "sweep_rejected"]


def test_the_named_time_moves_the_recording_and_the_files_own_is_kept() -> None:
    named = imported(upload(recorded(0, 10, at_s=50.0), at_s=1.7e9))
    assert named.sweeps[0].sweep.at_s[0] == 1.7e9
    own = what_was_imported(upload(recorded(0, 10, at_s=1.6e9)))
    unknown = what_was_imported(upload(recorded(0, 10, at_s=50.0)))
    assert own.recorded_at_utc is not None
    assert own.recorded_at_utc.timestamp() == 1.6e9
    assert unknown.recorded_at_utc is None


def test_a_place_that_does_not_fit_is_refused() -> None:
    away = FRAME.to_geo(0.0, 80_000.0)
    for given in (upload(recorded(0.0, 80_000.0)), upload(recorded(0.0, 10.0), place=away)):
        with pytest.raises(MissionInputError) as refused:
            facts(given)
        assert refused.value.reason == RecordingTooFar(near(80_000))
        assert refused.value.field == "lat"
    with pytest.raises(MissionInputError) as refused:
        facts(upload(recorded(0.0, 10.0, place_known=False)))
    assert refused.value.reason == PlaceNotStated("turn.csv")


def test_too_many_sweeps_at_once_are_refused() -> None:
    with pytest.raises(MissionInputError) as refused:
        facts(upload(*[recorded(0.0, 10.0)] * (MOST_SWEEPS + 1)))
    assert (refused.value.reason, refused.value.field) == (RecordingTooLong(MOST_SWEEPS + 1, MOST_SWEEPS), "file")


def test_a_frequency_and_an_altitude_that_do_not_fit_are_said_and_a_place_that_was_replaced() -> None:
    heard = recorded(0.0, 10.0).sweep
    heard = Sweep(heard.at_s, heard.heading_deg, heard.power_db, 433e6, Place(50.0, 7.0), math.nan)
    odd = RecordedSweep(heard, 0.0, True)
    assert what_was_imported(upload(odd)).remarks == [
        REMARK,
        OtherFrequency("turn.csv", 433e6, 868.3e6),
        ImportRemark("turn.csv", "altitude_unknown"),
    ]
    replaced = what_was_imported(upload(recorded(0.0, 10.0), place=FRAME.to_geo(5.0, 10.0)))
    assert replaced.remarks == [REMARK, ImportRemark("turn.csv", "place_replaced")]


async def test_the_same_recording_is_imported_once() -> None:
    stage = Stage()
    mission_id = await stage.room.drafts.create(spec(), "ann")
    first, again = [
        await stage.room.drafts.import_recording(mission_id, upload(recorded(0, 10)), "ann") for _ in range(2)
    ]
    assert (first[1], again[1]) == (False, True)
    told = ("recording_imported", "bearing_measured")
    assert [r.seq for r in again[0]] == [r.seq for r in first[0] if r.event.kind in told]
    assert stage.journal.kinds(mission_id).count("bearing_measured") == 1


async def test_a_journal_that_is_away_keeps_nothing_of_it() -> None:
    stage = Stage()
    mission_id = await stage.room.drafts.create(spec(), "ann")
    stage.journal.away = True
    with pytest.raises(JournalUnavailable):
        await stage.room.drafts.import_recording(mission_id, upload(recorded(0, 10)), "ann")
    stage.journal.away = False
    assert stage.journal.kinds(mission_id) == ["mission_drafted"]
    _, already = await stage.room.drafts.import_recording(mission_id, upload(recorded(0, 10)), "ann")
    assert not already


async def test_leaving_out_an_imported_bearing_or_editing_the_draft_settles_the_belief() -> None:
    stage = Stage()
    mission_id = await stage.room.drafts.create(spec(), "ann")
    given = upload(recorded(-80, 10), recorded(80, 10))
    new, _ = await stage.room.drafts.import_recording(mission_id, given, "ann")
    bearing = next(r.event for r in new if isinstance(r.event, BearingMeasured))
    assert (await order(stage, mission_id, commands.ExcludeBearing(bearing_id=bearing.bearing_id))).accepted
    assert [b.bearings for b in stage.journal.of_kind(mission_id, BeliefUpdated)] == [1, 2, 1]
    await stage.room.drafts.edit(mission_id, spec().model_copy(update={"name": "renamed"}), "ann")
    assert stage.journal.kinds(mission_id)[-1] == "belief_updated"


async def test_a_mission_in_flight_takes_a_recording_and_keeps_its_place(stage: Stage) -> None:
    mission_id = await stuck(stage)
    flown = stage.active.state.craft.chosen
    new, already = await stage.room.drafts.import_recording(mission_id, upload(recorded(0, 10)), "ann")
    assert not already
    assert {r.event.kind for r in new} == {"recording_imported", "bearing_measured"}
    updated = await stage.until(mission_id, "belief_updated", 2)
    assert isinstance(updated, BeliefUpdated)
    assert updated.bearings == 1
    assert stage.active.state.craft.phase == "flying"
    assert stage.active.state.craft.chosen == flown
    again = CommandRequest(command_id=uuid4(), command=commands.Hold())
    assert (await stage.room.flights.command(mission_id, again, commands.Author("ann"))).accepted


@pytest.mark.parametrize("bearing", [70.0, 310.0])
def test_a_recorded_turn_of_270_degrees_is_a_bearing_like_any_other(bearing: float) -> None:
    """310 lies in the gap; the finder is the real one."""
    n = 136
    times, headings = np.linspace(0.0, 9.0, n), np.linspace(0.0, 270.0, n)
    pattern = load_pattern(SMALL_YAGI)
    power = -60.0 + pattern.gain_at(bearing - headings)
    sweep = Sweep(times, headings, power, 868.3e6, FRAME.to_geo(0.0, -50.0), 140.0)
    given = upload(RecordedSweep(sweep, None, True))
    found = import_facts("m", drafted(), given, SparseDirectionFinder(), pattern, "ann").facts
    (measured,) = (fact for fact in found if isinstance(fact, BearingMeasured))
    off = math.remainder(measured.bearing_deg - pattern.offset_to_nose_deg - bearing, 360.0)
    assert abs(off) < 2.0 * measured.sigma_deg < 40.0


def test_a_sweep_tells_when_it_was_taken_where_that_is_known() -> None:
    """An emitter that moves is not where it was."""
    dated = imported(upload(recorded(-80.0, 10.0), recorded(80.0, 10.0, at_s=60.0), at_s=1.7e9))
    times = [fact.taken_at_s for fact in dated.facts if isinstance(fact, BearingMeasured)]
    assert times == pytest.approx([1.7e9 + 4.5, 1.7e9 + 64.5])
    unknown = imported(upload(recorded(-80.0, 10.0)))
    assert [fact.taken_at_s for fact in unknown.facts if isinstance(fact, BearingMeasured)] == [None]


def test_a_recording_of_which_nobody_knows_when_stops_no_search_for_what_moves() -> None:
    """Beside bearings whose time is known it tells nothing of where the emitter is by now."""
    moves = EmitterSpec(movement=MovementSpec(kind="drifting", speed_m_s=0.4))
    mission = spec([moves])
    mission = mission.model_copy(update={"sensor": mission.sensor.model_copy(update={"bearing_errors": "joint"})})
    state = drafted(mission)
    for given in (upload(recorded(-80.0, 10.0), name="old"), upload(recorded(80.0, 10.0), name="new", at_s=1.7e9)):
        found = import_facts("m", state, given, PointingFinder(TARGET), PATTERN, "ann")
        for fact in found.facts:
            state = evolve(state, fact, 1.7e9)
    belief = state.emitters["emitter-1"].belief
    assert belief is not None
    assert (belief.bearings, belief.localized) == (2, False)


def test_whatever_may_name_a_recording_as_its_source_is_looked_at() -> None:
    kinds = [kind for kind in get_args(get_args(Event)[0]) if "source" in kind.model_fields]
    naming = [kind for kind in kinds if ImportSource in get_args(kind.model_fields["source"].annotation)]
    assert {kind.model_fields["kind"].default for kind in naming} | {"recording_imported"} == set(OF_IMPORTS)
