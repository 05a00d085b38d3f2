"""Facts, specifications and reasons that the tests of search, craft and mission share."""

from __future__ import annotations

from dataclasses import replace

from backend.craft.inputs import StartFacts
from backend.events import (
    FIRST_CRAFT,
    BearingMeasured,
    BearingSource,
    BeliefUpdated,
    CheckFact,
    CraftSource,
    ImportSource,
    PersonSource,
    PlanChosen,
    SilenceFact,
    SweepRejected,
    TurnFact,
)
from backend.reasons.flight import Ordered, VehicleLinkLost, WatchBroke
from backend.reasons.safety import BatteryShort, BatterySilent, OutsideFence
from backend.reasons.turning import MaximumSeen, SectorExpected
from backend.spec import (
    FIRST_EMITTER,
    EmitterSpec,
    FlightSpec,
    LocalizationSpec,
    MissionSpec,
    Place,
    Polygon,
    SearchArea,
    SensorSpec,
    UniformPriorSpec,
)
from hardware.authority import Authority
from hardware.reasons.preflight import GpsChecked, LinkChecked
from hardware.reasons.receiver import ReceiverSilent
from hardware.reasons.sweep import NoDirection
from hardware.reasons.vehicle import VehicleSilent
from planner.reasons import EveryPlaceRefused, NoBearingYet

HOME = Place(lat=50.0, lon=7.0)
AREA = Polygon(coordinates=[[(7.0, 50.0), (7.004, 50.0), (7.004, 50.001), (7.0, 50.001), (7.0, 50.0)]])
SPEC = MissionSpec(
    name="test",
    area=AREA,
    sensor=SensorSpec(maximum_retakes=1),
    localization=LocalizationSpec(maximum_bearings=4),
)
WAITING_SPEC = SPEC.model_copy(update={"flight": FlightSpec(automatic=False)})
SECOND = "emitter-2"
TWO_SPEC = SPEC.model_copy(
    update={"emitters": [EmitterSpec(), EmitterSpec(emitter_id=SECOND, frequency_hz=869.5e6)]},
)
OTHER_AREA = SearchArea(
    area=Polygon(coordinates=[[(7.0, 50.001), (7.004, 50.001), (7.004, 50.002), (7.0, 50.002), (7.0, 50.001)]]),
    priors={FIRST_EMITTER: UniformPriorSpec()},
    fence=None,
    fence_margin_m=200.0,
    no_fly=[],
)

CHECK = CheckFact(name="vehicle_link", ok=True, reason=LinkChecked("px4"), blocking=True)
FAILED_CHECK = CheckFact(name="gps", ok=False, reason=GpsChecked("no fix", 3, 6), blocking=True)
START = StartFacts(checks=(CHECK,), home=HOME, home_amsl_m=100.0, software="test")

VETO = OutsideFence("place", 30.0)
BATTERY_VETO = BatteryShort(20.0, 10.0, 8.0, 25.0)
SILENT_BATTERY = BatterySilent()
LINK_LOST = VehicleLinkLost(3.0)
RECEIVER_SILENT = ReceiverSilent(5.0)
NO_ANSWER = VehicleSilent("return", 9.0)
NO_TAKE_OFF = VehicleSilent("take_off", 9.0)
NO_PLACE = EveryPlaceRefused()
NOT_YET = NoBearingYet()
BROKE = WatchBroke("vehicle")

OURS = Authority(who="ours", commanded=(1,), heard=1, kind="waiting", armed=True)
PILOT = Authority(who="pilot", taken_by="mode", taken_at_s=1_000.0, mode="POSCTL", heard=2, kind="other", armed=True)
PERHAPS_PILOT = Authority(
    who="pilot",
    taken_by="mode",
    taken_at_s=1_000.0,
    mode="RETURN",
    perhaps_failsafe=True,
    heard=3,
    kind="return",
    armed=True,
)
GIVEN_BACK = Authority(
    who="pilot",
    taken_by="mode",
    taken_at_s=1_000.0,
    mode="POSCTL",
    given_back=True,
    heard=1,
    kind="waiting",
    armed=True,
)
FAILSAFE = Authority(
    who="failsafe", taken_by="mode", taken_at_s=1_000.0, mode="RETURN", heard=3, kind="return", armed=True
)
NAMED_FAILSAFE = replace(FAILSAFE, cause="battery")
LANDED_BY_FAILSAFE = Authority(
    who="nobody", taken_by="mode", taken_at_s=1_000.0, mode="RETURN", given_back=True, failsafe_landed=True, heard=1,
    kind="waiting",
)  # fmt: skip
NOBODY = Authority()
LANDED_BY_PILOT = Authority(
    who="nobody", taken_by="mode", taken_at_s=1_000.0, mode="POSCTL", given_back=True, heard=1, kind="waiting"
)


def plan(number: int = 1, craft_id: str = FIRST_CRAFT) -> PlanChosen:
    return PlanChosen(
        craft_id=craft_id,
        emitter_id=FIRST_EMITTER,
        place_number=number,
        place=Place(lat=50.0005, lon=7.0 + number * 1e-4),
        source="planner",
        reason=Ordered("start", "test"),
        expected_time_s=100.0,
        time_90_s=150.0,
        candidates=[],
        rollouts=10,
        plan_ms=1.0,
    )


OWN = CraftSource(craft_id=FIRST_CRAFT)
PERSON = PersonSource(name="ben")
IMPORT = ImportSource(recording_id="turn")


def bearing(
    number: int = 1, emitter_id: str = FIRST_EMITTER, source: BearingSource = OWN, bearing_id: str | None = None
) -> BearingMeasured:
    return BearingMeasured(
        emitter_id=emitter_id,
        source=source,
        bearing_id=bearing_id or f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=HOME,
        altitude_amsl_m=140.0,
        bearing_deg=45.0,
        sigma_deg=7.0,
        quality=0.9,
        peaks=[],
        snr_db=20.0,
        drift_m=0.1,
        binned_db=[],
        fitted_db=[],
    )


def rejected(attempt: int = 1, number: int = 1, emitter_id: str = FIRST_EMITTER) -> SweepRejected:
    return SweepRejected(
        emitter_id=emitter_id,
        source=OWN,
        sweep_id=f"r{number}-{attempt}",
        place_number=number,
        attempt=attempt,
        quality=0.3,
        reason=NoDirection(),
        place=HOME,
        binned_db=[],
        fitted_db=[],
    )


def silent(attempt: int = 1, number: int = 1, emitter_id: str = FIRST_EMITTER) -> SweepRejected:
    """Listened all around with an antenna that hears to every side, and heard nothing."""
    told = SilenceFact(chances=[1.0] * 16, gain_db=[0.0] * 36)
    return rejected(attempt, number, emitter_id).model_copy(update={"silence": told})


def in_sector(swept: SweepRejected) -> SweepRejected:
    """The same of a turn that left most of the circle out."""
    turn = TurnFact(
        begin_deg=30.0,
        planned_deg=120.0,
        turned_deg=120.0,
        planned_because=SectorExpected(120.0, 95.0),
        went_on_because=[],
        stopped_because=MaximumSeen(120.0, 40.0, 1.0),
    )
    return swept.model_copy(update={"turn": turn})


def belief(bearings: int = 0, localized: bool = False, emitter_id: str = FIRST_EMITTER) -> BeliefUpdated:
    return BeliefUpdated(
        emitter_id=emitter_id,
        bearings=bearings,
        estimate=None,
        consistent=True,
        localized=localized,
        not_yet=[] if localized else [NOT_YET],
        digest="d",
    )
