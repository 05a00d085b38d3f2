"""Files of bearings brought into a mission: all or none, once, as one source (or one a station) with its own errors."""

from __future__ import annotations

import math
from uuid import uuid4

import pytest

AREA = {"type": "Polygon", "coordinates": [[[7.2, 50.6], [7.204, 50.6], [7.204, 50.602], [7.2, 50.602], [7.2, 50.6]]]}
TARGET = (7.202, 50.601)
PLACES = ((7.2, 50.6), (7.204, 50.6), (7.204, 50.602), (7.199, 50.603))


def bearing_deg(lon: float, lat: float) -> float:
    east = (TARGET[0] - lon) * math.cos(math.radians(lat))
    return math.degrees(math.atan2(east, TARGET[1] - lat)) % 360.0


def kraken(frequency_hz: float = 868_300_000.0) -> str:
    """A front that points to 350."""
    return "\n".join(
        f"{1700000000000 + 300_000 * n}, {(bearing_deg(lon, lat) + 10.0) % 360.0:.2f}, 80, -31, {frequency_hz:.0f},"
        f" UCA, 412, roof, {lat}, {lon}, 350.0, 10.0, GPS, R"
        for n, (lon, lat) in enumerate(PLACES)
    )


async def draft(client, **changes) -> str:
    return (await client.post("/api/missions", json={"name": "m", "area": AREA, **changes})).json()["mission_id"]


async def bring(client, mission_id: str, text: str, **said):
    files = {"files": ("station.csv", text, "text/csv")}
    return await client.post(f"/api/missions/{mission_id}/recordings", files=files, data=said)


async def facts(services, mission_id: str, kind: str) -> list:
    return [r.event for r in await services.journal.read(mission_id) if r.event.kind == kind]


async def test_a_krakens_file_localizes_and_counts_once(client, services):
    mission_id = await draft(client)
    reply = await bring(client, mission_id, kraken())
    assert reply.status_code == 201, reply.text
    told = reply.json()
    assert [round(one["bearing_deg"]) for one in told["sweeps"]] == [round(bearing_deg(*place)) for place in PLACES]
    bearings = await facts(services, mission_id, "bearing_measured")
    assert {(b.source.kind, b.source.recording_id) for b in bearings} == {("import", told["recording_id"])}
    assert [b.taken_at_s for b in bearings] == [1700000000.0 + 300.0 * n for n in range(4)]
    (belief,) = await facts(services, mission_id, "belief_updated")
    assert belief.bearings == 4
    assert abs(belief.estimate.lon - TARGET[0]) < 5e-4
    again = await bring(client, mission_id, kraken())
    assert (again.status_code, again.json()["already"], len(again.json()["sweeps"])) == (200, True, 4)
    assert len(await facts(services, mission_id, "bearing_measured")) == 4


async def test_each_station_of_a_krakens_log_is_a_source_of_its_own(client, services):
    """Two whose compasses differ by 30 degrees had one between them."""
    mission_id = await draft(client)
    lines = [
        f"{1700000000000 + 300_000 * n}, {(bearing_deg(lon, lat) + off) % 360.0:.2f}, 80, -31, 868300000, UCA, 412,"
        f" {station}, {lat}, {lon}, 0.0, 0.0, GPS, R"
        for station, off in (("roof", 15.0), ("van", -15.0))
        for n, (lon, lat) in enumerate(PLACES)
    ]
    told = (await bring(client, mission_id, "\n".join(lines))).json()
    assert len(told["sweeps"]) == 8
    (belief,) = await facts(services, mission_id, "belief_updated")
    assert {one.source.name: one.bias_deg > 0.0 for one in belief.sources} == {"roof": True, "van": False}
    again = await bring(client, mission_id, "\n".join(lines))
    assert (again.status_code, again.json()["already"], len(again.json()["sweeps"])) == (200, True, 8)
    muted = {
        "command_id": str(uuid4()),
        "command": {"kind": "mute_source", "of": "person", "name": "van", "muted": True, "reason": ""},
    }
    assert (await client.post(f"/api/missions/{mission_id}/commands", json=muted)).json()["accepted"]


