"""What a craft's receiver heard while it flew from place to place."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.events import BearingSource, CraftSource, HeardOnTheWay
from backend.search.state import SearchState
from backend.search.way_facts import Leg, way_fact
from backend.spec import EmitterSpec, MissionSpec, Place


def listened_to(mission: MissionSpec) -> tuple[EmitterSpec, ...]:
    """The emitters of which legs count: those that stand still, where errors are joint."""
    if not mission.sensor.listen_on_the_way or mission.sensor.bearing_errors != "joint":
        return ()
    return tuple(emitter for emitter in mission.emitters if emitter.movement.kind == "still")


async def heard_on_leg(
    equipment: CraftEquipment,
    mission: MissionSpec,
    listening: Listening,
    search: SearchState,
    place_number: int,
    begin: Place | None,
    began_s: float,
) -> tuple[HeardOnTheWay, ...]:
    """One fact an emitter, of a leg that just ended where the craft will turn. begin None: nobody knows from where.

    Sends nothing, waits for nothing: samples that are still to come were heard beside that place, where they would not
    count.
    """
    wanted = listened_to(mission)
    telemetry = equipment.vehicle.telemetry()
    if not wanted or begin is None or telemetry.position is None:
        return ()
    source = CraftSource(craft_id=equipment.craft_id)
    leg = Leg(source, place_number, begin, (*turned_at(search, source), telemetry.position))
    # headings of a clock that runs oddly cannot be dated
    headings = equipment.vehicle.headings(began_s) if telemetry.odd_clock_rate is None else []
    ended_s = equipment.clock.now()
    return tuple(
        [
            await asyncio.to_thread(
                way_fact,
                leg,
                emitter.emitter_id,
                mission.sensor,
                equipment.pattern,
                listening.between(began_s, ended_s, emitter.frequency_hz),
                headings,
            )
            for emitter in wanted
        ]
    )


def turned_at(search: SearchState, source: BearingSource) -> tuple[Place, ...]:
    """Where this source's turns told something."""
    told: Iterable[Place] = (
        fact.place
        for emitter in search.emitters.values()
        for fact in (*emitter.measured, *emitter.silences)
        if fact.source == source
    )
    return tuple(dict.fromkeys(told))
