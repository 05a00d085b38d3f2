"""What every Vehicle must do, on every adapter: the two simulated autopilots, and a real one when its URL is given.

CROSSFIX_TEST_VEHICLE=udpin://0.0.0.0:14540 flies the real (or software-in-the-loop) autopilot behind that URL: it takes
off, flies some 40 m around its home at 15 m and lands. Keep clear. What needs a simulated pilot is then skipped.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import os
import socket
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass, field
from itertools import pairwise

import pytest

from hardware.autopilot.connect import connect_vehicle
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import ScaledClock, WallClock
from hardware.frame import LocalFrame
from hardware.ports import PilotHasControl, Vehicle, VehicleError, VehicleUnreachable
from hardware.readings import GeoPoint
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, free_port, launch_simulated

REAL_URL = os.environ.get("CROSSFIX_TEST_VEHICLE")
SPEEDUP = 16.0
HEIGHT = 15.0
FLIGHT_COMMANDS = {20, 21, 22, 115, 176, 178, 192, 400}
DEAD_STATION = {"sim-px4": ("NAV_DLL_ACT", "RETURN"), "sim-ardupilot": ("FS_GCS_ENABLE", "RTL")}


@dataclass
class Rig:
    """One vehicle under test with its clock; `autopilot` None when it is a real one."""

    name: str
    vehicle: MavsdkVehicle
    clock: ScaledClock
    autopilot: SimulatedAutopilot | None
    lines: list[str] = field(default_factory=list)

    @property
    def sim(self) -> SimulatedAutopilot:
        if self.autopilot is None:
            pytest.skip("needs the simulated autopilot's pilot and faults")
        return self.autopilot

    async def until(self, happened: Callable[[], bool], seconds: float, what: str) -> None:
        end = self.clock.now() + seconds
        while not happened():
            assert self.clock.now() < end, f"{what} did not happen within {seconds} s: {self.vehicle.telemetry()}"
            await self.clock.sleep(0.1)

    def place(self, east: float, north: float) -> GeoPoint:
        """Metres from home."""
        home = self.vehicle.telemetry().home
        assert home is not None
        return LocalFrame(home).to_geo(east, north)

    def amsl(self) -> float:
        home = self.vehicle.telemetry().home_amsl_m
        assert home is not None
        return home + HEIGHT

    def off_by(self, place: GeoPoint) -> float:
        position = self.vehicle.telemetry().position
        assert position is not None
        return math.hypot(*LocalFrame(place).to_enu(position))

    async def airborne(self) -> None:
        if not self.vehicle.telemetry().in_air:
            await self.vehicle.take_off(HEIGHT)


async def _ready(vehicle: Vehicle, clock: ScaledClock) -> None:
    """Wait as an operator would until the vehicle is ready (failsafe parameters do not mend themselves)."""
    for _ in range(60):
        checks = await vehicle.preflight()
        if all(check.ok for check in checks if check.blocking and not check.name.startswith("Failsafe")):
            return
        await clock.sleep(1.0)


@pytest.fixture(params=["sim-px4", "sim-ardupilot", "real"])
async def rig(request: pytest.FixtureRequest) -> AsyncIterator[Rig]:
    name: str = request.param
    if name == "real":
        if REAL_URL is None:
            pytest.skip("CROSSFIX_TEST_VEHICLE names no vehicle")
        clock, autopilot, url = WallClock(), None, REAL_URL
    else:
        clock = ScaledClock(None, SPEEDUP)
        flavour = name.removeprefix("sim-")
        setting = Setting(flavour=flavour, speedup=SPEEDUP, seed=7, wind=(4.0, 250.0, 1.5), station_timeout_s=2.5)
        autopilot = await launch_simulated(setting)
        url = autopilot.url
    vehicle = await connect_vehicle(url, clock)
    rig = Rig(name, vehicle, clock, autopilot)

    async def listen() -> None:
        async for line in vehicle.changes():
            rig.lines.append(line)

    listener = asyncio.create_task(listen())
    try:
        await _ready(vehicle, clock)
        yield rig
    finally:
        if autopilot is None and vehicle.telemetry().in_air:
            with contextlib.suppress(VehicleError):
                vehicle.release_pilot_latch()
                await vehicle.land()
                await rig.until(lambda: not vehicle.telemetry().armed, 120, "landing")
        await vehicle.close()
        await asyncio.wait_for(listener, 5)  # closing ends changes()
        if autopilot is not None:
            await autopilot.stop()


async def _ends_with(task: asyncio.Task[None], error: type[BaseException], says: str = "") -> None:
    with pytest.raises(error, match=says):
        await asyncio.wait_for(task, 60)


async def test_the_snapshot_says_where_and_how_the_vehicle_is(rig: Rig) -> None:
    t = rig.vehicle.telemetry()

    assert t.connected
    assert t.autopilot in ("px4", "ardupilot")
    assert t.position is not None
    assert t.home is not None
    assert rig.off_by(t.home) < 100.0
    assert t.heading_deg is not None
    assert 0.0 <= t.heading_deg < 360.0
    assert t.heading_at_s is not None
    assert -0.05 < t.at_s - t.heading_at_s < 2.0
    assert t.controller == "nobody"
    assert t.mode
    await rig.clock.sleep(2.0)
    since = rig.clock.now() - 1.5
    headings = rig.vehicle.headings(since)
    assert len(headings) >= 10
    assert all(since <= a.at_s < b.at_s <= rig.clock.now() for a, b in pairwise(headings))


async def test_a_ready_vehicle_passes_its_checklist_and_each_bad_failsafe_refuses_with_a_remedy(rig: Rig) -> None:
    sim, (parameter, _) = rig.sim, DEAD_STATION.get(rig.name, ("", ""))
    assert [check for check in await rig.vehicle.preflight() if check.blocking and not check.ok] == []

    await sim.order("set_param", name=parameter, value=0)
    refused = [check for check in await rig.vehicle.preflight() if check.blocking and not check.ok]

    assert len(refused) == 1
    assert parameter in refused[0].name
    assert parameter in refused[0].remedy


async def test_it_takes_off_flies_turns_and_returns_each_seen_by_telemetry(rig: Rig) -> None:
    vehicle = rig.vehicle

    await vehicle.take_off(HEIGHT)
    t = vehicle.telemetry()
    assert t.in_air
    assert t.altitude_relative_m == pytest.approx(HEIGHT, abs=1.5)
    assert t.controller == "crossfix"

    place = rig.place(east=30.0, north=-25.0)
    await vehicle.goto(place, rig.amsl(), 5.0)
    assert rig.off_by(place) < 2.5
    if rig.autopilot is not None:
        truth = await rig.autopilot.order("truth")
        assert math.hypot(*LocalFrame(place).to_enu(GeoPoint(truth["lat"], truth["lon"]))) < 4.0

    began = rig.clock.now()
    await vehicle.turn(30.0)
    took = rig.clock.now() - began
    headings = [sample.heading_deg for sample in vehicle.headings(began)]
    turned = sum(math.remainder(b - a, 360.0) for a, b in pairwise(headings))
    assert turned >= 350.0
    assert {int(heading // 20) for heading in headings} == set(range(18))
    assert 8.0 < took < 30.0
    assert rig.off_by(place) < 3.0

    await vehicle.return_home()
    assert vehicle.telemetry().mode in ("RETURN", "RTL")
    await rig.until(lambda: not vehicle.telemetry().armed, 180, "the landing after the return")
    home = vehicle.telemetry().home
    assert home is not None
    assert rig.off_by(home) < 3.0
    assert not [line for line in rig.lines if "took over" in line]


async def test_hold_stops_a_flight_and_a_turn_at_any_moment(rig: Rig) -> None:
    vehicle = rig.vehicle
    await rig.airborne()

    far = rig.place(east=0.0, north=400.0)
    flight = asyncio.create_task(vehicle.goto(far, rig.amsl(), 7.0))
    await rig.until(lambda: (vehicle.telemetry().velocity_north_m_s or 0.0) > 4.0, 20, "flying north")
    await vehicle.hold()
    await _ends_with(flight, VehicleError, "replaced by Hold")
    stopped = vehicle.telemetry().position
    assert stopped is not None
    assert rig.off_by(far) > 250.0
    await rig.clock.sleep(8.0)
    assert rig.off_by(stopped) < 4.0

    turn = asyncio.create_task(vehicle.turn(20.0))
    await rig.clock.sleep(5.0)
    await vehicle.hold()
    await _ends_with(turn, VehicleError, "replaced by Hold")
    await rig.clock.sleep(4.0)
    headings = [sample.heading_deg for sample in vehicle.headings(rig.clock.now() - 2.0)]
    assert max(abs(math.remainder(heading - headings[0], 360.0)) for heading in headings) < 5.0

    await vehicle.goto(rig.place(0.0, 20.0), rig.amsl(), 7.0)  # after a hold it flies on
    await vehicle.land()
    assert vehicle.telemetry().mode == "LAND"
    await rig.until(lambda: not vehicle.telemetry().armed, 90, "the landing")
    assert rig.off_by(rig.place(0.0, 20.0)) < 4.0


async def test_on_the_ground_flight_orders_are_refused_in_words(rig: Rig) -> None:
    here = rig.vehicle.telemetry().position
    assert here is not None

    for order in (rig.vehicle.goto(here, rig.amsl(), 5.0), rig.vehicle.turn(30.0)):
        with pytest.raises(VehicleError, match="take off first"):
            await order
    for order in (rig.vehicle.return_home(), rig.vehicle.land()):
        with pytest.raises(VehicleError, match="on the ground"):
            await order
    await rig.vehicle.hold()  # nothing to do, never an error


@pytest.mark.parametrize(("altitude", "speed"), [(math.nan, 5.0), (500.0, 0.0), (500.0, -1.0), (math.inf, 5.0)])
async def test_orders_that_mean_nothing_are_refused_before_they_are_sent(altitude: float, speed: float) -> None:
    vehicle = MavsdkVehicle("udpin://127.0.0.1:1", WallClock())

    with pytest.raises(ValueError, match="No place to fly to"):
        await vehicle.goto(GeoPoint(47.0, 8.0), altitude, speed)
    for rate in (0.0, math.nan, 500.0):
        with pytest.raises(ValueError, match="turn rate must be"):
            await vehicle.turn(rate)
    with pytest.raises(ValueError, match="take-off altitude"):
        await vehicle.take_off(-3.0)


async def test_before_it_is_connected_every_order_says_so() -> None:
    vehicle = MavsdkVehicle("udpin://127.0.0.1:1", WallClock())
    orders: list[Callable[[], Awaitable[object]]] = [
        vehicle.hold,
        vehicle.land,
        vehicle.return_home,
        vehicle.preflight,
        lambda: vehicle.goto(GeoPoint(47.0, 8.0), 500.0, 5.0),
        lambda: vehicle.turn(30.0),
        lambda: vehicle.take_off(10.0),
    ]

    assert not vehicle.telemetry().connected
    assert vehicle.telemetry().autopilot == "unknown"
    for order in orders:
        with pytest.raises(VehicleUnreachable, match="No vehicle is connected"):
            await order()


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
    await _ends_with(flight, PilotHasControl, "Resume")
    assert vehicle.telemetry().controller == "pilot"
    assert vehicle.telemetry().held_by_pilot
    assert any("pilot took over" in line for line in rig.lines)

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
        with pytest.raises(PilotHasControl):
            await order()
    await sim.order("give_back")
    await rig.clock.sleep(3.0)
    assert not vehicle.telemetry().held_by_pilot
    with pytest.raises(PilotHasControl):  # the mode switch alone gives nothing back
        await vehicle.goto(here, rig.amsl(), 5.0)
    received = (await sim.order("commands", since_s=taken["time_s"] + 1e-6))["commands"]
    assert [number for _, number in received if number in FLIGHT_COMMANDS] == []

    vehicle.release_pilot_latch()
    assert vehicle.telemetry().controller != "pilot"
    await vehicle.goto(here, rig.amsl(), 5.0)
    assert vehicle.telemetry().controller == "crossfix"
    assert rig.off_by(here) < 3.0


async def test_a_mode_that_nobody_commanded_latches_too(rig: Rig) -> None:
    """The autopilot's own failsafe, or a pilot who selects return: the mission must not fight it."""
    await rig.airborne()
    mode = "RETURN" if rig.name == "sim-px4" else "RTL"

    await rig.sim.order("pilot_mode", mode=mode)
    await rig.until(lambda: rig.vehicle.telemetry().controller == "pilot", 5, "the latch")

    with pytest.raises(PilotHasControl, match=mode):
        await rig.vehicle.goto(rig.place(0.0, 0.0), rig.amsl(), 5.0)


