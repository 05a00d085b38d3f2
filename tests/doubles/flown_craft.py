"""A craft whose modes are heard and commanded one by one: who flies it is what `now` says."""

from __future__ import annotations

from hardware.authority import (
    Authority,
    CommandAcknowledged,
    CommandSent,
    ModeHeard,
    ModeKind,
    Seen,
    authority_after,
)

HOLD, GUIDED, POSCTL, RETURN, LAND = 1, 2, 3, 4, 5
KINDS: dict[int, ModeKind] = {HOLD: "waiting", GUIDED: "waiting", POSCTL: "other", RETURN: "return", LAND: "land"}
NAMES = {HOLD: "HOLD", GUIDED: "GUIDED", POSCTL: "POSCTL", RETURN: "RETURN", LAND: "LAND"}


class Craft:
    """`now`: who flies after all that was seen; every `hears` is a tenth of a second later."""

    def __init__(self, *before: Seen) -> None:
        self.now = Authority()
        self.at_s = 1_000.0
        for seen in before:
            self.sees(seen)

    def sees(self, seen: Seen) -> Authority:
        self.now = authority_after(self.now, seen)
        return self.now

    def hears(
        self, mode: int, armed: bool | None = True, in_air: bool = True, after_silence: bool = False
    ) -> Authority:
        self.at_s += 0.1
        return self.sees(ModeHeard(mode, KINDS[mode], NAMES[mode], armed, in_air, after_silence, self.at_s))

    def on_ground(self, mode: int, armed: bool | None = False) -> Authority:
        return self.hears(mode, armed, in_air=False)

    def commands(self, *modes: int) -> Authority:
        return self.sees(CommandSent(frozenset(modes)))

    def waits(self, seconds: float) -> None:
        self.at_s += seconds


def flying(mode: int = HOLD) -> Craft:
    """By our command."""
    craft = Craft()
    craft.on_ground(HOLD)
    craft.commands(mode)
    craft.sees(CommandAcknowledged())
    craft.hears(mode)
    assert craft.now.who == "ours"
    return craft
