"""Recorded sweeps as facts: like flown ones, once, all or nothing, with every doubt said."""

from __future__ import annotations

import math
from uuid import uuid4

import numpy as np
import pytest
from doubles import FRAME, PATTERN, PointingFinder, Stage, spec

from backend import commands
from backend.commands import CommandRequest
from backend.events import BearingMeasured, BeliefUpdated, MissionDrafted, RecordingImported, SweepRejected
from backend.mission.errors import MissionConflict, MissionInputError
from backend.mission.importing import Upload, import_facts
from backend.mission.state import MissionState, evolve
from backend.spec import Place
from hardware.direction_finding.recordings import RecordedSweep, Recording
from hardware.readings import GeoPoint, Sweep

TARGET = (30.0, 60.0)


def recorded(x: float, y: float, at_s: float = 0.0, place_known: bool = True) -> RecordedSweep:
    n = 90
    position = FRAME.to_geo(x, y)
    times, headings = np.linspace(at_s, at_s + 9.0, n), np.linspace(0.0, 356.0, n)
    sweep = Sweep(times, headings, np.full(n, -60.0), 868.3e6, position, 140.0)
    return RecordedSweep(sweep, None, place_known)


def upload(*sweeps: RecordedSweep, name: str = "a", **words: object) -> Upload:
    recording = Recording(sweeps, ("turn.csv:7: not understood",))
    return Upload(recording_id=name, filename="turn.csv", recording=recording, **words)  # type: ignore[arg-type]


def drafted() -> MissionState:
    return evolve(MissionState(), MissionDrafted(spec=spec()), 0.0)


def facts(given: Upload, finder: PointingFinder | None = None) -> list:
    return list(import_facts("m", drafted(), given, finder or PointingFinder(TARGET), PATTERN, "ann").facts)


def test_every_sweep_leaves_the_facts_of_a_flown_one() -> None:
    found = import_facts(
        "m", drafted(), upload(recorded(-80.0, 10.0), recorded(80.0, 10.0)), PointingFinder(TARGET), PATTERN, "ann"
    )
    assert [f.kind for f in found.facts] == [
        "recording_imported",
        *["sweep_started", "bearing_measured", "belief_updated"] * 2,
    ]
    imported, bearings = found.facts[0], [f for f in found.facts if isinstance(f, BearingMeasured)]
    assert isinstance(imported, RecordingImported)
    assert imported.sweep_ids == [b.sweep_id for b in bearings] == [k.sweep_id for k in found.sweeps]
    assert imported.remarks[0] == "turn.csv:7: not understood"
    assert [b.place_number for b in bearings] == [1, 2]
    assert [b.bearings for b in found.facts if isinstance(b, BeliefUpdated)] == [1, 2]


def test_a_rejected_sweep_is_a_fact_and_changes_no_belief() -> None:
    kinds = [f.kind for f in facts(upload(recorded(0.0, 10.0)), PointingFinder(TARGET, rejected=1))]
    assert kinds == ["recording_imported", "sweep_started", "sweep_rejected"]


def test_the_named_time_moves_the_recording_and_the_files_own_is_kept() -> None:
    named = import_facts(
        "m", drafted(), upload(recorded(0, 10, at_s=50.0), at_s=1.7e9), PointingFinder(TARGET), PATTERN, "ann"
    )
    assert named.sweeps[0].sweep.at_s[0] == 1.7e9
    own, unknown = facts(upload(recorded(0, 10, at_s=1.6e9)))[0], facts(upload(recorded(0, 10, at_s=50.0)))[0]
    assert own.recorded_at_utc.timestamp() == 1.6e9
    assert unknown.recorded_at_utc is None


def test_place_frequency_and_altitude_that_do_not_fit_are_said_or_refused() -> None:
    away = FRAME.to_geo(0.0, 80_000.0)
    with pytest.raises(MissionInputError, match="80 km from the mission's area"):
        facts(upload(recorded(0.0, 80_000.0)))
    with pytest.raises(MissionInputError, match="does not tell where"):
        facts(upload(recorded(0.0, 10.0, place_known=False)))
    with pytest.raises(MissionInputError, match="km from"):
        facts(upload(recorded(0.0, 10.0), place=Place(lat=away.lat_deg, lon=away.lon_deg)))
    odd = recorded(0.0, 10.0)
    heard = odd.sweep
    heard = Sweep(heard.at_s, heard.heading_deg, heard.power_db, 433e6, GeoPoint(50.0, 7.0), math.nan)
    odd = RecordedSweep(heard, 0.0, True)
    remarks = facts(upload(odd))[0].remarks
    assert any("433.0000 MHz; the mission looks for 868.3000 MHz" in r for r in remarks)
    assert any("altitude" in r for r in remarks)


async def test_the_same_recording_is_imported_once() -> None:
    stage = Stage()
    mission_id = await stage.service.create(spec(), "ann")
    first, again = [await stage.service.import_recording(mission_id, upload(recorded(0, 10)), "ann") for _ in range(2)]
    assert (first[1], again[1]) == (False, True)
    told = ("recording_imported", "bearing_measured")
    assert [r.seq for r in again[0]] == [r.seq for r in first[0] if r.event.kind in told]
    assert stage.journal.kinds(mission_id).count("bearing_measured") == 1


async def test_a_journal_that_is_away_keeps_nothing_of_it() -> None:
    stage = Stage()
    mission_id = await stage.service.create(spec(), "ann")
    stage.journal.away = True
    with pytest.raises(ConnectionError):
        await stage.service.import_recording(mission_id, upload(recorded(0, 10)), "ann")
    stage.journal.away = False
    assert stage.journal.kinds(mission_id) == ["mission_drafted"]
    _, already = await stage.service.import_recording(mission_id, upload(recorded(0, 10)), "ann")
    assert not already


async def test_leaving_out_an_imported_bearing_or_editing_the_draft_settles_the_belief() -> None:
    stage = Stage()
    mission_id = await stage.service.create(spec(), "ann")
    new, _ = await stage.service.import_recording(mission_id, upload(recorded(-80, 10), recorded(80, 10)), "ann")
    bearing = next(r.event for r in new if isinstance(r.event, BearingMeasured))
    exclude = commands.ExcludeBearing(bearing_id=bearing.bearing_id)
    await stage.service.command(mission_id, CommandRequest(command_id=uuid4(), command=exclude), "ann")
    beliefs = [e for e in stage.journal.events(mission_id) if isinstance(e, BeliefUpdated)]
    assert [b.bearings for b in beliefs] == [1, 2, 1]
    await stage.service.edit(mission_id, spec().model_copy(update={"name": "renamed"}), "ann")
    assert stage.journal.kinds(mission_id)[-1] == "belief_updated"


async def test_a_mission_in_flight_takes_no_recording() -> None:
    stage = Stage()
    await stage.service.start_up()
    try:
        mission_id = await stage.service.create(spec(), "ann")
        started = CommandRequest(command_id=uuid4(), command=commands.Start())
        assert (await stage.service.command(mission_id, started, "ann")).accepted
        with pytest.raises(MissionConflict, match="flying"):
            await stage.service.import_recording(mission_id, upload(recorded(0, 10)), "ann")
    finally:
        await stage.service.shut_down()
    assert not any(isinstance(e, SweepRejected) for e in stage.journal.events(mission_id))
