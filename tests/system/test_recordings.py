"""Recordings imported over a real server: the journal, the belief and the raw sweep as after a flown one."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from console import Console

from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sdr.sigmf_file import Azimuth, write_sigmf

pytestmark = pytest.mark.system

REAL = Path(__file__).parents[3] / "shared" / "data" / "uavrt_rotation_example.csv"
RATE_HZ = 8000.0


def square(place: Place, side_m: float) -> dict[str, Any]:
    frame, half = LocalFrame(place), side_m / 2.0
    corners = [frame.to_geo(x * half, y * half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]
    return {"type": "Polygon", "coordinates": [[(c.lon, c.lat) for c in corners]]}


async def drafted(operator: Console, **changes: Any) -> dict[str, Any]:
    spec = (await operator.client.get("/api/defaults")).json()["spec"] | changes
    return (await operator.client.post("/api/missions", json=spec)).json()


async def sent(operator: Console, mission_id: str, *files: Path, **words: Any) -> httpx.Response:
    parts = [("files", (file.name, file.read_bytes())) for file in files]
    return await operator.client.post(f"/api/missions/{mission_id}/recordings", files=parts, data=words)


async def events(operator: Console, mission_id: str) -> list[dict[str, Any]]:
    return (await operator.client.get(f"/api/missions/{mission_id}/events")).json()["events"]


def plain(path: Path, bearing_deg: float, seed: int) -> Path:
    heading = np.arange(0.0, 360.0, 4.0)
    power = load_pattern(SMALL_YAGI).gain_at(bearing_deg - heading) - 60.0
    power += np.random.default_rng(seed).normal(0.0, 0.7, power.size)
    rows = [f"{h},{p:.2f}" for h, p in zip(heading, power, strict=True)]
    path.write_text("\n".join(["heading_deg,power_db", *rows, "ninety,-60", "12,nan"]))
    return path


PLACES = ((-120.0, 20.0), (130.0, 30.0), (0.0, 10.0), (-60.0, 180.0), (120.0, 170.0), (-40.0, 60.0))
"""As many as a search needs that knows nothing of the compass, nor of outliers."""


async def test_recordings_become_bearings_and_a_belief_of_a_draft(operator: Console, tmp_path: Path) -> None:
    home = Place(50.6234, 7.2046)
    frame, emitter = LocalFrame(home), (40.0, 110.0)
    mission_id = operator.mission_id
    answers = []
    for k, (x, y) in enumerate(PLACES):
        place = frame.to_geo(x, y)
        bearing = math.degrees(math.atan2(emitter[0] - x, emitter[1] - y)) % 360.0
        file = plain(tmp_path / f"turn{k}.csv", bearing, k)
        words = {"lat": place.lat, "lon": place.lon, "at_utc": f"2026-05-01T10:0{k}:00Z"}
        answer = await sent(operator, mission_id, file, **words)
        assert answer.status_code == 201, answer.text
        answers.append((file, words, answer.json()))
        assert answer.json()["sweeps"][0]["bearing_deg"] == pytest.approx(bearing, abs=3.0)
        assert [r["line"] for r in answer.json()["remarks"][:2]] == [92, 93]
    mission = (await operator.client.get(f"/api/missions/{mission_id}")).json()
    assert (mission["phase"], mission["bearings"], mission["localized"]) == ("ready", len(PLACES), True)
    (estimate,) = [emitter["estimate"] for emitter in mission["found"]]
    found = frame.to_enu(Place(estimate["lat"], estimate["lon"]))
    assert math.dist(found, emitter) < 15.0
    told = await events(operator, mission_id)
    kinds = [e["event"]["kind"] for e in told]
    ours = kinds[kinds.index("recording_imported") :]
    assert ours == ["recording_imported", "bearing_measured", "belief_updated"] * len(PLACES)
    await operator.until(lambda: len(operator.of("belief_updated")) == len(PLACES))
    belief = await operator.client.get(f"/api/missions/{mission_id}/beliefs")
    assert belief.status_code == 200
    sweep_id = answers[1][2]["sweeps"][0]["sweep_id"]
    raw = (await operator.client.get(f"/api/missions/{mission_id}/sweeps/{sweep_id}")).json()
    assert raw["began_at_utc"].startswith("2026-05-01T10:01:00")
    assert len(raw["power_db"]) == 90
    file, words, first = answers[0]
    again = await sent(operator, mission_id, file, **words)
    assert (again.status_code, again.json()["already"]) == (200, True)
    assert again.json()["sweeps"] == first["sweeps"]
    assert len(await events(operator, mission_id)) == len(told)


async def test_imported_bearings_are_flown_with_and_a_flying_mission_takes_more(
    operator: Console, tmp_path: Path
) -> None:
    frame = LocalFrame(Place(50.6234, 7.2046))
    place, mission_id = frame.to_geo(-120.0, 20.0), operator.mission_id
    file = plain(tmp_path / "turn.csv", 30.0, 1)
    words = {"lat": place.lat, "lon": place.lon}
    imported = await sent(operator, mission_id, file, **words, frequency_hz=868.3e6)
    assert imported.status_code == 201
    assert imported.json()["remarks"][-2]["code"] == "not_iq"
    await operator.start()
    await operator.until_event("plan_chosen")
    beliefs = operator.of("belief_updated")
    assert [b["event"]["bearings"] for b in beliefs] == [1, 1]
    assert operator.of("plan_chosen")[0]["event"]["place_number"] == 2
    place_number = operator.of("plan_chosen")[-1]["event"]["place_number"]
    another = await sent(operator, mission_id, plain(tmp_path / "other.csv", 40.0, 2), **words)
    assert another.status_code == 201, another.text
    sources = [e["event"]["source"]["kind"] for e in operator.of("bearing_measured")]
    await operator.until(lambda: operator.of("belief_updated")[-1]["event"]["bearings"] >= 2)
    assert sources[:1] == ["import"]
    reached = await operator.until_event("place_reached")
    assert reached["place_number"] == place_number


@pytest.mark.skipif(not REAL.exists(), reason="no real recording on this machine")
async def test_a_real_rotation_is_read_end_to_end(operator: Console) -> None:
    there = Place(35.1779665, -111.65683)
    draft = await drafted(operator, area=square(there, 800.0), name="Flagstaff")
    answer = await sent(operator, draft["mission_id"], REAL)
    assert answer.status_code == 201, answer.text
    (sweep,) = answer.json()["sweeps"]
    assert sweep["accepted"]
    assert sweep["bearing_deg"] == pytest.approx(197.6, abs=3.0 * sweep["sigma_deg"])
    assert sweep["place"]["lat"] == pytest.approx(there.lat, abs=1e-6)
    remarks = answer.json()["remarks"]
    assert [r["line"] for r in remarks if r.get("cell") == "-9999"] == [32, 94, 177, 178, 180]
    assert all(r["file"] == REAL.name for r in remarks)
    wrong = await sent(operator, operator.mission_id, REAL)
    assert wrong.status_code == 422
    assert wrong.json()["reason"]["code"] == "recording_too_far"


async def test_iq_of_a_turn_is_imported_with_its_headings(operator: Console, tmp_path: Path) -> None:
    t = np.arange(int(12.0 * RATE_HZ)) / RATE_HZ
    gain_db = load_pattern(SMALL_YAGI).gain_at(70.0 - 30.0 * t)
    noise = np.random.default_rng(1).normal(size=(2, t.size)) * 1e-4
    iq = 10.0 ** (gain_db / 20.0 - 1.0) * np.exp(2j * np.pi * 900.0 * t) + noise[0] + 1j * noise[1]
    azimuths = [Azimuth(int(s * RATE_HZ), 0, 30.0 * s % 360.0) for s in np.arange(0.0, 12.0, 0.1)]
    here = Place(50.6236, 7.2050)
    meta = write_sigmf(tmp_path / "t", iq.astype(np.complex64), RATE_HZ, 868.2991e6, 1.78e9, azimuths, here)
    answer = await sent(operator, operator.mission_id, meta.with_suffix(".sigmf-data"), meta)
    assert answer.status_code == 201, answer.text
    assert answer.json()["sweeps"][0]["bearing_deg"] == pytest.approx(70.0, abs=1.5)
    alone = await sent(operator, operator.mission_id, meta)
    assert alone.status_code == 422
    assert alone.json()["reason"]["code"] == "sigmf_file_missing"


async def test_what_cannot_be_imported_leaves_nothing_behind(operator: Console, tmp_path: Path) -> None:
    mission_id, place = operator.mission_id, {"lat": 50.6236, "lon": 7.2050}
    before = await events(operator, mission_id)
    empty, text = tmp_path / "empty.csv", tmp_path / "text.csv"
    empty.write_text("")
    text.write_text("this is\nno recording\n")
    good = plain(tmp_path / "good.csv", 10.0, 3)
    for files, words, expected in (
        ((empty,), place, "file_unusable"),
        ((text,), place, "columns_unknown"),
        ((good,), {}, "place_not_stated"),
        ((good,), {"lat": 50.6}, "half_given"),
        ((good,), {"lat": 95, "lon": 7}, "lat"),
        ((good,), place | {"at_utc": "yesterday"}, "at_utc"),
        ((good,), place | {"pulse_width_s": 0.02}, "pulse_period_s"),
        ((good,), place | {"offset_deg": "left"}, "offset_deg"),
        ((good, text), place, "two_recordings"),
        ((), place, "files"),
    ):
        answer = await sent(operator, mission_id, *files, **words)
        assert answer.status_code == 422, (words, answer.text)
        assert expected in json.dumps(answer.json()), answer.text
    assert await events(operator, mission_id) == before
    assert (await sent(operator, "nobody", good, **place)).status_code == 404
