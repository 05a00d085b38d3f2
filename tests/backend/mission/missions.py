"""Facts, inputs and states that the machine's tests share."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime

from backend import commands
from backend.events import BearingMeasured, BeliefUpdated, CheckFact, Event, PlanChosen, Recorded, SweepRejected
from backend.mission import effects as asked
from backend.mission import inputs
from backend.mission.effects import Effect, Record
from backend.mission.machine import transition
from backend.mission.safety import Veto
from backend.mission.state import MissionState, evolve
from backend.spec import (
    FlightSpec,
    LocalizationSpec,
    MissionSpec,
    Place,
    Polygon,
    SearchArea,
    SensorSpec,
    UniformPriorSpec,
)

HOME = Place(lat=50.0, lon=7.0)
AREA = Polygon(coordinates=[[(7.0, 50.0), (7.004, 50.0), (7.004, 50.001), (7.0, 50.001), (7.0, 50.0)]])
SPEC = MissionSpec(
    name="test",
    area=AREA,
    sensor=SensorSpec(maximum_retakes=1),
    localization=LocalizationSpec(maximum_bearings=4),
)
ELSEWHERE = SearchArea(
    area=Polygon(coordinates=[[(7.0, 50.001), (7.004, 50.001), (7.004, 50.002), (7.0, 50.002), (7.0, 50.001)]]),
    prior=UniformPriorSpec(),
    fence=None,
    fence_margin_m=200.0,
    no_fly=[],
)
WAITING_SPEC = SPEC.model_copy(update={"flight": FlightSpec(automatic=False)})
CHECK = CheckFact(name="link", ok=True, detail="ok", remedy="", blocking=True)
FAILED_CHECK = CheckFact(name="gps", ok=False, detail="no fix", remedy="wait", blocking=True)
START = inputs.StartFacts(checks=(CHECK,), home=HOME, home_amsl_m=100.0, software="test")
VETO = Veto("fence", "outside", "stay inside")
BATTERY_VETO = Veto("battery", "too little", "go home")

MOVES = (asked.TakeOff, asked.FlyTo, asked.Measure, asked.ReturnHome, asked.Land)
"""What sends the vehicle somewhere."""


def kinds(effects: tuple[Effect, ...]) -> list[type]:
    return [type(e) for e in effects]


def moves(effects: tuple[Effect, ...]) -> list[Effect]:
    return [e for e in effects if isinstance(e, MOVES)]


def answer(effects: tuple[Effect, ...]) -> asked.Reply:
    return next(e for e in effects if isinstance(e, asked.Reply))


def commanded(command: commands.Command, command_id: str = "c", **more: object) -> inputs.Commanded:
    start = START if isinstance(command, commands.Start) else None
    return inputs.Commanded(command_id, "anna", command, **{"start": start, **more})  # type: ignore[arg-type]


def plan(number: int = 1) -> PlanChosen:
    return PlanChosen(
        place_number=number,
        place=Place(lat=50.0005, lon=7.0 + number * 1e-4),
        source="planner",
        reason="best",
        expected_time_s=100.0,
        time_90_s=150.0,
        candidates=[],
        rollouts=10,
        plan_ms=1.0,
    )


def bearing(number: int = 1) -> BearingMeasured:
    return BearingMeasured(
        bearing_id=f"b{number}",
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


def rejected(attempt: int = 1, number: int = 1) -> SweepRejected:
    return SweepRejected(
        sweep_id=f"r{number}-{attempt}",
        place_number=number,
        attempt=attempt,
        quality=0.3,
        reason="flat",
        place=HOME,
        binned_db=[],
        fitted_db=[],
    )


def belief(bearings: int = 0, localized: bool = False) -> BeliefUpdated:
    return BeliefUpdated(
        bearings=bearings,
        estimate=None,
        consistent=True,
        localized=localized,
        not_yet=[] if localized else ["not yet: too few"],
        digest="d",
    )


def belief_ready(state: MissionState, localized: bool = False) -> inputs.BeliefReady:
    return inputs.BeliefReady(state.bearing_ids, belief(len(state.bearing_ids), localized))


class Walk:
    """A machine driven by inputs, with everything it recorded and asked for."""

    def __init__(self, spec: MissionSpec = SPEC) -> None:
        from backend.events import MissionDrafted

        self.at_s = 1_000.0
        self.state = evolve(MissionState(), MissionDrafted(spec=spec), self.at_s)
        self.recorded: list[Recorded] = []
        self._keep([MissionDrafted(spec=spec)])
        self._commands = 0

    def give(self, given: inputs.Input) -> tuple[Effect, ...]:
        self.at_s += 1.0
        self.state, effects = transition(self.state, given, self.at_s)
        self._keep([e.event for e in effects if isinstance(e, Record)])
        return effects

    def command(self, command: commands.Command, **more: object) -> tuple[Effect, ...]:
        self._commands += 1
        return self.give(commanded(command, f"c{self._commands}", **more))

    def to(self, phase: str) -> Walk:
        """Along the usual way to `phase`."""
        usual = {
            "draft": (),
            "ready": (inputs.PreflightDone((CHECK,)),),
            "taking_off": (commands.Start(),),
            "planning": (inputs.InTheAir(HOME, 40.0),),
            "waiting": (inputs.Planned(plan(1)),),
            "flying": (inputs.Planned(plan(1)), commands.Accept()),
            "measuring": (inputs.Arrived(HOME, 0.5, 20.0),),
        }
        for step in ("ready", "taking_off", "planning", "flying", "measuring"):
            if self.state.phase == phase:
                return self
            self._play(usual["waiting"] if phase == "waiting" and step == "flying" else usual[step])
            if self.state.phase == "planning" and not self.state.belief_current and phase != "planning":
                self.give(belief_ready(self.state))
        after: dict[str, tuple[object, ...]] = {
            "hold": (commands.Hold(),),
            "manual": (inputs.PilotTookOver("POSCTL", "stick"),),
            "returning": (commands.Return(),),
            "landing": (commands.Return(), inputs.HomeReached()),
            "done": (commands.Return(), inputs.HomeReached(), inputs.Landed()),
            "aborted": (commands.Abort(),),
        }
        self._play(after.get(phase, ()))
        if self.state.phase != phase:
            raise AssertionError(f"the usual way ended in {self.state.phase}, not {phase}")
        return self

    def _play(self, steps: Iterable[object]) -> None:
        for step in steps:
            if isinstance(step, commands.Accept) and self.state.phase != "waiting":
                continue
            if isinstance(step, commands.Model):
                self.command(step)  # type: ignore[arg-type]
            else:
                self.give(step)  # type: ignore[arg-type]

    def _keep(self, events: Iterable[Event]) -> None:
        at = datetime.fromtimestamp(self.at_s, UTC)
        for event in events:
            self.recorded.append(Recorded(seq=len(self.recorded) + 1, mission_id="m", at_utc=at, event=event))

    @property
    def kinds(self) -> list[str]:
        return [r.event.kind for r in self.recorded]


def failed_mission() -> Walk:
    walk = Walk().to("taking_off")
    walk.give(inputs.WorkFailed("take_off", "motors did not arm", "look at it", in_air=False))
    return walk


PHASES = (
    "draft", "ready", "taking_off", "planning", "waiting", "flying", "measuring", "hold", "manual", "returning",
    "landing", "done", "aborted", "failed",
)  # fmt: skip


def walk_in(phase: str) -> Walk:
    if phase == "failed":
        return failed_mission()
    return Walk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)


def every_input(state: MissionState) -> list[inputs.Input]:
    """At least one of each kind, both fitting and stale ones."""
    number = max(state.place_number, 1)
    known = state.measured[0].bearing_id if state.measured else "unknown"
    alert = state.open_alerts[0] if state.open_alerts else "unknown-1"
    ordered: list[commands.Command] = [
        commands.Start(),
        commands.Hold(),
        commands.Resume(),
        commands.Return(),
        commands.Abort(),
        commands.Override(place=HOME),
        commands.ChangeArea(search=ELSEWHERE),
        commands.Accept(),
        commands.Veto(),
        commands.SetAutomatic(automatic=True),
        commands.SetAutomatic(automatic=False),
        commands.ExcludeBearing(bearing_id=known),
        commands.AcknowledgeAlert(alert_id=alert),
    ]
    links: tuple[inputs.Link, ...] = ("vehicle", "receiver", "console", "payload")
    timers: tuple[inputs.TimerName, ...] = ("console_hold", "console_return", "landing")
    steps: tuple[inputs.StepName, ...] = ("take_off", "fly", "measure", "plan", "belief", "hold", "return", "land")
    return [
        *(commanded(c, f"every-{i}") for i, c in enumerate(ordered)),
        commanded(commands.Override(place=HOME), "vetoed", objections=(VETO,)),
        commanded(commands.ChangeArea(search=ELSEWHERE), "area", objections=(VETO,)),
        commanded(commands.Resume(), "on-ground", on_ground=True),
        commanded(commands.Resume(), "not given back", objections=(VETO,)),
        commanded(commands.Start(), "refused", objections=(VETO,)),
        inputs.Edited(SPEC),
        inputs.PreflightDone((CHECK,)),
        inputs.PreflightDone((FAILED_CHECK,)),
        inputs.InTheAir(HOME, 40.0),
        inputs.Planned(plan(number + 1)),
        inputs.Planned(plan(number + 1), (VETO,)),
        inputs.Planned(plan(number + 1), (BATTERY_VETO,)),
        inputs.NothingToPlan("all places are forbidden"),
        inputs.Arrived(HOME, 0.4, 12.0),
        inputs.SweepTaken(bearing(len(state.measured) + 1)),
        inputs.SweepRefused(rejected(max(state.attempt, 1), number)),
        belief_ready(state),
        belief_ready(state, localized=True),
        inputs.BeliefReady(("stale",), belief(1)),
        *(inputs.WorkFailed(s, "did not work", "try again", in_air) for s in steps for in_air in (True, False, None)),
        inputs.WorkVetoed((VETO,)),
        inputs.WorkVetoed((BATTERY_VETO,)),
        inputs.PilotTookOver("POSCTL", "stick"),
        inputs.FailsafeActs("RETURN"),
        inputs.FailsafeStopped("HOLD"),
        *(inputs.LinkDown(link, "silent") for link in links),
        *(inputs.LinkUp(link, 3.0) for link in links),
        inputs.LinkUp("vehicle", 12.0, going_home=True),
        inputs.BatteryLow("just enough to return"),
        inputs.BatteryReported(),
        inputs.HomeReached(),
        inputs.Landed(),
        *(inputs.TimerExpired(name) for name in timers),
        inputs.Interrupted("another one flies"),
        inputs.NotStored("bearing_measured: a number is missing"),
        inputs.Restarted(pilot=False, going_home=False, detail="back"),
        inputs.Restarted(pilot=False, going_home=True, detail="back"),
        inputs.Restarted(pilot=True, going_home=False, detail="back"),
    ]
