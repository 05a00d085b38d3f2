"""Who has control: a latch that any mode we did not command closes, and only an operator opens. Pure."""

from __future__ import annotations

from collections.abc import Callable

from hardware.readings import Controller


class ControlLatch:
    """Knows the modes that follow from our last command; whatever else the vehicle shows while flying is not ours.

    Between a command and the first sight of its mode the mode before it is tolerated, and those of our command before
    it, which may show only now. A mode that was there already is no such sight until the command is acknowledged.
    `calm`: the modes in which an airborne vehicle we never commanded (after a restart) waits for orders.
    """

    def __init__(self, calm: frozenset[int], mode_name: Callable[[int], str]) -> None:
        self._calm = calm
        self._mode_name = mode_name
        self._expected: frozenset[int] | None = None
        self._tolerated: frozenset[int] = frozenset()
        self._stale: int | None = None
        self._mode: int | None = None
        self._armed = False
        self._landed = False
        self._reason: str | None = None

    @property
    def reason(self) -> str | None:
        """Why commands are refused, None when they pass. One attribute read: safe from the sending thread."""
        return self._reason

    @property
    def controller(self) -> Controller:
        if self._reason is not None:
            return "nobody" if self._landed else "pilot"
        return "nobody" if self._expected is None else "crossfix"

    @property
    def held(self) -> bool:
        """Closed, and the vehicle is still in a mode in which it does not wait for orders: release would take it."""
        return self._reason is not None and self._armed and self._mode not in self._calm

    def command(self, modes: frozenset[int]) -> None:
        """We are about to send a command after which these modes are ours."""
        before = frozenset() if self._mode is None else frozenset({self._mode})
        self._tolerated |= before | (self._expected or frozenset())
        self._expected, self._stale = modes, self._mode

    def acknowledged(self) -> None:
        """The autopilot has taken the last command: what it shows from now on follows from it."""
        self._stale = None

    def observe(self, mode: int, armed: bool, in_air: bool) -> str | None:
        """The vehicle's mode as heard. Returns the reason when this closes the latch now."""
        self._mode = mode
        was_armed, self._armed = self._armed, armed
        self._landed = not armed and (was_armed or self._landed)
        if was_armed and not armed:
            self._expected = None  # the flight has ended; a new one starts with a command
        if not armed and self._expected is None:
            return None
        if self._reason is not None:
            return None
        if not in_air and mode in self._calm and not self._tolerated:
            ours = True  # an autopilot goes to its waiting mode by itself once it has landed
        elif self._expected is None:
            ours = mode in self._calm or not in_air
        elif mode in self._expected:
            ours = True
            if mode != self._stale:
                self._tolerated = frozenset()
        else:
            ours = mode in self._tolerated
        return (
            None if ours else self.latch(f"the vehicle is in {self._mode_name(mode)}, which Crossfix did not command")
        )

    def stand_down(self) -> None:
        """What was commanded came to nothing and the vehicle stands on the ground: its modes are anybody's again."""
        self._expected = None

    def latch(self, reason: str) -> str:
        """Close it for a reason other than the mode (the autopilot's own word that the pilot moved the sticks)."""
        self._reason, self._landed = reason, False
        return reason

    def release(self) -> None:
        """The operator's deed: the mode of this moment is accepted, commands pass again."""
        self._reason = None
        self._expected = frozenset({self._mode}) if self._armed and self._mode is not None else None
        self._tolerated = frozenset()