async def test_a_station_is_itself_for_an_emitter_that_no_other_station_of_the_log_heard(client, services):
    """Its compass had one error for the emitter that both heard, and another for the one that it heard alone."""
    emitters = [
        {"emitter_id": "fox", "frequency_hz": 868_300_000.0},
        {"emitter_id": "tag", "frequency_hz": 868_900_000.0},
    ]
    mission_id = await draft(client, emitters=emitters)
    alone = kraken(868_900_000.0)
    log = "\n".join([kraken(), kraken().replace("roof", "van"), alone])
    sources = {}
    for one in ("fox", "tag"):
        assert (await bring(client, mission_id, log, emitter_id=one)).status_code == 201
        taken = [fact for fact in await facts(services, mission_id, "bearing_measured") if fact.emitter_id == one]
        sources[one] = {getattr(fact.source, "name", "") for fact in taken}
    assert sources == {"fox": {"roof", "van"}, "tag": {"roof"}}


async def report(client, mission_id: str, line: str) -> None:
    reply = await client.post(f"/api/missions/{mission_id}/bearings/kraken", content=line)
    assert reply.status_code == 201, reply.text


async def known_of(services, mission_id: str) -> list[list[int]]:
    imports = await facts(services, mission_id, "recording_imported")
    return [[one.count for one in fact.remarks if one.code == "kind_left_out"] for fact in imports]


async def test_a_stations_bearings_that_came_live_count_once_when_its_log_is_brought_in(client, services):
    """In one minute the station's first line came live, and the log begins with another of it."""
    mission_id = await draft(client)
    lines = kraken().replace("170000", "169999").splitlines()
    for line in lines[:2]:
        await report(client, mission_id, line.replace("00000,", "08000,", 1).replace(", 350.0,", ", 351.0,"))
    assert (await bring(client, mission_id, "\n".join(lines))).status_code == 201
    bearings = await facts(services, mission_id, "bearing_measured")
    assert [one.taken_at_s for one in bearings] == [1699990000.0 + 300.0 * n + 8.0 * (n < 2) for n in range(4)]
    assert {one.source.name for one in bearings} == {"roof"}
    (*_, belief) = await facts(services, mission_id, "belief_updated")
    assert belief.bearings == 4
    assert await known_of(services, mission_id) == [[2]]


async def test_a_stations_bearings_that_come_after_their_log_count_once(client, services):
    mission_id = await draft(client)
    lines = kraken().splitlines()
    assert (await bring(client, mission_id, "\n".join(lines))).status_code == 201
    imported = await facts(services, mission_id, "bearing_measured")
    reply = await client.post(f"/api/missions/{mission_id}/bearings/kraken", content=lines[0])
    assert reply.status_code == 200, reply.text
    assert await facts(services, mission_id, "bearing_measured") == imported
    again = await bring(client, mission_id, "\n".join(lines))
    assert again.status_code == 200, "the same file is known, bearings and all"
    await report(client, mission_id, lines[0].replace("1700000000000", "1700000061500"))
    assert len(await facts(services, mission_id, "bearing_measured")) == len(imported) + 1


async def test_a_log_that_went_on_brings_what_is_new(client, services):
    mission_id = await draft(client)
    lines = kraken().splitlines()
    for some in (lines[:3], lines, lines[1:]):
        assert (await bring(client, mission_id, "\n".join(some))).status_code == 201
    bearings = await facts(services, mission_id, "bearing_measured")
    assert [one.taken_at_s for one in bearings] == [1700000000.0 + 300.0 * n for n in range(4)]
    assert await known_of(services, mission_id) == [[], [3], [3]]


async def test_what_is_new_in_a_file_that_names_no_station_is_nobodys_where_two_stations_are_known_of_it(
    client, services
):
    mission_id = await draft(client)
    log = kraken().replace("170000", "169999").splitlines()
    for line in (log[0], log[1].replace("roof", "van")):
        await report(client, mission_id, line)
    rows = [
        f"1,,{bearing_deg(lon, lat):.2f},1,{lat},{lon},,,{at_s},{at_s}"
        for at_s, (lon, lat) in zip(range(1699990000, 1699991200, 300), PLACES, strict=True)
    ]
    assert (await bring(client, mission_id, "\n".join(rows))).status_code == 201
    bearings = await facts(services, mission_id, "bearing_measured")
    assert [one.source.kind for one in bearings] == ["person", "person", "import", "import"]


