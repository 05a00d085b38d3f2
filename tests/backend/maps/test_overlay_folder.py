"""An overlay is stored as what can be drawn of it."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from backend.maps.overlay_folder import OverlayFolder
from backend.maps.refusal import MapRefused, NotStored
from backend.ports import Kept
from backend.reasons.maps import MoreLeftOut, NoRoomForMap, OverlayUnusable
from backend.reasons.storage import StockFull

NOW = datetime(2026, 5, 1, 12, tzinfo=UTC)
GEOJSON = b'\xef\xbb\xbf {"type": "Point", "coordinates": [7.1, 50.2]}'
KML = b"<kml><Placemark><Point><coordinates>7,50</coordinates></Point></Placemark></kml>"


@pytest.fixture
def folder(tmp_path: Path) -> OverlayFolder:
    return OverlayFolder(tmp_path / "overlays")


def test_stored_listed_read_and_deleted(folder: OverlayFolder) -> None:
    assert folder.overlays() == ([], [])
    second = folder.keep(KML, "tracks", NOW)
    first = folder.keep(GEOJSON, "Nests", NOW)
    assert folder.overlays() == ([first, second], [])
    assert (first.format, first.features, first.bounds) == ("geojson", 1, (7.1, 50.2, 7.1, 50.2))
    assert second.format == "kml"
    stored = json.loads(folder.path(first.overlay_id).read_bytes())
    assert stored["features"][0]["geometry"] == {"type": "Point", "coordinates": [7.1, 50.2]}
    folder.delete(first.overlay_id)
    assert folder.overlays() == ([second], [])
    with pytest.raises(NotStored):
        folder.path(first.overlay_id)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is empty"),
        (b"lat,lon", "something else"),
        (b'{"type": "FeatureCollection", "features": []}', "nothing that can be drawn"),
        (b'{"type": "Point", "coordinates": [1000, 2000]}', "not on Earth"),
        (b"<kml/>", "nothing that can be drawn"),
    ],
)
def test_nothing_is_kept_of_what_cannot_be_drawn(folder: OverlayFolder, content: bytes, words: str) -> None:
    with pytest.raises(MapRefused, match=words):
        folder.keep(content, "bad", NOW)
    assert folder.overlays() == ([], [])


@pytest.mark.parametrize(
    "unknown",
    ['"Feature 2 is left out."', "7", "null", "[]", "{}", '{"code": "more_left_out"}', '{"code": "of_later"}'],
)
def test_notes_that_are_no_reasons_are_dropped_and_the_others_stay(folder: OverlayFolder, unknown: str) -> None:
    stored = folder.keep(GEOJSON, "Nests", NOW)
    known = '{"code": "more_left_out", "parts": 3}'
    label = folder.directory / f"{stored.overlay_id}.json"
    label.write_text(label.read_text().replace('"notes":[]', f'"notes":[{unknown}, {known}]'))
    assert folder.overlays() == ([stored.model_copy(update={"notes": [MoreLeftOut(3)]})], [])


@pytest.mark.parametrize("damaged", [b"", b"{}", b'{"notes": 7}', b'{"notes": []}', b"[" * 100_000, b"\xff", b"null"])
def test_a_damaged_description_is_named_and_the_others_are_listed(folder: OverlayFolder, damaged: bytes) -> None:
    stored = folder.keep(GEOJSON, "Nests", NOW)
    (folder.directory / "broken.json").write_bytes(damaged)
    assert folder.overlays() == ([stored], [OverlayUnusable("broken.json")])


def test_half_a_surrogate_in_a_file_or_a_name_does_no_harm(folder: OverlayFolder) -> None:
    feature = (
        b'{"type": "Feature", "properties": {"name": "\\ud800", "\\udfff": 1},'
        b' "geometry": {"type": "Point", "coordinates": [7, 50]}}'
    )
    stored = folder.keep(feature, "nest \ud800", NOW)
    assert stored.name == "nest ?"
    assert folder.overlays() == ([stored], [])
    (read,) = json.loads(folder.path(stored.overlay_id).read_bytes())["features"]
    assert read["properties"] == {"name": "?", "?": 1}


def test_there_is_room_for_a_few_overlays_only(folder: OverlayFolder) -> None:
    first = folder.keep(GEOJSON, "Nests", NOW)
    used = folder.path(first.overlay_id).stat().st_size
    assert folder.kept() == Kept(1, used)
    for tight in (replace(folder, most_bytes=used + 10), replace(folder, most=1)):
        with pytest.raises(MapRefused) as refused:
            tight.keep(KML, "tracks", NOW)
        assert refused.value.reason == StockFull("overlays", tight.most, tight.most_bytes)
        assert folder.overlays() == ([first], [])
        again = tight.keep(GEOJSON, "Nests of May", NOW)
        assert (again.overlay_id, again.name) == (first.overlay_id, "Nests of May"), "the same file takes no more room"
        first = again


def test_an_upload_may_not_take_what_the_journal_needs(folder: OverlayFolder) -> None:
    with pytest.raises(MapRefused) as refused:
        replace(folder, reserve_bytes=2**60).keep(GEOJSON, "Nests", NOW)
    assert isinstance(refused.value.reason, NoRoomForMap)
    assert folder.overlays() == ([], [])
