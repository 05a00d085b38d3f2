"""Who has control of every Vehicle: a pilot, an autopilot by itself, this program or the next."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import pytest
from rig import DEAD_STATION, FLIGHT_COMMANDS, HEIGHT, Rig, ends_with

from hardware.autopilot.connect import connect_vehicle
from hardware.ports import NotInControl
from hardware.reasons.vehicle_news import TakenOver, TakenOverBySticks
from hardware.yaw_swings import Swinging, SwingPlan


async def test_a_pilot_ends_automatic_flight_and_nothing_passes_until_released(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()
    flight = asyncio.create_task(vehicle.goto(rig.place(0.0, 300.0), rig.amsl(), 7.0))
    await rig.until(lambda: (vehicle.telemetry().velocity_north_m_s or 0.0) > 3.0, 20, "flying north")

    if rig.name == "sim-px4":
        taken = await sim.order("pilot_sticks", east_m_s=1.0)
        assert taken["took_control"]
    else:
        taken = await sim.order("pilot_mode")
    await ends_with(flight, NotInControl)
    assert vehicle.telemetry().authority.who == "pilot"
    assert not vehicle.telemetry().authority.given_back
    assert any(isinstance(news, TakenOver | TakenOverBySticks) for news in rig.news)

    here = rig.place(0.0, 10.0)
    orders: list[Callable[[], Awaitable[None]]] = [
        vehicle.hold,
        vehicle.return_home,
        vehicle.land,
        lambda: vehicle.goto(here, rig.amsl(), 5.0),
        lambda: vehicle.turn(30.0),
        lambda: vehicle.take_off(20.0),
    ]
    for order in orders:
        with pytest.raises(NotInControl):
            await order()
    await sim.order("give_back")
    await rig.clock.sleep(3.0)
    assert vehicle.telemetry().authority.given_back
    with pytest.raises(NotInControl):  # the mode switch alone gives nothing back
        await vehicle.goto(here, rig.amsl(), 5.0)
    received = (await sim.order("commands", since_s=taken["time_s"] + 1e-6))["commands"]
    assert [number for _, number in received if number in FLIGHT_COMMANDS] == []

    vehicle.take_control()
    assert vehicle.telemetry().authority.who != "pilot"
    await vehicle.goto(here, rig.amsl(), 5.0)
    assert vehicle.telemetry().authority.who == "ours"
    assert rig.off_by(here) < 3.0


@pytest.mark.parametrize("what", ["flight", "turn"])
async def test_a_pilots_switch_that_meets_commands_under_way_is_never_undone(rig: Rig, what: str) -> None:
    """On a link of a second each way a command is nearly always under way, and none of them selects a mode."""
    vehicle, sim = rig.vehicle, rig.sim
    steered = {"sim-px4": "HOLD", "sim-ardupilot": "GUIDED"}[rig.name]
    await rig.airborne()
    await sim.order("link_delay", seconds=1.0)
    for after_s in (0.3, 0.6, 0.9, 1.2):
        vehicle.take_control()
        there = rig.place(0.0, 40.0 * after_s)
        deed = vehicle.turn(40.0) if what == "turn" else vehicle.goto(there, rig.amsl(), 5.0)
        task = asyncio.create_task(deed)
        await rig.clock.sleep(after_s)
        pilots = (await sim.order("pilot_mode"))["mode"]
        await ends_with(task, NotInControl)
        await rig.clock.sleep(3.0)
        assert (await sim.order("truth"))["mode"] == pilots
        assert vehicle.telemetry().authority.who == "pilot"
        await sim.order("pilot_mode", mode=steered)
        async with asyncio.timeout(60):
            while not vehicle.telemetry().authority.given_back:  # noqa: ASYNC110 (heard a moment later)
                await asyncio.sleep(0.02)


async def test_a_pilots_switch_that_meets_swings_of_the_nose_is_never_undone(rig: Rig) -> None:
    """On a link of half a second each way an order of the nose is nearly always under way."""
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()
    await sim.order("link_delay", seconds=0.5)
    for after_s, place in ((0.3, rig.place(0.0, 120.0)), (0.8, rig.place(120.0, 0.0)), (1.4, rig.place(0.0, -120.0))):
        vehicle.take_control()
        swinging = Swinging(SwingPlan(45.0, 75.0, 30.0), lambda _: 500.0)
        flight = asyncio.create_task(vehicle.goto(place, rig.amsl(), 5.0, None, swinging))
        await rig.until(lambda swinging=swinging: swinging.swings.stage == "swinging", 60, "swinging")
        await rig.clock.sleep(after_s)
        taken = await sim.order("pilot_mode")
        await ends_with(flight, NotInControl)
        assert swinging.swings.end == "not_ours"
        await rig.clock.sleep(3.0)
        assert (await sim.order("truth"))["mode"] == taken["mode"]
        received = (await sim.order("commands", since_s=taken["time_s"] + 2.5))["commands"]
        assert [number for _, number in received if number in FLIGHT_COMMANDS] == []
        await sim.order("pilot_mode", mode={"sim-px4": "HOLD", "sim-ardupilot": "GUIDED"}[rig.name])
        async with asyncio.timeout(60):
            while not vehicle.telemetry().authority.given_back:  # noqa: ASYNC110 (heard a moment later)
                await asyncio.sleep(0.02)


async def test_an_order_that_undoes_a_pilots_switch_is_seen_within_a_second_and_nothing_follows(rig: Rig) -> None:
    """A return is the order of a person and has to change the mode: on a slow link it may meet the pilot's."""
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()
    await sim.order("link_delay", seconds=2.0)
    before = vehicle.telemetry().authority.commanded
    returning = asyncio.create_task(vehicle.return_home())
    async with asyncio.timeout(60):
        while vehicle.telemetry().authority.commanded == before:  # noqa: ASYNC110 (sent a moment later)
            await asyncio.sleep(0)
    taken = await sim.order("pilot_mode")
    await ends_with(returning, NotInControl)
    await rig.clock.sleep(5.0)
    assert (await sim.order("truth"))["mode"] != taken["mode"]
    assert vehicle.telemetry().authority.who == "pilot"
    quiet_from = (await sim.order("ping"))["time_s"]
    with pytest.raises(NotInControl):
        await vehicle.hold()
    await rig.clock.sleep(3.0)
    received = (await sim.order("commands", since_s=quiet_from))["commands"]
    assert [number for _, number in received if number in FLIGHT_COMMANDS] == []


