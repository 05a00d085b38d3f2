"""Drafting, editing and commanding over HTTP, and how the API says no."""

from __future__ import annotations

import asyncio
from uuid import uuid4

import pytest
from facts import bearing, belief

from backend.events import CommandRefused, EstimateFact
from backend.spec import Polygon
from backend.wire.problem import Problem

AREA = {"type": "Polygon", "coordinates": [[[7.2, 50.6], [7.204, 50.6], [7.204, 50.602], [7.2, 50.602], [7.2, 50.6]]]}


def spec(**changes) -> dict:
    return {"name": "Search", "area": AREA, **changes}


async def draft(client, **changes) -> dict:
    reply = await client.post("/api/missions", json=spec(**changes))
    assert reply.status_code == 201, reply.text
    return reply.json()


def is_problem(reply, status: int) -> dict:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"] == "application/problem+json"
    problem = reply.json()
    assert Problem.model_validate(problem).model_dump(mode="json") == problem
    assert problem["status"] == status
    assert "Traceback" not in reply.text
    return problem


async def test_a_drafted_mission_is_listed_and_opens_again(client):
    first, second = await draft(client, name="one"), await draft(client, name="two")
    assert {m["name"] for m in (await client.get("/api/missions")).json()["missions"]} == {"one", "two"}
    again = (await client.get(f"/api/missions/{first['mission_id']}")).json()
    assert again == first
    assert again["phase"] == "draft"
    assert again["editable"]
    assert again["spec"]["sensor"]["sigma_deg"] == 7.0
    assert second["mission_id"] != first["mission_id"]


async def test_the_list_comes_in_pages_without_gap_or_double_and_by_name(client):
    """All are drafted in the same microsecond: the id decides."""
    made = [(await draft(client, name=f"Owl_{n}" if n % 2 else f"fox % {n}"))["mission_id"] for n in range(7)]
    seen, after = [], None
    while True:
        asked = {"limit": 3} if after is None else {"limit": 3, "after": after}
        page = (await client.get("/api/missions", params=asked)).json()
        seen += [mission["mission_id"] for mission in page["missions"]]
        after = page["next"]
        if after is None:
            break
        assert len(page["missions"]) == 3
    assert len(seen) == 7
    assert set(seen) == set(made)
    for part, count in (("owl_", 3), ("OWL", 3), ("%", 4), ("owlx", 0), ("", 7)):
        found = (await client.get("/api/missions", params={"named": part})).json()
        assert (len(found["missions"]), found["next"]) == (count, None), part
    for wrong in ({"after": "x"}, {"limit": 0}, {"after": f"{10**30}.m"}, {"named": "\x00"}):
        is_problem(await client.get("/api/missions", params=wrong), 422)


async def test_editing_replaces_the_specification(client):
    mission = await draft(client)
    url = f"/api/missions/{mission['mission_id']}"
    edited = (await client.put(f"{url}/spec", json=spec(name="Other"))).json()
    assert edited["name"] == edited["spec"]["name"] == "Other"
    assert (await client.get(url)).json() == edited


async def test_an_edit_of_what_was_saved_since_is_refused_and_replaces_it_when_it_says_so(client):
    first = await draft(client)
    url = f"/api/missions/{first['mission_id']}/spec"
    theirs = (await client.put(url, json=spec(name="Theirs"), params={"from_seq": first["spec_seq"]})).json()
    late = is_problem(await client.put(url, json=spec(name="Mine"), params={"from_seq": first["spec_seq"]}), 409)
    assert late["reason"] == {"code": "edited_meanwhile", "by": "operator", "seq": theirs["spec_seq"]}
    assert (await client.get(f"/api/missions/{first['mission_id']}")).json() == theirs
    over = await client.put(url, json=spec(name="Mine"), params={"from_seq": late["reason"]["seq"]})
    assert (over.status_code, over.json()["name"]) == (200, "Mine")


async def test_an_edit_whose_answer_was_lost_is_sent_again_and_stored_once(client):
    first = await draft(client)
    asked = {"json": spec(name="Mine"), "params": {"from_seq": first["spec_seq"]}}
    stored = (await client.put(f"/api/missions/{first['mission_id']}/spec", **asked)).json()
    assert (await client.put(f"/api/missions/{first['mission_id']}/spec", **asked)).json() == stored


