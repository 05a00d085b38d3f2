"""Commands with acknowledgement: sent only while that is ours to do, sent again visibly, refused with a reason."""

from __future__ import annotations

import asyncio
import time
from collections import defaultdict
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field

from hardware.authority import CommandAcknowledged, CommandSent
from hardware.autopilot.control import Control
from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.messages import Outgoing, result_of
from hardware.deadline import Deadline
from hardware.ports import Clock, NotInControl, VehicleError
from hardware.reasons.vehicle import (
    AutopilotRefused,
    CommandName,
    CommandResult,
    CommandUnanswered,
    ManoeuvreName,
    ManoeuvreReplaced,
    ModeLeft,
    ModeNotCommanded,
    SticksMoved,
)
from hardware.reasons.vehicle_news import TriedAgain, VehicleNews

ACK_S, ACK_WALL_S, ATTEMPTS = 1.5, 1.0, 3
QUICK, SLACK_S = 0.9, 0.05
"""An answer that comes sooner than this share of the link's quickest round trip, by more than the slack, is one to an
order before of the same number: an answer names no more than that."""


class CommandDenied(VehicleError):
    """The autopilot answered, and said no."""

    def __init__(self, reason: AutopilotRefused) -> None:
        super().__init__(reason)
        self.refusal = reason


class CommandLost(VehicleError):
    """No answer came, however often it was sent. It may have been carried out."""

    def __init__(self, reason: CommandUnanswered) -> None:
        super().__init__(reason)
        self.unanswered = reason


class OutOfMode(VehicleError):
    """The vehicle is not in the mode in which it obeys the command, though nobody took it. sent: once at least, before
    it left that; its answer is not known."""

    def __init__(self, reason: ModeLeft, sent: bool) -> None:
        super().__init__(reason)
        self.sent = sent


class ManoeuvreSuperseded(VehicleError):
    """A later one (hold, return, another flight) replaced this manoeuvre."""


class Manoeuvre:
    """One thing the vehicle is to do; a later one supersedes it, and then it sends nothing more."""

    def __init__(self, name: ManoeuvreName) -> None:
        self.name: ManoeuvreName = name
        self.superseded_by: ManoeuvreName | None = None


@dataclass(slots=True)
class _Order:
    """One order that is sent until it is answered. sent_at_s: for the first time, by time.monotonic; None: not yet."""

    sent_at_s: float | None = None
    answer: asyncio.Future[CommandResult] = field(default_factory=lambda: asyncio.get_running_loop().create_future())


