"""The library: missions found again, labelled, deleted and brought back, checked against the truth."""

from __future__ import annotations

from uuid import uuid4

import pytest
from facts import HOME
from sqlalchemy import text

from backend.events import Event, MissionLabelled, MissionStarted, PhaseChanged
from backend.reasons.flight import Ordered
from backend.store.engine import make_engine
from backend.store.journal import SqlJournal
from backend.store.spool import Spool

NOW_S = 1_700_000_000.0

AREA = {"type": "Polygon", "coordinates": [[[7.2, 50.6], [7.204, 50.6], [7.204, 50.602], [7.2, 50.602], [7.2, 50.6]]]}
FAR = {"type": "Polygon", "coordinates": [[[8.2, 51.6], [8.204, 51.6], [8.204, 51.602], [8.2, 51.602], [8.2, 51.6]]]}


async def draft(client, **changes) -> str:
    reply = await client.post("/api/missions", json={"name": "Search", "area": AREA, **changes})
    assert reply.status_code == 201, reply.text
    return reply.json()["mission_id"]


async def names(client, **asked) -> set[str]:
    reply = await client.get("/api/missions", params=asked)
    assert reply.status_code == 200, reply.text
    return {mission["name"] for mission in reply.json()["missions"]}


async def test_missions_are_found_by_place_emitter_date_result_and_words(client):
    await draft(client, name="near", emitters=[{"label": "Fox 12", "frequency_hz": 148.52e6}])
    await draft(client, name="far", area=FAR)
    assert await names(client, box="7.1,50.5,7.203,50.65") == {"near"}
    assert await names(client, box="7.3,50.5,8.0,51.7") == set()
    assert await names(client, emitter="fox 12") == await names(client, emitter="148.52") == {"near"}
    assert await names(client, emitter="%") == set()
    assert await names(client, outcome="localized") == set()
    assert await names(client, vehicle="craft-1") == set(), "neither has flown"
    assert await names(client, since="2000-01-01T00:00:00Z") == {"near", "far"}
    assert await names(client, until="2000-01-01T00:00:00Z") == set()
    for wrong in ({"box": "1,2,3"}, {"box": "a,b,c,d"}, {"outcome": "lost"}, {"since": "today"}, {"emitter": "\x00"}):
        assert (await client.get("/api/missions", params=wrong)).status_code == 422, wrong


def beside_the_antimeridian(west: float) -> dict:
    east = west + 0.004
    ring = [[west, 50.6], [east, 50.6], [east, 50.602], [west, 50.602], [west, 50.6]]
    return {"type": "Polygon", "coordinates": [ring]}


async def test_a_rectangle_reaches_through_the_antimeridian(client):
    await draft(client, name="last of the east", area=beside_the_antimeridian(179.99))
    await draft(client, name="first of the west", area=beside_the_antimeridian(-179.99))
    await draft(client, name="at home")
    both = {"last of the east", "first of the west"}
    for box in ("179.5,50,-179.5,51", "179.5,50,180.5,51", "-180.5,50,-179.5,51"):
        assert await names(client, box=box) == both, box
    assert await names(client, box="179.5,50,180,51") == {"last of the east"}
    assert await names(client, box="-180,50,-179.5,51") == {"first of the west"}
    for box in ("-180,-90,180,90", "-270,-90,270,90", "-180,50,180,51"):
        assert await names(client, box=box) == both | {"at home"}, box
    assert await names(client, box="179.5,51,-179.5,52") == set()


async def test_an_area_across_the_antimeridian_is_found_there_and_nowhere_else(client):
    across = [[179.99, 50.6], [-179.99, 50.6], [-179.99, 50.61], [179.99, 50.6]]
    await draft(client, name="across", area={"type": "Polygon", "coordinates": [across]})
    for box in (
        "179.5,50,-179.5,51",
        "179.5,50,179.995,51",
        "-180,50,-179.5,51",
        "-179.995,50,-170,51",
        "170,50,190,51",
    ):
        assert await names(client, box=box) == {"across"}, box
    for box in ("0,50,10,51", "-179.5,50,179.5,51", "179.5,51,-179.5,52"):
        assert await names(client, box=box) == set(), box


async def test_words_are_found_whatever_their_case_in_any_language(client):
    mission_id = await draft(client)
    labels = {"name": "Übung Größe", "tags": ["ÄSCHE"], "notes": "Čáp"}
    assert (await client.put(f"/api/missions/{mission_id}/labels", json=labels)).status_code == 200
    for words in ("übung", "ÜBUNG", "GRÖ", "äsche", "čáp", "ČÁP"):
        assert await names(client, named=words) == {"Übung Größe"}, words
    for words in ("%", "_", "ubung"):
        assert await names(client, named=words) == set(), words


