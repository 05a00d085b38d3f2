"""A flown decision taken anew: the same with nothing changed, another with another sensor; nothing is recorded."""

from __future__ import annotations

import base64
import json
import math
import struct

import pytest

from backend.events import BearingExcluded, BearingMeasured, MissionDrafted, MissionStarted
from backend.mission.localization import localization
from backend.spec import MissionSpec, Place, Polygon
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint

HOME = Place(lat=50.6, lon=7.2)
FRAME = LocalFrame(GeoPoint(HOME.lat, HOME.lon))
EMITTER = (30.0, 120.0)


def corner(x: float, y: float) -> tuple[float, float]:
    point = FRAME.to_geo(x, y)
    return point.lon_deg, point.lat_deg


RING = [corner(-150, 0), corner(150, 0), corner(150, 200), corner(-150, 200), corner(-150, 0)]
SPEC = MissionSpec(name="meadow", area=Polygon(coordinates=[RING]))
TASK = localization(SPEC, HOME, 100.0)


def bearing(number: int, x: float, y: float) -> BearingMeasured:
    return BearingMeasured(
        bearing_id=f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=TASK.place(x, y),
        altitude_amsl_m=140.0,
        bearing_deg=math.degrees(math.atan2(EMITTER[0] - x, EMITTER[1] - y)) % 360,
        sigma_deg=7.0,
        quality=0.9,
        peaks=[],
        snr_db=20.0,
        drift_m=0.2,
        binned_db=[0.0] * 180,
        fitted_db=[0.0] * 180,
    )


BEARINGS = [bearing(1, 0, 0), bearing(2, 140, 60), bearing(3, 140, 150)]


@pytest.fixture
async def flown(services) -> str:
    events = [MissionDrafted(spec=SPEC), MissionStarted(by="operator", home=HOME, home_amsl_m=100.0, software="0")]
    for number, fact in enumerate(BEARINGS, start=1):
        events += [fact, TASK.belief_fact(BEARINGS[:number])[0]]
    await services.journal.append("m1", events)
    return "m1"


async def ask(client, mission_id: str, **changed) -> dict:
    answer = await client.post(f"/api/missions/{mission_id}/what-if", json={"bearings": 2} | changed)
    assert answer.status_code == 200, answer.text
    return answer.json()


async def test_with_nothing_changed_it_is_what_was_flown(client, flown, services):
    before = len(await services.journal.read(flown))
    told = await ask(client, flown)
    fact, _ = TASK.belief_fact(BEARINGS[:2])
    assert told["belief"]["digest"] == fact.digest
    assert [step["bearings"] for step in told["steps"]] == [0, 1, 2]
    for step in told["steps"][1:]:
        assert step["expected_rmse_m"] == step["flown_expected_rmse_m"]
        assert step["localized"] == step["flown_localized"]
    assert told["plan"]["place_number"] == 3
    assert told["plan"]["candidates"]
    assert len(await services.journal.read(flown)) == before


async def test_a_worse_sensor_would_have_known_less(client, flown):
    worse = await ask(client, flown, sigma_deg=25.0)
    last = worse["steps"][-1]
    assert last["expected_rmse_m"] > 1.5 * last["flown_expected_rmse_m"]
    assert worse["belief"]["localized"] is False


async def test_another_planner_chooses_by_its_own_reason(client, flown):
    rollout, fisher = await ask(client, flown), await ask(client, flown, method="base_policy", base_policy="fisher")
    assert fisher["plan"]["reason"] != rollout["plan"]["reason"]
    assert fisher["plan"]["rollouts"] == 0


async def test_the_frame_holds_the_belief_that_would_have_been(client, flown):
    told = await ask(client, flown, bearings=3, sigma_deg=3.0)
    frame = base64.b64decode(told["frame_base64"])
    (length,) = struct.unpack_from("<I", frame)
    header = json.loads(frame[4 : 4 + length])
    assert (header["mission_id"], header["bearings"], header["encoding"]) == (flown, 3, "u8-log-zlib")


async def test_an_excluded_bearing_counts_neither_then_nor_now(client, flown, services):
    without = [BEARINGS[0], BEARINGS[2]]
    excluded = BearingExcluded(bearing_id="b2", by="operator", reason="")
    await services.journal.append(flown, [excluded, TASK.belief_fact(without)[0]])
    told = await ask(client, flown)
    assert told["belief"]["digest"] == TASK.belief_fact(without)[0].digest


@pytest.mark.parametrize(
    ("mission_id", "body", "status"),
    [("m1", {"bearings": 4}, 404), ("m2", {"bearings": 1}, 404), ("m1", {"bearings": 1, "sigma_deg": 0}, 422)],
)
async def test_what_makes_no_sense_is_refused(client, flown, mission_id, body, status):
    answer = await client.post(f"/api/missions/{mission_id}/what-if", json=body)
    assert answer.status_code == status
    assert answer.json()["title"]
