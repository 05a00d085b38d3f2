"""From an address to a vehicle that answers."""

from __future__ import annotations

from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.ports import Clock


async def connect_vehicle(
    url: str, clock: Clock, timeout_s: float = 30.0, minimum_battery_percent: float = 30.0
) -> MavsdkVehicle:
    """A connected vehicle. Raises ValueError (no such address form) or VehicleUnreachable (nobody answers)."""
    vehicle = MavsdkVehicle(url, clock, minimum_battery_percent)
    await vehicle.connect(timeout_s)
    return vehicle
