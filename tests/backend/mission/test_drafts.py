"""Missions before they fly: drafted, edited, checked, and refused with reasons."""

from __future__ import annotations

from typing import Any

import pytest
from equipment import spec
from facts import CHECK
from flights import order, stuck
from refusals import refusing
from stage import Stage

from backend import commands
from backend.events import AntennaChecked, BearingMeasured, BeliefUpdated, MissionDrafted, MissionEdited, PersonSource
from backend.mission.inputs import Input
from backend.reasons import refusals
from backend.reasons.safety import AltitudeOutside
from backend.search.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.search.inputs import BearingsArrived
from backend.search.state import SearchState
from backend.spec import Place


def antenna_checked() -> AntennaChecked:
    check = CHECK.model_copy(update={"name": "antenna"})
    return AntennaChecked(check=check, emitter=Place(lat=50.0, lon=7.1), by="ann")


async def test_drafts_are_checked_edited_and_refused_with_reasons(stage: Stage) -> None:
    bad = spec().model_copy(update={"area": spec().area.model_copy(update={"coordinates": []})})
    with pytest.raises(MissionInputError):
        await stage.room.drafts.create(bad, "anna")
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert stage.journal.state(mission_id).phase == "draft"
    assert (await stage.room.drafts.preflight(mission_id)).passed
    assert stage.journal.state(mission_id).phase == "ready"
    await stage.room.drafts.edit(mission_id, spec(speed_m_s=5.0), "anna")
    assert stage.journal.state(mission_id).phase == "draft"
    edited = stage.journal.of_kind(mission_id, MissionEdited)[0]
    assert (edited.spec.flight.speed_m_s, edited.by) == (5.0, "anna")
    assert not (await order(stage, mission_id, commands.Hold())).accepted
    with refusing(refusals.NoMission("nobody"), MissionNotFound):
        await stage.room.drafts.edit("nobody", spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    with refusing(refusals.NotEditable, MissionConflict):
        await stage.room.drafts.edit(mission_id, spec(), "anna")


@pytest.mark.parametrize(
    ("flight", "outside"),
    [
        ({"altitude_relative_m": 130.0}, (130.0, 10.0, 120.0)),
        ({"altitude_relative_m": 5.0}, (5.0, 10.0, 120.0)),
        ({"minimum_altitude_relative_m": 60.0, "maximum_altitude_relative_m": 30.0}, (40.0, 60.0, 30.0)),
    ],
)
async def test_an_altitude_outside_its_band_is_refused_where_it_is_drafted_and_where_it_is_edited(
    stage: Stage, flight: dict[str, Any], outside: tuple[float, float, float]
) -> None:
    mission_id = await stage.room.drafts.create(spec(altitude_relative_m=120.0), "anna")
    for refused in (
        stage.room.drafts.create(spec(**flight), "anna"),
        stage.room.drafts.edit(mission_id, spec(**flight), "anna"),
    ):
        with pytest.raises(MissionInputError) as error:
            await refused
        assert error.value.field == "flight.altitude_relative_m"
        assert error.value.reason == AltitudeOutside(*outside)
    assert stage.journal.of_kind(mission_id, MissionEdited) == []


async def test_a_draft_from_before_the_band_was_asked_is_read_and_not_started(stage: Stage) -> None:
    high = spec(altitude_relative_m=130.0)
    await stage.journal.append("old", [MissionDrafted(spec=high)])
    checked = await stage.room.drafts.preflight("old")
    assert AltitudeOutside(130.0, 10.0, 120.0) in [check.reason for check in checked.checks if not check.ok]
    assert not (await order(stage, "old", commands.Start())).accepted
    assert stage.vehicle.names == []


async def test_the_check_of_the_antenna_stays_in_the_checklist_until_an_edit(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    await stage.room.records.append(mission_id, [antenna_checked()])
    assert "antenna" in [check.name for check in (await stage.room.drafts.preflight(mission_id)).checks]
    await stage.room.drafts.edit(mission_id, spec(), "anna")
    assert "antenna" not in [check.name for check in (await stage.room.drafts.preflight(mission_id)).checks]


async def test_no_antenna_is_checked_while_a_mission_flies(stage: Stage) -> None:
    mission_id = await stuck(stage)
    other = await stage.room.drafts.create(spec(), "anna")
    for checked in (mission_id, other):
        with refusing(refusals.MissionFlies(), MissionConflict):
            await stage.room.drafts.check_antenna(checked, Place(lat=50.0, lon=7.1), 1.0, "ann")


async def test_a_preflight_of_a_craft_that_is_not_there_is_refused(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    with pytest.raises(KeyError):
        await stage.room.drafts.preflight(mission_id, "craft-9")


def taken(search: SearchState, number: int, place: Place, bearing_deg: float) -> Input:
    fact = BearingMeasured(
        emitter_id=next(iter(search.emitters)),
        source=PersonSource(name="ben"),
        bearing_id=f"ben-{number}",
        sweep_id=None,
        place_number=number,
        place=place,
        altitude_amsl_m=100.0,
        bearing_deg=bearing_deg,
        sigma_deg=3.0,
        quality=1.0,
        peaks=[],
        snr_db=None,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
    )
    return BearingsArrived((fact,))


async def test_a_persons_bearings_reach_the_belief_of_a_mission_in_the_air_and_the_craft_flies_on(
    stage: Stage,
) -> None:
    mission_id = await stuck(stage)
    chosen = stage.active.state.craft.chosen
    beliefs = len(stage.journal.of_kind(mission_id, BeliefUpdated))
    given = taken(stage.active.state.search, 7, Place(lat=50.0, lon=6.9995), 45.0)
    await stage.room.flights.give(mission_id, given)
    updated = await stage.until(mission_id, "belief_updated", beliefs + 1)
    assert isinstance(updated, BeliefUpdated)
    assert updated.bearings == 1
    assert (stage.active.state.craft.phase, stage.active.state.craft.chosen) == ("flying", chosen)
    assert stage.vehicle.names.count("goto") == 1


async def test_a_persons_bearings_are_kept_by_a_mission_that_nobody_flies(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    search = stage.journal.state(mission_id).search
    for number, (lon, bearing_deg) in enumerate(((6.9995, 45.0), (7.0005, 315.0)), 1):
        await stage.room.flights.give(mission_id, taken(search, number, Place(lat=50.0, lon=lon), bearing_deg))
    state = stage.journal.state(mission_id)
    assert len(state.search.measured) == 2
    assert (state.phase, state.engaged) == ("draft", ())
    await stage.room.drafts.edit(mission_id, spec(speed_m_s=5.0), "anna")
    (belief,) = stage.journal.of_kind(mission_id, BeliefUpdated)
    assert belief.bearings == 2
    assert stage.journal.state(mission_id).search.beliefs_current
