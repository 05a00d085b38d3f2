"""MAVLink through MAVSDK: one autopilot's messages in the order they came, and messages to it. No policy here.

The raw messages are used rather than MAVSDK's actions because an action retransmits by itself (a command could then
reach the autopilot after a pilot took over) and because they carry the autopilot's own time and its raw mode.
"""

# pyright: standard
# (mavsdk has no types)

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import math
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any, TypeVar

from mavsdk import Mavsdk, System
from mavsdk.plugins.geofence import Geofence, GeofenceError
from mavsdk.plugins.mavlink_direct import MavlinkDirect, MavlinkMessage
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw, MissionRawError, MissionRawResult
from mavsdk.plugins.param import Param, ParamError

from hardware.autopilot.fence_items import FenceItem
from hardware.autopilot.opening import Connection, check_url, open_connection
from hardware.ports import VehicleUnreachable
from hardware.reasons.vehicle import NoAutopilotAnswers, VehicleLinkNotOpened

log = logging.getLogger(__name__)
T = TypeVar("T")
AUTOPILOT_COMPONENT = 1
FENCE_WALL_S = 60.0
"""The longest that a fence may take one way; one polygon takes about 4 s on a link of 250 ms each way."""
PARAMETER_ASKS, PARAMETER_WALL_S = 3, 1.0
"""How often a parameter is asked for that the autopilot has not named yet, and how long each time."""
_FLOATS = frozenset({9, 10})
"""MAV_PARAM_TYPE."""
CLOSE_WALL_S = 10.0
"""What a parameter is waited for, that nobody answers, and a little more."""

FROM_ANY_COMPONENT = frozenset({"OPEN_DRONE_ID_ARM_STATUS"})
"""Messages that a device of the vehicle sends itself; of all others only the autopilot's own count."""

Fields = dict[str, Any]


_GLOBAL, _FENCE = 0, 1  # MAV_FRAME, MAV_MISSION_TYPE


class FenceTransferFailed(Exception):
    """The library's word for why: timeout, denied, too_many_mission_items ..."""


def _wire_item(seq: int, item: FenceItem) -> MissionItem:
    return MissionItem(
        seq=seq,
        frame=_GLOBAL,
        command=item.number,
        current=int(seq == 0),
        autocontinue=0,
        param1=item.first,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=item.lat_e7,
        y=item.lon_e7,
        z=0.0,
        mission_type=_FENCE,
    )


