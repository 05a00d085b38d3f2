"""The autopilot's own fence: set for a mission, read back, put back; and what stands in the way of that."""

from __future__ import annotations

import pytest
from rig import Rig

from hardware.autopilot.opening import PATIENCE_WALL_S, be_patient
from hardware.fence import FencePolygon, MissionNets, Nets, NetsPlan
from hardware.ports import PlaceRefused, VehicleError
from hardware.reasons.nets import FenceNotTransferred, FenceReadBackDifferent, OwnCeilingLower, OwnFenceTighter


def square(rig: Rig, half_m: float, inside: bool = True, east: float = 0.0, north: float = 0.0) -> FencePolygon:
    corners = ((-half_m, -half_m), (half_m, -half_m), (half_m, half_m), (-half_m, half_m))
    return FencePolygon(tuple(rig.place(east + x, north + y) for x, y in corners), inside)


def wanted(rig: Rig, half_m: float = 60.0, ceiling_m: float = 50.0) -> MissionNets:
    home = rig.vehicle.telemetry().home
    assert home is not None
    zones = (square(rig, half_m), square(rig, 5.0, inside=False, east=30.0, north=30.0))
    return MissionNets(home, zones, zones, ceiling_m, ceiling_m)


async def planned(rig: Rig) -> NetsPlan:
    return await rig.vehicle.plan_nets(wanted(rig))


async def test_the_nets_of_a_mission_go_up_are_read_back_and_come_down_as_they_were(rig: Rig) -> None:
    plan = await planned(rig)
    assert await rig.vehicle.nets() == plan.before
    try:
        await rig.vehicle.set_nets(plan.after)
        held = await rig.vehicle.nets()
        assert [len(zone.corners) for zone in held.zones if isinstance(zone, FencePolygon)] == [4, 4]
        assert held.values() == pytest.approx(plan.after.values())
    finally:
        await rig.vehicle.set_nets(plan.before)
    assert await rig.vehicle.nets() == plan.before


async def test_within_its_nets_a_vehicle_flies_and_beyond_them_it_does_not(rig: Rig) -> None:
    plan = await planned(rig)
    try:
        await rig.vehicle.set_nets(plan.after)
        await rig.airborne()
        inside = rig.place(0.0, 25.0)
        await rig.vehicle.goto(inside, rig.amsl(), 5.0)
        assert rig.off_by(inside) < 3.0
        for place in (rig.place(0.0, 200.0), rig.place(30.0, 30.0)):
            with pytest.raises(PlaceRefused):
                await rig.vehicle.goto(place, rig.amsl(), 5.0)
            assert rig.off_by(inside) < 5.0
        await rig.vehicle.land()
        await rig.until(lambda: rig.vehicle.telemetry().armed is False, 120, "landing")
    finally:
        await rig.vehicle.set_nets(plan.before)


async def test_a_fence_of_the_owner_that_is_tighter_refuses_and_a_wider_one_is_put_back(rig: Rig) -> None:
    plan = await planned(rig)
    own = Nets((square(rig, 40.0),), plan.after.parameters)
    try:
        await rig.vehicle.set_nets(own)
        own = await rig.vehicle.nets()  # as the wire rounds it
        with pytest.raises(VehicleError) as refused:
            await rig.vehicle.plan_nets(wanted(rig))
        assert isinstance(refused.value.reason, OwnFenceTighter)
        assert 15.0 < refused.value.reason.beyond_m < 35.0

        with pytest.raises(VehicleError) as refused:
            await rig.vehicle.plan_nets(wanted(rig, half_m=30.0, ceiling_m=70.0))
        assert isinstance(refused.value.reason, OwnCeilingLower)
        assert refused.value.reason.own_m == pytest.approx(50.0)

        again = await rig.vehicle.plan_nets(wanted(rig, half_m=30.0, ceiling_m=40.0))
        assert again.before == own
        await rig.vehicle.set_nets(again.after)
        await rig.vehicle.set_nets(again.before)
        assert await rig.vehicle.nets() == own
    finally:
        await rig.vehicle.set_nets(plan.before)


async def test_no_net_is_put_back_under_a_pilot_who_has_armed_it_meanwhile(rig: Rig) -> None:
    plan = await planned(rig)
    try:
        await rig.vehicle.set_nets(plan.after)
        held = await rig.vehicle.nets()
        await rig.airborne()
        assert await rig.vehicle.put_nets_back(plan.before, [plan.after]) is None
        assert await rig.vehicle.nets() == held
        await rig.vehicle.land()
        await rig.until(lambda: rig.vehicle.telemetry().armed is False, 120, "landing")
        assert await rig.vehicle.put_nets_back(plan.before, [plan.after]) is True
        assert await rig.vehicle.nets() == plan.before
    finally:
        await rig.vehicle.set_nets(plan.before)


async def test_the_parameters_as_shipped_are_no_limit_of_the_owner_but_are_put_in_force(rig: Rig) -> None:
    if rig.name != "sim-ardupilot":
        pytest.skip("ArduCopter ships with a fence that is not enabled")
    plan = await rig.vehicle.plan_nets(wanted(rig, half_m=400.0, ceiling_m=120.0))
    assert plan.before.values()["FENCE_ENABLE"] == 0.0
    after = plan.after.values()
    assert (after["FENCE_ENABLE"], after["FENCE_TYPE"], after["FENCE_ALT_MAX"]) == (1.0, 5.0, 120.0)


@pytest.mark.parametrize("lost", [1, 2, 4])
async def test_answers_that_get_lost_do_no_harm(rig: Rig, lost: int) -> None:
    plan = await planned(rig)
    await rig.sim.order("fence_fault", mute=lost)
    await rig.vehicle.set_nets(plan.after)
    assert (await rig.vehicle.nets()).values() == pytest.approx(plan.after.values())


@pytest.mark.parametrize("after", [2, 5, 9, 10])
async def test_an_upload_that_breaks_off_is_an_error_and_can_be_made_again(rig: Rig, after: int) -> None:
    """Ten messages: the fence is asked for, announced, its eight corners sent; then it is read back."""
    plan = await planned(rig)
    await rig.sim.order("fence_fault", deaf_after=after)
    link = rig.vehicle._monitor.link._mavsdk
    assert link is not None
    be_patient(link, 0.3)  # nobody answers: it gives up sooner
    with pytest.raises(VehicleError) as broken:
        await rig.vehicle.set_nets(plan.after)
    be_patient(link, PATIENCE_WALL_S)
    assert isinstance(broken.value.reason, FenceNotTransferred)
    held = (await rig.sim.order("fence"))["items"]
    assert len(held) in (0, 8)  # never a part of it
    await rig.sim.order("fence_fault")
    await rig.vehicle.set_nets(plan.after)
    assert len((await rig.sim.order("fence"))["items"]) == 8


async def test_a_vehicle_that_keeps_another_fence_than_it_was_sent_is_found_out(rig: Rig) -> None:
    plan = await planned(rig)
    await rig.sim.order("fence_fault", altered=True)
    with pytest.raises(VehicleError) as different:
        await rig.vehicle.set_nets(plan.after)
    assert different.value.reason == FenceReadBackDifferent(1)