async def test_labels_are_kept_and_searched_and_the_list_has_a_small_map(client):
    mission_id = await draft(client)
    labels = {"name": "Owls", "tags": ["night", "season 3"], "notes": "by the river"}
    assert (await client.put(f"/api/missions/{mission_id}/labels", json=labels)).json()["name"] == "Owls"
    for words in ("owls", "SEASON", "river"):
        assert await names(client, named=words) == {"Owls"}
    (listed,) = (await client.get("/api/missions")).json()["missions"]
    assert (listed["tags"], listed["notes"]) == (labels["tags"], labels["notes"])
    assert listed["sketch"]["outline"] == [AREA["coordinates"][0]]
    for wrong in (
        {**labels, "name": "owls\uffff"},
        {**labels, "name": "owls\ufdd0"},
        {**labels, "name": "owls\U0010fffe"},
        {**labels, "name": " "},
        {**labels, "name": "\u200b"},
        {**labels, "name": "owls\u202egpj"},
        {**labels, "name": "o\x00wls"},
        {**labels, "tags": ["a\nb"]},
        {**labels, "tags": ["a,b"]},
        {**labels, "tags": ["x" * 41]},
        {**labels, "tags": ["x"] * 21},
    ):
        assert (await client.put(f"/api/missions/{mission_id}/labels", json=wrong)).status_code == 422


async def test_a_tag_is_one_whatever_ends_a_line_elsewhere(client):
    mission_id = await draft(client)
    tags = ["night\u2028owl", "night\u2029owl", "night\x85owl"]
    told = await client.put(f"/api/missions/{mission_id}/labels", json={"name": "Owls", "tags": tags, "notes": ""})
    assert (told.status_code, told.json()["tags"]) == (200, tags)
    await client.put(f"/api/missions/{mission_id}/labels", json={"name": "Owls", "tags": [], "notes": ""})
    assert (await client.get("/api/missions")).json()["missions"][0]["tags"] == []


async def test_an_emitter_is_found_by_every_digit_of_its_frequency(client):
    exact = {"868.3125": 868.3125e6, "148.52345": 148_523_450.0, "1575.42015": 1_575_420_150.0, "0.457": 457_000.0}
    for megahertz, frequency_hz in exact.items():
        await draft(client, name=megahertz, emitters=[{"frequency_hz": frequency_hz}])
    assert [await names(client, emitter=megahertz) for megahertz in exact] == [{megahertz} for megahertz in exact]
    assert await names(client, emitter="148.523") == {"148.52345"}


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"name": "owls\u202egpj"}, "name"),
        ({"name": "owls\ufffe"}, "name"),
        ({"name": "o\nwls"}, "name"),
        ({"name": "\u200b"}, "name"),
        ({"emitters": [{"label": "vixen\u202egpj"}]}, "emitters.0.label"),
    ],
)
async def test_a_draft_is_named_by_the_rule_of_labels(client, changes, field):
    mission_id = await draft(client)
    spec = (await client.get(f"/api/missions/{mission_id}")).json()["spec"]
    for told in (
        await client.post("/api/missions", json=spec | changes),
        await client.put(f"/api/missions/{mission_id}/spec", json=spec | changes),
    ):
        assert (told.status_code, told.json()["errors"][0]["field"]) == (422, field), told.text
        assert told.json()["reason"]["code"] == "field_invalid"


async def test_odd_names_are_kept_as_they_were_written(client):
    mission_id = await draft(client)
    family = "\U0001f468\u200d\U0001f469\u200d\U0001f467"
    for name in ("<img src=x onerror=alert(1)>", "%", "'; drop table missions; --", family, "x" * 120):
        labels = {"name": name, "tags": ["owls", "owls", family], "notes": ""}
        told = await client.put(f"/api/missions/{mission_id}/labels", json=labels)
        assert (told.status_code, told.json()["name"], told.json()["tags"]) == (200, name, ["owls", family])
        assert await names(client, named=name) == {name}


async def test_a_deleted_mission_is_out_of_the_list_and_comes_back(client):
    mission_id = await draft(client)
    assert (await client.delete(f"/api/missions/{mission_id}")).status_code == 204
    assert await names(client) == set()
    assert await names(client, deleted=True) == {"Search"}
    assert (await client.post(f"/api/missions/{mission_id}/restore")).status_code == 200
    assert await names(client) == {"Search"}
    assert (await client.delete("/api/missions/unknown")).status_code == 404


async def test_a_deleted_mission_is_started_from_no_tab_that_still_shows_it(client):
    mission_id = await draft(client)
    for _ in range(2):
        assert (await client.delete(f"/api/missions/{mission_id}")).status_code == 204
    order = {"command_id": str(uuid4()), "command": {"kind": "start"}}
    reply = (await client.post(f"/api/missions/{mission_id}/commands", json=order)).json()
    assert (reply["accepted"], reply["reason"]["code"]) == (False, "was_deleted")
    assert await names(client, deleted=True) == {"Search"}


