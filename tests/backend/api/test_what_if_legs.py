"""A supposition about the moment that somebody looks at, where legs are heard between bearings."""

from __future__ import annotations

import pytest
from ground import AREA, HOME, towards
from legs import TARGET, way

from backend.events import MissionDrafted, MissionStarted
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
