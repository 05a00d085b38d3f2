"""A supposition about the moment that somebody looks at, where legs are heard between bearings."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest
from ground import AREA, FRAME, HOME, towards
from legs import TARGET, way

from backend.api.what_if import _last_place
from backend.events import MissionDrafted, MissionStarted, PlacePassed, PlaceReached, Recorded
from backend.reasons.turning import WayToldEnough
from backend.search.localization import localization
from backend.spec import MissionSpec, SensorSpec

SPEC = MissionSpec(name="m", area=AREA, sensor=SensorSpec(bearing_errors="joint", listen_on_the_way=True))
TASK = localization(SPEC, HOME)
FIRST = towards(60.0, -40.0, TARGET, sigma=7.0)
SECOND = towards(200.0, 100.0, TARGET, sigma=7.0)


@pytest.fixture
async def flown(services) -> dict[str, int]:
    """A bearing, a leg, a bearing. The numbers of the events by what was believed last."""
    heard = TASK.after((), [way()])
    said = [TASK.belief_fact([FIRST])[0], heard.belief_fact([FIRST])[0], heard.belief_fact([FIRST, SECOND])[0]]
    events = [
        MissionDrafted(spec=SPEC),
        MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0"),
        *(FIRST, said[0], way(), said[1], SECOND, said[2]),
    ]
    await services.journal.append("m1", events)
    recorded = await services.journal.read("m1")
    first, leg, second = (one.seq for one in recorded if one.event.kind == "belief_updated")
    return {"first": first, "leg": leg, "second": second}


async def asked(client, bearings: int, until: int | None) -> dict:
    answer = await client.post("/api/missions/m1/what-if", json={"bearings": bearings, "until": until})
    assert answer.status_code == 200, answer.text
    return answer.json()


async def test_a_leg_counts_from_the_moment_on_at_which_it_was_heard(client, flown):
    bare, heard = TASK.belief_fact([FIRST])[0], TASK.after((), [way()]).belief_fact([FIRST])[0]
    assert bare.digest != heard.digest
    moments = (
        (flown["first"], bare),
        (flown["leg"] - 1, bare),  # heard, and not believed yet
        (flown["leg"], heard),
        (flown["second"], heard),
        (None, heard),
    )
    for until, believed in moments:
        told = await asked(client, 1, until)
        assert told["belief"]["digest"] == believed.digest
        last = told["steps"][-1]
        assert last["expected_rmse_m"] == last["flown_expected_rmse_m"]


async def test_a_moment_before_a_bearing_has_no_belief_after_it(client, flown):
    answer = await client.post("/api/missions/m1/what-if", json={"bearings": 2, "until": flown["leg"]})
    assert answer.status_code == 404
    assert answer.json()["reason"]["code"] == "nothing_there"
    assert (await asked(client, 2, flown["second"]))["belief"]["bearings"] == 2


async def test_a_moment_is_an_event_number(client, flown):
    for until in (-1, "now", 1.5):
        answer = await client.post("/api/missions/m1/what-if", json={"bearings": 1, "until": until})
        assert answer.status_code == 422


async def test_the_next_place_is_chosen_from_one_that_was_passed(client, services):
    """A mission that never stops has flown on from where its last bearing was taken."""
    sensor = SPEC.sensor.model_copy(update={"swing_on_the_way": True, "never_stop": True})
    heard = TASK.after((), [way()]).belief_fact([FIRST])[0]
    there = FRAME.to_geo(100.0, 0.0)
    events = [
        MissionDrafted(spec=SPEC.model_copy(update={"sensor": sensor})),
        MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0"),
        FIRST,
        TASK.belief_fact([FIRST])[0],
        PlaceReached(craft_id="craft-1", place_number=7, place=there, distance_m=0.0, flight_time_s=9.0),
        *(way(), heard, PlacePassed(craft_id="craft-1", place_number=7, reason=WayToldEnough(6.0))),
    ]
    await services.journal.append("m1", events)
    *_, passed = await services.journal.read("m1")
    numbers = [(await asked(client, 1, until))["plan"]["place_number"] for until in (4, passed.seq, None)]
    assert numbers == [FIRST.place_number + 1, 8, 8]


def test_a_place_passed_before_the_last_bearing_is_left_behind():
    there = PlaceReached(craft_id="craft-1", place_number=7, place=HOME, distance_m=0.0, flight_time_s=9.0)
    passed = PlacePassed(craft_id="craft-1", place_number=7, reason=WayToldEnough(6.0))
    at = datetime.fromtimestamp(0.0, UTC)
    recorded = [
        Recorded(seq=k, mission_id="m1", at_utc=at, event=event)
        for k, event in enumerate((FIRST, there, passed, SECOND), start=1)
    ]
    assert _last_place(recorded, [FIRST], TASK.home) == (HOME, 8)
    assert _last_place(recorded, [FIRST, SECOND], TASK.home) == (SECOND.place, SECOND.place_number + 1)
    assert _last_place(recorded, [], TASK.home) == (TASK.home, 1)