async def test_a_mode_that_nobody_commanded_latches_until_the_vehicle_has_landed_and_is_nobodys(rig: Rig) -> None:
    """The autopilot's own failsafe, or a pilot who selects landing: the mission must not fight it."""
    await rig.airborne()

    await rig.sim.order("pilot_mode", mode="LAND")
    await rig.until(lambda: rig.vehicle.telemetry().authority.who == "pilot", 5, "the latch")

    with pytest.raises(NotInControl, match="LAND"):
        await rig.vehicle.goto(rig.place(0.0, 0.0), rig.amsl(), 5.0)
    await rig.until(lambda: rig.vehicle.telemetry().armed is False, 60, "the landing")
    assert rig.vehicle.telemetry().authority.who == "nobody"
    with pytest.raises(NotInControl, match="LAND"):
        await rig.vehicle.take_off(HEIGHT)


async def test_when_this_program_dies_the_autopilot_acts_and_a_new_one_finds_it(rig: Rig) -> None:
    sim, (parameter, returning) = rig.sim, DEAD_STATION.get(rig.name, ("", ""))
    await rig.airborne()
    await sim.order("set_param", name=parameter, value=0)
    await rig.vehicle.goto(rig.place(0.0, 30.0), rig.amsl(), 6.0)
    await rig.vehicle.close()

    again = await connect_vehicle(sim.url, rig.clock)
    try:
        t = again.telemetry()
        assert t.in_air
        assert t.authority.who == "nobody"
        assert rig.off_by(rig.place(0.0, 30.0)) < 3.0
        await again.hold()  # no latch: the vehicle waits as it was left
        assert again.telemetry().authority.who == "ours"
        await sim.order("set_param", name=parameter, value={"RETURN": 2, "RTL": 1}[returning])
    finally:
        await again.close()
    for _ in range(100):
        if (await sim.order("truth"))["mode"] == returning:
            return
        await asyncio.sleep(0.1)
    pytest.fail("the autopilot did not return by itself after its ground station was gone")
