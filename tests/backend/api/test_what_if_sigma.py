"""Another sigma than was measured, where most of it is what all bearings of a flight have in common."""

from __future__ import annotations

import pytest
from ground import AREA, HOME, towards
from legs import TARGET

from backend.events import MissionDrafted, MissionStarted
from backend.search.localization import localization
from backend.spec import MissionSpec, SensorSpec

SPEC = MissionSpec(name="m", area=AREA, sensor=SensorSpec(bearing_errors="joint"))
TASK = localization(SPEC, HOME)
MEASURED = [
    towards(x, y, TARGET, sigma=4.3).model_copy(update={"heading_sigma_deg": 4.0, "pattern_sigma_deg": 1.0})
    for x, y in ((60.0, -40.0), (200.0, 100.0))
]


@pytest.fixture
async def flown(services) -> None:
    started = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
    await services.journal.append("m1", [MissionDrafted(spec=SPEC), started, *MEASURED])


async def test_a_sigma_below_the_share_in_common_is_supposed_of_the_share_too(client, flown):
    """The compass' four degrees alone were more than all, and nothing was left for a bearing by itself."""
    expected_m: list[float] = []
    for sigma_deg in (0.1, 2.0, 4.0, 4.3, 8.0):
        asked = {"bearings": 2, "sigma_deg": sigma_deg}
        answer = await client.post("/api/missions/m1/what-if", json=asked)
        assert answer.status_code == 200, answer.text
        expected_m.append(answer.json()["steps"][-1]["expected_rmse_m"])
    assert expected_m == sorted(expected_m)
    assert (await client.put("/api/missions/m1/variants/sharp", json={"sigma_deg": 2.0})).status_code == 204
    compared = await client.get("/api/missions/m1/courses")
    assert compared.status_code == 200, compared.text
    assert [course["name"] for course in compared.json()["courses"]] == [None, "sharp"]
