"""Health, defaults and the vehicle, with every part there and without."""

from __future__ import annotations

import math

import pytest

from backend.ports import Lesson, Said
from backend.search.localization import localization
from backend.spec import MissionSpec
from hardware.readings import Place, Telemetry

GONE = Telemetry(connected=False, at_s=0.0)


async def test_all_is_well(client):
    health = (await client.get("/api/health")).json()
    assert health["state"] == "ok"
    assert health["database"] == {"state": "ok", "kind": "sqlite", "reason": None, "spooled": 0, "refused": 0}
    assert health["vehicles"] == [{"craft_id": "craft-1", "connected": True, "autopilot": "px4", "reason": None}]


async def test_the_disk_and_the_rule_of_retention_are_told(client):
    health = (await client.get("/api/health")).json()
    assert health["disk_free_bytes"] > 0
    assert health["keep_sweeps_days"] is None


async def test_without_a_port_for_bearings_nothing_is_told_of_them(client):
    assert (await client.get("/api/health")).json()["bearings_udp"] is None


async def test_a_probe_gets_200_as_long_as_the_server_answers(client, vehicle):
    assert (await client.get("/health")).json() == {"state": "ok"}
    vehicle.heard_last = GONE
    reply = await client.get("/health")
    assert (reply.status_code, reply.json()) == (200, {"state": "degraded"})


async def test_a_missing_vehicle_is_said_with_its_reason(client, vehicle):
    vehicle.heard_last = GONE
    health = (await client.get("/api/health")).json()
    assert health["state"] == "degraded"
    assert [vehicle["reason"]["code"] for vehicle in health["vehicles"]] == ["no_link"]


async def test_the_suggested_mission_can_be_flown_from_home(client):
    defaults = (await client.get("/api/defaults")).json()
    assert defaults["home"] == {"lat": 50.6, "lon": 7.2}
    spec = MissionSpec.model_validate(defaults["spec"])
    task = localization(spec, Place(**defaults["home"]))
    x, y = task.problem.area[0].T
    assert math.isclose(x.min(), -x.max(), abs_tol=0.1)
    assert abs(y.min()) < 0.1
    assert (await client.post("/api/missions", json=defaults["spec"])).status_code == 201


@pytest.mark.parametrize(
    ("sensor", "meant"),
    [(None, "joint"), ({}, "joint"), ({"sigma_deg": 5.0}, "joint"), ({"bearing_errors": "independent"}, "independent")],
)
async def test_a_request_that_names_no_model_of_errors_has_them_estimated(client, sensor, meant):
    spec = (await client.get("/api/defaults")).json()["spec"]
    assert spec["sensor"]["bearing_errors"] == "joint"
    asked = {**spec, "sensor": sensor} if sensor is not None else {k: v for k, v in spec.items() if k != "sensor"}
    drafted = (await client.post("/api/missions", json=asked)).json()
    assert drafted["spec"]["sensor"]["bearing_errors"] == meant
    edited = await client.put(f"/api/missions/{drafted['mission_id']}/spec", json=asked)
    assert edited.json()["spec"]["sensor"]["bearing_errors"] == meant
    assert edited.json()["spec"]["sensor"].get("sigma_deg") == (sensor or {}).get("sigma_deg", 7.0)


@pytest.mark.parametrize(
    "errors",
    [
        {"bearing_errors": "independent", "shared_errors": False, "sweep_evidence": "peak"},
        {"bearing_errors": "joint", "shared_errors": False, "sweep_evidence": "peak"},
        {"bearing_errors": "joint", "shared_errors": True, "sweep_evidence": "whole"},
    ],
)
async def test_an_edit_that_does_not_name_what_bearings_are_taken_for_leaves_it(client, errors):
    spec = (await client.get("/api/defaults")).json()["spec"]
    drafted = (await client.post("/api/missions", json={**spec, "sensor": errors})).json()
    url = f"/api/missions/{drafted['mission_id']}/spec"
    edited = (await client.put(url, json={**spec, "sensor": {"sigma_deg": 5.0}})).json()["spec"]["sensor"]
    assert edited["sigma_deg"] == 5.0
    assert {name: edited[name] for name in errors} == errors
    named = (await client.put(url, json={**spec, "sensor": {"sweep_evidence": "whole"}})).json()["spec"]["sensor"]
    assert {name: named[name] for name in errors} == {**errors, "sweep_evidence": "whole"}


