from __future__ import annotations

import asyncio

import pytest
from equipment import HOME, FlatVehicle
from facts import PILOT

from backend.craft import reconnecting_vehicle
from backend.craft.reconnecting_vehicle import ReconnectingVehicle
from backend.reasons.checks import NoVehicleYet
from hardware.clock import ScaledClock
from hardware.ports import VehicleUnreachable
from hardware.reasons.vehicle import NoAutopilotAnswers
from hardware.reasons.vehicle_news import ParameterSet, TakenOver


async def test_a_vehicle_that_comes_late_is_connected_in_the_background(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reconnecting_vehicle, "PAUSE_S", 0.01)
    clock = ScaledClock()
    switched_on = False

    def make() -> FlatVehicle:
        found = FlatVehicle(clock)
        found.reachable = switched_on
        return found

    vehicle = ReconnectingVehicle(make, clock, "udpin://nowhere")
    with pytest.raises(VehicleUnreachable):
        await vehicle.connect(0.05)
    assert not vehicle.telemetry().connected
    assert vehicle.headings(0.0) == []
    assert isinstance(vehicle.reason, NoAutopilotAnswers)
    (check,) = await vehicle.preflight()
    assert (check.ok, check.reason) == (False, vehicle.reason)
    with pytest.raises(VehicleUnreachable):
        await vehicle.take_off(10.0)
    first = asyncio.ensure_future(anext(vehicle.changes()))
    switched_on = True
    await vehicle.connect(5.0)
    assert vehicle.telemetry().position == HOME
    assert vehicle.reason is None
    found = vehicle._vehicle
    assert isinstance(found, FlatVehicle)
    found.pilot_takes_over()
    assert isinstance((await first).reason, TakenOver)
    await vehicle.close()


class BrokenVehicle(FlatVehicle):
    async def connect(self, timeout_s: float = 30.0) -> None:
        raise RuntimeError("a message that nobody expected")


async def test_a_fault_of_our_own_does_not_end_the_connecting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reconnecting_vehicle, "PAUSE_S", 0.01)
    clock = ScaledClock()
    kinds = iter((BrokenVehicle, BrokenVehicle))
    vehicle = ReconnectingVehicle(lambda: next(kinds, FlatVehicle)(clock), clock, "udpin://somewhere")
    await vehicle.connect(5.0)
    assert vehicle.telemetry().connected
    await vehicle.close()


async def test_before_the_first_attempt_it_is_said_where_the_vehicle_is_looked_for() -> None:
    vehicle = ReconnectingVehicle(lambda: FlatVehicle(ScaledClock()), ScaledClock(), "udpin://somewhere")
    assert vehicle.reason == NoVehicleYet("udpin://somewhere")
    (check,) = await vehicle.preflight()
    assert check.reason == NoVehicleYet("udpin://somewhere")


async def test_who_flew_before_a_restart_is_kept_for_the_vehicle_that_answers_later() -> None:
    clock = ScaledClock()
    vehicle = ReconnectingVehicle(lambda: FlatVehicle(clock), clock, "udpin://somewhere")
    vehicle.restore(PILOT)
    await vehicle.connect(5.0)
    authority = vehicle.telemetry().authority
    assert authority.taken_by == PILOT.taken_by
    vehicle.take_control()
    assert vehicle.telemetry().authority.taken_by is None
    await vehicle.close()


MENDED = ParameterSet("NAV_DLL_ACT", 0.0, 2)


class MendableVehicle(FlatVehicle):
    async def mend_failsafes(self) -> list[ParameterSet]:
        return [MENDED]


@pytest.mark.parametrize(("kind", "mended"), [(FlatVehicle, []), (MendableVehicle, [MENDED])])
async def test_failsafes_are_mended_where_a_vehicle_can(kind: type[FlatVehicle], mended: list[ParameterSet]) -> None:
    clock = ScaledClock()
    vehicle = ReconnectingVehicle(lambda: kind(clock), clock, "udpin://somewhere")
    with pytest.raises(VehicleUnreachable):
        await vehicle.mend_failsafes()
    await vehicle.connect(5.0)
    assert await vehicle.mend_failsafes() == mended
    await vehicle.close()
