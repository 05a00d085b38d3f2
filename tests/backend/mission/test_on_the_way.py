"""A mission that listens on the way: a fact a leg, beliefs that count it, and the same again from the journal."""

from __future__ import annotations

from equipment import FRAME, spec
from flights import flying, order
from stage import Stage

from backend import commands
from backend.events import BeliefUpdated, HeardOnTheWay, PlaceReached
from backend.search.localization import localization
from backend.spec import FIRST_EMITTER, MissionSpec, Place
from hardware.readings import HeadingSample
from hardware.yaw_swings import Swinging

STEPS = 60


def listening() -> MissionSpec:
    mission = spec()
    sensor = mission.sensor.model_copy(update={"bearing_errors": "joint", "listen_on_the_way": True})
    return mission.model_copy(update={"sensor": sensor})


def turning_in_flight(stage: Stage) -> None:
    """The vehicle turns its nose all the way and tells where it is meanwhile."""
    vehicle = stage.vehicle
    goto = vehicle.goto

    async def turning(
        place: Place,
        altitude_amsl_m: float,
        speed_m_s: float,
        heading_deg: float | None = None,
        swinging: Swinging | None = None,
    ) -> None:
        assert vehicle.state.position is not None
        here, there = FRAME.to_enu(vehicle.state.position), FRAME.to_enu(place)
        for step in range(STEPS):
            began_s = stage.clock.now()
            await stage.clock.sleep(0.2)
            took_s = stage.clock.now() - began_s
            looks = 2 + int(2.0 * took_s)  # a busy machine sleeps for seconds of this clock
            for look in range(looks):
                share = (step + look / looks) / STEPS
                at = FRAME.to_geo(*(a + share * (b - a) for a, b in zip(here, there, strict=True)))
                vehicle.headings_heard.append(HeadingSample(began_s + look / looks * took_s, 360.0 * share, at))
        await goto(place, altitude_amsl_m, speed_m_s, heading_deg)

    vehicle.goto = turning  # type: ignore[method-assign]


async def test_each_leg_is_kept_counted_and_folded_again_from_the_journal(stage: Stage) -> None:
    turning_in_flight(stage)
    mission_id = await stage.room.drafts.create(listening(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until_true(lambda: len(stage.journal.of_kind(mission_id, HeardOnTheWay)) >= 2)
    await stage.until(mission_id, "belief_updated")
    legs = stage.journal.of_kind(mission_id, HeardOnTheWay)
    reached = stage.journal.of_kind(mission_id, PlaceReached)
    assert [leg.place_number for leg in legs] == [place.place_number for place in reached]
    assert any(leg.tells for leg in legs)
    await stage.until_true(lambda: stage.journal.state(mission_id).search.beliefs_current)
    events = stage.journal.events(mission_id)
    search = stage.journal.state(mission_id).search
    emitter = search.emitters[FIRST_EMITTER]
    last = [event for event in events if isinstance(event, BeliefUpdated)][-1]
    assert search.home is not None
    task = localization(search.mission, search.home).after(emitter.unheard, emitter.legs)
    assert task.belief_fact(emitter.bearings)[0].digest == last.digest


async def test_a_mission_that_does_not_ask_for_it_keeps_no_leg(stage: Stage) -> None:
    turning_in_flight(stage)
    mission_id = await flying(stage)
    await stage.until_phase(mission_id, "measuring")
    assert stage.journal.of_kind(mission_id, HeardOnTheWay) == []