async def test_without_a_vehicle_the_area_lies_around_the_configured_place(client, vehicle, settings):
    vehicle.heard_last = GONE
    defaults = (await client.get("/api/defaults")).json()
    assert defaults["home"] is None
    lon, lat = defaults["spec"]["area"]["coordinates"][0][0]
    assert abs(lat - settings.home_lat_deg) < 0.01
    assert abs(lon - settings.home_lon_deg) < 0.01


async def test_every_value_has_its_age_and_nan_is_unknown(client, services, vehicle):
    vehicle.heard_last = Telemetry(
        connected=True,
        at_s=services.now() - 1,
        position=Place(50.6, 7.2),
        position_at_s=services.now() - 2,
        heading_deg=math.nan,
        heading_at_s=services.now() + 1,
        velocity_north_m_s=3.0,
        velocity_east_m_s=4.0,
        velocity_down_m_s=-1.0,
    )
    told = (await client.get("/api/vehicle")).json()
    assert (told["lat"], told["position_age_s"]) == (50.6, 2.0)
    assert (told["heading_deg"], told["heading_age_s"]) == (None, 0.0)
    assert (told["ground_speed_m_s"], told["climb_m_s"]) == (5.0, 1.0)
    assert (told["battery_percent"], told["battery_age_s"]) == (None, None)


async def test_a_craft_is_asked_by_its_name(client):
    told = (await client.get("/api/vehicle", params={"craft": "craft-1"})).json()
    assert (told["craft_id"], told["who"]) == ("craft-1", "nobody")
    unknown = await client.get("/api/vehicle", params={"craft": "craft-9"})
    assert unknown.status_code == 404
    assert unknown.json()["reason"] == {"what": "craft", "which": "craft-9", "code": "nothing_there"}


async def test_what_was_learned_of_a_compass_is_shown_and_forgotten(client, services):
    lessons, craft = services.missions.equipment.lessons, services.missions.equipment.first
    said = (Said(0.5, 0.0), Said(10.0, -9.0))
    for number in (1, 2):
        one = Lesson(f"m{number}", 4, 6.0, 1.0, said, (Said(1.0, 0.0),), (Said(0.05, 0.0),))
        await lessons.keep(craft.craft_id, craft.pattern.name, one)
    known = (await client.get("/api/crafts/craft-1/compass")).json()
    assert (known["flights"], known["bearings"], known["antenna"]) == (2, 8, craft.pattern.name)
    assert known["bias_deg"] == 6.0
    assert known["expected_bias_deg"] < 2.0
    right = (await client.get("/api/crafts/craft-1/compass?bearing_offset_deg=6")).json()
    assert (right["bias_deg"], right["flights"]) == (0.0, 2)
    assert (await client.get("/api/crafts/craft-1/compass?bearing_offset_deg=200")).status_code == 422
    joint = (await client.get("/api/defaults")).json()["spec"]
    drafted = (await client.post("/api/missions", json=joint)).json()["spec"]
    assert (joint["sensor"]["learned"], drafted["sensor"]["learned"]["flights"]) == (None, 2)
    gone = (await client.delete("/api/crafts/craft-1/compass")).json()
    assert (gone["flights"], gone["bias_deg"]) == (0, None)
    assert gone["expected_bias_deg"] > 4.0
    assert (await client.get("/api/crafts/craft-9/compass")).status_code == 404
