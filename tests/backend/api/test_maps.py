"""Maps and overlays over HTTP: streamed in, ranged out, every refusal a problem with a remedy."""

from __future__ import annotations

import io
from dataclasses import replace

import httpx
import pytest
from fastapi import FastAPI
from narrowing import known
from PIL import Image
from pmtiles.reader import Reader
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

from backend.settings import Settings

AREA = {
    "type": "Polygon",
    "coordinates": [[[7.20, 50.62], [7.21, 50.62], [7.21, 50.63], [7.20, 50.63], [7.20, 50.62]]],
}
GEOJSON = b'{"type": "Feature", "properties": {"name": "nest"}, "geometry": {"type": "Point", "coordinates": [7, 50]}}'


def archive_bytes(zoom: int = 14) -> bytes:
    picture, archive = io.BytesIO(), io.BytesIO()
    Image.new("RGB", (256, 256), (90, 140, 90)).save(picture, "PNG")
    writer = Writer(archive)
    for x in range(8516, 8524):
        for y in range(5508, 5516):
            writer.write_tile(zxy_to_tileid(zoom, x, y), picture.getvalue())
    header = {"tile_type": TileType.PNG, "tile_compression": Compression.NONE}
    box = {"min_lon_e7": 71_000_000, "min_lat_e7": 505_500_000, "max_lon_e7": 72_900_000, "max_lat_e7": 506_700_000}
    writer.finalize({**header, **box}, {"attribution": "somebody"})
    return archive.getvalue()


@pytest.fixture
async def uploaded(client: httpx.AsyncClient) -> dict:
    reply = await client.post("/api/maps", params={"filename": "C:\\maps\\Westerwald.pmtiles"}, content=archive_bytes())
    assert reply.status_code == 201, reply.text
    return reply.json()


def assert_problem(reply, status: int, words: str) -> None:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"] == "application/problem+json"
    problem = reply.json()
    assert words in problem["detail"]
    assert problem["remedy"] or status == 404


async def test_an_uploaded_map_is_listed_described_and_deleted(client: httpx.AsyncClient, uploaded: dict) -> None:
    assert uploaded["name"] == "Westerwald"
    assert uploaded["attribution"] == "somebody"
    listed = (await client.get("/api/maps")).json()
    assert listed["maps"] == [uploaded]
    assert listed["room_bytes"] > 0
    assert (await client.get(f"/api/maps/{uploaded['map_id']}")).json() == uploaded
    assert (await client.delete(f"/api/maps/{uploaded['map_id']}")).status_code == 204
    assert (await client.get("/api/maps")).json()["maps"] == []
    assert_problem(await client.delete(f"/api/maps/{uploaded['map_id']}"), 404, "There is no map")


async def test_tiles_are_read_by_ranges_as_the_pmtiles_client_does(client: httpx.AsyncClient, uploaded: dict) -> None:
    url, whole = f"/api/maps/{uploaded['map_id']}/tiles.pmtiles", archive_bytes()
    asked: list[tuple[int, int]] = []

    def note(offset: int, length: int) -> bytes:
        asked.append((offset, length))
        return whole[offset : offset + length]

    assert known(Reader(note).get(14, 8519, 5512)).startswith(b"\x89PNG")
    for offset, length in asked:
        reply = await client.get(url, headers={"Range": f"bytes={offset}-{offset + length - 1}"})
        assert reply.status_code == 206
        assert reply.headers["etag"] == f'"{uploaded["map_id"]}"'
        assert reply.content == whole[offset : offset + length]


async def test_a_range_is_cut_at_the_end_and_refused_beyond(client: httpx.AsyncClient, uploaded: dict) -> None:
    url, whole = f"/api/maps/{uploaded['map_id']}/tiles.pmtiles", archive_bytes()
    assert (await client.get(url)).content == whole
    reply = await client.get(url, headers={"Range": f"bytes={len(whole) - 3}-{len(whole) + 1000}"})
    assert (reply.status_code, reply.content) == (206, whole[-3:])
    assert reply.headers["content-range"] == f"bytes {len(whole) - 3}-{len(whole) - 1}/{len(whole)}"
    reply = await client.get(url, headers={"Range": f"bytes={len(whole)}-{len(whole) + 10}"})
    assert reply.status_code == 416
    assert reply.headers["content-range"].endswith(f"/{len(whole)}")


