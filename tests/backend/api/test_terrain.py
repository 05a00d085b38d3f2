"""Terrain over HTTP: uploaded, listed, drawn, deleted; every refusal leaves nothing behind."""

from __future__ import annotations

from pathlib import Path

import httpx
import numpy as np
import pytest
from relief import geotiff

from backend.maps.terrarium import decode
from backend.settings import Settings

HEIGHTS = np.fromfunction(lambda row, column: 200.0 + 0.2 * row + 0.1 * column, (600, 700)).astype(np.float32)
FILE = geotiff(HEIGHTS, north_deg=50.7, west_deg=7.1, compressed=True, predictor=3, tile=64)


async def upload(client: httpx.AsyncClient, content: bytes = FILE, **query: str) -> httpx.Response:
    return await client.post("/api/terrain", params={"filename": "Westerwald.tif", **query}, content=content)


async def test_uploaded_terrain_is_listed_drawn_and_deleted(client: httpx.AsyncClient) -> None:
    reply = await upload(client)
    assert reply.status_code == 201, reply.text
    found = reply.json()
    assert (found["name"], found["format"]) == ("Westerwald", "geotiff")
    assert found["spacing_m"] == pytest.approx(30.9, abs=0.1)
    assert (await client.get("/api/terrain")).json()["terrains"] == [found]
    tile = await client.get("/api/terrain/tiles/13/4260/2756")
    assert tile.status_code == 200
    assert 200.0 < np.nanmedian(decode(tile.content)) < 400.0
    assert (await client.get("/api/terrain/tiles/13/10/10")).status_code == 204
    lines = (await client.get("/api/terrain/contours", params={"lat": 50.65, "lon": 7.2})).json()["features"]
    assert len(lines) > 5
    assert {line["geometry"]["type"] for line in lines} == {"MultiLineString"}
    assert (await client.delete(f"/api/terrain/{found['terrain_id']}")).status_code == 204
    assert (await client.get("/api/terrain")).json()["terrains"] == []
    assert (await client.delete(f"/api/terrain/{found['terrain_id']}")).status_code == 404


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "neither a GeoTIFF nor a PMTiles"),
        (b"PK\x03\x04 a zip", "neither a GeoTIFF nor a PMTiles"),
        (geotiff(HEIGHTS, epsg=25832), "EPSG:4326"),
        (FILE[: len(FILE) // 2], "damaged"),
        (b"PMTiles\x02" + bytes(200), "version 2"),
        (geotiff(HEIGHTS * 1000), "nowhere on earth"),
    ],
)
async def test_a_refused_upload_leaves_nothing(
    client: httpx.AsyncClient, settings: Settings, content: bytes, words: str
) -> None:
    reply = await upload(client, content)
    assert reply.status_code == 422, reply.text
    problem = reply.json()
    assert words in problem["detail"]
    assert problem["remedy"]
    assert [path.name for path in (settings.data_dir / "terrain").glob("*")] == []


async def test_the_list_survives_what_was_damaged_afterwards(client: httpx.AsyncClient, settings: Settings) -> None:
    kept = (await upload(client)).json()
    other = (await upload(client, geotiff(HEIGHTS + 1, north_deg=50.7, west_deg=7.1))).json()
    folder: Path = settings.data_dir / "terrain"
    (folder / "nonsense").write_bytes(b"\x93NUMPY nonsense")
    (folder / "nonsense").rename(folder / f"{other['terrain_id']}.npy")
    (folder / "stray.json").write_text("[]")
    listed = (await client.get("/api/terrain")).json()
    assert kept in listed["terrains"]
    assert [each["file"] for each in listed["unusable"]] == sorted([f"{other['terrain_id']}.json", "stray.json"])
    assert (await client.get("/api/terrain/tiles/13/4260/2756")).status_code == 200


async def test_the_same_file_twice_is_one(client: httpx.AsyncClient) -> None:
    await upload(client)
    await upload(client, name="again")
    assert [terrain["name"] for terrain in (await client.get("/api/terrain")).json()["terrains"]] == ["again"]
