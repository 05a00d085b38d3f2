"""What was acknowledged is there, in order, without gaps and byte for byte, on both databases."""

from __future__ import annotations

import math

import numpy as np
import pytest

from backend.events import (
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    CraftSource,
    HoldOrdered,
    MissionDrafted,
    MissionEnded,
    MissionStarted,
    PhaseChanged,
)
from backend.ports import FactRefused, TrackPoint
from backend.reasons.flight import Proceeds
from backend.reasons.search import Localized
from backend.spec import MissionSpec, Polygon
from backend.store.entries import JournalConflict
from hardware.readings import Place, Sweep

SPEC = MissionSpec(name="Æ search", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
DRAFT = MissionDrafted(spec=SPEC)
STARTED = MissionStarted(
    craft_id="craft-1", by="operator", home=Place(lat=50.6, lon=7.2), home_amsl_m=100.0, software="0.1.0"
)
ENDED = MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0)


def hold(by: str = "operator") -> HoldOrdered:
    return HoldOrdered(craft_id="craft-1", by=by, reason=None)


def bearing(snr_db: float | None = 20.0, bearing_deg: float = 1 / 3) -> BearingMeasured:
    return BearingMeasured(
        emitter_id="emitter-1",
        source=CraftSource(craft_id="craft-1"),
        bearing_id="b1",
        sweep_id="s1",
        place_number=1,
        place=Place(lat=50.6, lon=7.2),
        altitude_amsl_m=140.0,
        bearing_deg=bearing_deg,
        sigma_deg=7.0,
        quality=0.9,
        peaks=[],
        snr_db=snr_db,
        drift_m=0.1,
        binned_db=[None, 0.1],
        fitted_db=[0.0, 0.1],
    )


async def test_another_process_reads_back_the_same_facts(bench):
    first = await bench.open()
    written = await first.append("m", [DRAFT, STARTED, bearing()])
    bench.now_s += 0.123457
    written += await first.append("m", [hold()])
    await bench.close()
    again = await bench.open()
    assert await again.read("m") == written
    assert await again.append("m", [hold("later")]) == await again.read("m", after=4)


async def test_a_fact_that_makes_no_sense_is_refused_can_be_kept_aside_and_blocks_nothing(journal, tmp_path):
    await journal.append("m", [DRAFT])
    broken = bearing().model_copy(update={"bearing_deg": math.nan})
    with pytest.raises(FactRefused, match="bearing_deg"):
        await journal.append("m", [hold(), broken])
    await journal.keep_aside("m", [broken], "no bearing")
    (after,) = await journal.append("m", [hold()])
    assert after.seq == 2
    assert journal.report().refused == 1
    assert b"bearing_measured" in (tmp_path / "journal.refused").read_bytes()


async def test_after_a_conflict_the_next_fact_follows_what_the_other_wrote(bench):
    one, other = await bench.open(), await bench.open("other.spool")
    await one.append("m", [DRAFT])
    await other.append("m", [hold("theirs")])
    with pytest.raises(JournalConflict):
        await one.append("m", [hold("ours")])
    (again,) = await one.append("m", [hold("ours")])
    assert again.seq == 3
    assert [record.event.by for record in (await one.read("m"))[1:]] == ["theirs", "ours"]


async def test_a_second_writer_is_found_out(bench):
    one, other = await bench.open(), await bench.open("other.spool")
    await one.append("m", [DRAFT])
    await other.read("m")
    await other.append("m", [hold("theirs")])
    with pytest.raises(JournalConflict):
        await one.append("m", [hold("ours")])


async def test_the_list_counts_bearings_that_count_and_no_silences(journal):
    def left_out(which: str, heard: bool) -> BearingExcluded:
        return BearingExcluded(emitter_id="emitter-1", bearing_id=which, by="operator", reason="", heard=heard)

    def back(which: str, heard: bool) -> BearingIncluded:
        return BearingIncluded(emitter_id="emitter-1", bearing_id=which, by="operator", heard=heard)

    counts: list[int] = []
    await journal.append("m", [DRAFT, STARTED, bearing()])
    for fact in (left_out("s2", False), back("s2", False), left_out("b1", True), back("b1", True)):
        await journal.append("m", [fact])
        counts.append((await journal.mission("m")).bearings)
    assert counts == [1, 1, 0, 1]


async def test_the_list_tells_phase_outcome_and_counts(bench):
    journal = await bench.open()
    await journal.append("old", [DRAFT])
    bench.now_s += 10
    moved = PhaseChanged(craft_id="craft-1", before="planning", after="measuring", reason=Proceeds("flight"))
    excluded = BearingExcluded(emitter_id="emitter-1", bearing_id="b1", by="operator", reason="")
    await journal.append("new", [DRAFT, STARTED, moved, bearing(), bearing(), excluded])
    (flying, _) = await journal.missions()
    assert (flying.phase, flying.crafts, flying.flying) == ("measuring", {"craft-1": "measuring"}, True)
    await journal.append("new", [ENDED])
    new, old = await journal.missions()
    assert (new.mission_id, old.mission_id) == ("new", "old")
    assert (new.phase, new.outcome, new.flying) == ("done", "localized", True)
    assert (new.emitters, new.bearings, new.mission_time_s) == (1, 1, 200.0)
    assert new == await journal.mission("new")
    assert (old.phase, old.started_at_us, old.name) == ("draft", None, "Æ search")
    assert await journal.mission("none") is None


async def test_kinds_can_be_picked(journal):
    await journal.append("m", [DRAFT, STARTED, hold(), bearing(), hold(), ENDED])
    assert [record.seq for record in await journal.read_kinds("m", ["hold_ordered", "mission_ended"])] == [3, 5, 6]


async def test_a_raw_sweep_comes_back_bit_for_bit(journal):
    await journal.append("m", [DRAFT])
    at_s = np.array([1.0, 2.0, 3.0])
    power_db = np.array([-80.0, math.nan, -70.000000001])
    sweep = Sweep(at_s, at_s * 30, power_db, 868.3e6, Place(50.6, 7.2), math.nan, 0.4, 2, None, "7")
    await journal.save_sweep("m", "s1", "craft-1", "emitter-1", 1, 2, sweep)
    await journal.save_sweep("m", "s1", "craft-1", "emitter-1", 1, 2, sweep)
    stored = await journal.sweep("m", "s1")
    assert (stored.craft_id, stored.emitter_id) == ("craft-1", "emitter-1")
    assert (stored.place_number, stored.attempt, stored.altitude_amsl_m, stored.tag) == (1, 2, None, "7")
    np.testing.assert_array_equal(stored.sweep().power_db, power_db)
    np.testing.assert_array_equal(stored.sweep().heading_deg, at_s * 30)
    assert await journal.sweep("m", "s2") is None


async def test_the_tracks_are_in_time_order_and_without_doubles(journal):
    await journal.append("m", [DRAFT])
    points = [TrackPoint(1.7e9 + n / 2, 50.6, 7.2, 140.0, 40.0, 90.0, None, "HOLD") for n in range(5)]
    await journal.save_track("m", "craft-1", points[2:])
    await journal.save_track("m", "craft-1", [*points[:3], TrackPoint(1.7e9, math.nan, 7.2, 1, 1, 1, None, None)])
    await journal.save_track("m", "craft-2", points[:1])
    assert await journal.tracks("m") == {"craft-1": points, "craft-2": points[:1]}


async def test_an_ended_mission_is_still_read_and_written(journal):
    written = await journal.append("m", [DRAFT, STARTED, ENDED])
    assert await journal.read("m") == written
    (late,) = await journal.append("m", [hold()])
    assert late.seq == 4
