"""What a belief takes of a sweep, otherwise than it was flown: peak and sigma, or what it says of all directions."""

from __future__ import annotations

import pytest
from ground import AREA, HOME, towards
from legs import TARGET

from backend.events import BearingMeasured, MissionDrafted, MissionStarted
from backend.search.localization import localization
from backend.spec import MissionSpec, SensorSpec
from hardware.direction_finding.circle import SweepLikelihood


def sweep(x: float, y: float) -> BearingMeasured:
    """Its likelihood is sharper than its sigma."""
    fact = towards(x, y, TARGET, sigma=12.0)
    return fact.model_copy(update={"likelihood": SweepLikelihood.normal(fact.bearing_deg, 4.0).packed()})


MEASURED = [sweep(60.0, -40.0), sweep(200.0, 100.0)]


def expected_m(evidence: str) -> float:
    spec = MissionSpec.model_validate(
        {"name": "m", "area": AREA, "sensor": {"bearing_errors": "joint", "sweep_evidence": evidence}}
    )
    fact, _ = localization(spec, HOME).belief_fact(MEASURED)
    assert fact.estimate is not None
    return fact.estimate.expected_rmse_m


@pytest.mark.parametrize(("flown", "supposed"), [("peak", "whole"), ("whole", "peak")])
async def test_what_counts_of_a_sweep_is_supposed_as_a_mission_has_it(client, services, flown, supposed):
    spec = MissionSpec(name="m", area=AREA, sensor=SensorSpec(bearing_errors="joint", sweep_evidence=flown))
    started = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
    await services.journal.append("m1", [MissionDrafted(spec=spec), started, *MEASURED])
    found: dict[str | None, float] = {}
    for wanted in (None, flown, supposed):
        answer = await client.post("/api/missions/m1/what-if", json={"bearings": 2, "sweep_evidence": wanted})
        assert answer.status_code == 200, answer.text
        found[wanted] = answer.json()["steps"][-1]["expected_rmse_m"]
    assert found[None] == found[flown] == pytest.approx(expected_m(flown))
    assert found[supposed] == pytest.approx(expected_m(supposed))
    assert abs(found[flown] - found[supposed]) > 1.0
    kept = await client.put("/api/missions/m1/variants/other", json={"sweep_evidence": supposed})
    assert kept.status_code == 204, kept.text
    assert (
        await client.post("/api/missions/m1/what-if", json={"bearings": 2, "sweep_evidence": "none"})
    ).status_code == 422