async def test_what_another_station_heard_at_the_same_time_is_another_bearing(client, services):
    mission_id = await draft(client)
    roof, van = kraken(), kraken().replace("roof", "van")
    for log in ("\n".join([roof, van.splitlines()[0]]), "\n".join([roof, van])):
        assert (await bring(client, mission_id, log)).status_code == 201
    bearings = await facts(services, mission_id, "bearing_measured")
    assert [one.source.name for one in bearings] == ["roof"] * 4 + ["van"] * 4
    assert await known_of(services, mission_id) == [[], [5]]


async def test_bearings_of_another_time_place_or_direction_are_others(client, services):
    mission_id = await draft(client)
    told = "1,0,70.0,1,50.6,7.2,100,0,0,1700000000"
    changes = (("1700000000", "1700000002"), ("50.6,", "50.6002,"), ("70.0", "70.2"), ("70.0", "70.05"))
    for text in (told, *(told.replace(*change) for change in changes)):
        assert (await bring(client, mission_id, text)).status_code == 201
    assert await known_of(services, mission_id) == [[], [], [], [], [1]]


async def test_of_a_stations_two_logs_one_bearing_a_minute_and_place_counts_as_of_one(client, services):
    mission_id = await draft(client)
    first = kraken().splitlines()[0]
    changes = (("1700000000000", "1700000061500"), ("50.6,", "50.6002,"), ("350.0", "349.8"))
    for line in (first, *(first.replace(*change) for change in changes)):
        assert (await bring(client, mission_id, line)).status_code == 201
    assert await known_of(services, mission_id) == [[], [], [], [1]]


async def test_a_file_is_called_what_can_be_shown_of_its_name(client, services):
    mission_id = await draft(client)
    files = {"files": ("../roof\u202evsc.csv", kraken(), "text/csv")}
    reply = await client.post(f"/api/missions/{mission_id}/recordings", files=files)
    assert (reply.status_code, reply.json()["filename"]) == (201, "roofvsc.csv")


async def test_our_own_bearing_file_comes_back_as_it_went(client, services):
    first, second = await draft(client), await draft(client)
    assert (await bring(client, first, kraken())).status_code == 201
    text = (await client.get(f"/api/missions/{first}/export/csv")).text
    reply = await bring(client, second, text)
    assert reply.status_code == 201, reply.text
    ours, theirs = [await facts(services, one, "bearing_measured") for one in (first, second)]
    assert [round(b.bearing_deg, 4) for b in ours] == [round(b.bearing_deg, 4) for b in theirs]
    assert [b.place.lat for b in ours] == [b.place.lat for b in theirs]


async def test_bearings_without_a_sigma_get_the_one_that_their_misses_show(client, services):
    """Seven degrees were taken for granted: bearings that miss one another by fifteen then claimed a wrong place."""
    told: list[float] = []
    for off_deg, times in ((0.0, 1), (25.0, 1), (0.0, 2)):
        mission_id = await draft(client)
        turned = [bearing_deg(*place) + off * off_deg for place, off in zip(PLACES, (1, -1, 0.8, -0.6), strict=True)]
        rows = "".join(f"{lat},{lon},{b}\n" for (lon, lat), b in zip(PLACES, turned, strict=True)) * times
        reply = await bring(client, mission_id, f"lat,lon,bearing_deg\n{rows}")
        assert reply.status_code == 201, reply.text
        found = {b.sigma_deg for b in await facts(services, mission_id, "bearing_measured")}
        assert len(found) == 1
        told += found
    assert told[2] < 10.0 < told[0] < 12.0, "the more that agree, the less is left of the prior of hand-held antennas"
    assert told[1] > max(14.0, 1.5 * told[0])
    stated = await draft(client)
    assert (await bring(client, stated, "lat,lon,bearing_deg,sigma_deg\n50.6,7.2,40,9\n")).status_code == 201
    assert [b.sigma_deg for b in await facts(services, stated, "bearing_measured")] == [9.0]


async def test_what_does_not_belong_to_the_search_is_refused_whole(client, services):
    mission_id = await draft(client)
    far = f"lat,lon,bearing_deg\n50.6,7.2,{bearing_deg(7.2, 50.6)}\n10.0,10.0,5\n"
    many = "lat,lon,bearing_deg\n" + "50.6,7.2,45\n" * 201
    for text, code in (
        (kraken(100_000_000.0), "heard_elsewhere"),
        (far, "recording_too_far"),
        (many, "recording_too_long"),
        ("lat,lon,bearing_deg\nnorth,7.2,45\n", "nothing_usable"),
    ):
        reply = await bring(client, mission_id, text)
        assert (reply.status_code, reply.json()["reason"]["code"]) == (422, code)
    assert await facts(services, mission_id, "bearing_measured") == []


