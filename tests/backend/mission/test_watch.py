from __future__ import annotations

from dataclasses import replace

import pytest
from doubles import FRAME, Stage, spec
from missions import BATTERY_VETO, Walk, plan, walk_in

from backend.mission import inputs, watch
from backend.mission.equipment import Equipment
from backend.mission.listening import Listening
from backend.mission.localization import localization
from backend.mission.machine import transition
from backend.mission.safety import NOMINAL_DRAIN_PERCENT_S, vehicle_vetoes
from backend.mission.state import MissionState
from backend.mission.watch import Drain, Watch
from backend.spec import Place
from hardware.autopilot.patience import Deadline


class HandClock:
    """Time moves when told."""

    def __init__(self) -> None:
        self.at = 1_000.0

    def now(self) -> float:
        return self.at

    async def sleep(self, seconds: float) -> None:
        self.at += seconds


class Scene:
    def __init__(self) -> None:
        stage = Stage()
        self.clock = HandClock()
        self.vehicle, self.publisher = stage.vehicle, stage.publisher
        self.vehicle.clock = self.clock  # type: ignore[assignment]
        self.state: MissionState = Walk().to("flying").state
        self.given: list[inputs.Input] = []
        self.listening = Listening(stage.receiver, self.clock, 868.3e6, 5.0)
        equipment = Equipment(
            vehicle=stage.vehicle,
            receiver=stage.receiver,
            finder=stage.finder,
            pattern=None,  # type: ignore[arg-type]
            journal=stage.journal,
            publisher=stage.publisher,
            clock=self.clock,
            software="test",
        )
        task = localization(spec(), Place(lat=50.0, lon=7.0), 100.0)
        self.watch = Watch(equipment, task.limits, self.listening, lambda: self.state, self.given.append)
        self.see(in_air=True, armed=True, altitude_relative_m=40.0, altitude_amsl_m=140.0)

    def see(self, **values: object) -> None:
        self.vehicle.state = replace(self.vehicle.state, **values)  # type: ignore[arg-type]

    def machine_answers(self) -> None:
        """What is given from now on changes the state."""

        def give(given: inputs.Input) -> None:
            self.given.append(given)
            self.state, _ = transition(self.state, given, self.clock.at)

        self.watch.give = give

    def tick(self, times: int = 1, step_s: float = 0.2) -> list[inputs.Input]:
        self.given.clear()
        for _ in range(times):
            self.clock.at += step_s
            self.watch.tick()
        return self.given


@pytest.fixture
def scene() -> Scene:
    return Scene()


def test_nothing_happens_while_all_is_well(scene: Scene) -> None:
    assert scene.tick(20) == []


def test_a_link_that_goes_and_comes_is_told_once_each_way(scene: Scene) -> None:
    scene.tick()
    scene.vehicle.heard = False
    told = scene.tick(5)
    assert [type(g) for g in told] == [inputs.LinkDown]
    scene.vehicle.heard = True
    (up,) = scene.tick(5)
    assert isinstance(up, inputs.LinkUp)
    assert up.outage_s == pytest.approx(1.0)


def test_a_console_counts_only_after_one_was_there(scene: Scene) -> None:
    assert scene.tick(3) == []
    scene.publisher.consoles = 2
    assert scene.tick(3) == []
    scene.publisher.consoles = 0
    assert scene.tick(3) == [inputs.LinkDown("console", "no console is connected")]


def test_a_machine_that_stood_still_is_no_silent_receiver(scene: Scene) -> None:
    scene.listening.start = lambda: None  # type: ignore[method-assign]
    scene.tick()
    scene.tick(1, step_s=60.0)
    assert scene.listening._quiet_s < 2.0
    scene.tick(30)
    assert scene.listening._quiet_s > 5.0


def test_the_battery_is_told_once_until_it_recovers(scene: Scene) -> None:
    scene.see(battery_percent=26.0)
    (low,) = scene.tick(5)
    assert isinstance(low, inputs.BatteryLow)
    scene.see(battery_percent=90.0)
    assert scene.tick(2) == [inputs.BatteryReported()]


def test_a_charge_at_the_limit_is_told_once(scene: Scene) -> None:
    told = []
    for charge in (29.0, 31.0, 29.0, 31.0):  # five percent for the landing, twenty-five in reserve
        scene.see(battery_percent=charge)
        told += [type(given) for given in scene.tick()]
    assert told == [inputs.BatteryLow]


def test_a_low_battery_is_told_again_when_the_mission_flies_on_or_is_held_on_its_way_home(scene: Scene) -> None:
    scene.see(battery_percent=26.0)
    for phase, told in (("hold", 1), ("waiting", 1), ("returning", 1), ("hold", 1), ("manual", 0)):
        scene.state = walk_in(phase).state
        assert [type(given) for given in scene.tick(5)].count(inputs.BatteryLow) == told


