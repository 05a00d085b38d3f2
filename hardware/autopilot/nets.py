"""Reads and sets the autopilot's own nets. What it says it took counts for nothing: what it holds afterwards does."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from hardware.autopilot.fence_items import FenceUnreadable, first_difference, items_of, zones_of
from hardware.autopilot.link import FenceTransferFailed
from hardware.autopilot.monitor import Monitor
from hardware.fence import FenceZone, Nets, ParameterValue
from hardware.ports import VehicleError
from hardware.reasons.nets import FenceNotTransferred, FenceParameterUnread, FenceReadBackDifferent, FenceUnknownForm
from hardware.reasons.vehicle import ParameterNotSet

ATTEMPTS = 3
TOLERANCE = 1e-3


async def read_nets(monitor: Monitor) -> Nets:
    """Raises VehicleError when a part of it cannot be read: what is not known is not fine."""
    rules = monitor.dialect.nets
    found: list[ParameterValue] = []
    for name in rules.parameters:
        value = await monitor.link.parameter(name)
        if value is not None:
            found.append(ParameterValue(name, value))
        elif name in rules.required:
            raise VehicleError(FenceParameterUnread(name))
    return Nets(await _zones(monitor), tuple(found))


async def set_nets(monitor: Monitor, nets: Nets) -> None:
    """Zones first, then the parameters that put them in force. Raises VehicleError unless all of it is read back."""
    await _write(monitor, nets, lambda: True)
    await _check_held(monitor, nets)


async def _write(monitor: Monitor, nets: Nets, may: Callable[[], bool]) -> bool:
    """may: asked right before each change. False: it said no, and what was left is as it was."""
    present = await read_nets(monitor)
    if first_difference(nets.zones, present.zones) is not None:
        if not may():
            return False
        await _send_zones(monitor, nets.zones)
    before = present.values()
    for one in nets.parameters:
        if one.parameter not in before or _close(before[one.parameter], one.value):
            continue
        if not may():
            return False
        if not await monitor.link.set_parameter(one.parameter, one.value):
            raise VehicleError(ParameterNotSet(one.parameter, one.value))
    return True


async def _check_held(monitor: Monitor, nets: Nets) -> None:
    after = await read_nets(monitor)
    different = first_difference(nets.zones, after.zones)
    if different is not None:
        raise VehicleError(FenceReadBackDifferent(different + 1))
    held = after.values()
    for one in nets.parameters:
        if not _close(held.get(one.parameter, math.nan), one.value):
            raise VehicleError(ParameterNotSet(one.parameter, one.value))


async def put_nets_back(monitor: Monitor, before: Nets, ours: Sequence[Nets]) -> bool | None:
    """See Vehicle.put_nets_back. Part by part: an interrupted change has left some of ours and some of theirs."""
    present = await read_nets(monitor)
    known = (before, *ours)
    same = any(first_difference(nets.zones, present.zones) is None for nets in known)
    whole, back = same, before.values()
    values: list[ParameterValue] = []
    for one in present.parameters:
        left = [nets.values()[one.parameter] for nets in known if one.parameter in nets.values()]
        mine = any(_close(one.value, value) for value in left)
        whole = whole and mine
        values.append(ParameterValue(one.parameter, back.get(one.parameter, one.value)) if mine else one)
    nets = Nets(before.zones if same else present.zones, tuple(values))
    if not await _write(monitor, nets, lambda: monitor.snapshot.armed is False):
        return None
    await _check_held(monitor, nets)
    return whole


async def _send_zones(monitor: Monitor, zones: tuple[FenceZone, ...]) -> None:
    """Again when it was not taken. A lost acknowledgement looks like a failure: the fence that is held decides."""
    for attempt in range(1, ATTEMPTS + 1):
        try:
            await monitor.link.set_fence(items_of(zones))
            return
        except FenceTransferFailed as failed:
            if first_difference(zones, await _zones(monitor)) is None:
                return
            if attempt == ATTEMPTS:
                raise VehicleError(FenceNotTransferred("sent", str(failed))) from failed


async def _zones(monitor: Monitor) -> tuple[FenceZone, ...]:
    try:
        return zones_of(await monitor.link.fence())
    except FenceTransferFailed as failed:
        raise VehicleError(FenceNotTransferred("read", str(failed))) from failed
    except FenceUnreadable as unreadable:
        raise VehicleError(FenceUnknownForm(str(unreadable))) from unreadable


def _close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=TOLERANCE, abs_tol=TOLERANCE)
