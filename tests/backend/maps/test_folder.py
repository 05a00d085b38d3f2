"""A map is in the folder completely or not at all."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator
from datetime import UTC, datetime
from pathlib import Path

import pytest

from backend.maps import upload as upload_module
from backend.maps.folder import MapFolder
from backend.maps.refusal import MapRefused, NotStored
from backend.reasons.maps import MapLabelDamaged, NotAnArchive, PutByHand
from backend.workers import Workers

NOW = datetime(2026, 5, 1, 12, tzinfo=UTC)


async def pieces(content: bytes, size: int = 1000) -> AsyncIterator[bytes]:
    for start in range(0, len(content), size):
        yield content[start : start + size]


@pytest.fixture
def folder(tmp_path: Path) -> MapFolder:
    return MapFolder(tmp_path / "maps", reserve_bytes=0)


def files(folder: MapFolder) -> list[str]:
    return sorted(path.name for path in folder.directory.iterdir())


async def test_what_is_stored_is_listed_and_byte_for_byte_the_same(
    folder: MapFolder, make_archive, workers: Workers
) -> None:
    content = make_archive(
        [(3, 4, 2), (3, 4, 3)], metadata={"attribution": '<a href="x">&copy; somebody</a>'}
    ).read_bytes()
    package = await folder.store(pieces(content), "Westerwald", len(content), NOW, workers)
    assert folder.packages() == ([package], [])
    assert folder.path(package.map_id).read_bytes() == content
    assert (package.name, package.kind, package.tile_type, package.min_zoom, package.max_zoom, package.tiles) == (
        "Westerwald",
        "raster",
        "png",
        3,
        3,
        2,
    )
    assert package.attribution == "© somebody"
    assert package.bounds == (7.19, 50.61, 7.22, 50.64)
    assert package.added_at_utc == NOW
    assert files(folder) == [f"{package.map_id}.json", f"{package.map_id}.pmtiles"]


async def test_the_same_file_twice_is_one_map_under_its_newest_name(
    folder: MapFolder, make_archive, workers: Workers
) -> None:
    content = make_archive().read_bytes()
    first = await folder.store(pieces(content), "one", None, NOW, workers)
    second = await folder.store(pieces(content), "two", None, NOW, workers)
    assert first.map_id == second.map_id
    assert [package.name for package in folder.packages()[0]] == ["two"]


async def test_the_archive_names_itself_when_nobody_does(folder: MapFolder, make_archive, workers: Workers) -> None:
    content = make_archive(metadata={"name": "from its metadata"}).read_bytes()
    assert (await folder.store(pieces(content), "", None, NOW, workers)).name == "from its metadata"


async def test_vector_layers_are_described(folder: MapFolder, make_archive, workers: Workers) -> None:
    metadata = {
        "vector_layers": [
            {"id": "water", "fields": {"name": "String", "depth": "Number"}, "minzoom": 0, "maxzoom": 14},
            {"no id": 1},
            "nonsense",
        ]
    }
    content = make_archive(vector=True, metadata=metadata).read_bytes()
    package = await folder.store(pieces(content), "v", None, NOW, workers)
    (layer,) = package.vector_layers
    assert (package.kind, layer.id, layer.fields, layer.max_zoom) == ("vector", "water", ["depth", "name"], 14)


async def test_nothing_is_left_of_a_refused_upload(folder: MapFolder, make_archive, workers: Workers) -> None:
    content = make_archive([(2, 1, 1), (2, 1, 2)]).read_bytes()
    for bad, announced in ((b"nonsense" * 50, None), (content[:-20], None), (content[:-20], len(content)), (b"", 0)):
        with pytest.raises(MapRefused):
            await folder.store(pieces(bad), "bad", announced, NOW, workers)
    assert files(folder) == []


async def test_nothing_is_left_of_an_upload_that_breaks_off(folder: MapFolder, make_archive, workers: Workers) -> None:
    content = make_archive().read_bytes()

    async def broken() -> AsyncIterator[bytes]:
        yield content[:50]
        raise ConnectionResetError

    with pytest.raises(ConnectionResetError):
        await folder.store(broken(), "bad", None, NOW, workers)
    assert files(folder) == []


async def test_other_files_are_refused_at_their_first_block(folder: MapFolder, workers: Workers) -> None:
    taken = 0

    async def endless() -> AsyncIterator[bytes]:
        nonlocal taken
        for _ in range(1000):
            taken += 2**20
            yield b"x" * 2**20

    with pytest.raises(MapRefused, match="not a PMTiles archive"):
        await folder.store(endless(), "bad", None, NOW, workers)
    assert taken == 2**20


async def test_the_reserve_stays_free(
    folder: MapFolder, make_archive, monkeypatch: pytest.MonkeyPatch, workers: Workers
) -> None:
    content = make_archive().read_bytes()
    full = MapFolder(folder.directory, reserve_bytes=2**60)
    assert full.room_bytes() == 0
    for announced in (len(content), None):
        with pytest.raises(MapRefused, match="does not fit"):
            await full.store(pieces(content), "big", announced, NOW, workers)
    assert files(folder) == []


async def test_a_part_file_of_a_dead_server_is_removed(folder: MapFolder, make_archive, workers: Workers) -> None:
    folder.directory.mkdir()
    old, fresh = folder.directory / ".upload-old.part", folder.directory / ".upload-fresh.part"
    old.write_bytes(b"x")
    fresh.write_bytes(b"x")
    os.utime(old, (NOW.timestamp() - 10 * upload_module.ABANDONED_S, NOW.timestamp() - 10 * upload_module.ABANDONED_S))
    os.utime(fresh, (NOW.timestamp(), NOW.timestamp()))
    await folder.store(pieces(make_archive().read_bytes()), "m", None, NOW, workers)
    assert not old.exists()
    assert fresh.exists()


async def test_a_file_put_there_by_hand_is_named_not_shown(folder: MapFolder, make_archive, workers: Workers) -> None:
    await folder.store(pieces(make_archive().read_bytes()), "good", None, NOW, workers)
    (folder.directory / "mine.pmtiles").write_bytes(b"PMTiles")
    (folder.directory / "0123456789abcdef.pmtiles").write_bytes(b"damaged")
    (folder.directory / "0123456789abcdef.json").write_text('{"name": "x", "added_at_utc": "2026-05-01T12:00:00Z"}')
    unlabelled = await folder.store(pieces(make_archive([(1, 0, 0)]).read_bytes()), "unlabelled", None, NOW, workers)
    (folder.directory / f"{unlabelled.map_id}.json").write_text("{}")
    packages, unusable = folder.packages()
    assert [package.name for package in packages] == ["good"]
    assert {found.file: found.because for found in unusable} == {
        "mine.pmtiles": PutByHand(),
        "0123456789abcdef.pmtiles": NotAnArchive(None),
        f"{unlabelled.map_id}.pmtiles": MapLabelDamaged(),
    }


async def test_a_deleted_map_is_gone(folder: MapFolder, make_archive, workers: Workers) -> None:
    package = await folder.store(pieces(make_archive().read_bytes()), "m", None, NOW, workers)
    folder.delete(package.map_id)
    assert files(folder) == []
    with pytest.raises(NotStored):
        folder.package(package.map_id)
