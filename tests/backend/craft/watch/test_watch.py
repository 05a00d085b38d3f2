"""What the watch makes of a vehicle, a receiver and consoles that come and go."""

from __future__ import annotations

from dataclasses import replace

import pytest
from craft_walk import CraftWalk, craft_in
from equipment import FRAME, spec
from facts import BATTERY_VETO, plan
from stage import Stage

from backend.craft import inputs
from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.craft.machine import transition
from backend.craft.safety import limits_of, vehicle_vetoes
from backend.craft.state import CraftState
from backend.craft.watch.watch import Watch
from backend.events import FIRST_CRAFT
from backend.reasons.flight import BackAfterRestart, NoConsole, PlaceUnknown, VehicleLinkLost
from backend.reasons.safety import BatteryShort, BatterySilent, BatteryUnknown, FailsafeActs, NoPosition
from backend.search.task import search_task
from backend.spec import Place
from hardware.authority import CommandSent
from hardware.readings import Channel
from hardware.reasons.vehicle_news import ClockRateOdd


class HandClock:
    """Time moves by hand."""

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
        walk = CraftWalk().to("flying")
        self.state, self.search = walk.craft, walk.search
        self.given: list[inputs.CraftInput] = []
        self.listening = Listening(stage.receiver, self.clock, (Channel(868.3e6),), 5.0)
        equipment = CraftEquipment(
            craft_id=FIRST_CRAFT,
            vehicle=stage.vehicle,
            receiver=stage.receiver,
            finder=stage.finder,
            pattern=stage.craft().pattern,
            clock=self.clock,
            publisher=stage.publisher,
        )
        limits = limits_of(search_task(spec(), Place(lat=50.0, lon=7.0), 100.0))
        self.see(in_air=True, armed=True, altitude_relative_m=40.0, altitude_amsl_m=140.0)
        self.vehicle.shows("HOLD")
        self.vehicle.control.see(CommandSent(frozenset({1})))
        self.watch = Watch(equipment, limits, self.listening, lambda: self.state, self.given.append)

    def be(self, state: CraftState) -> None:
        self.state = replace(state, authority=self.vehicle.control.authority)

    def see(self, **values: object) -> None:
        self.vehicle.state = replace(self.vehicle.state, **values)  # type: ignore[arg-type]

    def machine_answers(self) -> None:
        """What is given from now on changes the state."""

        def give(given: inputs.CraftInput) -> None:
            self.given.append(given)
            self.state, _ = transition(self.state, self.search, given, self.clock.at)

        self.watch.give = give

    def heard(self, times: int = 1) -> list[tuple[str, str | None]]:
        """Who flies, and in which mode they took it, of each change."""
        found = [given.authority for given in self.tick(times) if isinstance(given, inputs.AuthorityHeard)]
        return [(authority.who, authority.mode) for authority in found]

    def tick(self, times: int = 1, step_s: float = 0.2) -> list[inputs.CraftInput]:
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


def test_a_link_that_goes_and_comes_is_noticed_once_each_way(scene: Scene) -> None:
    scene.tick()
    scene.vehicle.heard = False
    (down,) = scene.tick(5)
    assert isinstance(down, inputs.LinkDown)
    assert isinstance(down.because, VehicleLinkLost)
    scene.vehicle.heard = True
    (up,) = scene.tick(5)
    assert isinstance(up, inputs.LinkUp)
    assert up.outage_s == pytest.approx(1.2)


def test_an_outage_of_the_vehicle_counts_from_when_it_was_heard_last(scene: Scene) -> None:
    """Its loss is noticed seconds later."""
    scene.see(battery_at_s=scene.clock.at)
    scene.clock.at += 3.0
    scene.vehicle.heard = False
    scene.tick(20)
    scene.vehicle.heard = True
    (up,) = scene.tick()
    assert isinstance(up, inputs.LinkUp)
    assert up.outage_s == pytest.approx(3.0 + 21 * 0.2)


def test_an_odd_clock_is_told_once_each_way_and_not_forgotten_while_the_link_is_lost(scene: Scene) -> None:
    scene.see(odd_clock_rate=0.9)
    assert scene.tick(5) == [inputs.ClockOdd(ClockRateOdd(0.9))]
    scene.see(odd_clock_rate=0.88)
    scene.vehicle.heard = False
    (lost,) = scene.tick(5)
    assert isinstance(lost, inputs.LinkDown)
    scene.see(odd_clock_rate=None)
    scene.vehicle.heard = True
    back = scene.tick(5)
    assert [type(one) for one in back] == [inputs.LinkUp, inputs.ClockAgrees]


def test_a_vehicle_that_says_that_it_lost_its_place_is_heard_once_each_way_and_may_not_be_flown(scene: Scene) -> None:
    scene.see(position_lost_since_s=scene.clock.at)
    assert scene.tick(5) == [inputs.LinkDown("gps", PlaceUnknown())]
    assert NoPosition() in vehicle_vetoes(scene.watch.situation())
    scene.see(position_lost_since_s=None)
    (back,) = scene.tick(5)
    assert isinstance(back, inputs.LinkUp)
    assert vehicle_vetoes(scene.watch.situation()) == ()


