"""Whole searches in the field world, by the command that flies them."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from field_flights import FLOWN
from narrowing import a
from typer.testing import CliRunner

from backend.api.suggestion import suggested_mission
from backend.cli.field_gyration import circling, heard_circling
from backend.cli.field_legs import LISTENED_HZ, NOSE_DEG_S2, flown, listened
from backend.cli.field_missions import AS_FLOWN, HOME, LOOK_S, SETTLE_S, FieldOptions, FieldStudy, mission_of
from backend.cli.field_study import FieldWays
from backend.cli.field_summary import summary
from backend.cli.main import app
from backend.events import BearingMeasured
from backend.search.sector import planned_turn, whole_turn
from backend.simulation.field_world import drawn_field
from hardware.sim.propagation import Fading
from hardware.yaw_swings import Swinging, SwingPlan
from planner.geometry import bounds
from planner.motion import flight_time, turn_between
from planner.types import FullMotion


def run(*arguments):
    return CliRunner().invoke(app, ["study", "run", "--scenario", "field-world", *arguments])


def test_a_mission_is_its_seed():
    study = FieldStudy.of(FieldOptions("fisher"))
    first, again, other = study.fly(5), study.fly(5), study.fly(6)
    assert first == again
    assert first.time_s != other.time_s
    assert first.turned_deg == 360.0 * (first.bearings + first.rejected)


def test_crossfix_does_as_in_new_missions_unless_asked_otherwise():
    assert list(FieldWays(["crossfix", "fisher"], (), ()).rows()) == [
        ("crossfix", "sector", "way_swinging"),
        ("fisher", "whole", "places"),
    ]
    assert list(FieldWays(["crossfix"], (), ["way"]).rows()) == [("crossfix", "whole", "way")]
    assert list(FieldWays(["crossfix"], ["sector", "whole"], ()).rows()) == [
        ("crossfix", "sector", "places"),
        ("crossfix", "whole", "places"),
    ]
    assert list(FieldWays(["gyration"], ["sector", "whole"], ["never_stopping"]).rows()) == [
        ("gyration", "whole", "places")
    ]
    suggested, flown_so = suggested_mission(HOME).sensor, mission_of(FieldOptions("crossfix", *AS_FLOWN)).sensor
    for name in ("sector_turns", "listen_on_the_way", "swing_on_the_way", "never_stop"):
        assert getattr(flown_so, name) == getattr(suggested, name)


def test_a_sector_is_turned_as_far_as_the_machine_says_and_takes_that_long():
    study = FieldStudy.of(FieldOptions(turns="sector"))
    field = drawn_field(5, study.task.frame, bounds(study.task.problem.area), 0.0)
    east, north = field.truth
    off = (np.arange(360) - math.degrees(math.atan2(east, north)) + 180.0) % 360.0 - 180.0
    towards = np.exp(-0.5 * (off / 10.0) ** 2)
    plan = planned_turn(towards / towards.sum())
    found, turned_deg, looks = study.measured(field, (0.0, 0.0), 0, plan)
    assert isinstance(found, BearingMeasured)
    assert found.turn is not None
    assert plan.width_deg <= turned_deg <= 360.0
    assert found.turn.turned_deg == turned_deg
    assert looks == 1 + len(found.turn.went_on_because)
    assert found.measurement_time_s == pytest.approx(turned_deg / 30.0 + (looks - 1) * LOOK_S + SETTLE_S)
    whole, whole_deg, once = study.measured(field, (0.0, 0.0), 0, whole_turn("first"))
    assert isinstance(whole, BearingMeasured)
    assert (whole_deg, once) == (360.0, 1)


def test_a_leg_is_flown_as_the_movement_model_has_it_and_only_a_turning_antenna_tells():
    study = FieldStudy.of(FieldOptions(listens="way_swinging"))
    field = drawn_field(5, study.task.frame, bounds(study.task.problem.area), 4.0)
    here, place = (-100.0, 20.0), (20.0, 80.0)
    for swings in (False, True):
        swinging = Swinging(SwingPlan(30.0, 75.0, 30.0), lambda _: 500.0) if swings else None
        leg = flown(here, place, 0.0, swinging)
        turning = turn_between(0.0, math.atan2(60.0, 120.0))
        motion = FullMotion()
        took_s = float(flight_time(motion, math.dist(here, place), turning)) - motion.constant
        assert len(leg.x) / LISTENED_HZ == pytest.approx(took_s, abs=0.2)
        assert (leg.x[0], leg.y[0]) == pytest.approx(here, abs=0.1)
        assert (leg.x[-1], leg.y[-1]) == pytest.approx(place, abs=1.0)
        told = listened(field, leg, [here, place], 0, study.spec.sensor, study.pattern)
        again = listened(field, leg, [here, place], 0, study.spec.sensor, study.pattern)
        assert told.model_copy(update={"leg_id": again.leg_id}) == again
        assert told.tells is swings
        assert swinging is None or (swinging.swings.swung >= 2 and swinging.swings.end == "near_place")
        rate_deg_s = np.diff(leg.nose_deg)[int(turning / motion.turn_rate * LISTENED_HZ) + 1 :] * LISTENED_HZ
        assert np.abs(rate_deg_s).max() <= (30.0 if swings else 0.0) + 1e-6
        assert np.abs(np.diff(rate_deg_s)).max() <= NOSE_DEG_S2 / LISTENED_HZ + 1e-6
        assert np.degrees(leg.lean[:, 0]).max() == pytest.approx(15.0, abs=1.5), "it leans into its flight, east"
        assert np.degrees(leg.lean[-20:, 0]).min() < -3.0, "and back where it brakes"


def test_a_craft_that_never_stops_takes_its_bearing_where_it_heard_it():
    study = FieldStudy.of(FieldOptions("gyration", compass_deg=0.0))
    field = study.field(5)
    calm = replace(field, world=replace(field.world, reflectors=(), fading=Fading(math.inf)), shadows=field.shadows[:1])
    way = circling((-100.0, 20.0), (60.0, 20.0), 0.0, 12.0)
    gone_m = float(way.x[-1]) + 100.0
    assert gone_m == pytest.approx(36.0, abs=1.0), "from hover to hover in the time of a circle"
    assert way.turned_deg == pytest.approx(360.0, abs=4.0)
    assert circling((0.0, 0.0), (0.0, 0.0), 90.0, 12.0).x == pytest.approx(np.zeros(120))
    sweep, reading = heard_circling(calm, way, 0, study.finder, study.pattern)
    x, _ = study.task.frame.to_enu(sweep.position)
    east, north = field.truth
    towards = math.degrees(math.atan2(east - x, north - 20.0))
    assert abs(math.remainder(reading.bearing_deg - towards, 360.0)) < 8.0
    share = (reading.bearing_deg % 360.0) / 360.0
    assert x == pytest.approx(float(way.x[int(share * 119)]), abs=2.0)


def test_a_mission_that_never_stops_ends_in_time():
    mission = FieldStudy.of(FieldOptions("gyration")).fly(5)
    assert mission.turned_deg == pytest.approx(30.0 * mission.time_s)
    assert mission.time_s <= 400.0 + 12.0


def test_a_row_counts_claims_and_bearings_from_afar():
    missions = [
        FLOWN,
        replace(FLOWN, error_m=30.0, in_c95=False, off_deg=(45.0, 3.0)),
        replace(FLOWN, localized=False, in_c95=False, error_m=90.0, time_s=400.0),
    ]
    row = summary(FieldOptions(), missions)
    assert (row.localized, row.in_c95, row.false_claims) == pytest.approx((2 / 3, 0.5, 0.5))
    assert row.localized_in_time == pytest.approx(2 / 3)
    assert summary(FieldOptions(), [FLOWN, replace(FLOWN, time_s=401.0)]).localized_in_time == 0.5
    assert row.seed == FLOWN.seed
    assert (row.outliers, row.bearings_far) == (1, 6)
    assert row.time_s == pytest.approx(200.0)
    assert row.energy_kj == pytest.approx(50.0)


def test_a_row_without_a_claim_says_nothing_of_claims():
    facts = summary(FieldOptions(), [replace(FLOWN, localized=False)]).as_json()
    assert facts["in_c95"] is None
    assert facts["false_claims"] is None
    assert facts["planner"] == "crossfix"


def test_the_command_flies_a_row_a_planner():
    found = run(
        "--planner", "fisher", "--planner", "random_walk", "--runs", "1", "--seed", "5", "--workers", "1", "--json"
    )
    assert found.exit_code == 0, found.output
    rows = json.loads(found.stdout)
    assert [row["planner"] for row in rows] == ["fisher", "random_walk"]
    assert all(row["missions"] == 1 and row["time_s"] > 0 for row in rows)


THREE = ("--planner", "random_walk", "--runs", "3", "--seed", "5", "--json")


def test_a_row_is_the_same_here_and_in_processes():
    there, here = run(*THREE, "--workers", "2"), run(*THREE, "--workers", "1")
    assert (there.exit_code, here.exit_code) == (0, 0), there.output
    assert json.loads(there.stdout) == json.loads(here.stdout)


@pytest.mark.long
def test_a_row_is_the_same_here_and_on_a_dask_cluster():
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0"
    ) as cluster:
        there = run(*THREE, "--scheduler", a(LocalCluster, cluster).scheduler_address)
    here = run(*THREE, "--workers", "1")
    assert (there.exit_code, here.exit_code) == (0, 0), there.output
    assert json.loads(there.stdout) == json.loads(here.stdout)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--planner", "sopt"), "choose one of"),
        (("--scenario", "2"), "by itself"),
        (("--seed", "1", "--seed", "2"), "by itself"),
        (("--runs", "0"), "--runs"),
        (("--workers", "0"), "--workers"),
        (("--config", "slow"), "--config means nothing to field-world"),
        (("--base-policy", "fisher"), "--base-policy means nothing"),
        (("--turn-rate", "1"), "--turn-rate"),
        (("--turns", "half"), "--turns"),
        (("--listens", "never"), "--listens"),
        (("--compass-sd", "-1"), "--compass-sd"),
        (("--compass-bias", "-8"), "--compass-bias"),
        (("--compass-bias", "8", "--compass-sd", "4"), "give one of them"),
        (("--antenna", "dish"), "--antenna"),
    ],
)
def test_what_cannot_be_flown_is_refused_in_words(arguments, told):
    found = run(*arguments)
    assert found.exit_code != 0
    assert told in found.output
    assert "Traceback" not in found.output


def test_a_row_that_is_stopped_says_that_nothing_is_kept(monkeypatch):
    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("backend.cli.field_study.spread", stopped)
    ended = CliRunner().invoke(app, ["study", "run", "--scenario", "field-world", "--runs", "2"])
    assert ended.exit_code == 130
    assert "stopped; nothing is kept of field-world" in ended.output