async def test_a_draft_whose_answer_was_lost_is_drafted_once(client):
    own = {"mission_id": str(uuid4())}
    first = await client.post("/api/missions", json=spec(), params=own)
    assert (first.status_code, first.json()["mission_id"]) == (201, own["mission_id"])
    again = is_problem(await client.post("/api/missions", json=spec(name="Other"), params=own), 409)
    assert again["reason"] == {"code": "drafted_before", **own}
    assert [m["name"] for m in (await client.get("/api/missions")).json()["missions"]] == ["Search"]
    is_problem(await client.post("/api/missions", json=spec(), params={"mission_id": "../x"}), 422)


async def test_of_two_drafts_of_one_id_at_once_one_is_stored(client):
    own = {"mission_id": str(uuid4())}
    both = await asyncio.gather(*(client.post("/api/missions", json=spec(name=n), params=own) for n in ("a", "b")))
    assert sorted(reply.status_code for reply in both) == [201, 409]
    assert len((await client.get("/api/missions")).json()["missions"]) == 1


async def test_a_wrong_field_is_named(client):
    problem = is_problem(await client.post("/api/missions", json=spec(sensor={"sigma_deg": -1})), 422)
    assert problem["reason"]["code"] == "request_invalid"
    assert [(error["field"], error["reason"]["code"]) for error in problem["errors"]] == [
        ("sensor.sigma_deg", "field_out_of_range")
    ]
    problem = is_problem(await client.post("/api/missions", json=spec(colour="red")), 422)
    assert [(error["field"], error["reason"]["code"]) for error in problem["errors"]] == [("colour", "field_unknown")]


async def test_a_wrong_field_of_one_of_several_kinds_is_named_as_it_was_sent(client):
    ring = {"kind": "ring", "centre": {"lat": 50, "lon": 7}, "inner_m": -1}
    sent = spec(emitters=[{"prior": ring}], planner={"motion": {"kind": "linear", "speed_m_s": -3}})
    problem = is_problem(await client.post("/api/missions", json=sent), 422)
    assert [error["field"] for error in problem["errors"]] == [
        "emitters.0.prior.inner_m",
        "emitters.0.prior.outer_m",
        "planner.motion.speed_m_s",
    ]


async def test_a_kind_that_is_no_word_is_refused_like_any_other(client):
    for odd in ([], {}, 7, None):
        problem = is_problem(await client.post("/api/missions", json={"name": "Search", "kind": odd, "type": odd}), 422)
        assert "area" in [error["field"] for error in problem["errors"]]


async def test_an_altitude_outside_its_band_is_named_as_a_field(client):
    flight = {"altitude_relative_m": 130, "maximum_altitude_relative_m": 120}
    problem = is_problem(await client.post("/api/missions", json=spec(flight=flight)), 422)
    assert [(error["field"], error["reason"]["code"]) for error in problem["errors"]] == [
        ("flight.altitude_relative_m", "altitude_outside")
    ]


@pytest.mark.parametrize("body", [b"", b"{", b"[" * 100_000, b"\xff\xfe", b'{"name": NaN}', b"1" * 5000])
async def test_a_body_that_is_no_json_is_a_problem(client, body):
    reply = await client.post("/api/missions", content=body, headers={"content-type": "application/json"})
    is_problem(reply, reply.status_code)
    assert 400 <= reply.status_code < 500


@pytest.mark.parametrize("rest", ["", "/events", "/track", "/sweeps/s", "/beliefs", "/export/kml"])
async def test_an_unknown_mission_is_not_found(client, rest):
    problem = is_problem(await client.get(f"/api/missions/nobody{rest}"), 404)
    assert problem["reason"] == {"code": "no_mission", "mission_id": "nobody"}


async def test_a_command_reaches_the_mission_and_its_refusal_is_an_answer(client, services):
    mission_id = (await draft(client))["mission_id"]
    body = {"command_id": str(uuid4()), "command": {"kind": "hold"}}
    reply = await client.post(f"/api/missions/{mission_id}/commands", json=body)
    assert reply.status_code == 200
    assert reply.json()["accepted"] is False
    refused = (await services.journal.read(mission_id))[-1]
    assert isinstance(refused.event, CommandRefused)
    assert (refused.event.command_id, refused.event.command) == (body["command_id"], "hold")
    assert (reply.json()["reason"], reply.json()["seq"]) == (refused.model_dump(mode="json")["event"]["reason"], 2)
    is_problem(await client.post("/api/missions/nobody/commands", json=body), 404)
    body["command"] = {"kind": "fly_away"}
    is_problem(await client.post(f"/api/missions/{mission_id}/commands", json=body), 422)