async def test_a_deleted_mission_takes_nothing_in_from_a_tab_that_still_shows_it(client):
    mission_id = await draft(client)
    base = f"/api/missions/{mission_id}"
    spec = (await client.get(base)).json()["spec"]
    bearing = {"bearing_id": "b" * 8, "place": {"lat": 50.6, "lon": 7.2}, "bearing_deg": 45.0}
    table = {"files": ("b.csv", "lat,lon,bearing_deg\n50.6,7.2,45\n", "text/csv")}
    assert (await client.delete(base)).status_code == 204

    async def tried() -> list[int]:
        replies = [
            await client.put(f"{base}/spec", json=spec),
            await client.post(f"{base}/bearings", json=bearing),
            await client.post(f"{base}/recordings", files=table),
        ]
        return [reply.status_code for reply in replies]

    assert await tried() == [409, 409, 409]
    assert (await client.get(base)).json()["bearings"] == 0
    assert (await client.post(f"{base}/restore")).status_code == 200
    assert await tried() == [200, 201, 201]


async def test_the_truth_is_told_and_the_last_word_counts(client):
    mission_id = await draft(client)
    told = {"place": {"lat": 50.601, "lon": 7.202}, "accuracy_m": 4, "how": "phone"}
    found = (await client.put(f"/api/missions/{mission_id}/truth", json=told)).json()
    assert found["sketch"]["truth"] == {"emitter-1": [7.202, 50.601]}
    checked = (await client.get("/api/calibration")).json()
    assert (checked["missions"], checked["not_found"], checked["fixes"], checked["suggested"]) == (1, 0, [], None)
    assert checked["c95"] == {"of": 0, "share": 0.0, "low": 0.0, "high": 1.0}
    not_found = {"place": None, "how": "map"}
    assert (await client.put(f"/api/missions/{mission_id}/truth", json=not_found)).status_code == 200
    checked = (await client.get("/api/calibration")).json()
    assert (checked["missions"], checked["not_found"], checked["fixes"]) == (1, 1, [])
    wrong = {**told, "emitter_id": "nobody"}
    assert (await client.put(f"/api/missions/{mission_id}/truth", json=wrong)).status_code == 422


async def test_a_place_that_nobody_can_have_found_the_emitter_at_is_no_truth(client):
    """A phone without a fix, or latitude and longitude the wrong way round: the season's errors were of continents, and
    the next flight's compass learned from them."""
    mission_id = await draft(client)
    for place in ({"lat": 0.0, "lon": 0.0}, {"lat": 7.202, "lon": 50.601}):
        reply = await client.put(f"/api/missions/{mission_id}/truth", json={"place": place, "how": "typed"})
        assert (reply.status_code, reply.json()["reason"]["code"]) == (422, "place_too_far")
    assert (await client.get("/api/calibration")).json()["missions"] == 0


async def damaged(settings, mission_id: str, *facts: Event) -> None:
    """With these facts besides, written by a server before; then its draft is no text any more."""
    spool = Spool(settings.data_dir / "before.spool", 64 * 1024)
    before = SqlJournal(make_engine(settings.async_database_url, 60.0), spool, lambda: NOW_S, timeout_s=60.0)
    await before.append(mission_id, facts)
    await before.close()
    engine = make_engine(settings.async_database_url, 60.0)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(
            text("UPDATE events SET body = :body WHERE mission_id = :mission_id AND seq = 1"),
            {"body": b"\x78\x9c no text", "mission_id": mission_id},
        )
    await engine.dispose()


def forgotten(services, mission_id: str) -> None:
    """By this server's memory, as after a restart."""
    services.journal._written.pop(mission_id, None)


IN_FLIGHT = (
    MissionStarted(craft_id="craft-1", by="ben", home=HOME, home_amsl_m=100.0, software="0"),
    PhaseChanged(craft_id="craft-1", before="ground", after="flying", reason=Ordered("start", "ben")),
)


@pytest.mark.parametrize("facts", [(), IN_FLIGHT], ids=["a draft", "never landed"])
async def test_a_damaged_mission_says_so_and_is_deleted_and_brought_back_like_any_other(
    client, services, settings, facts
):
    mission_id = await draft(client, name="bad")
    await draft(client, name="good")
    forgotten(services, mission_id)
    await damaged(settings, mission_id, *facts, MissionLabelled(name="bad", tags=[], notes="", by="ben"))
    forgotten(services, mission_id)
    opened = await client.get(f"/api/missions/{mission_id}")
    assert (opened.status_code, opened.json()["reason"]["code"]) == (500, "mission_damaged")
    assert "deleted" in opened.json()["remedy"]
    for _ in range(2):  # again changes nothing
        assert (await client.delete(f"/api/missions/{mission_id}")).status_code == 204
        assert await names(client) == {"good"}
        assert await names(client, deleted=True) == {"bad"}
    (line,) = (await client.get("/api/missions", params={"deleted": True})).json()["missions"]
    assert not line["flying"], "so that it is buried when its time is up"
    assert line["outcome"] == ("failed" if facts else None)
    assert line["last_seq"] == (7 if facts else 3)
    for _ in range(2):
        back = await client.post(f"/api/missions/{mission_id}/restore")
        assert (back.status_code, back.json()["deleted_at_utc"]) == (200, None)
        assert await names(client) == {"bad", "good"}
    assert (await client.delete("/api/missions/none")).status_code == 404
    assert (await client.post("/api/missions/none/restore")).status_code == 404
