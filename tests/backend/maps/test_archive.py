"""Archives are read as the reference library reads them; anything else is refused with a sentence."""

from __future__ import annotations

import gzip
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pmtiles.tile import Entry, deserialize_directory, serialize_directory, write_varint

from backend.maps.archive import Archive, parse_directory, parse_varints
from backend.maps.refusal import MapRefused
from planner.reason import remedy_of


def test_has_exactly_the_tiles_that_were_written(make_archive) -> None:
    written = {(0, 0, 0), (5, 16, 10), (14, 8519, 5497), (14, 8520, 5497), (14, 8519, 5498)}
    archive = Archive(make_archive(written))
    archive.check()
    near = {(z, x + dx, y + dy) for z, x, y in written if z for dx in (-1, 0, 1) for dy in (-1, 0, 1)}
    assert {tile for tile in near | written if archive.has(*tile)} == written


def test_finds_tiles_behind_leaf_directories(make_archive) -> None:
    rng = np.random.default_rng(3)
    written = {(12, int(x), int(y)) for x, y in rng.integers(0, 4096, (30_000, 2))}
    archive = Archive(make_archive(written, contents=lambda number: str(number**2).encode()))
    assert archive.header["leaf_directory_length"] > 0
    asked = [*list(written)[:300], *((12, int(x), int(y)) for x, y in rng.integers(0, 4096, (300, 2)))]
    assert [archive.has(*tile) for tile in asked] == [tile in written for tile in asked]


def test_equal_neighbours_are_one_run(tmp_path: Path) -> None:
    entries = [Entry(5, 0, 40, 3), Entry(9, 0, 40, 1)]
    directory = parse_directory(gzip.decompress(serialize_directory(entries)))
    assert directory.run_length.tolist() == [3, 1]
    assert directory.tile_id.tolist() == [5, 9]


@given(
    st.lists(
        st.tuples(st.integers(0, 2**40), st.integers(0, 2**40), st.integers(0, 2**31), st.integers(0, 100)),
        min_size=1,
        max_size=40,
    )
)
def test_directories_read_as_the_reference_library_reads_them(rows: list[tuple[int, int, int, int]]) -> None:
    entries = [Entry(*row) for row in sorted(rows)]
    packed = serialize_directory(entries)
    theirs = deserialize_directory(packed)
    ours = parse_directory(gzip.decompress(packed))
    assert ours.tile_id.tolist() == [entry.tile_id for entry in theirs]
    assert ours.offset.tolist() == [entry.offset for entry in theirs]
    assert ours.length.tolist() == [entry.length for entry in theirs]
    assert ours.run_length.tolist() == [entry.run_length for entry in theirs]


@given(st.lists(st.integers(0, 2**62), min_size=1, max_size=50))
def test_varints_come_back(numbers: list[int]) -> None:
    stream = io.BytesIO()
    for number in numbers:
        write_varint(stream, number)
    assert parse_varints(stream.getvalue()).tolist() == numbers


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty"),
        (b"SQLite format 3\x00" + bytes(200), "MBTiles"),
        (b"\x89PNG" + bytes(200), "PNG picture"),
        (b"<html>" + bytes(200), "XML or a web page"),
        (b"PMTiles\x03" + bytes(10), "header: there is less"),
        (b"PMTiles\x02" + bytes(200), "version 2"),
        (b"PMTiles\x03" + bytes(200), "type unknown"),
        (b"PMTiles\x03" + b"\xff" * 200, "header: it cannot be read"),
    ],
)
def test_other_files_are_named_for_what_they_are(tmp_path: Path, content: bytes, words: str) -> None:
    path = tmp_path / "other.pmtiles"
    path.write_bytes(content)
    with pytest.raises(MapRefused, match=words) as refusal:
        Archive(path)
    assert remedy_of(refusal.value.reason)


def test_an_archive_cut_off_is_refused(make_archive) -> None:
    path = make_archive([(1, 0, 0), (1, 1, 0)])
    content = path.read_bytes()
    path.write_bytes(content[:-10])
    with pytest.raises(MapRefused, match="less than it states"):
        Archive(path).check()


def test_tiles_of_another_type_than_stated_are_refused(make_archive) -> None:
    path = make_archive()
    content = bytearray(path.read_bytes())
    content[99] = 3
    path.write_bytes(content)
    with pytest.raises(MapRefused, match="first tile: the picture is not of the type"):
        Archive(path).check()


def test_no_flipped_byte_makes_it_fall_over(make_archive) -> None:
    path = make_archive([(1, 0, 0), (1, 1, 0), (1, 1, 1)])
    whole = path.read_bytes()
    rng = np.random.default_rng(11)
    refused = 0
    for _ in range(300):
        content = bytearray(whole)
        content[int(rng.integers(0, min(len(whole), 400)))] = int(rng.integers(0, 256))
        path.write_bytes(content)
        try:
            archive = Archive(path)
            archive.check()
            archive.has(1, 1, 1)
        except MapRefused:
            refused += 1
    assert 0 < refused < 300


def test_tile_pixels_are_read_from_a_tile(make_archive) -> None:
    assert Archive(make_archive(side=512)).tile_pixels() == 512
    assert Archive(make_archive(name="v.pmtiles", vector=True)).tile_pixels() is None