@pytest.mark.parametrize(
    ("craft_id", "code"), [("craft-9", "no_such_craft"), ("craft-1", "not_started"), (None, "not_started")]
)
async def test_a_command_names_its_craft_or_means_the_only_one(client, craft_id, code):
    mission = await draft(client)
    body = {"command_id": str(uuid4()), "command": {"kind": "resume", "craft_id": craft_id}}
    reply = await client.post(f"/api/missions/{mission['mission_id']}/commands", json=body)
    assert reply.json()["reason"]["code"] == code


async def test_a_mission_says_what_is_known_of_each_emitter(client):
    tag = {"emitter_id": "tag", "frequency_hz": 150e6, "kind": "pulsed"}
    mission = await draft(client, emitters=[{"emitter_id": "beacon"}, tag])
    assert mission["emitters"] == 2
    assert [(e["emitter_id"], e["bearings"], e["localized"]) for e in mission["found"]] == [
        ("beacon", 0, False),
        ("tag", 0, False),
    ]
    assert [reason["code"] for e in mission["found"] for reason in e["not_yet"]] == ["no_bearing_yet"] * 2
    twice = await client.post("/api/missions", json=spec(emitters=[tag, tag]))
    is_problem(twice, 422)


@pytest.mark.parametrize("nothing", [{"bearings": 0}, {"estimate": None}], ids=["taken back", "inconsistent"])
async def test_what_nobody_measured_is_neither_an_estimate_nor_found(client, services, nothing):
    """After a start and an abort at once, and once all bearings are taken back, only the area is believed in."""
    mission_id = (await draft(client))["mission_id"]
    place = EstimateFact(
        lat=50.601, lon=7.202, expected_rmse_m=9.0, c95=Polygon.model_validate(AREA), c95_area_m2=6e2,
        major_axis_m=8.0, minor_axis_m=6.0, major_axis_deg=0.0,
    )  # fmt: skip
    sure = belief(2).model_copy(update={"estimate": place})
    unsure = sure.model_copy(update=nothing)
    for fact, names in ((unsure, []), (sure, ["emitter-1"]), (unsure, [])):
        await services.journal.append(mission_id, [fact])
        mission = (await client.get(f"/api/missions/{mission_id}")).json()
        assert [one["emitter_id"] for one in mission["found"] if one["estimate"] is not None] == names
        assert list(mission["sketch"]["found"]) == names


async def test_bearings_of_which_no_belief_can_be_made_are_not_said_to_be_none(client, services):
    mission = await draft(client)
    await services.journal.append(mission["mission_id"], [bearing(1)])
    (found,) = (await client.get(f"/api/missions/{mission['mission_id']}")).json()["found"]
    assert (found["bearings"], found["not_yet"]) == (1, [{"code": "bearings_not_in_belief", "bearings": 1}])


async def test_a_fault_of_our_own_is_a_problem_with_an_incident(client, vehicle, monkeypatch, caplog):
    def broken() -> None:
        raise RuntimeError("secret detail")

    monkeypatch.setattr(vehicle, "telemetry", broken)
    reply = await client.get("/api/vehicle")
    reason = is_problem(reply, 500)["reason"]
    assert reason["code"] == "server_broke"
    assert reason["incident"] in caplog.text
    assert "secret detail" not in reply.text


async def test_unknown_paths_and_methods_are_problems(client):
    unknown = is_problem(await client.get("/api/nothing"), 404)["reason"]
    assert (unknown["code"], unknown["which"]) == ("nothing_there", "/api/nothing")
    refused = is_problem(await client.delete("/api/missions"), 405)["reason"]
    assert (refused["code"], refused["status"]) == ("http_refused", 405)


async def test_too_large_a_body_is_refused_with_and_without_a_length(client):
    async def chunks():
        for _ in range(9):
            yield b" " * 2**20

    for body in (b" " * (9 * 2**20), chunks()):
        problem = is_problem(await client.post("/api/missions", content=body), 413)
        assert problem["reason"]["code"] == "body_too_large"
    assert (await client.get("/api/missions")).json()["missions"] == []