@pytest.mark.parametrize("at_s", ["1e300", "inf", "nan", "9e9", "-1"])
async def test_a_time_that_cannot_be_is_no_time(client, services, at_s):
    mission_id = await draft(client)
    bearings = f"2,rot.csv,{bearing_deg(7.2, 50.6)},0.5,50.6,7.2,10.0,110.0,1684766889.8,{at_s}"
    turn = "heading_deg,power_db,time,lat,lon\n" + "\n".join(
        f"{n + 0.5},{-60 - n % 180},{at_s},50.6,7.2" for n in range(0, 360, 5)
    )
    for text in (bearings, turn):
        reply = await bring(client, mission_id, text)
        assert reply.status_code == 201, reply.text
    (imported, _) = await facts(services, mission_id, "recording_imported")
    assert imported.recorded_at_utc is None
    assert {one.taken_at_s for one in await facts(services, mission_id, "bearing_measured")} == {None}


async def test_a_file_of_mistakes_is_told_briefly(client, services):
    """Its remarks are a fact, and every page that shows the mission loads it."""
    mission_id = await draft(client)
    text = f"lat,lon,bearing_deg\n50.6,7.2,{bearing_deg(7.2, 50.6)}\n" + "north,7.2,45\n" * 3000
    told = (await bring(client, mission_id, text)).json()
    assert len(told["sweeps"]) == 1
    assert len(told["remarks"]) == 51
    assert (told["remarks"][-1]["code"], told["remarks"][-1]["remarks"]) == ("remarks_not_listed", 2950)
    tags = "\n".join(f"{n:0100},rot.csv,45,0.5,50.6,7.2,10.0,110.0,1684766889.8,1684767153.8" for n in range(500))
    refused = (await bring(client, mission_id, tags)).json()["reason"]
    assert (refused["code"], len(refused["tags"]), max(map(len, refused["tags"]))) == ("one_tag_only", 21, 60)


async def test_a_cell_without_end_is_no_table(client):
    mission_id = await draft(client)
    reply = await bring(client, mission_id, "lat,lon,bearing_deg\n50.6,7.2," + "4" * 200_000)
    assert (reply.status_code, reply.json()["reason"]["code"]) == (422, "file_unusable")


async def test_a_place_or_an_offset_beside_bearings_is_said_to_change_nothing(client):
    for said in ({"lat": 50.6, "lon": 7.2}, {"offset_deg": 10.0}):
        told = (await bring(client, await draft(client), kraken(), **said)).json()
        assert [(remark["code"], remark["about"]) for remark in told["remarks"]] == [
            ("import_remark", "bearings_stand")
        ]
        assert [round(one["bearing_deg"]) for one in told["sweeps"]] == [round(bearing_deg(*place)) for place in PLACES]


async def test_of_several_emitters_the_file_or_whoever_sends_it_says_which(client, services):
    """A bearing of one counted for another would be believed."""
    emitters = [{"emitter_id": f"e{n}", "frequency_hz": 868.1e6 + n * 200e3} for n in (0, 1)]
    mission_id = await draft(client, emitters=emitters)
    plain = f"lat,lon,bearing_deg\n50.6,7.2,{bearing_deg(7.2, 50.6)}\n"
    refused = await bring(client, mission_id, plain)
    assert (refused.status_code, refused.json()["reason"]["code"]) == (422, "which_emitter")
    assert (await bring(client, mission_id, plain, emitter_id="e0")).status_code == 201
    assert (await bring(client, mission_id, kraken())).status_code == 201
    heard = [fact.emitter_id for fact in await facts(services, mission_id, "bearing_measured")]
    assert heard == ["e0", *["e1"] * 4]


async def test_bearings_of_another_frequency_are_left_out_and_named(client, services):
    mission_id = await draft(client)
    mixed = kraken() + "\n" + kraken(100_000_000.0)
    told = (await bring(client, mission_id, mixed)).json()
    assert len(told["sweeps"]) == 4
    assert [remark["code"] for remark in told["remarks"]] == ["other_frequency"]