def test_a_console_counts_only_after_one_was_there(scene: Scene) -> None:
    assert scene.tick(3) == []
    scene.publisher.consoles = 2
    assert scene.tick(3) == []
    scene.publisher.consoles = 0
    assert scene.tick(3) == [inputs.LinkDown("console", NoConsole("hold"))]


def test_a_machine_that_stood_still_is_no_silent_receiver(scene: Scene) -> None:
    scene.listening.start = lambda: None  # type: ignore[method-assign]
    scene.tick()
    scene.tick(1, step_s=60.0)
    assert scene.listening._quiet_s < 2.0
    scene.tick(30)
    assert scene.listening._quiet_s > 5.0


def test_a_low_battery_is_noticed_once_until_it_recovers(scene: Scene) -> None:
    scene.see(battery_percent=26.0)
    (low,) = scene.tick(5)
    assert isinstance(low, inputs.BatteryLow)
    scene.see(battery_percent=90.0)
    assert scene.tick(2) == [inputs.BatteryReported()]


def test_a_charge_at_the_limit_is_noticed_once(scene: Scene) -> None:
    found = []
    for charge in (29.0, 31.0, 29.0, 31.0):  # five percent for the landing, twenty-five in reserve
        scene.see(battery_percent=charge)
        found += [type(given) for given in scene.tick()]
    assert found == [inputs.BatteryLow]


def stages(found: list[inputs.CraftInput]) -> list[str]:
    return [given.stage for given in found if isinstance(given, inputs.BatteryLow)]


def test_a_battery_counts_as_lower_once_it_has_been_that_low_for_a_while(scene: Scene) -> None:
    scene.be(craft_in("hold").craft)
    scene.see(position=FRAME.to_geo(0.0, 80.0), battery_percent=5.0)
    assert stages(scene.tick(20)) == ["return"]
    assert stages(scene.tick(10)) == ["land"]


def test_no_single_reading_makes_a_vehicle_land(scene: Scene) -> None:
    scene.be(craft_in("hold").craft)
    scene.see(position=FRAME.to_geo(0.0, 80.0))
    found: list[inputs.CraftInput] = []
    for charge in (90.0, 0.0, 90.0, 0.0, 88.0, None, 0.0, 88.0):
        scene.see(battery_percent=charge)
        found += scene.tick(5)
    assert set(stages(found)) == {"return"}


def test_a_low_battery_is_noticed_again_when_the_mission_flies_on_or_is_held_on_its_way_home(scene: Scene) -> None:
    scene.see(battery_percent=26.0)
    for phase, times in (("hold", 1), ("waiting", 1), ("returning", 1), ("hold", 1), ("manual", 0)):
        scene.be(craft_in(phase).craft)  # type: ignore[arg-type]
        assert [type(given) for given in scene.tick(5)].count(inputs.BatteryLow) == times


def test_an_alert_that_a_planned_flight_or_another_server_raised_is_cleared_too(scene: Scene) -> None:
    walk = CraftWalk().to("planning")
    walk.give(inputs.Planned(plan(1), (BATTERY_VETO,)))
    scene.be(walk.craft)
    assert inputs.BatteryReported() in scene.tick()


def test_a_charge_that_the_vehicle_no_longer_reports_is_noticed_and_cleared_when_it_is_reported_again(
    scene: Scene,
) -> None:
    scene.tick()
    scene.vehicle.charge_reported = False
    assert scene.tick(30, step_s=1.0) == []
    assert scene.tick(2, step_s=1.0) == [inputs.BatteryLow(BatterySilent())]
    scene.see(battery_percent=26.0)
    scene.vehicle.charge_reported = True
    (low,) = scene.tick(2)
    assert isinstance(low, inputs.BatteryLow)
    assert isinstance(low.because, BatteryShort)
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
    assert [type(found) for found in scene.tick(36, step_s=1.0)] == [inputs.LinkDown]
    scene.vehicle.heard, scene.vehicle.charge_reported = True, False
    assert [type(found) for found in scene.tick(5, step_s=1.0)] == [inputs.LinkUp]


def test_a_battery_that_stays_unknown_in_the_air_sends_the_vehicle_home(scene: Scene) -> None:
    scene.see(battery_percent=None)
    assert scene.tick(100) == []
    (unknown,) = scene.tick(100)
    assert isinstance(unknown, inputs.BatteryLow)
    assert unknown.because == BatteryUnknown()
    assert scene.tick(50) == []


def test_the_pilot_is_noticed_once(scene: Scene) -> None:
    scene.machine_answers()
    scene.vehicle.shows("POSCTL")
    assert scene.heard(3) == [("pilot", "POSCTL")]
    assert scene.state.phase == "manual"