def test_an_alert_that_a_planned_flight_or_another_server_raised_is_cleared_too(scene: Scene) -> None:
    walk = Walk().to("planning")
    walk.give(inputs.Planned(plan(1), (BATTERY_VETO,)))
    scene.state = walk.state
    assert inputs.BatteryReported() in scene.tick()


def test_a_charge_that_the_vehicle_no_longer_reports_is_told_and_cleared_when_it_is_reported_again(
    scene: Scene,
) -> None:
    scene.tick()
    scene.vehicle.charge_reported = False
    assert scene.tick(30, step_s=1.0) == []
    assert scene.tick(2, step_s=1.0) == [inputs.BatteryLow("the battery's charge is no longer reported")]
    scene.see(battery_percent=26.0)
    scene.vehicle.charge_reported = True
    (low,) = scene.tick(2)
    assert isinstance(low, inputs.BatteryLow)
    assert "the reserve" in low.detail
    scene.see(battery_percent=None)
    scene.tick(200)
    scene.see(battery_percent=90.0)
    assert scene.tick(2) == [inputs.BatteryReported()]


def test_a_lost_link_is_no_battery_that_stopped_reporting_neither_before_nor_after_it_was_noticed(
    scene: Scene,
) -> None:
    scene.tick()
    scene.vehicle.heard, scene.vehicle.silence_unnoticed = False, True
    assert scene.tick(36, step_s=1.0) == []
    scene.vehicle.silence_unnoticed = False
    assert [type(told) for told in scene.tick(36, step_s=1.0)] == [inputs.LinkDown]
    scene.vehicle.heard, scene.vehicle.charge_reported = True, False
    assert [type(told) for told in scene.tick(5, step_s=1.0)] == [inputs.LinkUp]


def test_a_battery_that_stays_unknown_in_the_air_sends_the_vehicle_home(scene: Scene) -> None:
    scene.see(battery_percent=None)
    assert scene.tick(100) == []
    (unknown,) = scene.tick(100)
    assert isinstance(unknown, inputs.BatteryLow)
    assert "does not report" in unknown.detail
    assert scene.tick(50) == []


def test_the_pilot_is_noticed_and_a_failsafe_found_after_a_restart_is_not_taken_for_one(scene: Scene) -> None:
    scene.state = Walk().to("hold").state
    scene.watch.tolerated_mode = "RETURN"
    scene.see(controller="pilot", mode="RETURN")
    assert scene.tick(3) == []
    scene.see(mode="POSCTL")
    assert inputs.PilotTookOver("POSCTL", "the vehicle is in POSCTL") in scene.tick()


def test_a_return_that_began_while_the_link_was_lost_is_the_failsafes_one_seen_to_begin_is_the_pilots(
    scene: Scene,
) -> None:
    scene.vehicle.heard = False
    assert isinstance(scene.tick()[0], inputs.LinkDown)
    scene.state = Walk().to("hold").state
    scene.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    scene.vehicle.heard = True
    (up,) = scene.tick()
    assert isinstance(up, inputs.LinkUp)
    assert up.going_home
    assert scene.tick(3) == []
    scene.see(mode="LAND")
    assert scene.tick(3) == []
    scene.vehicle.heard = False
    scene.tick()
    scene.see(mode="POSCTL")
    scene.vehicle.heard = True
    assert inputs.PilotTookOver("POSCTL", "the vehicle is in POSCTL") in scene.tick()


@pytest.mark.parametrize("phase", ["hold", "planning", "flying", "measuring", "taking_off"])
def test_a_return_right_after_the_vehicle_was_heard_again_is_the_failsafes_a_later_one_is_not(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, phase: str
) -> None:
    """An operator who resumes at once changes nothing about that."""
    monkeypatch.setattr(watch, "HEARD_AGAIN_WALL_S", 0.0)
    scene.state = Walk().to("hold").state
    scene.tick(20)
    scene.state = Walk().to(phase).state
    scene.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    scene.machine_answers()
    assert scene.tick(3) == [inputs.FailsafeActs("RETURN")]
    assert scene.state.phase == "hold"
    assert scene.watch.failsafe_flies
    scene.see(controller="crossfix", mode="HOLD", held_by_pilot=False)
    assert scene.tick(80) == []
    scene.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    assert isinstance(scene.tick()[0], inputs.PilotTookOver)


def test_a_return_right_after_the_start_of_a_mission_is_the_pilots(scene: Scene) -> None:
    scene.state = Walk().to("taking_off").state
    scene.tick()
    scene.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    assert scene.tick() == [inputs.PilotTookOver("RETURN", "the vehicle is in RETURN", True)]


