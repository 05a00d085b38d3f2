"""The IQ of imported recordings: kept as it came, offered as SigMF, bounded, and gone with its mission."""

from __future__ import annotations

import io
import tarfile
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import numpy as np
import pytest
import sigmf
from recorded_turn import turn_sigmf

from backend.store.engine import engine_for_once
from backend.store.iq_folder import IqFolder
from backend.store.retention import bury, thin_iq
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.sdr.sigmf_file import load_sigmf
from hardware.sdr.sigmf_names import ARCHIVE, DATA, META

AREA = {"type": "Polygon", "coordinates": [[[7.2, 50.6], [7.21, 50.6], [7.21, 50.61], [7.2, 50.61], [7.2, 50.6]]]}


@pytest.fixture
async def mission_id(client: httpx.AsyncClient) -> str:
    spec = {"name": "IQ", "area": AREA, "emitters": [{"frequency_hz": 868.3e6}]}
    return (await client.post("/api/missions", json=spec)).json()["mission_id"]


@pytest.fixture(scope="module")
def turn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return turn_sigmf(tmp_path_factory.mktemp("turn"))


async def send(client: httpx.AsyncClient, mission_id: str, *files: Path) -> dict[str, object]:
    parts = [("files", (file.name, file.read_bytes())) for file in files]
    answer = await client.post(f"/api/missions/{mission_id}/recordings", files=parts)
    assert answer.status_code in (200, 201), answer.text
    return answer.json()


async def exported(client: httpx.AsyncClient, mission_id: str) -> httpx.Response:
    return await client.get(f"/api/missions/{mission_id}/export/sigmf")


async def test_what_was_imported_as_sigmf_is_exported_as_sigmf(client, mission_id, turn, tmp_path):
    assert (await send(client, mission_id, turn, turn.with_suffix(DATA)))["iq_kept"] is True
    size = turn.stat().st_size + turn.with_suffix(DATA).stat().st_size
    assert (await client.get(f"/api/missions/{mission_id}")).json()["iq_bytes"] == size
    (listed,) = (await client.get("/api/missions")).json()["missions"]
    assert listed["iq_bytes"] == size
    answer = await exported(client, mission_id)
    assert (answer.status_code, answer.headers["content-type"]) == (200, "application/x-tar")
    assert int(answer.headers["content-length"]) == len(answer.content)
    with tarfile.open(fileobj=io.BytesIO(answer.content)) as archive:
        name = f"crossfix-{mission_id}-0"
        assert archive.getnames() == [name, f"{name}/{name}{META}", f"{name}/{name}{DATA}"]
        meta, data = (archive.extractfile(f"{name}/{name}{ending}") for ending in (META, DATA))
        assert meta is not None
        assert data is not None
        assert meta.read() == turn.read_bytes()
        assert data.read() == turn.with_suffix(DATA).read_bytes()
    whole = tmp_path / f"whole{ARCHIVE}"
    whole.write_bytes(answer.content)
    again = load_sigmf(whole)  # which judges it by the schema of SigMF
    kept = again.samples.part(0, again.samples.size)
    assert np.array_equal(kept, np.fromfile(turn.with_suffix(DATA), np.complex64))
    assert len(again.azimuths) == 40


async def test_an_archive_comes_out_as_what_was_in_it_and_twice_is_once(client, mission_id, turn, tmp_path):
    whole = tmp_path / f"turn{ARCHIVE}"
    recording = sigmf.fromfile(str(turn))
    assert isinstance(recording, sigmf.SigMFFile)
    recording.archive(str(whole))
    for _ in range(2):
        assert (await send(client, mission_id, whole))["iq_kept"] is True
    once = await exported(client, mission_id)
    await send(client, mission_id, turn, turn.with_suffix(DATA))
    twice = await exported(client, mission_id)
    with tarfile.open(fileobj=io.BytesIO(once.content)) as archive:
        assert len(archive.getnames()) == 3
    with tarfile.open(fileobj=io.BytesIO(twice.content)) as archive:
        assert len(archive.getnames()) == 6
        contents = [archive.extractfile(m) for m in archive.getmembers() if m.name.endswith(DATA)]
        assert {found.read() for found in contents if found} == {turn.with_suffix(DATA).read_bytes()}