async def test_coverage_of_an_area(client: httpx.AsyncClient, uploaded: dict) -> None:
    found = (await client.post("/api/maps/coverage", json={"area": AREA})).json()
    assert found["covered"] is True
    assert found["maps"][0]["full_to_zoom"] == 14
    elsewhere = {"type": "Polygon", "coordinates": [[[0, 0], [0.01, 0], [0.01, 0.01], [0, 0]]]}
    found = (await client.post("/api/maps/coverage", json={"area": elsewhere})).json()
    assert (found["covered"], found["fraction"]) == (False, 0.0)
    assert found["missing"]["type"] == "MultiPolygon"
    crossing = {"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0], [0, 2], [0, 0]]]}
    assert_problem(await client.post("/api/maps/coverage", json={"area": crossing}), 422, "crosses itself")


async def test_layers_for_the_page(client: httpx.AsyncClient, uploaded: dict) -> None:
    layers = (await client.get(f"/api/maps/{uploaded['map_id']}/layers", params={"theme": "dark"})).json()
    assert layers["source"]["tileSize"] == 256
    assert layers["layers"][0]["source"] == layers["source_id"]


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"", "empty"), (b"<html>", "web page"), (archive_bytes()[:500], "less than it states")],
)
async def test_a_bad_file_is_refused_and_nothing_kept(
    client: httpx.AsyncClient, settings: Settings, content: bytes, words: str
) -> None:
    assert_problem(await client.post("/api/maps", content=content), 422, words)
    assert list((settings.data_dir / "maps").iterdir()) == []


async def test_a_file_larger_than_the_disk_is_refused(
    client: httpx.AsyncClient, app: FastAPI, settings: Settings
) -> None:
    full = settings.model_copy(update={"disk_low_bytes": 2**60})
    app.state.services = replace(app.state.services, settings=full)
    assert_problem(await client.post("/api/maps", content=archive_bytes()), 413, "does not fit")


async def test_a_damaged_map_does_not_take_the_list_along(
    client: httpx.AsyncClient, uploaded: dict, settings: Settings
) -> None:
    (settings.data_dir / "maps" / "0123456789abcdef.pmtiles").write_bytes(b"damaged")
    (settings.data_dir / "maps" / "0123456789abcdef.json").write_text("{}")
    listed = (await client.get("/api/maps")).json()
    assert listed["maps"] == [uploaded]
    assert listed["unusable"]


async def test_the_small_basemap_is_sent_as_it_lies(client: httpx.AsyncClient) -> None:
    reply = await client.get("/api/basemap")
    assert reply.headers["content-encoding"] == "gzip"
    assert int(reply.headers["content-length"]) < 150_000
    assert set(reply.json()) == {"scale", "land", "lakes", "rivers", "towns"}


async def test_overlays(client: httpx.AsyncClient) -> None:
    reply = await client.post("/api/overlays", params={"name": "Nests"}, content=GEOJSON)
    assert reply.status_code == 201
    overlay = reply.json()
    assert (await client.get("/api/overlays")).json() == {"overlays": [overlay], "unusable": []}
    collection = (await client.get(f"/api/overlays/{overlay['overlay_id']}")).json()
    assert collection["features"][0]["properties"] == {"name": "nest"}
    assert (await client.delete(f"/api/overlays/{overlay['overlay_id']}")).status_code == 204
    assert_problem(await client.get(f"/api/overlays/{overlay['overlay_id']}"), 404, "There is no overlay")


async def test_overlays_that_cannot_be_read(client: httpx.AsyncClient) -> None:
    assert_problem(await client.post("/api/overlays", content=b"lat,lon\n1,2"), 422, "it is something else")
    assert_problem(await client.post("/api/overlays", content=b"<" * 21_000_000), 413, "at most")
    assert (await client.get("/api/overlays")).json() == {"overlays": [], "unusable": []}
