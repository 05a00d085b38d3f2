"""What a craft does, where it is, and who flies it."""

from __future__ import annotations

from typing import Literal

from backend.events.bearings import AntennaFact
from backend.events.fact import Fact, Known
from backend.reasons import Reason
from backend.spec import Id, LearnedErrors, Place
from hardware.authority import Authority

FIRST_CRAFT = "craft-1"

Phase = Literal[
    "ground",  # not flying for this mission
    "taking_off",
    "planning",  # choosing the next place
    "waiting",  # a place is proposed, the operator must accept
    "flying",
    "measuring",
    "hold",  # hovering until an operator resumes
    "manual",  # the pilot has control
    "returning",
    "landing",
]
"""What a craft does."""


class GroundFact(Fact):
    """The terrain that a flight is checked against, which is kept under its digest. sources: names of the files.
    home_m: the home's height AMSL by the terrain."""

    digest: str
    sources: list[str]
    spacing_m: float
    home_m: Known


class MissionStarted(Fact):
    """A craft begins to fly for the mission. The first one's home is the origin of the mission's local frame. antenna
    None: nobody kept it. ground None: the ground was taken to be flat at the home's height. learned: of the bearings'
    errors, takes the place of what the specification says; None leaves that."""

    kind: Literal["mission_started"] = "mission_started"
    craft_id: Id
    by: str
    home: Place
    home_amsl_m: float
    software: str
    antenna: AntennaFact | None = None
    ground: GroundFact | None = None
    learned: LearnedErrors | None = None


class PhaseChanged(Fact):
    """The fold takes `after`; `before` is for whoever reads."""

    kind: Literal["phase_changed"] = "phase_changed"
    craft_id: Id
    before: Phase
    after: Phase
    reason: Reason


class TookOff(Fact):
    """altitude_relative_m: above home, when the climb was confirmed."""

    kind: Literal["took_off"] = "took_off"
    craft_id: Id
    place: Place
    altitude_relative_m: float


class FlightStarted(Fact):
    """Ordered, not yet confirmed: PlaceReached is."""

    kind: Literal["flight_started"] = "flight_started"
    craft_id: Id
    place_number: int
    place: Place
    altitude_amsl_m: float


class PlaceRefused(Fact):
    """The autopilot would not fly to the chosen place; it is not ordered again."""

    kind: Literal["place_refused"] = "place_refused"
    craft_id: Id
    place_number: int
    place: Place
    reason: Reason


class PlaceReached(Fact):
    """distance_m: from where it was sent to. flight_time_s: by the mission's clock."""

    kind: Literal["place_reached"] = "place_reached"
    craft_id: Id
    place_number: int
    place: Place
    distance_m: float
    flight_time_s: float


class PlacePassed(Fact):
    """The craft does not turn at a place that it reached, and why: of a mission that never stops to turn."""

    kind: Literal["place_passed"] = "place_passed"
    craft_id: Id
    place_number: int
    reason: Reason


class SweepStarted(Fact):
    """attempt: counts the turns at this place from 1."""

    kind: Literal["sweep_started"] = "sweep_started"
    craft_id: Id
    place_number: int
    attempt: int


class BatteryCountdownStarted(Fact):
    """The craft holds and its battery runs low: it returns after `seconds`, unless somebody stops that, once."""

    kind: Literal["battery_countdown_started"] = "battery_countdown_started"
    craft_id: Id
    seconds: float
    reason: Reason


class BatteryCountdownStopped(Fact):
    """by None: the battery suffices again."""

    kind: Literal["battery_countdown_stopped"] = "battery_countdown_stopped"
    craft_id: Id
    by: str | None


class AuthorityChanged(Fact):
    """Who flies the craft from now on. by: the operator whose deed it was, None when the vehicle showed it."""

    kind: Literal["authority_changed"] = "authority_changed"
    craft_id: Id
    authority: Authority
    by: str | None = None