class Commander:
    """Sends commands for manoeuvres. Control and the manoeuvre are asked in the instant before each send.

    mode_heard: waits for the vehicle's next word of its mode, or until it has been silent about it long enough.
    quickest_s: seconds of wall time from a question to its answer, at least, as the link is of late; 0: not known.
    """

    def __init__(
        self,
        link: MavlinkLink,
        clock: Clock,
        control: Control,
        announce: Callable[[VehicleNews], None],
        mode_heard: Callable[[], Awaitable[None]],
        quickest_s: Callable[[], float],
    ) -> None:
        self._link = link
        self._clock = clock
        self._control = control
        self._announce = announce
        self._mode_heard = mode_heard
        self._quickest_s = quickest_s
        self._waiting: dict[int, list[_Order]] = defaultdict(list)

    def acknowledged(self, fields: Fields) -> None:
        """A COMMAND_ACK came."""
        quickest_s = self._quickest_s()
        since_s = time.monotonic() - min(QUICK * quickest_s, max(quickest_s - SLACK_S, 0.0))
        for order in self._waiting.get(int(fields["command"]), ()):
            if order.sent_at_s is not None and order.sent_at_s <= since_s and not order.answer.done():
                order.answer.set_result(result_of(int(fields["result"])))

    def check(self, manoeuvre: Manoeuvre) -> None:
        """Raises NotInControl or ManoeuvreSuperseded when this manoeuvre may not go on."""
        authority = self._control.authority
        if authority.taken_by == "sticks":
            raise NotInControl(SticksMoved(manoeuvre.name))
        if authority.taken_by == "mode" and authority.who != "ours":
            raise NotInControl(ModeNotCommanded(manoeuvre.name, authority.mode or "", authority.who))
        if manoeuvre.superseded_by is not None:
            raise ManoeuvreSuperseded(ManoeuvreReplaced(manoeuvre.name, manoeuvre.superseded_by))

    async def send(
        self,
        manoeuvre: Manoeuvre,
        outgoing: Outgoing,
        modes: frozenset[int],
        command: CommandName,
        again: Callable[[], Outgoing] | None = None,
    ) -> None:
        """Send a flight command until it is acknowledged. modes: the raw modes that are ours after it. again: what goes
        out where it was not answered; None: the same.

        One that changes the mode goes right after the vehicle's own word of its mode: sent blindly, it would undo a
        pilot's switch; and not again once its mode shows, though its answer got lost. Any other goes only while the
        vehicle is in one of `modes`.
        Raises CommandDenied, OutOfMode, NotInControl, ManoeuvreSuperseded, CommandLost.
        """

        def allowed() -> bool:
            authority = self._control.authority
            in_mode = outgoing.changes_mode or authority.heard in modes
            return authority.who == "ours" and in_mode and manoeuvre.superseded_by is None

        in_mode_before, order = self._control.authority.heard in modes, _Order()
        for attempt in range(1, ATTEMPTS + 1):
            if attempt > 1 and again is not None:
                outgoing = again()
            if outgoing.changes_mode:
                await self._mode_heard()
            self.check(manoeuvre)
            self._control.see(CommandSent(modes))
            if not allowed():
                raise OutOfMode(ModeLeft(command), sent=order.sent_at_s is not None)
            result = await self._exchange(outgoing, order, attempt, allowed)
            self.check(manoeuvre)
            if result in outgoing.delivered:
                self._control.see(CommandAcknowledged())
                return
            if result is not None:
                raise CommandDenied(AutopilotRefused(command, result))
            if outgoing.changes_mode and not in_mode_before and self._control.authority.heard in modes:
                self._control.see(CommandAcknowledged())
                return
            if attempt < ATTEMPTS:
                self._announce(TriedAgain(CommandUnanswered(command, attempt), attempt + 1))
        raise CommandLost(CommandUnanswered(command, ATTEMPTS))

    async def ask(self, outgoing: Outgoing) -> bool:
        """Send a command that moves nothing (telemetry rates); True when accepted. Anybody may have control."""
        order = _Order()
        for attempt in range(1, ATTEMPTS + 1):
            result = await self._exchange(outgoing, order, attempt, lambda: True)
            if result is not None:
                return result == "accepted"
        return False

    async def _exchange(
        self, outgoing: Outgoing, order: _Order, attempt: int, allowed: Callable[[], bool]
    ) -> CommandResult | None:
        """The final result, or None when none came (or nothing was sent)."""
        fields = outgoing.fields
        if outgoing.message == "COMMAND_LONG":
            fields = fields | {"confirmation": attempt - 1}

        def goes() -> bool:
            may = allowed()
            if may and order.sent_at_s is None:
                order.sent_at_s = time.monotonic()
            return may

        waiting = self._waiting[outgoing.number]
        waiting.append(order)
        try:
            if not await self._link.send(outgoing.message, fields, goes):
                return None
            result = await self._answer(order, Deadline(self._clock, ACK_S, ACK_WALL_S), allowed)
            if result == "in_progress":
                order.answer = asyncio.get_running_loop().create_future()
                result = await self._answer(order, Deadline(self._clock, 10.0, 5.0), allowed)
            return result
        finally:
            waiting.remove(order)

    async def _answer(self, order: _Order, deadline: Deadline, allowed: Callable[[], bool]) -> CommandResult | None:
        while not deadline.passed and allowed():
            done, _ = await asyncio.wait((order.answer,), timeout=0.05)
            if done:
                return order.answer.result()
        return None
