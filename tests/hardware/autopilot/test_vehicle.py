"""MavsdkVehicle beyond its port's contract: against the simulated autopilots over real sockets."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from hardware.autopilot.connect import connect_vehicle
from hardware.autopilot.messages import ARM, HOME_POSITION_ID, TAKE_OFF, message_interval
from hardware.autopilot.snapshot import Fields, Snapshot
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import ScaledClock
from hardware.frame import LocalFrame
from hardware.ports import NotInControl, VehicleError
from hardware.readings import Announcement
from hardware.reasons.vehicle import AutopilotRefused
from hardware.reasons.vehicle_news import PositionJumped, SwitchUndone, TriedAgain, VehicleNews
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated

SPEEDUP = 16.0


@dataclass
class Rig:
    vehicle: MavsdkVehicle
    clock: ScaledClock
    sim: SimulatedAutopilot
    news: list[VehicleNews]

    async def until(self, happened: Callable[[], bool], seconds: float = 60.0) -> None:
        end = self.clock.now() + seconds
        while not happened():
            assert self.clock.now() < end, f"did not happen in {seconds} s: {self.news}, {self.vehicle.telemetry()}"
            await self.clock.sleep(0.1)

    async def climbed(self, height_m: float) -> None:
        await self.until(lambda: (self.vehicle.telemetry().altitude_relative_m or 0.0) > height_m)

    async def knows_the_switch(self) -> None:
        """The first position that is heard is no movement."""
        await self.until(lambda: self.vehicle._monitor.mode_switch._position_us is not None)

    async def announced(self, happened: Callable[[VehicleNews], bool]) -> None:
        await self.until(lambda: any(happened(news) for news in self.news))


async def _keep(source: AsyncIterator[Announcement], news: list[VehicleNews]) -> None:
    async for announcement in source:
        news.append(announcement.reason)  # noqa: PERF401 (each must be seen when it comes)


async def make(flavour: str, speedup: float = SPEEDUP) -> AsyncIterator[Rig]:
    clock = ScaledClock(None, speedup)
    sim = await launch_simulated(Setting(flavour=flavour, speedup=speedup))
    news: list[VehicleNews] = []
    try:
        vehicle = await connect_vehicle(sim.url, clock)

        listener = asyncio.create_task(_keep(vehicle.changes(), news))
        try:
            yield Rig(vehicle, clock, sim, news)
        finally:
            await vehicle.close()
            await asyncio.wait_for(listener, 60)
    finally:
        await sim.stop()


@pytest.fixture(params=["px4", "ardupilot"])
async def rig(request: pytest.FixtureRequest) -> AsyncIterator[Rig]:
    async for rig in make(request.param):
        yield rig


@pytest.fixture(params=["px4", "ardupilot"])
async def slow(request: pytest.FixtureRequest) -> AsyncIterator[Rig]:
    """A millisecond of this computer is 4 ms of the flight only."""
    async for rig in make(request.param, speedup=4.0):
        yield rig


@pytest.fixture
async def px4() -> AsyncIterator[Rig]:
    async for rig in make("px4"):
        yield rig


async def test_headings_are_true_at_their_own_time_while_turning(slow: Rig) -> None:
    """A heading stamped 0.1 s wrong would be 4.5 degrees wrong at 45 deg/s."""
    await slow.vehicle.take_off(10.0)
    turn = asyncio.create_task(slow.vehicle.turn(45.0))
    truth: list[tuple[float, float]] = []
    while not turn.done():
        asked = slow.clock.now()
        heading = (await slow.sim.order("truth"))["heading_deg"]
        answered = slow.clock.now()
        if answered - asked < 0.02:
            truth.append((0.5 * (asked + answered), heading))
        await asyncio.sleep(0.005)
    await turn
    await slow.clock.sleep(0.5)

    samples = slow.vehicle.headings(truth[0][0] - 1.0)
    told = np.interp(
        [at for at, _ in truth],
        [sample.at_s for sample in samples],
        np.unwrap([sample.heading_deg for sample in samples], period=360.0),
    )
    error = [math.remainder(a - b, 360.0) for a, (_, b) in zip(told, truth, strict=True)]
    assert len(error) > 20
    assert abs(float(np.median(error))) < 2.0
    assert float(np.percentile(np.abs(error), 90)) < 4.0


async def test_unsafe_failsafes_are_mended_on_wish_and_then_pass(rig: Rig) -> None:
    flavour = rig.vehicle.telemetry().autopilot
    unsafe = {
        "px4": {"NAV_DLL_ACT": 0, "COM_DL_LOSS_T": 300, "COM_RC_OVERRIDE": 2},
        "ardupilot": {"FS_GCS_ENABLE": 0, "FS_GCS_TIMEOUT": 120, "MAV_GCS_SYSID": 1},
    }
    for name, value in unsafe[flavour].items():
        await rig.sim.order("set_param", name=name, value=value)

    done = await rig.vehicle.mend_failsafes()

    assert {parameter.parameter for parameter in done} == set(unsafe[flavour])
    checks = [check for check in await rig.vehicle.preflight() if check.name == "failsafe"]
    assert all(check.ok for check in checks), checks
    assert await rig.vehicle.mend_failsafes() == []


async def test_its_patience_with_a_silent_station_is_known_by_itself_and_with_each_preflight(rig: Rig) -> None:
    monitor = rig.vehicle._monitor
    await rig.until(lambda: monitor.patience_s is not None)
    assert monitor.patience_s == (10.0 if rig.vehicle.telemetry().autopilot == "px4" else 5.0)
    await rig.sim.order("set_param", name=monitor.dialect.station_time, value=7)
    await rig.vehicle.preflight()
    assert monitor.patience_s == 7.0
    await rig.sim.order("set_param", name=monitor.dialect.station_time, value=0)
    await rig.vehicle.preflight()
    assert monitor.patience_s == 7.0, "no patience is none that is known"


async def test_a_rebooted_autopilot_is_asked_for_its_telemetry_again(rig: Rig) -> None:
    await rig.clock.sleep(10.0)
    await rig.sim.order("reboot")

    await rig.clock.sleep(5.0)
    await rig.until(lambda: len(rig.vehicle.headings(rig.clock.now() - 2.0)) > 30)  # 20 Hz again
    assert rig.vehicle.telemetry().connected
    samples = rig.vehicle.headings(rig.clock.now() - 30.0)
    assert all(a.at_s < b.at_s for a, b in pairwise(samples))
    assert samples[-1].at_s <= rig.clock.now()


async def test_a_gps_jump_is_announced(px4: Rig) -> None:
    await px4.vehicle.take_off(10.0)
    assert not any(isinstance(news, PositionJumped) for news in px4.news)
    await px4.sim.order("gps_jump", north_m=40, seconds=5)

    await px4.announced(lambda news: isinstance(news, PositionJumped))
    jumped = next(news for news in px4.news if isinstance(news, PositionJumped))
    assert 35.0 < jumped.jumped_m < 50.0


async def test_hold_during_take_off_stops_the_climb(rig: Rig) -> None:
    take_off = asyncio.create_task(rig.vehicle.take_off(100.0))
    await rig.until(lambda: (rig.vehicle.telemetry().altitude_relative_m or 0.0) > 8.0)
    await rig.vehicle.hold()
    with pytest.raises(VehicleError, match="replaced by the hold"):
        await take_off
    await rig.clock.sleep(8.0)

    height = rig.vehicle.telemetry().altitude_relative_m
    assert height is not None
    assert 5.0 < height < 40.0


@pytest.mark.parametrize("stop", ["hold", "return_home"])
async def test_what_stops_a_take_off_is_sent_before_a_heartbeat_has_said_that_the_vehicle_is_armed(
    slow: Rig, monkeypatch: pytest.MonkeyPatch, stop: str
) -> None:
    await slow.clock.sleep(8.0)
    fold = Snapshot.fold

    def never_armed(snapshot: Snapshot, name: str, fields: Fields, heard_at_s: float) -> None:
        if name == "HEARTBEAT":
            fields = fields | {"base_mode": int(fields["base_mode"]) & ~mavlink.MAV_MODE_FLAG_SAFETY_ARMED}
        fold(snapshot, name, fields, heard_at_s)

    monkeypatch.setattr(Snapshot, "fold", never_armed)
    take_off = asyncio.create_task(slow.vehicle.take_off(100.0))
    async with asyncio.timeout(60):
        while not [number for _, number in (await slow.sim.order("commands"))["commands"] if number == TAKE_OFF]:  # noqa: ASYNC110 (another process)
            await asyncio.sleep(0)
    await getattr(slow.vehicle, stop)()
    with pytest.raises(VehicleError, match="replaced by"):
        await take_off
    mode = (await slow.sim.order("truth"))["mode"]
    assert mode in ({"hold": ("HOLD", "BRAKE"), "return_home": ("RETURN", "RTL", "LAND")}[stop])


async def test_what_stops_a_take_off_is_sent_before_the_answer_to_the_arming_has_come(slow: Rig) -> None:
    """A real PX4 over 250 ms stood armed for 11 s after its return was ordered: nothing was sent to it."""
    await slow.clock.sleep(8.0)
    await slow.sim.order("link_delay", seconds=0.5)
    take_off = asyncio.create_task(slow.vehicle.take_off(100.0))
    async with asyncio.timeout(60):
        while not [number for _, number in (await slow.sim.order("commands"))["commands"] if number == ARM]:  # noqa: ASYNC110 (another process)
            await asyncio.sleep(0)
    assert slow.vehicle.telemetry().armed is None
    await slow.vehicle.land()
    with pytest.raises(VehicleError, match="replaced by"):
        await take_off
    assert (await slow.sim.order("truth"))["mode"] == "LAND"


async def test_a_climb_that_somebody_ends_by_our_own_mode_is_told_in_seconds(px4: Rig) -> None:
    """A pilot put a real PX4 into HOLD at 10 m, and it was said to take off for 110 s."""
    take_off = asyncio.create_task(px4.vehicle.take_off(100.0))
    await px4.until(lambda: (px4.vehicle.telemetry().altitude_relative_m or 0.0) > 8.0)
    began_s = px4.clock.now()
    await px4.sim.order("pilot_mode", mode="HOLD")
    with pytest.raises(VehicleError, match="climbed to"):
        await take_off
    assert px4.clock.now() - began_s < 200.0, "it does not wait for the climb's own deadline, 230 s"


async def test_a_px4_that_landed_out_of_its_climb_is_not_armed_in_the_mode_that_takes_off(px4: Rig) -> None:
    """A real one began to climb to 2.5 m as it was armed, before a take-off was ordered."""
    climb = asyncio.create_task(px4.vehicle.take_off(100.0))
    await px4.until(lambda: (px4.vehicle.telemetry().altitude_relative_m or 0.0) > 5.0)
    await px4.vehicle.land()
    with pytest.raises(VehicleError, match="replaced by"):
        await climb
    await px4.until(lambda: px4.vehicle.telemetry().armed is False)
    assert px4.vehicle.telemetry().mode == "TAKEOFF"

    await px4.sim.order("fault", kind="refuse", count=1, of=TAKE_OFF)
    await px4.vehicle.take_off(10.0)
    assert any(isinstance(news, TriedAgain) and isinstance(news.because, AutopilotRefused) for news in px4.news)


async def test_a_px4_that_is_told_to_stay_as_it_turns_back_keeps_its_nose(px4: Rig) -> None:
    await px4.vehicle.take_off(10.0)
    telemetry = px4.vehicle.telemetry()
    assert telemetry.home is not None
    assert telemetry.altitude_amsl_m is not None
    far = LocalFrame(telemetry.home).to_geo(0.0, 300.0)
    flight = asyncio.create_task(px4.vehicle.goto(far, telemetry.altitude_amsl_m, 7.0, 90.0))
    await px4.until(lambda: (px4.vehicle.telemetry().velocity_north_m_s or 0.0) > 6.0)
    began_s = px4.clock.now()
    await px4.vehicle.hold()
    with pytest.raises(VehicleError, match="replaced by the hold"):
        await flight
    await px4.clock.sleep(6.0)
    headings = [sample.heading_deg for sample in px4.vehicle.headings(began_s + 1.0)]
    assert max(abs(math.remainder(heading - headings[0], 360.0)) for heading in headings) < 6.0


async def test_two_holds_at_once_both_succeed(rig: Rig) -> None:
    await rig.vehicle.take_off(10.0)

    await asyncio.gather(rig.vehicle.hold(), rig.vehicle.hold())

    assert rig.vehicle.telemetry().mode in ("HOLD", "BRAKE")


def arming_refused(news: VehicleNews) -> bool:
    return (
        isinstance(news, TriedAgain) and isinstance(news.because, AutopilotRefused) and news.because.command == "arming"
    )


async def test_take_off_waits_out_an_autopilot_that_is_not_ready_and_says_so(px4: Rig) -> None:
    await px4.sim.order("prearm", ok=False)
    take_off = asyncio.create_task(px4.vehicle.take_off(10.0))
    await px4.announced(arming_refused)
    await px4.sim.order("prearm", ok=True)
    await asyncio.wait_for(take_off, 60)

    assert px4.vehicle.telemetry().in_air


@pytest.mark.parametrize("lost", [1, 3])
async def test_a_take_off_whose_answer_was_lost_is_no_failure(rig: Rig, lost: int) -> None:
    """In the air ArduCopter refuses the repeated order: it hovered for a minute, and was said not to have left. After
    three lost answers it was braked a metre above the ground."""
    await rig.sim.order("fault", kind="unanswered", count=lost, of=TAKE_OFF)
    await asyncio.wait_for(rig.vehicle.take_off(10.0), 60)

    assert rig.vehicle.telemetry().in_air
    sent = (await rig.sim.order("commands", since_s=0.0))["commands"]
    assert [number for _, number in sent].count(TAKE_OFF) <= max(lost, 2)


@pytest.mark.parametrize("drift_m", [-3.0, 15.0])
async def test_a_take_off_refused_on_the_ground_is_ordered_again_wherever_home_was_before(
    rig: Rig, drift_m: float
) -> None:
    """Arming sets home: the step of the relative height was taken for a climb, or hid the climb."""
    await rig.sim.order("home_drift", up_m=drift_m)
    await rig.sim.order("fault", kind="refuse", count=1, of=TAKE_OFF)
    await asyncio.wait_for(rig.vehicle.take_off(10.0), 60)

    truth = await rig.sim.order("truth")
    assert truth["altitude_relative_m"] == pytest.approx(10.0, abs=1.0)


@pytest.mark.parametrize("drift_m", [-3.0, 1.4])
async def test_a_take_off_ends_at_the_height_above_the_home_that_arming_sets(rig: Rig, drift_m: float) -> None:
    """PX4 takes a height AMSL: from the home of before, it hung below the one that was waited for."""
    await rig.sim.order("home_drift", up_m=drift_m)
    await asyncio.wait_for(rig.vehicle.take_off(20.0), 60)

    truth = await rig.sim.order("truth")
    assert truth["altitude_relative_m"] == pytest.approx(20.0, abs=1.0)


async def test_a_pilot_who_selects_a_mode_on_the_ground_ends_the_take_off(px4: Rig) -> None:
    await px4.clock.sleep(7.0)
    await px4.sim.order("prearm", ok=False)
    take_off = asyncio.create_task(px4.vehicle.take_off(10.0))
    await px4.announced(arming_refused)
    await px4.sim.order("pilot_mode", mode="STABILIZED")

    with pytest.raises(NotInControl, match="STABILIZED"):
        await asyncio.wait_for(take_off, 60)


async def test_a_cancelled_flight_sends_nothing_more_and_the_vehicle_obeys_the_next_order(rig: Rig) -> None:
    await rig.vehicle.take_off(10.0)
    home = rig.vehicle.telemetry().home
    amsl = rig.vehicle.telemetry().altitude_amsl_m
    assert home is not None
    assert amsl is not None
    far = LocalFrame(home).to_geo(0.0, 300.0)
    flight = asyncio.create_task(rig.vehicle.goto(far, amsl, 8.0))
    await rig.clock.sleep(6.0)
    flight.cancel()
    with pytest.raises(asyncio.CancelledError):
        await flight
    at = (await rig.sim.order("ping"))["time_s"]
    await rig.clock.sleep(10.0)
    assert (await rig.sim.order("commands", since_s=at))["commands"] == []

    await rig.vehicle.hold()
    assert rig.vehicle.telemetry().authority.who == "ours"


async def test_telemetry_keeps_its_rates_in_simulated_time(slow: Rig) -> None:
    await slow.clock.sleep(12.0)
    headings = slow.vehicle.headings(slow.clock.now() - 10.0)
    gaps = np.diff([sample.at_s for sample in headings])

    assert len(headings) == pytest.approx(195, abs=15)
    assert float(np.quantile(gaps, 0.95)) < 0.2


async def test_a_home_that_was_not_heard_is_asked_for_again(rig: Rig) -> None:
    """A real ArduCopter was not heard to say it, over a slow link, and no mission could start."""
    await rig.clock.sleep(12.0)
    monitor = rig.vehicle._monitor
    assert await monitor.commander.ask(message_interval(HOME_POSITION_ID, 0.001))
    monitor.snapshot.home = None
    await rig.until(lambda: rig.vehicle.telemetry().home is not None)


async def test_a_switch_that_an_order_undid_before_it_was_told_is_seen_by_its_channel() -> None:
    async for ardupilot in make("ardupilot"):
        await ardupilot.vehicle.take_off(10.0)
        await ardupilot.climbed(5.0)
        await ardupilot.knows_the_switch()
        await ardupilot.vehicle.return_home()  # just above the ground it would land before the switch moves
        await ardupilot.sim.order("move_switch")
        await ardupilot.announced(lambda news: isinstance(news, SwitchUndone))

        assert ardupilot.vehicle.telemetry().mode == "RTL"
        with pytest.raises(NotInControl):
            await ardupilot.vehicle.hold()
