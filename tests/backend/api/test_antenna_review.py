"""After a flight: whether its sweeps fit the antenna that was measured, and the pattern that they show instead."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from backend.events import CraftSource, MissionDrafted, MissionStarted
from backend.search.antenna import antenna_fact
from backend.search.localization import localization
from backend.search.sweep_facts import Taken, sweep_fact
from backend.spec import MissionSpec, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.calibration import true_bearing_deg
from hardware.direction_finding.comparison import beam
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import parse_pattern
from hardware.readings import Place
from tests.backend.api.test_what_if import HOME, SPEC, bearing
from tests.benchmarks.pattern_mismatch import Mismatch, deformed, sweep_of

NOMINAL = beam(60.0)
UNEVEN = deformed(60.0, left=0.75, right=1.25)
SQUINTED = deformed(60.0, squint_deg=12.0)
TASK = localization(SPEC, HOME)
JOINT = SPEC.model_copy(update={"sensor": SensorSpec(bearing_errors="joint")})
EMITTER: Place = TASK.place(20.0, 110.0)
PLACES = [(-100.0, 10.0), (120.0, 30.0), (130.0, 180.0), (-120.0, 170.0), (0.0, 20.0), (10.0, 195.0)]


async def fly(services, heard: AntennaPattern, localized: bool, mission: MissionSpec = SPEC) -> None:
    rng = np.random.default_rng(4)
    events: list = [
        MissionDrafted(spec=mission),
        MissionStarted(
            craft_id="craft-1",
            by="operator",
            home=HOME,
            home_amsl_m=100.0,
            software="0",
            antenna=antenna_fact(NOMINAL),
        ),
    ]
    bearings = []
    for number, (x, y) in enumerate(PLACES, start=1):
        truth, _ = true_bearing_deg(TASK.place(x, y), EMITTER)
        sweep = sweep_of(Mismatch("", heard, NOMINAL), 90, 40.0, truth, rng)
        sweep = dataclasses.replace(sweep, position=TASK.place(x, y), altitude_amsl_m=140.0)
        taken = Taken("emitter-1", CraftSource(craft_id="craft-1"), f"s{number}", number, 1)
        fact = sweep_fact(taken, mission.sensor, sweep, SparseDirectionFinder().estimate(sweep, NOMINAL), 12.0)
        assert fact.kind == "bearing_measured"
        bearings.append(fact)
        events.append(fact)
    belief = localization(mission, HOME).belief_fact(bearings)[0]
    events.append(belief.model_copy(update={"localized": localized and belief.estimate is not None}))
    await services.journal.append("m1", events)


async def test_another_antenna_is_named_and_its_pattern_proposed(client, services):
    await fly(services, UNEVEN, localized=True)
    told = (await client.get("/api/missions/m1/antenna")).json()
    assert told["sweeps"] == len(PLACES)
    assert told["doubt"]["code"] == "not_the_measured_antenna"
    proposed = parse_pattern(told["proposed"]["filename"], told["proposed"]["text"])
    # the flanks at 6 dB: 0.71 of 0.75 and of 1.25 times 60 degrees
    uneven = float(proposed.gain_at(np.array([50.0]))[0] - proposed.gain_at(np.array([-50.0]))[0])
    assert uneven > 2.0
    assert proposed.pointing_sigma_deg is not None
    asked = {"bearings": 3, "pattern": told["proposed"]}
    raw = await client.post("/api/missions/m1/what-if", json=asked)
    assert raw.json().get("reason", {}).get("code") == "samples_not_stored"  # the pattern itself was taken


async def test_an_antenna_that_points_beside_is_proposed_as_it_points(client, services):
    """Its sweeps fit the pattern as well as ever; that they are all turned shows where they cross."""
    await fly(services, SQUINTED, localized=True, mission=JOINT)
    told = (await client.get("/api/missions/m1/antenna")).json()
    assert told["doubt"]["code"] == "bearings_corrected"
    assert abs(told["doubt"]["bias_deg"]) > 8.0
    proposed = parse_pattern(told["proposed"]["filename"], told["proposed"]["text"])
    angle = np.arange(-60.0, 61.0)
    points_deg = float(angle[np.argmax(proposed.gain_at(angle))])
    assert abs(points_deg) > 6.0
    assert np.sign(points_deg) == -np.sign(told["doubt"]["bias_deg"])


@pytest.mark.parametrize("mission", [SPEC, JOINT])
async def test_the_measured_antenna_is_left_alone(client, services, mission):
    await fly(services, NOMINAL, localized=True, mission=mission)
    told = (await client.get("/api/missions/m1/antenna")).json()
    assert told["doubt"] is None
    assert told["proposed"] is None


async def test_without_a_place_no_pattern_is_proposed(client, services):
    await fly(services, UNEVEN, localized=False)
    told = (await client.get("/api/missions/m1/antenna?emitter=emitter-1")).json()
    assert told["doubt"]["code"] == "not_the_measured_antenna"
    assert told["proposed"] is None


@pytest.mark.parametrize("path", ["/api/missions/m2/antenna", "/api/missions/m1/antenna?emitter=fox"])
async def test_what_there_is_nothing_of_is_not_found(client, services, path):
    await services.journal.append("m1", [MissionDrafted(spec=SPEC)])
    assert (await client.get(path)).status_code == 404


async def test_a_mission_without_sweeps_has_nothing_to_say(client, services):
    await services.journal.append("m1", [MissionDrafted(spec=SPEC)])
    told = (await client.get("/api/missions/m1/antenna")).json()
    assert told == {"sweeps": 0, "repeats_db": None, "doubt": None, "proposed": None}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("fitted_db", [[], [None] * 180])
async def test_a_bearing_that_nothing_was_fitted_to_is_no_fault(client, services, fitted_db):
    odd = bearing(1, -100.0, 0.0).model_copy(update={"fitted_db": fitted_db, "snr_db": 12.0})
    started = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
    started = started.model_copy(update={"antenna": antenna_fact(NOMINAL)})
    await services.journal.append("odd", [MissionDrafted(spec=SPEC), started, odd])
    reply = await client.get("/api/missions/odd/antenna")
    assert reply.status_code == 200, reply.text
