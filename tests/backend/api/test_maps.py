"""Maps and overlays over HTTP: streamed in, ranged out, every refusal a problem with a remedy."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from PIL import Image
from pmtiles.reader import Reader
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

from backend.api import maps, problems

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
        for y in range(5494, 5502):
            writer.write_tile(zxy_to_tileid(zoom, x, y), picture.getvalue())
    header = {"tile_type": TileType.PNG, "tile_compression": Compression.NONE}
    box = {"min_lon_e7": 71_000_000, "min_lat_e7": 505_500_000, "max_lon_e7": 72_900_000, "max_lat_e7": 506_700_000}
    writer.finalize({**header, **box}, {"attribution": "somebody"})
    return archive.getvalue()


@pytest.fixture
def client(tmp_path: Path) -> Iterator[TestClient]:
    app = FastAPI()
    app.include_router(maps.router)
    problems.install(app)
    app.state.services = SimpleNamespace(settings=SimpleNamespace(data_dir=tmp_path, disk_low_bytes=0))
    with TestClient(app, raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def uploaded(client: TestClient) -> dict:
    reply = client.post("/api/maps", params={"filename": "C:\\maps\\Westerwald.pmtiles"}, content=archive_bytes())
    assert reply.status_code == 201, reply.text
    return reply.json()


def assert_problem(reply, status: int, words: str) -> None:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"] == "application/problem+json"
    problem = reply.json()
    assert words in problem["detail"]
    assert problem["remedy"]


def test_an_uploaded_map_is_listed_described_and_deleted(client: TestClient, uploaded: dict) -> None:
    assert uploaded["name"] == "Westerwald"
    assert uploaded["attribution"] == "somebody"
    listed = client.get("/api/maps").json()
    assert listed["maps"] == [uploaded]
    assert listed["room_bytes"] > 0
    assert client.get(f"/api/maps/{uploaded['map_id']}").json() == uploaded
    assert client.delete(f"/api/maps/{uploaded['map_id']}").status_code == 204
    assert client.get("/api/maps").json()["maps"] == []
    assert_problem(client.delete(f"/api/maps/{uploaded['map_id']}"), 404, "There is no map")


def test_tiles_are_read_by_ranges_as_the_pmtiles_client_does(client: TestClient, uploaded: dict) -> None:
    url = f"/api/maps/{uploaded['map_id']}/tiles.pmtiles"

    def get_bytes(offset: int, length: int) -> bytes:
        reply = client.get(url, headers={"Range": f"bytes={offset}-{offset + length - 1}"})
        assert reply.status_code == 206
        assert reply.headers["etag"] == f'"{uploaded["map_id"]}"'
        return reply.content

    reader = Reader(get_bytes)
    assert reader.get(14, 8519, 5497).startswith(b"\x89PNG")
    assert reader.get(14, 0, 0) is None


def test_a_range_is_cut_at_the_end_and_refused_beyond(client: TestClient, uploaded: dict) -> None:
    url, whole = f"/api/maps/{uploaded['map_id']}/tiles.pmtiles", archive_bytes()
    assert client.get(url).content == whole
    reply = client.get(url, headers={"Range": f"bytes={len(whole) - 3}-{len(whole) + 1000}"})
    assert (reply.status_code, reply.content) == (206, whole[-3:])
    assert reply.headers["content-range"] == f"bytes {len(whole) - 3}-{len(whole) - 1}/{len(whole)}"
    reply = client.get(url, headers={"Range": f"bytes={len(whole)}-{len(whole) + 10}"})
    assert reply.status_code == 416
    assert reply.headers["content-range"].endswith(f"/{len(whole)}")


def test_coverage_of_an_area(client: TestClient, uploaded: dict) -> None:
    found = client.post("/api/maps/coverage", json={"area": AREA}).json()
    assert found["covered"] is True
    assert found["maps"][0]["full_to_zoom"] == 14
    elsewhere = {"type": "Polygon", "coordinates": [[[0, 0], [0.01, 0], [0.01, 0.01], [0, 0]]]}
    found = client.post("/api/maps/coverage", json={"area": elsewhere}).json()
    assert (found["covered"], found["fraction"]) == (False, 0.0)
    assert found["missing"]["type"] == "MultiPolygon"
    crossing = {"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0], [0, 2], [0, 0]]]}
    assert_problem(client.post("/api/maps/coverage", json={"area": crossing}), 422, "not a valid polygon")


def test_layers_for_the_page(client: TestClient, uploaded: dict) -> None:
    layers = client.get(f"/api/maps/{uploaded['map_id']}/layers", params={"theme": "dark"}).json()
    assert layers["source"]["tileSize"] == 256
    assert layers["layers"][0]["source"] == layers["source_id"]


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"", "empty"), (b"<html>", "web page"), (archive_bytes()[:500], "incomplete")],
)
def test_a_bad_file_is_refused_and_nothing_kept(client: TestClient, tmp_path: Path, content: bytes, words: str) -> None:
    assert_problem(client.post("/api/maps", content=content), 422, words)
    assert list((tmp_path / "maps").iterdir()) == []


def test_a_file_larger_than_the_disk_is_refused_before_it_is_sent(client: TestClient, tmp_path: Path) -> None:
    client.app.state.services.settings.disk_low_bytes = 2**60
    assert_problem(client.post("/api/maps", content=archive_bytes()), 413, "does not fit")
    client.app.state.services.settings.disk_low_bytes = 0


def test_a_damaged_map_does_not_take_the_list_along(client: TestClient, uploaded: dict, tmp_path: Path) -> None:
    (tmp_path / "maps" / "0123456789abcdef.pmtiles").write_bytes(b"damaged")
    (tmp_path / "maps" / "0123456789abcdef.json").write_text("{}")
    listed = client.get("/api/maps").json()
    assert listed["maps"] == [uploaded]
    assert listed["unusable"]


def test_overlays(client: TestClient) -> None:
    reply = client.post("/api/overlays", params={"name": "Nests"}, content=GEOJSON)
    assert reply.status_code == 201
    overlay = reply.json()
    assert client.get("/api/overlays").json() == {"overlays": [overlay]}
    collection = client.get(f"/api/overlays/{overlay['overlay_id']}").json()
    assert collection["features"][0]["properties"] == {"name": "nest"}
    assert client.delete(f"/api/overlays/{overlay['overlay_id']}").status_code == 204
    assert_problem(client.get(f"/api/overlays/{overlay['overlay_id']}"), 404, "There is no overlay")


def test_overlays_that_cannot_be_read(client: TestClient) -> None:
    assert_problem(client.post("/api/overlays", content=b"lat,lon\n1,2"), 422, "neither GeoJSON nor KML")
    assert_problem(client.post("/api/overlays", content=b"<" * 21_000_000), 413, "at most 20 MB")
    assert client.get("/api/overlays").json() == {"overlays": []}
