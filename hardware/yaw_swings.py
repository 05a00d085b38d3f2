"""Swings of the nose in flight, so that what is heard on the way tells directions: where the nose is wanted when. Pure.

The nose goes from side to side of a middle direction, in steps that are paced by the wanted rate and never more than
LEAD_DEG ahead of where telemetry sees it: a vehicle that yaws more slowly sets its own pace. It is asked for yaw alone,
between the places where it turns anyway, and only while it could brake before the nearest place where it may not be.
Once it is over it stays over.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal

from hardware.readings import Place
from hardware.reasons.on_the_way import SwingsEnd

BESIDE_M = 10.0
"""So near to the ends of a leg nothing that is heard counts."""
BRAKES_M_S2 = 2.0
ANSWERS_S = 0.5
"""Before it begins to brake."""
SPARE_M = 5.0
"""On top of the braking distance; and twice that before it swings again."""
LEAD_DEG = 30.0
NEAR_DEG = 8.0
"""The nose has come to a side when it is this near."""
FOLLOWS_DEG, FOLLOWS_S = 3.0, 5.0
"""A nose that moves by less in this time does not follow."""
LARGEST_AMPLITUDE_DEG = 150.0

Stage = Literal["before", "swinging", "kept", "over"]


@dataclass(frozen=True, slots=True)
class SwingPlan:
    """middle_deg: of the nose, clockwise from north. amplitude_deg: to either side of it. rate_deg_s: at most.
    facing_deg: where the nose is wanted at the leg's end, None: anywhere."""

    middle_deg: float
    amplitude_deg: float
    rate_deg_s: float
    facing_deg: float | None = None

    def __post_init__(self) -> None:
        wanted = (self.middle_deg, self.amplitude_deg, self.rate_deg_s, self.facing_deg or 0.0)
        if not all(map(math.isfinite, wanted)) or not 0.0 < self.amplitude_deg <= LARGEST_AMPLITUDE_DEG:
            raise ValueError(f"The nose cannot swing by {self.amplitude_deg} degrees about {self.middle_deg}.")
        if not 0.0 < self.rate_deg_s <= 90.0:
            raise ValueError(f"The nose cannot swing at {self.rate_deg_s} degrees a second.")

    @property
    def step_deg(self) -> float:
        """Between two orders, so that they come about every 0.75 s: smooth enough, and few enough for a thin link."""
        return min(45.0, max(10.0, 0.75 * self.rate_deg_s))


@dataclass(frozen=True, slots=True)
class Seen:
    """at_s: of the heading, degrees clockwise from north. flown_m, to_go_m: from and to the ends of the leg. clear_m:
    to the nearest place where the vehicle may not be. ours: nobody else flies, and no later order is under way."""

    at_s: float
    heading_deg: float
    flown_m: float
    to_go_m: float
    speed_m_s: float
    clear_m: float
    ours: bool


@dataclass(frozen=True, slots=True)
class Swings:
    """What is done and what was seen so far. end: None until it is over.

    side: to which the nose goes, 1: clockwise of the middle. wanted_deg: where it should be by now, asked_deg: where it
    was sent last, nose_deg: where it is, all from the middle on, clockwise and continuous. swung: sides that it came
    to. turned_deg, swinging_s: of the nose while it swung. lag_deg: the furthest that it was behind. followed: when and
    where it last moved.
    """

    plan: SwingPlan
    stage: Stage = "before"
    end: SwingsEnd | None = None
    side: float = 1.0
    wanted_deg: float = 0.0
    asked_deg: float | None = None
    nose_deg: float | None = None
    at_s: float = 0.0
    swung: int = 0
    turned_deg: float = 0.0
    swinging_s: float = 0.0
    lag_deg: float = 0.0
    followed: tuple[float, float] = (0.0, 0.0)

    @property
    def rate_deg_s(self) -> float:
        """As measured; 0 before it swings."""
        return self.turned_deg / self.swinging_s if self.swinging_s > 0.0 else 0.0


def braking_m(speed_m_s: float) -> float:
    """Flown before a vehicle of this speed stands."""
    return speed_m_s * ANSWERS_S + speed_m_s**2 / (2.0 * BRAKES_M_S2)


def over(swings: Swings, end: SwingsEnd) -> Swings:
    """Nothing is asked for any more; what was over stays over for its own reason."""
    return swings if swings.stage == "over" else replace(swings, stage="over", end=end)


