"""At least one of each kind of input to a craft, both fitting and stale ones."""

from __future__ import annotations

from functools import cache
from typing import get_args

from craft_walk import ordered
from facts import (
    BATTERY_VETO,
    BROKE,
    CHECK,
    FAILED_CHECK,
    FAILSAFE,
    GIVEN_BACK,
    HOME,
    LANDED_BY_PILOT,
    LINK_LOST,
    NAMED_FAILSAFE,
    NO_ANSWER,
    NO_PLACE,
    NOBODY,
    OURS,
    PERHAPS_PILOT,
    PILOT,
    VETO,
    bearing,
    plan,
    rejected,
)

from backend import commands
from backend.craft import inputs
from backend.craft.effects import TimerName
from backend.craft.safety import BatteryStage
from backend.craft.state import CraftState
from backend.events import Link
from backend.reasons import Interrupted
from backend.reasons.flight import OtherAntenna, StepName, Way
from backend.search.state import SearchState
from hardware.reasons.receiver import SamplesLost
from hardware.reasons.vehicle import PlaceNotTaken
from hardware.reasons.vehicle_news import (
    AutopilotRepeats,
    AutopilotSaid,
    AutopilotSaidMore,
    AutopilotWords,
    ClockRateOdd,
)

AUTHORITIES = (OURS, PILOT, PERHAPS_PILOT, GIVEN_BACK, FAILSAFE, NAMED_FAILSAFE, NOBODY, LANDED_BY_PILOT)
ORDERS: tuple[commands.ForCraft, ...] = (
    commands.Start(),
    commands.Hold(),
    commands.Resume(),
    commands.Return(),
    commands.Land(),
    commands.Abort(),
    commands.KeepHolding(),
    commands.Override(place=HOME),
    commands.Accept(),
    commands.Veto(),
    commands.SetAutomatic(automatic=True),
    commands.SetAutomatic(automatic=False),
)
LINKS: tuple[Link, ...] = ("vehicle", "receiver", "console", "payload", "gps")
TIMERS: tuple[TimerName, ...] = ("console_hold", "console_return", "landing", "order", "battery_return")
WAYS: tuple[Way, ...] = ("hold", "return", "land")
STEPS: tuple[StepName, ...] = ("take_off", "fly", "measure", "plan", "belief", "hold", "return", "land")


NOT_TAKEN = PlaceNotTaken("Reposition is outside geofence")
CLOCK_ODD = ClockRateOdd(0.9)
SAID: tuple[AutopilotWords, ...] = (
    AutopilotSaid("critical", "Battery failure"),
    AutopilotRepeats("critical", "Battery failure", 4),
    AutopilotSaid("warning", "High wind"),
    AutopilotSaidMore(3),
)


def every_craft_input(craft: CraftState, search: SearchState) -> tuple[inputs.CraftInput, ...]:
    return _every_input(max(craft.place_number, 1), max(craft.attempt, 1), len(search.measured))


@cache
def _every_input(number: int, attempt: int, measured: int) -> tuple[inputs.CraftInput, ...]:
    """Made once for all the states that differ in nothing of this: a sweep gives a million."""
    heard = bearing(number, bearing_id=f"b{measured + 1}")
    return (
        *(ordered(command) for command in ORDERS),
        *(ordered(command, objections=(VETO,)) for command in ORDERS),
        ordered(commands.Resume(), on_ground=True),
        ordered(commands.Start(), start=None),
        ordered(commands.Start(), start=inputs.StartFacts((FAILED_CHECK,), HOME, 100.0, "test")),
        ordered(commands.Start(), start=inputs.StartFacts((CHECK,), None, None, "test")),
        inputs.SearchChanged(),
        inputs.InTheAir(HOME, 40.0),
        inputs.Planned(plan(number + 1)),
        inputs.Planned(plan(number + 1).model_copy(update={"altitude_amsl_m": 181.0})),
        inputs.Planned(plan(number + 1), (VETO,)),
        inputs.Planned(plan(number + 1), (BATTERY_VETO,)),
        inputs.NothingToPlan(NO_PLACE),
        inputs.Arrived(HOME, 0.4, 12.0),
        inputs.SweepTaken((heard,)),
        inputs.SweepTaken((rejected(attempt, number),)),
        *(inputs.WorkFailed(step, NO_ANSWER, in_air) for step in STEPS for in_air in (True, False, None)),
        *(inputs.CarriedOut(way) for way in WAYS),
        inputs.PlaceNotTaken(HOME, NOT_TAKEN),
        *(inputs.Said(words) for words in SAID),
        inputs.SaidNoMore("Battery failure"),
        inputs.ClockOdd(CLOCK_ODD),
        inputs.ClockAgrees(),
        inputs.ReceiverLoses(SamplesLost(12.0)),
        inputs.ReceiverKeepsUp(),
        inputs.WorkVetoed((CLOCK_ODD,)),
        inputs.WorkVetoed((VETO,)),
        inputs.WorkVetoed((BATTERY_VETO,)),
        inputs.WorkVetoed((BATTERY_VETO,), on_ground=True),
        *(inputs.AuthorityHeard(authority) for authority in AUTHORITIES),
        inputs.FailsafeEnded("HOLD"),
        *(inputs.LinkDown(link, LINK_LOST) for link in LINKS),
        *(inputs.LinkUp(link, 3.0) for link in LINKS),
        *(inputs.BatteryLow(BATTERY_VETO, stage) for stage in get_args(BatteryStage)),
        inputs.ChargeLow(BATTERY_VETO),
        inputs.BatteryReported(),
        inputs.AutopilotReturns(VETO),
        inputs.HomeReached(),
        inputs.Landed(),
        *(inputs.TimerExpired(name) for name in TIMERS),
        inputs.Broke(BROKE),
        inputs.NetsUp(),
        inputs.NetsNotTaken(VETO),
        *(inputs.Restarted(authority, on_ground) for authority in AUTHORITIES for on_ground in (False, True)),
        *(inputs.Restarted(authority, other_antenna=OtherAntenna("a", "b")) for authority in AUTHORITIES),
        *(inputs.Leaving(homeward) for homeward in (False, True)),
        inputs.Abandoned(Interrupted("later_mission")),
    )