class MavlinkLink:
    """One connection, one autopilot. `on_message(name, fields)` is called on the event loop, in order of arrival.

    opened: a connection to url that is there already, and belongs to the link from now on.
    """

    def __init__(
        self,
        url: str,
        names: tuple[str, ...],
        on_message: Callable[[str, Fields], None],
        opened: Connection | None = None,
    ) -> None:
        self.url = check_url(url)
        self._names = names
        self._on_message = on_message
        self._mavsdk: Mavsdk | None = None if opened is None else opened.mavsdk
        self._direct: MavlinkDirect | None = None
        self._param: Param | None = None
        self._mission: MissionRaw | None = None
        self._geofence: Geofence | None = None
        self._sender = ThreadPoolExecutor(1, "mavlink-send")
        self._blocking = ThreadPoolExecutor(2, "mavlink-param")
        self._transfers = ThreadPoolExecutor(2, "mavlink-fence")
        self._under_way: set[Future[Any]] = set()
        self._closed = False
        self._parameters: dict[str, int] = {}
        """Name -> MAV_PARAM_TYPE of those that the autopilot has told a value of."""
        self._parameter_heard = asyncio.Event()
        self.system_id = 0

    async def open(self, timeout_s: float) -> None:
        """timeout_s: of wall time. Raises VehicleUnreachable when no autopilot answers."""
        loop = asyncio.get_running_loop()
        if self._mavsdk is None:
            try:
                opened = await loop.run_in_executor(self._blocking, open_connection, self.url)
            except OSError as error:
                await self.close()
                raise VehicleUnreachable(VehicleLinkNotOpened(self.url, error.strerror or str(error))) from error
            self._mavsdk = opened.mavsdk
        mavsdk = self._mavsdk
        system = await self._first_autopilot(mavsdk, timeout_s)
        if system is None:
            await self.close()
            raise VehicleUnreachable(NoAutopilotAnswers(self.url, timeout_s))
        self.system_id = system.get_system_id()
        direct = await self._waiting(self._blocking, self._lay_out, system)
        if self._closed:
            raise VehicleUnreachable(NoAutopilotAnswers(self.url, timeout_s))

        def heard(message: MavlinkMessage, _: Any) -> None:
            if message.component_id == AUTOPILOT_COMPONENT or message.message_name in FROM_ANY_COMPONENT:
                with contextlib.suppress(RuntimeError):  # the loop has ended
                    loop.call_soon_threadsafe(self._dispatch, message)

        for name in (*self._names, "PARAM_VALUE"):
            direct.subscribe_message(name, heard)

    def _lay_out(self, system: System) -> MavlinkDirect:
        """In a thread: MAVSDK reads all definitions of messages, 0.26 s, with each new connection."""
        direct = MavlinkDirect(system)
        self._param = Param(system)
        self._mission, self._geofence = MissionRaw(system), Geofence(system)
        self._direct = direct
        return direct

    async def _first_autopilot(self, mavsdk: Mavsdk, timeout_s: float) -> System | None:
        loop = asyncio.get_running_loop()
        found: asyncio.Future[System | None] = loop.create_future()

        def resolve(system: System | None) -> None:
            if not found.done():
                found.set_result(system)

        def heard(system: System | None) -> None:
            loop.call_soon_threadsafe(resolve, system)

        handle = mavsdk.first_autopilot_async(timeout_s, heard)
        try:
            return await found
        finally:
            mavsdk.cancel_first_autopilot(handle)

    def _dispatch(self, message: MavlinkMessage) -> None:
        if self._closed:
            return
        fields = json.loads(message.fields_json)
        if message.message_name == "PARAM_VALUE":
            self._parameters[fields["param_id"]] = fields["param_type"]
            self._parameter_heard.set()
        else:
            self._on_message(message.message_name, fields)

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        """Send one message to the autopilot; `allowed` is asked in the instant before, False sends nothing.

        None among the fields is sent as NaN; a target among them is kept. Returns whether it was sent.
        """
        if self._closed:
            return False
        addressed = {"target_system": self.system_id, "target_component": AUTOPILOT_COMPONENT} | fields
        target = addressed["target_system"], addressed["target_component"]
        message = MavlinkMessage(name, 0, 0, *target, json.dumps(addressed))
        return await asyncio.get_running_loop().run_in_executor(self._sender, self._send_now, message, allowed)

    def _send_now(self, message: MavlinkMessage, allowed: Callable[[], bool]) -> bool:
        if self._direct is None or self._closed or not allowed():
            return False
        self._direct.send_message(message)
        return True

    async def _waiting(self, threads: ThreadPoolExecutor, call: Callable[..., T], *given: Any) -> T:
        """A call that waits for the autopilot's answer; whoever gives up waiting does not end it."""
        running = threads.submit(call, *given)
        self._under_way.add(running)
        running.add_done_callback(self._under_way.discard)
        return await asyncio.wrap_future(running)

    async def parameter(self, name: str) -> float | None:
        """An autopilot parameter, or None when it has none of that name (or does not answer, or with no number)."""
        if not await self._has_parameter(name):
            return None
        return await self._waiting(self._blocking, self._read_parameter, name)

    def has_answered(self, name: str) -> bool:
        """The autopilot has named this parameter on this connection."""
        return name in self._parameters

    async def _has_parameter(self, name: str) -> bool:
        """MAVSDK asks six times, for 9 s, for one that there is not; ArduPilot answers nothing then."""
        for _ in range(PARAMETER_ASKS):
            if name in self._parameters:
                break
            if not await self.send("PARAM_REQUEST_READ", {"param_id": name, "param_index": -1}, lambda: True):
                return False
            end_s = time.monotonic() + PARAMETER_WALL_S
            while name not in self._parameters and (left_s := end_s - time.monotonic()) > 0.0:
                self._parameter_heard.clear()
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(left_s):
                        await self._parameter_heard.wait()
        return name in self._parameters and not self._closed

    def _read_parameter(self, name: str) -> float | None:
        if self._param is None:
            return None
        is_float = self._parameters[name] in _FLOATS
        read = self._param.get_param_float if is_float else self._param.get_param_int
        with contextlib.suppress(ParamError):
            value = float(read(name))
            return value if math.isfinite(value) else None
        return None

    async def fence(self) -> list[FenceItem]:
        """The fence that the autopilot holds. Raises FenceTransferFailed."""
        return await self._transferred(self._read_fence)

    def _read_fence(self) -> list[FenceItem]:
        if self._mission is None:
            raise FenceTransferFailed("no link")
        try:
            items = self._mission.download_geofence()
        except MissionRawError as error:
            if error.result == MissionRawResult.NO_MISSION_AVAILABLE:
                return []
            raise FenceTransferFailed(error.result.name.lower()) from error
        return [FenceItem(item.command, item.param1, item.x, item.y) for item in items]

    async def set_fence(self, items: Sequence[FenceItem]) -> None:
        """As a whole, in place of the one before; none clears it. Raises FenceTransferFailed."""
        await self._transferred(self._write_fence, items)

    async def _transferred(self, transfer: Callable[..., T], *given: Any) -> T:
        """MAVSDK sets a transfer no end of its own. What hangs keeps its thread, and nobody else's."""
        try:
            async with asyncio.timeout(FENCE_WALL_S):
                return await self._waiting(self._transfers, transfer, *given)
        except TimeoutError:
            raise FenceTransferFailed("timeout") from None

    def _write_fence(self, items: Sequence[FenceItem]) -> None:
        if self._mission is None or self._geofence is None:
            raise FenceTransferFailed("no link")
        try:
            if items:
                self._mission.upload_geofence([_wire_item(seq, item) for seq, item in enumerate(items)])
            else:
                self._geofence.clear_geofence()
        except (MissionRawError, GeofenceError) as error:
            raise FenceTransferFailed(error.result.name.lower()) from error

    async def set_parameter(self, name: str, value: float) -> bool:
        """True when the autopilot confirmed the new value."""
        if not await self._has_parameter(name):
            return False
        return await self._waiting(self._blocking, self._write_parameter, name, value)

    def _write_parameter(self, name: str, value: float) -> bool:
        """By the type it has: the bytes of a whole number, taken for a float, would be another value."""
        if self._param is None:
            return False
        with contextlib.suppress(ParamError):
            if self._parameters[name] in _FLOATS:
                self._param.set_param_float(name, value)
            else:
                self._param.set_param_int(name, round(value))
            return True
        return False

    async def close(self) -> None:
        """Idempotent. MAVSDK never answers a call that waits while it is destroyed: what is under way ends first."""
        if self._closed:
            return
        self._closed = True
        mavsdk, self._mavsdk = self._mavsdk, None
        if mavsdk is not None:
            await asyncio.to_thread(wait, tuple(self._under_way), CLOSE_WALL_S)
            await asyncio.get_running_loop().run_in_executor(self._blocking, mavsdk.destroy)
        self._sender.shutdown(wait=False)
        self._blocking.shutdown(wait=False)
        self._transfers.shutdown(wait=False, cancel_futures=True)