def test_control_that_is_given_back_and_taken_again_is_noticed_each_time(scene: Scene) -> None:
    scene.machine_answers()
    scene.vehicle.shows("POSCTL")
    scene.tick()
    scene.vehicle.pilot_gives_back()
    (given,) = scene.tick(3)
    assert isinstance(given, inputs.AuthorityHeard)
    assert given.authority.given_back
    scene.vehicle.take_control()
    assert scene.heard(3) == [("ours", None)]


def test_a_return_that_may_be_the_failsafes_is_noticed_with_the_doubt(scene: Scene) -> None:
    scene.machine_answers()
    scene.vehicle.shows("RETURN")
    (found,) = scene.tick(3)
    assert isinstance(found, inputs.AuthorityHeard)
    assert (found.authority.who, found.authority.perhaps_failsafe) == ("pilot", True)


def test_a_command_of_ours_is_no_change_of_who_flies(scene: Scene) -> None:
    scene.vehicle.control.see(CommandSent(frozenset({3, 4})))
    scene.vehicle.shows("RETURN")
    assert scene.tick(3) == []


def test_a_failsafe_that_acted_while_the_link_was_lost_comes_with_the_restored_link(scene: Scene) -> None:
    scene.machine_answers()
    scene.vehicle.heard = False
    assert isinstance(scene.tick()[0], inputs.LinkDown)
    scene.vehicle.shows("RETURN", after_silence=True)
    scene.vehicle.heard = True
    authority, up = scene.tick()
    assert isinstance(authority, inputs.AuthorityHeard)
    assert authority.authority.who == "failsafe"
    assert isinstance(up, inputs.LinkUp)
    assert scene.state.phase == "hold"
    assert scene.tick(3) == []
    scene.vehicle.shows("LAND")
    assert scene.heard(3) == [("failsafe", "LAND")]
    scene.vehicle.heard = False
    scene.tick()
    scene.vehicle.shows("POSCTL", after_silence=True)
    scene.vehicle.heard = True
    assert scene.heard() == [("pilot", "POSCTL")]


@pytest.mark.parametrize("phase", ["hold", "planning", "flying", "measuring", "taking_off"])
def test_a_failsafe_that_acts_in_any_phase_holds_the_craft_until_it_is_stopped(scene: Scene, phase: str) -> None:
    """An operator who resumes at once changes nothing about that."""
    scene.be(craft_in(phase).craft)  # type: ignore[arg-type]
    scene.machine_answers()
    scene.vehicle.shows("RETURN", after_silence=True)
    assert scene.heard(3) == [("failsafe", "RETURN")]
    assert scene.state.phase == "hold"
    scene.vehicle.shows("HOLD", after_silence=True)
    assert inputs.FailsafeEnded("HOLD") in scene.tick(3)


def test_after_a_failsafes_landing_only_the_ground_is_noticed(scene: Scene) -> None:
    scene.be(craft_in("hold").craft)
    scene.machine_answers()
    scene.vehicle.shows("RETURN", after_silence=True)
    scene.tick()
    scene.see(in_air=False)
    scene.vehicle.shows("HOLD")
    assert set(scene.tick(10)) == {inputs.Landed()}
    scene.see(armed=False)
    scene.vehicle.shows("HOLD")
    assert {type(found) for found in scene.tick(10)} == {inputs.AuthorityHeard, inputs.Landed}
    scene.see(armed=True, in_air=True)
    scene.vehicle.shows("POSCTL")
    assert scene.heard() == [("pilot", "POSCTL")]


def test_a_place_refused_because_the_failsafe_flies_names_it_and_no_pilot(scene: Scene) -> None:
    scene.vehicle.shows("RETURN", after_silence=True)
    assert vehicle_vetoes(scene.watch.situation()) == (FailsafeActs("RETURN"),)


def test_home_and_ground_are_noticed_when_they_are_reached(scene: Scene) -> None:
    scene.be(craft_in("returning").craft)
    scene.see(position=FRAME.to_geo(50.0, 0.0))
    assert scene.tick(3) == []
    scene.see(position=FRAME.to_geo(2.0, 1.0))
    assert scene.tick() == [inputs.HomeReached()]
    scene.be(craft_in("landing").craft)
    scene.see(in_air=False)
    assert inputs.Landed() not in scene.tick(2)
    assert inputs.Landed() in scene.tick(6)


def test_a_held_vehicle_on_the_ground_with_its_motors_off_has_landed_whoever_saw_it_fly(scene: Scene) -> None:
    """A server that starts as the vehicle touches down never saw it in the air."""
    scene.be(replace(craft_in("hold").craft, took_off=False, phase_reason=BackAfterRestart()))
    scene.see(in_air=False, armed=True)
    scene.vehicle.shows("HOLD")
    assert inputs.Landed() not in scene.tick(10)
    scene.see(in_air=False, armed=False)
    scene.vehicle.shows("HOLD")
    assert inputs.Landed() in scene.tick(10)


def test_the_track_is_thinned_to_two_points_a_second(scene: Scene) -> None:
    scene.tick(50)
    assert 17 <= len(scene.watch.track.points) <= 20
