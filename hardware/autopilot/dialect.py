"""What differs between autopilots, as data and small functions; the vehicle itself asks and never branches."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

from hardware.authority import ModeKind
from hardware.autopilot.failsafe_names import FailsafeWords
from hardware.autopilot.messages import Outgoing
from hardware.reasons.preflight import FailsafeWatch
from hardware.reasons.vehicle import CommandName

STATION_NOTICED_LOST_S = (2.0, 30.0)
"""Heartbeats come once a second: sooner would be a false alarm. Later, a vehicle without its station flies on or hovers
for a good part of its battery: ArduCopter allows 120 s, PX4 300."""


@dataclass(frozen=True, slots=True)
class FailsafeRule:
    """One parameter that must make the autopilot act by itself, and soon enough. `safe`: the values that do; `set_to`:
    the remedy."""

    parameter: str
    watch: FailsafeWatch
    safe: frozenset[int]
    set_to: int
    blocking: bool = True
    bit: int | None = None
    """When given, this bit must be set and `safe` is not looked at."""
    within: tuple[float, float] | None = None
    """When given, the value must lie there, and `safe` is not looked at."""
    formerly: str | None = None
    """The name of the same parameter in older versions."""
    thresholds: tuple[str, str] | None = None
    """Those with the voltage and the charge at which it acts; while both are 0 it never does."""

    def wanted(self, value: float | None) -> int:
        """What to set it to; value: as it is now, whose other bits stay."""
        return self.set_to if self.bit is None or value is None else int(value) | self.bit

    def holds(self, value: float) -> bool:
        """value: the parameter as a number; of a bit mask only `bit` is looked at."""
        if self.within is not None:
            least, most = self.within
            return least <= value <= most
        return bool(int(value) & self.bit) if self.bit is not None else int(value) in self.safe


@dataclass(frozen=True, slots=True)
class ModeOrder:
    """A mode to select: how to ask for it, and the raw custom modes that say the vehicle obeys."""

    command: CommandName
    custom: tuple[float, float]
    modes: frozenset[int]


@dataclass(frozen=True, slots=True)
class OwnFence:
    """What the parameters make of the fence that the autopilot holds. Metres; None: no such limit.

    watched: the polygons and circles it holds are in force. any_inclusion: inside one of several is enough.
    """

    watched: bool
    ceiling_m: float | None
    ceiling_parameter: str
    radius_m: float | None
    any_inclusion: bool


@dataclass(frozen=True, slots=True)
class NetRules:
    """parameters: those of the fence, in the order in which to set them; `required` must be readable.

    for_mission: (present values, ceiling m above home) -> those to change, so that the fence is in force.
    """

    parameters: tuple[str, ...]
    required: frozenset[str]
    own: Callable[[Mapping[str, float]], OwnFence]
    for_mission: Callable[[Mapping[str, float], float], dict[str, float]]
    most_corners: int


_CRITICAL = 5  # MAV_STATE
TurnMethod = Literal["yaw_steps", "nudged_yaw_steps", "condition_yaw", "condition_yaw_absolute"]
YawMethod = Literal["reposition", "condition_yaw"]


@dataclass(frozen=True, slots=True)
class Dialect:
    """One autopilot's way of speaking.

    waiting_modes: raw modes in which a flying vehicle waits for commands. returning_modes, landing_modes: those that a
    failsafe may enter by itself. takeover_text: the beginning of the text by which the autopilot reports the sticks.
    failsafe_words: how it names a failsafe of its own. state_tells_failsafe: the state in its heartbeat is critical
    while one has chosen the mode, and active as soon as a pilot has; ArduCopter's stays critical.
    waits_again: it goes on waiting by itself after a failsafe for its place; ArduCopter lands.
    mode_report: the message that tells the mode, and how often to ask for it (Hz). Both autopilots send it at once when
    the mode has changed; when that is lost the next one tells it. PX4 sends CURRENT_MODE at most so often, and twice a
    second when nothing changed: a fast rate costs nothing and shows a mode that lasted for an instant. ArduCopter 4.7
    has no CURRENT_MODE.
    mode_switch: the parameter with the number of the pilot's channel that selects modes; 0: none does.
    place_refused_texts: the beginnings of those by which it refuses a place that it has acknowledged.
    hold: commands that stop it, in the order to try them, those that change no mode in a hold mode only; hold_modes:
    the raw modes it then shows. stay: makes the place where it is the one it holds at; None: it comes to rest there by
    itself. hold_turns_nose: out of a flight, the first of these turns the nose as well. steering: the mode in which it
    flies to places and turns as told.
    before_take_off: the mode to be in for arming. take_off: (altitude relative m, altitude AMSL m) ->
    command. take_off_modes: raw modes while and after climbing; settled_modes: those that mean the climb has ended.
    reposition_sets_speed: DO_REPOSITION's param1 is obeyed; else DO_CHANGE_SPEED follows it.
    turn_methods: ways to turn a full circle, in the order in which to try them. yaw_on_the_way: how the nose is sent
    somewhere while it flies to a place.
    prearm_has_present_bit: SYS_STATUS says by a bit of its own whether it reports the checks before arming; else their
    health bit alone counts.
    return_altitudes: the parameter that the autopilot's own return climbs to and its unit in metres, newest name first.
    return_climbs: likewise, the one by which it climbs at least, from however high it begins; empty: there is none.
    """

    name: Literal["px4", "ardupilot"]
    mode_names: Mapping[int, str]
    mode_report: tuple[int, float]
    mode_switch: str
    waiting_modes: frozenset[int]
    returning_modes: frozenset[int]
    landing_modes: frozenset[int]
    takeover_text: str | None
    failsafe_words: FailsafeWords
    state_tells_failsafe: bool
    waits_again: bool
    place_refused_texts: tuple[str, ...]
    hold: tuple[Outgoing, ...]
    hold_modes: frozenset[int]
    stay: Outgoing | None
    hold_turns_nose: bool
    return_home: ModeOrder
    land: ModeOrder
    before_take_off: ModeOrder
    take_off: Callable[[float, float], Outgoing]
    take_off_modes: frozenset[int]
    settled_modes: frozenset[int]
    steering: ModeOrder
    reposition_sets_speed: bool
    turn_methods: tuple[TurnMethod, ...]
    yaw_on_the_way: YawMethod
    prearm_has_present_bit: bool
    nets: NetRules
    failsafes: tuple[FailsafeRule, ...]
    return_altitudes: tuple[tuple[str, float], ...]
    return_climbs: tuple[tuple[str, float], ...]

    @property
    def station_time(self) -> str:
        """The parameter that says for how long a station is silent before the autopilot acts on that."""
        return next(rule.parameter for rule in self.failsafes if rule.watch == "station_time")

    def failsafe_acts(self, state: int | None, tells_current_mode: bool) -> bool | None:
        """Whether a failsafe has chosen the mode; state: MAV_STATE of the heartbeat that tells it. None: not said. A
        PX4 before 1.15, which knows no CURRENT_MODE, is critical also while it only warns."""
        if state is None or not self.state_tells_failsafe:
            return None
        return False if state < _CRITICAL else True if tells_current_mode else None

    def mode_name(self, custom_mode: int) -> str:
        """As pilots know it; "mode N" for one that this dialect does not name."""
        return self.mode_names.get(custom_mode, f"mode {custom_mode}")

    def prearm_ok(self, present: bool | None, healthy: bool | None) -> bool | None:
        """Whether the autopilot would arm, from the bits of SYS_STATUS; None while it does not say."""
        reported = present if self.prearm_has_present_bit else healthy is not None
        return healthy if reported else None

    def mode_kind(self, custom_mode: int) -> ModeKind:
        """What the raw mode means for who flies; "other" may be the pilot."""
        if custom_mode in self.waiting_modes:
            return "waiting"
        if custom_mode in self.returning_modes:
            return "return"
        return "land" if custom_mode in self.landing_modes else "other"