def swung(swings: Swings, seen: Seen) -> tuple[Swings, float | None]:
    """The swings after one look, and where to send the nose now, clockwise from north; None: leave it."""
    if swings.stage == "over":
        return swings, None
    if not seen.ours:
        return over(swings, "not_ours"), None
    swings = _looked(swings, seen)
    if seen.to_go_m < BESIDE_M:
        return over(swings, "near_place"), swings.plan.facing_deg
    needed = braking_m(seen.speed_m_s) + SPARE_M
    if swings.stage == "swinging" and seen.clear_m < needed:
        return replace(swings, stage="kept"), seen.heading_deg % 360.0
    if swings.stage != "swinging":
        if seen.flown_m < BESIDE_M or seen.clear_m < needed + SPARE_M:
            return swings, None
        swings = _begun(swings)
    if seen.at_s - swings.followed[0] > FOLLOWS_S:
        return over(swings, "lags"), None
    return _sent(swings)


def _looked(swings: Swings, seen: Seen) -> Swings:
    """The nose where it is seen now; while it swings the pace goes on, too."""
    off = math.remainder(seen.heading_deg - swings.plan.middle_deg, 360.0)
    if swings.nose_deg is None:
        return replace(swings, nose_deg=off, at_s=seen.at_s, followed=(seen.at_s, off))
    step = math.remainder(off - swings.nose_deg, 360.0)
    nose, passed_s = swings.nose_deg + step, max(seen.at_s - swings.at_s, 0.0)
    followed = (seen.at_s, nose) if abs(nose - swings.followed[1]) > FOLLOWS_DEG else swings.followed
    looked = replace(swings, nose_deg=nose, at_s=max(seen.at_s, swings.at_s), followed=followed)
    if swings.stage != "swinging":
        return looked
    plan, side = swings.plan, swings.side
    edge = side * plan.amplitude_deg
    wanted = swings.wanted_deg + side * plan.rate_deg_s * passed_s
    wanted = max(nose - LEAD_DEG, min(nose + LEAD_DEG, wanted))
    wanted = min(wanted, edge) if side > 0.0 else max(wanted, edge)
    return replace(
        looked,
        wanted_deg=wanted,
        turned_deg=swings.turned_deg + abs(step),
        swinging_s=swings.swinging_s + passed_s,
        lag_deg=max(swings.lag_deg, abs(wanted - nose)),
    )


def _begun(swings: Swings) -> Swings:
    """From where the nose is, first across the middle."""
    nose = math.remainder(swings.nose_deg or 0.0, 360.0)
    side = -math.copysign(1.0, nose)
    return replace(
        swings,
        stage="swinging",
        side=side,
        nose_deg=nose,
        wanted_deg=nose,
        asked_deg=None,
        followed=(swings.at_s, nose),
    )


def _sent(swings: Swings) -> tuple[Swings, float | None]:
    """The next step, when it is due; at a side the way back begins."""
    plan, nose = swings.plan, swings.nose_deg
    edge = swings.side * plan.amplitude_deg
    if nose is not None and swings.wanted_deg == edge and abs(nose - edge) < NEAR_DEG:
        swings = replace(swings, side=-swings.side, swung=swings.swung + 1)
        edge = -edge
    ahead = swings.wanted_deg + swings.side * plan.step_deg
    asked = min(ahead, edge) if swings.side > 0.0 else max(ahead, edge)
    due = swings.asked_deg is None or abs(asked - swings.asked_deg) >= plan.step_deg
    if not due and (asked != edge or asked == swings.asked_deg):
        return swings, None
    return replace(swings, asked_deg=asked), (plan.middle_deg + asked) % 360.0


@dataclass(slots=True)
class Swinging:
    """The swings of one leg, driven by the link to the vehicle. clear_m: of a place, as in `Seen`."""

    plan: SwingPlan
    clear_m: Callable[[Place], float]
    swings: Swings = field(init=False)

    def __post_init__(self) -> None:
        self.swings = Swings(self.plan)

    def see(self, seen: Seen) -> float | None:
        """Where to send the nose now; None: leave it."""
        self.swings, yaw_deg = swung(self.swings, seen)
        return yaw_deg

    def stop(self, end: SwingsEnd) -> None:
        """Nothing is asked for any more."""
        self.swings = over(self.swings, end)