async def test_a_lost_link_is_flagged_and_a_flight_survives_it(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await sim.order("set_param", name=DEAD_STATION[rig.name][0], value=0)  # else the autopilot returns by itself
    await rig.airborne()
    place = rig.place(0.0, 140.0)
    flight = asyncio.create_task(vehicle.goto(place, rig.amsl(), 3.0))
    await rig.until(lambda: (vehicle.telemetry().velocity_north_m_s or 0.0) > 1.0, 20, "flying north")

    await sim.order("link_loss", seconds=2.0 * SPEEDUP)  # shorter than the 3 wall seconds that a link may be silent
    await rig.clock.sleep(2.2 * SPEEDUP)
    assert vehicle.telemetry().connected
    assert not any("link lost" in line for line in rig.lines)
    await sim.order("link_loss", seconds=4.0 * SPEEDUP)
    await rig.until(lambda: not vehicle.telemetry().connected, 3.9 * SPEEDUP, "the lost link")
    old = vehicle.telemetry()
    assert old.position_at_s is not None
    assert rig.clock.now() - old.position_at_s > 3.0  # its age can be seen
    await rig.until(lambda: vehicle.telemetry().connected, 30, "the restored link")
    await asyncio.wait_for(flight, 60)

    assert rig.off_by(place) < 3.0
    assert any("link lost" in line for line in rig.lines)
    assert any("link restored" in line for line in rig.lines)


async def test_an_acknowledged_goto_that_does_nothing_is_seen_repeated_and_at_last_an_error(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()
    place = rig.place(0.0, 25.0)

    await sim.order("fault", kind="ignore_goto", count=1)
    await vehicle.goto(place, rig.amsl(), 6.0)
    assert rig.off_by(place) < 3.0
    assert any("place sent again (2 of 3)" in line for line in rig.lines)

    await sim.order("fault", kind="ignore_goto", count=100)
    with pytest.raises(VehicleError, match="did not arrive"):
        await vehicle.goto(rig.place(0.0, 60.0), rig.amsl(), 6.0)


async def test_an_acknowledged_turn_that_does_nothing_is_seen_repeated_and_at_last_an_error(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()

    # PX4 is sent three yaw steps ahead of the nose, a few more when the wind moves it
    await sim.order("fault", kind="ignore_yaw", count=5 if rig.name == "sim-px4" else 3)
    began = rig.clock.now()
    await vehicle.turn(45.0)
    headings = [sample.heading_deg for sample in vehicle.headings(began)]
    assert {int(heading // 20) for heading in headings} == set(range(18))
    assert any("tried again" in line or "sent again" in line for line in rig.lines)

    await sim.order("fault", kind="ignore_yaw", count=1000)
    with pytest.raises(VehicleError, match="acknowledged the turn and did not make it"):
        await vehicle.turn(45.0)


async def test_a_refusal_reaches_the_caller_in_words(rig: Rig) -> None:
    await rig.airborne()
    await rig.sim.order("fault", kind="refuse", count=1)

    with pytest.raises(VehicleError, match=r"refused.*denied"):
        await rig.vehicle.goto(rig.place(0.0, 20.0), rig.amsl(), 5.0)


async def test_an_unanswered_command_is_sent_again_visibly(rig: Rig) -> None:
    await rig.airborne()
    await rig.sim.order("fault", kind="silent", count=1)

    await rig.vehicle.goto(rig.place(0.0, 20.0), rig.amsl(), 5.0)

    assert any("sent again (2 of 3)" in line for line in rig.lines)


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
        assert t.controller == "nobody"
        assert rig.off_by(rig.place(0.0, 30.0)) < 3.0
        await again.hold()  # no latch: the vehicle waits as it was left
        assert again.telemetry().controller == "crossfix"
        await sim.order("set_param", name=parameter, value={"RETURN": 2, "RTL": 1}[returning])
    finally:
        await again.close()
    for _ in range(100):
        if (await sim.order("truth"))["mode"] == returning:
            return
        await asyncio.sleep(0.1)
    pytest.fail("the autopilot did not return by itself after its ground station was gone")


async def test_nobody_there_is_said_in_words() -> None:
    with pytest.raises(VehicleUnreachable, match="No autopilot answers"):
        await connect_vehicle(f"udpin://127.0.0.1:{free_port()}", WallClock(), timeout_s=0.3)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        with pytest.raises(VehicleUnreachable, match="Another ground station"):
            await connect_vehicle(f"udpin://127.0.0.1:{taken.getsockname()[1]}", WallClock(), timeout_s=0.3)
    with pytest.raises(ValueError, match="udpin://"):
        MavsdkVehicle("14540", WallClock())
