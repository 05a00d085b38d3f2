from __future__ import annotations

import asyncio

import pytest
from doubles import HOME, FlatVehicle

from backend.mission import patient_vehicle
from backend.mission.patient_vehicle import PatientVehicle
from hardware.clock import ScaledClock
from hardware.ports import VehicleUnreachable


async def test_a_vehicle_that_comes_late_is_connected_in_the_background(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patient_vehicle, "PAUSE_S", 0.01)
    clock = ScaledClock()
    switched_on = False

    def make() -> FlatVehicle:
        vehicle = FlatVehicle(clock)
        vehicle.reachable = switched_on
        return vehicle

    patient = PatientVehicle(make, clock, "udpin://nowhere")
    with pytest.raises(VehicleUnreachable):
        await patient.connect(0.05)
    assert not patient.telemetry().connected
    assert patient.headings(0.0) == []
    assert patient.detail
    (check,) = await patient.preflight()
    assert not check.ok
    with pytest.raises(VehicleUnreachable):
        await patient.take_off(10.0)
    lines = patient.changes()
    first = asyncio.ensure_future(anext(lines))
    switched_on = True
    await patient.connect(5.0)
    assert patient.telemetry().position == HOME
    assert patient.detail == ""
    assert isinstance(patient._vehicle, FlatVehicle)
    patient._vehicle.take_control()
    assert "pilot" in await first
    await patient.close()


class BrokenVehicle(FlatVehicle):
    async def connect(self, timeout_s: float = 30.0) -> None:
        raise RuntimeError("a message that nobody expected")


async def test_a_fault_of_our_own_does_not_end_the_connecting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patient_vehicle, "PAUSE_S", 0.01)
    clock = ScaledClock()
    kinds = iter((BrokenVehicle, BrokenVehicle))
    patient = PatientVehicle(lambda: next(kinds, FlatVehicle)(clock), clock, "udpin://somewhere")
    await patient.connect(5.0)
    assert patient.telemetry().connected
    await patient.close()


class MendableVehicle(FlatVehicle):
    async def mend_failsafes(self) -> list[str]:
        return ["NAV_DLL_ACT set from 0 to 2"]


@pytest.mark.parametrize(("kind", "lines"), [(FlatVehicle, []), (MendableVehicle, ["NAV_DLL_ACT set from 0 to 2"])])
async def test_failsafes_are_mended_where_a_vehicle_can(kind: type[FlatVehicle], lines: list[str]) -> None:
    clock = ScaledClock()
    patient = PatientVehicle(lambda: kind(clock), clock, "udpin://somewhere")
    with pytest.raises(VehicleUnreachable):
        await patient.mend_failsafes()
    await patient.connect(5.0)
    assert await patient.mend_failsafes() == lines
    await patient.close()
