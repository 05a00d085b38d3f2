"""The mission protocol as an autopilot answers it, for its fence. A message in, messages out.

An upload takes effect as a whole with its last item. A repeated item of a finished upload is an error, as PX4 has it:
a lost acknowledgement looks like a failure to the sender although the fence is there.
"""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.fence import ERROR, INVALID_SEQUENCE, Fence, Item, judged
from hardware.sim.autopilot.firmware import Faults

FENCE = mavlink.MAV_MISSION_TYPE_FENCE
MOVED_E7 = 5_000
"""How far the autopilot that is ordered to keep another fence moves its first corner: some 50 m."""


class FenceProtocol:
    """The autopilot's side of a fence's transfer: MISSION_COUNT to MISSION_ACK, and back.

    refuses_repeated: an item that came already is an error (ArduCopter), else the next one is asked for again (PX4).
    """

    def __init__(self, fence: Fence, faults: Faults, refuses_repeated: bool) -> None:
        self._fence = fence
        self._refuses_repeated = refuses_repeated
        self._faults = faults
        self._coming: list[Item] | None = None
        self._count = 0

    def answer(self, message: Any) -> list[Any]:
        """To MISSION_* of mission type FENCE; none while ordered to be deaf to it."""
        faults = self._faults
        if faults.fence_deaf_after == 0:
            return []
        if faults.fence_deaf_after > 0:
            faults.fence_deaf_after -= 1
        answers = self._answer(message)
        if faults.fence_mute > 0:
            faults.fence_mute -= 1
            return []
        return answers

    def _answer(self, message: Any) -> list[Any]:
        to = message.get_srcSystem(), message.get_srcComponent()
        match message.get_type():
            case "MISSION_REQUEST_LIST":
                return [mavlink.MAVLink_mission_count_message(*to, len(self._fence.items), FENCE)]
            case "MISSION_REQUEST_INT":
                return [self._one(to, int(message.seq))]
            case "MISSION_CLEAR_ALL":
                self._fence.items, self._coming = (), None
                return [mavlink.MAVLink_mission_ack_message(*to, 0, FENCE)]
            case "MISSION_COUNT":
                self._coming, self._count = [], message.count
                return [self._next(to)]
            case "MISSION_ITEM_INT":
                return [self._take(to, message)]
            case _:
                return []

    def _one(self, to: tuple[int, int], seq: int) -> Any:
        if seq >= len(self._fence.items):
            return mavlink.MAVLink_mission_ack_message(*to, INVALID_SEQUENCE, FENCE)
        return _item_message(to, seq, self._fence.items[seq])

    def _next(self, to: tuple[int, int]) -> Any:
        """Ask for the next item, or end the upload."""
        assert self._coming is not None
        if len(self._coming) < self._count:
            return mavlink.MAVLink_mission_request_int_message(*to, len(self._coming), FENCE)
        result = judged(self._coming)
        if result == 0:
            self._fence.items = self._kept(tuple(self._coming))
        self._coming = None
        return mavlink.MAVLink_mission_ack_message(*to, result, FENCE)

    def _kept(self, items: tuple[Item, ...]) -> tuple[Item, ...]:
        if not (self._faults.fence_altered and items):
            return items
        first = items[0]
        return (Item(first.number, first.first, first.lat_e7 + MOVED_E7, first.lon_e7), *items[1:])

    def _take(self, to: tuple[int, int], message: Any) -> Any:
        if self._coming is None:
            return mavlink.MAVLink_mission_ack_message(*to, ERROR, FENCE)
        if message.seq == len(self._coming):
            self._coming.append(Item(message.command, message.param1, message.x, message.y))
        elif self._refuses_repeated:
            return mavlink.MAVLink_mission_ack_message(*to, INVALID_SEQUENCE, FENCE)
        return self._next(to)


def _item_message(to: tuple[int, int], seq: int, item: Item) -> Any:
    return mavlink.MAVLink_mission_item_int_message(
        *to, seq, 0, item.number, 0, 1, item.first, 0.0, 0.0, 0.0, item.lat_e7, item.lon_e7, 0.0, FENCE
    )