def test_a_failsafe_that_an_order_of_before_it_stops_is_no_pilot_but_a_later_stop_is(scene: Scene) -> None:
    scene.state = Walk().to("hold").state
    scene.tick()
    for mode, told in (("RETURN", inputs.FailsafeActs("RETURN")), ("HOLD", inputs.FailsafeStopped("HOLD"))):
        scene.see(controller="pilot", mode=mode, held_by_pilot=True)
        assert scene.tick() == [told]
    later = Scene()
    later.state = Walk().to("hold").state
    later.watch.tolerated_mode = "RETURN"
    later.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    later.tick()
    later.watch._heard_again = Deadline(later.clock, 0.0)
    later.see(mode="HOLD")
    assert inputs.PilotTookOver("HOLD", "the vehicle is in HOLD") in later.tick()


def test_the_mode_after_a_failsafes_landing_is_no_pilots_but_who_takes_off_by_hand_is_one(scene: Scene) -> None:
    scene.state = Walk().to("hold").state
    scene.watch.tolerated_mode = "RETURN"
    scene.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    assert scene.tick(3) == []
    scene.see(in_air=False, mode="HOLD")
    assert set(scene.tick(10)) == {inputs.Landed()}
    scene.see(controller="nobody", armed=False, held_by_pilot=False)
    assert set(scene.tick(10)) == {inputs.Landed()}
    scene.see(controller="pilot", armed=True, in_air=True, mode="POSCTL", held_by_pilot=True)
    assert inputs.PilotTookOver("POSCTL", "the vehicle is in POSCTL") in scene.tick()


def test_a_link_that_comes_back_after_the_failsafe_has_landed_says_no_way_home(scene: Scene) -> None:
    scene.state = Walk().to("hold").state
    scene.watch.tolerated_mode = "RETURN"
    scene.see(controller="nobody", mode="HOLD", armed=False, in_air=False)
    scene.tick()
    scene.vehicle.heard = False
    scene.tick()
    scene.vehicle.heard = True
    (up,) = (told for told in scene.tick() if isinstance(told, inputs.LinkUp))
    assert not up.going_home


def test_a_place_refused_because_the_failsafe_flies_names_it_and_no_pilot(scene: Scene) -> None:
    scene.watch.tolerated_mode = "RETURN"
    scene.see(controller="pilot", mode="RETURN", held_by_pilot=True)
    (veto,) = vehicle_vetoes(scene.watch.situation())
    assert (veto.rule, veto.detail) == ("failsafe", "the autopilot acts by itself: RETURN")
    assert veto.remedy == "hold or resume first"


def test_home_and_ground_are_told_when_they_are_reached(scene: Scene) -> None:
    scene.state = Walk().to("returning").state
    scene.see(position=FRAME.to_geo(50.0, 0.0))
    assert scene.tick(3) == []
    scene.see(position=FRAME.to_geo(2.0, 1.0))
    assert scene.tick() == [inputs.HomeReached()]
    scene.state = Walk().to("landing").state
    scene.see(in_air=False)
    assert inputs.Landed() not in scene.tick(2)
    assert inputs.Landed() in scene.tick(6)


def test_the_track_is_thinned_to_two_points_a_second(scene: Scene) -> None:
    scene.tick(50)
    assert 17 <= len(scene.watch.track) <= 20


def test_drain_is_nominal_until_enough_was_used_to_tell() -> None:
    drain = Drain()
    flying = replace(Stage().vehicle.state, in_air=True)
    for second in range(0, 600, 10):
        drain.update(replace(flying, battery_percent=90.0 - 0.1 * second), float(second))
        if second < 60:
            assert drain.percent_s == NOMINAL_DRAIN_PERCENT_S
    assert drain.percent_s == pytest.approx(0.1)


def test_drain_counts_neither_the_time_on_the_ground_nor_a_silent_link() -> None:
    drain = Drain()
    flying = replace(Stage().vehicle.state, in_air=True)
    drain.update(replace(flying, battery_percent=90.0, battery_at_s=0.0), 0.0)
    drain.update(replace(flying, battery_percent=80.0, battery_at_s=100.0), 100.0)
    drain.update(replace(flying, battery_percent=80.0, battery_at_s=100.0), 300.0)
    assert drain.percent_s == pytest.approx(0.1)
    drain.update(replace(flying, in_air=False, battery_percent=80.0, battery_at_s=1_000.0), 1_000.0)
    drain.update(replace(flying, battery_percent=80.0, battery_at_s=2_000.0), 2_000.0)
    drain.update(replace(flying, battery_percent=60.0, battery_at_s=2_100.0), 2_100.0)
    assert drain.percent_s == pytest.approx(0.2)
