"""What every Vehicle does with a command: confirmed by telemetry, or refused with a reason before it is sent."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from itertools import pairwise

import pytest
from rig import DEAD_STATION, HEIGHT, Rig, ends_with

from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import WallClock
from hardware.frame import LocalFrame
from hardware.ports import VehicleError, VehicleUnreachable
from hardware.readings import Place, ReturnAltitude
from hardware.reasons.preflight import FailsafeParameter
from hardware.reasons.vehicle_news import TakenOver, TakenOverBySticks
from hardware.yaw_swings import Swinging, SwingPlan


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
    assert t.authority.who == "nobody"
    assert t.mode
    await rig.until(lambda: len(rig.vehicle.headings(rig.clock.now() - 1.5)) >= 10, 20, "ten headings within 1.5 s")
    since = rig.clock.now() - 1.5
    headings = rig.vehicle.headings(since)
    assert all(since <= a.at_s < b.at_s <= rig.clock.now() for a, b in pairwise(headings))


async def test_a_ready_vehicle_passes_its_checklist_and_each_bad_failsafe_refuses_with_a_remedy(rig: Rig) -> None:
    sim, (parameter, _) = rig.sim, DEAD_STATION.get(rig.name, ("", ""))
    assert [check for check in await rig.vehicle.preflight() if check.blocking and not check.ok] == []

    await sim.order("set_param", name=parameter, value=0)
    refused = [check for check in await rig.vehicle.preflight() if check.blocking and not check.ok]

    assert len(refused) == 1
    reason = refused[0].reason
    assert isinstance(reason, FailsafeParameter)
    assert (reason.parameter, reason.value) == (parameter, 0.0)


async def test_the_altitude_of_its_own_return_is_read_in_metres(rig: Rig) -> None:
    parameter, unit = {"sim-px4": ("RTL_RETURN_ALT", 1.0), "sim-ardupilot": ("RTL_ALT", 100.0)}.get(rig.name, ("", 1.0))
    await rig.sim.order("set_param", name=parameter, value=45.0 * unit)

    expected = ReturnAltitude(parameter, 45.0)
    if rig.name != "sim-px4":
        await rig.sim.order("set_param", name="RTL_CLIMB_MIN", value=300)
        expected = ReturnAltitude(parameter, 45.0, "RTL_CLIMB_MIN", 3.0)
    assert await rig.vehicle.return_altitude() == expected


async def test_it_takes_off_flies_turns_and_returns_each_seen_by_telemetry(rig: Rig) -> None:
    vehicle = rig.vehicle

    await vehicle.take_off(HEIGHT)
    t = vehicle.telemetry()
    assert t.in_air
    assert t.altitude_relative_m == pytest.approx(HEIGHT, abs=1.5)
    assert t.authority.who == "ours"

    place = rig.place(east=30.0, north=-25.0)
    await vehicle.goto(place, rig.amsl(), 5.0)
    assert rig.off_by(place) < 2.5
    if rig.autopilot is not None:
        truth = await rig.autopilot.order("truth")
        assert math.hypot(*LocalFrame(place).to_enu(Place(truth["lat"], truth["lon"]))) < 4.0

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
    assert not [news for news in rig.news if isinstance(news, TakenOver | TakenOverBySticks)]


async def test_it_turns_by_a_part_of_the_circle_either_way_and_goes_on_from_there(rig: Rig) -> None:
    vehicle = rig.vehicle
    await rig.airborne()
    place = rig.place(east=0.0, north=15.0)
    await vehicle.goto(place, rig.amsl(), 5.0, 120.0)  # where the nose is by then is the autopilot's matter
    for by_deg in (-70.0, 160.0, 45.0):
        began = rig.clock.now()
        await vehicle.turn(30.0, by_deg)
        headings = [sample.heading_deg for sample in vehicle.headings(began)]
        turned = sum(math.remainder(b - a, 360.0) for a, b in pairwise(headings))
        assert math.copysign(1.0, by_deg) * turned == pytest.approx(abs(by_deg), abs=20.0)
    assert rig.off_by(place) < 3.0


async def test_hold_stops_a_flight_and_a_turn_at_any_moment(rig: Rig) -> None:
    vehicle = rig.vehicle
    await rig.airborne()

    far = rig.place(east=0.0, north=400.0)
    flight = asyncio.create_task(vehicle.goto(far, rig.amsl(), 7.0))
    await rig.until(lambda: (vehicle.telemetry().velocity_north_m_s or 0.0) > 4.0, 20, "flying north")
    await vehicle.hold()
    await ends_with(flight, VehicleError, "replaced by the hold")
    stopped = vehicle.telemetry().position
    assert stopped is not None
    assert rig.off_by(far) > 250.0
    await rig.clock.sleep(8.0)
    assert rig.off_by(stopped) < 1.5  # it told of its hold when it was at rest, not when it was slow

    turn = asyncio.create_task(vehicle.turn(20.0))
    await rig.clock.sleep(5.0)
    await vehicle.hold()
    await ends_with(turn, VehicleError, "replaced by the hold")
    await rig.clock.sleep(4.0)
    headings = [sample.heading_deg for sample in vehicle.headings(rig.clock.now() - 2.0)]
    assert max(abs(math.remainder(heading - headings[0], 360.0)) for heading in headings) < 5.0

    near = rig.place(0.0, 20.0)  # by this flight's home: once disarmed, PX4 takes where it stands for its next one
    await vehicle.goto(near, rig.amsl(), 7.0)  # after a hold it flies on
    await vehicle.land()
    assert vehicle.telemetry().mode == "LAND"
    await rig.until(lambda: not vehicle.telemetry().armed, 90, "the landing")
    assert rig.off_by(near) < 4.0


def swings_by(*headings: float, middle_deg: float) -> tuple[float, float]:
    """The furthest to either side of the middle."""
    off = [math.remainder(heading - middle_deg, 360.0) for heading in headings]
    return min(off), max(off)


async def test_the_nose_swings_on_the_way_and_the_flight_arrives_as_ever(rig: Rig) -> None:
    vehicle = rig.vehicle
    await rig.airborne()
    place = rig.place(east=0.0, north=140.0)
    swinging = Swinging(SwingPlan(middle_deg=60.0, amplitude_deg=60.0, rate_deg_s=30.0), lambda _: 500.0)
    began = rig.clock.now()
    await vehicle.goto(place, rig.amsl(), 5.0, None, swinging)
    took = rig.clock.now() - began
    assert rig.off_by(place) < 2.5
    assert took < 28.0 + 20.0
    swings = swinging.swings
    assert swings.end == "near_place"
    assert swings.swung >= 3
    assert 10.0 < swings.rate_deg_s < 60.0
    assert swings.lag_deg <= 30.0
    frame = LocalFrame(place)
    samples = [(s.heading_deg, frame.to_enu(s.position)) for s in vehicle.headings(began) if s.position is not None]
    on_the_way = [heading for heading, (_, north) in samples if 60.0 < north + 140.0 < 120.0]
    low, high = swings_by(*on_the_way, middle_deg=60.0)
    assert -85.0 < low < -40.0
    assert 40.0 < high < 85.0
    assert max(abs(east) for _, (east, _) in samples) < 4.0
    assert vehicle.telemetry().authority.who == "ours"
    if rig.autopilot is not None:
        received = (await rig.sim.order("commands", since_s=0.0))["commands"]
        assert sum(number in (115, 192) for _, number in received) >= 8


async def test_hold_stops_the_swings_with_the_flight(rig: Rig) -> None:
    vehicle = rig.vehicle
    await rig.airborne()
    swinging = Swinging(SwingPlan(middle_deg=0.0, amplitude_deg=90.0, rate_deg_s=30.0), lambda _: 500.0)
    flight = asyncio.create_task(vehicle.goto(rig.place(0.0, 400.0), rig.amsl(), 7.0, None, swinging))
    await rig.until(lambda: swinging.swings.swung > 0, 60, "swinging")
    await vehicle.hold()
    await ends_with(flight, VehicleError, "replaced by the hold")
    assert swinging.swings.end == "not_ours"
    since = rig.clock.now() + 1.0
    await rig.until(lambda: len(vehicle.headings(since)) >= 20, 60, "headings while it hovers")
    headings = [sample.heading_deg for sample in vehicle.headings(since)]
    assert max(abs(math.remainder(heading - headings[0], 360.0)) for heading in headings) < 5.0


async def test_an_autopilot_that_does_not_turn_its_nose_flies_on_all_the_same(rig: Rig) -> None:
    vehicle = rig.vehicle
    await rig.airborne()
    await rig.sim.order("fault", kind="ignore_yaw", count=1000)
    place = rig.place(0.0, 120.0)
    swinging = Swinging(SwingPlan(middle_deg=90.0, amplitude_deg=60.0, rate_deg_s=30.0), lambda _: 500.0)
    await vehicle.goto(place, rig.amsl(), 5.0, None, swinging)
    assert rig.off_by(place) < 2.5
    assert swinging.swings.end == "lags"


async def test_on_the_ground_flight_orders_are_refused_in_words(rig: Rig) -> None:
    here = rig.vehicle.telemetry().position
    assert here is not None

    for order in (rig.vehicle.goto(here, rig.amsl(), 5.0), rig.vehicle.turn(30.0)):
        with pytest.raises(VehicleError, match="not in the air"):
            await order
    for order in (rig.vehicle.return_home(), rig.vehicle.land()):
        with pytest.raises(VehicleError, match="on the ground"):
            await order
    await rig.vehicle.hold()  # nothing to do, never an error


@pytest.mark.parametrize(("altitude", "speed"), [(math.nan, 5.0), (500.0, 0.0), (500.0, -1.0), (math.inf, 5.0)])
async def test_orders_that_mean_nothing_are_refused_before_they_are_sent(altitude: float, speed: float) -> None:
    vehicle = MavsdkVehicle("udpin://127.0.0.1:1", WallClock())

    with pytest.raises(ValueError, match="No place to fly to"):
        await vehicle.goto(Place(47.0, 8.0), altitude, speed)
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
        lambda: vehicle.goto(Place(47.0, 8.0), 500.0, 5.0),
        lambda: vehicle.turn(30.0),
        lambda: vehicle.take_off(10.0),
    ]

    assert not vehicle.telemetry().connected
    assert vehicle.telemetry().autopilot == "unknown"
    for order in orders:
        with pytest.raises(VehicleUnreachable, match="No vehicle is connected"):
            await order()


async def test_lost_gps_is_noticed_and_headings_since_have_no_place(rig: Rig) -> None:
    await rig.airborne()
    await rig.sim.order("link_delay", seconds=0.08)
    assert rig.vehicle.telemetry().position_lost_since_s is None

    lost_s = rig.clock.now()
    await rig.sim.order("gps_loss", seconds=3)
    await rig.until(lambda: rig.vehicle.telemetry().position_lost_since_s is not None, 5, "the word that GPS is lost")

    noticed_s = rig.vehicle.telemetry().position_lost_since_s
    assert noticed_s is not None
    assert noticed_s >= lost_s - 0.1
    await rig.clock.sleep(0.5)
    assert all(sample.position is None for sample in rig.vehicle.headings(rig.clock.now() - 0.4))
    await rig.until(lambda: rig.vehicle.telemetry().position_lost_since_s is None, 10, "the word that it is back")