async def test_where_no_iq_was_kept_the_export_says_so(client, mission_id, tmp_path):
    table = tmp_path / "turn.csv"
    gains = load_pattern(SMALL_YAGI).gain_at(70.0 - np.arange(0.0, 360.0, 4.0))
    rows = [f"{4 * k},{-60 + gain:.2f}" for k, gain in enumerate(gains)]
    table.write_text("\n".join(["heading_deg,power_db", *rows]))
    parts = [("files", (table.name, table.read_bytes()))]
    words = {"lat": "50.605", "lon": "7.205"}
    answer = await client.post(f"/api/missions/{mission_id}/recordings", files=parts, data=words)
    assert answer.json()["iq_kept"] is False, answer.text
    refused = await exported(client, mission_id)
    assert (refused.status_code, refused.json()["reason"]["code"]) == (404, "iq_not_kept")
    assert (await client.get(f"/api/missions/{mission_id}")).json()["iq_bytes"] == 0
    assert (await exported(client, "unknown")).json()["reason"]["code"] != "iq_not_kept"


def laid(folder: Path, *names: str) -> Path:
    folder.mkdir()
    for name in names:
        (folder / name).write_bytes(b"12345678")
    return folder


def test_what_finds_no_room_or_is_no_pair_is_not_kept(tmp_path):
    pair = laid(tmp_path / "pair", f"recording{META}", f"recording{DATA}")
    half = laid(tmp_path / "half", f"recording{META}")
    broken = laid(tmp_path / "broken", f"recording{ARCHIVE}")
    assert not IqFolder(tmp_path / "iq", most_bytes=15).keep("m", "r", pair)
    assert not IqFolder(tmp_path / "iq", reserve_bytes=2**62).keep("m", "r", pair)
    folder = IqFolder(tmp_path / "iq")
    assert not folder.keep("m", "r", half)
    assert not folder.keep("m", "r", broken)
    assert folder.of("m") == []
    assert folder.keep("m", "r", pair)
    assert [one.size_bytes for one in folder.of("m")] == [16]
    assert not IqFolder(tmp_path / "iq", most_bytes=23).keep("m", "other", pair), "8 bytes are there already"


def test_an_archive_with_names_that_lead_elsewhere_writes_nowhere_else(tmp_path):
    upload = tmp_path / "upload"
    upload.mkdir()
    with tarfile.open(upload / f"recording{ARCHIVE}", "w") as archive:
        for name in (f"../../{'x'}{META}", f"/etc/x{DATA}"):
            entry = tarfile.TarInfo(name)
            entry.size = 4
            archive.addfile(entry, io.BytesIO(b"1234"))
        link = tarfile.TarInfo(f"link{DATA}")
        link.type, link.linkname = tarfile.SYMTYPE, "/etc/passwd"
        archive.addfile(link)
    folder = IqFolder(tmp_path / "iq")
    assert folder.keep("m", "r", upload)
    (kept,) = folder.of("m")
    assert (kept.meta.read_bytes(), kept.data.read_bytes()) == (b"1234", b"1234")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["iq", "upload"]


async def test_iq_stays_with_its_mission_and_goes_with_it(client, mission_id, turn, settings, services):
    await send(client, mission_id, turn, turn.with_suffix(DATA))
    engine = engine_for_once(settings.async_database_url, 5.0)
    late = datetime.now(UTC) + timedelta(days=400)
    try:
        assert await thin_iq(engine, services.iq, 1.0, late) == [], "it never ended"
        assert (await client.delete(f"/api/missions/{mission_id}")).status_code == 204
        assert await thin_iq(engine, services.iq, None, late) == [], "it can be restored"
        assert await bury(engine, 30.0, late) == 1
        assert await thin_iq(engine, services.iq, None, late) == [mission_id]
    finally:
        await engine.dispose()
    assert services.iq.kept().number == 0
