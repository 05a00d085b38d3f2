"""All files of a mission in one zip: for the archive, or for a colleague whose tools are not known."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

from backend.events import Recorded
from backend.version import VERSION
from backend.wire import export
from backend.wire.cot_export import cot_package
from backend.wire.mcap_export import mcap

Export = Callable[[Sequence[Recorded], export.Tracks], str | bytes]

FILES: dict[str, tuple[Export, str]] = {
    "mission.json": (export.journal_json, "everything: all events and the flown path"),
    "mission.geojson": (export.geojson, "area, path, bearings, estimate, 95 % region, for GIS programs"),
    "mission.kml": (export.kml, "the same for Google Earth"),
    "bearings.csv": (export.bearings_csv, "bearings as the UAV-RT project writes them"),
    "mission.mcap": (mcap, "a recording over time, for Foxglove and Lichtblick"),
    "tak.zip": (cot_package, "emitter, error ellipse and bearings, a data package for ATAK and WinTAK"),
}


SCHEMA = "crossfix bundle"
SCHEMA_VERSION, WITHOUT_WAYS = 2, 1
"""A bundle without ways is as it was, and can be brought in by a Crossfix of before."""
MANIFEST, SWEEPS, TRACKS, WAYS = "bundle.json", "sweeps.jsonl", "tracks.jsonl", "ways.geojson"
RAW: dict[str, str] = {
    MANIFEST: "which schema the bundle has; Crossfix opens it as a mission",
    SWEEPS: "the power of each sweep, sample by sample, a line each (samples: zlib of three rows of float64)",
    TRACKS: "the flown path of each craft with all that was kept of it, a line each",
    WAYS: "roads, paths and barriers that were uploaded, where there are any",
}
"""What another installation needs besides mission.json for the same review."""


def bundle(
    recorded: Sequence[Recorded], tracks: export.Tracks, raw: Mapping[str, bytes] = MappingProxyType({})
) -> bytes:
    """The zip; the same mission gives the same bytes. raw: the files SWEEPS, TRACKS and, where there are
    ways, WAYS, as the store writes them."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        words_of = {name: words for name, (_, words) in FILES.items()} | RAW
        if WAYS not in raw:
            del words_of[WAYS]
        contents = "".join(f"{name:16} {words}\n" for name, words in words_of.items())
        notice = "Positions are WGS84, bearings degrees clockwise from true north, times UTC."
        _add(archive, "README.txt", f"A mission of crossfix {VERSION}.\n{notice}\n\n{contents}")
        for name, (make, _) in FILES.items():
            _add(archive, name, make(recorded, tracks))
        manifest = {
            "schema": SCHEMA,
            "version": SCHEMA_VERSION if WAYS in raw else WITHOUT_WAYS,
            "software": f"crossfix {VERSION}",
            "mission_id": recorded[0].mission_id,
            "events": len(recorded),
        }
        _add(archive, MANIFEST, json.dumps(manifest, indent=1))
        for name in (SWEEPS, TRACKS):
            _add(archive, name, raw.get(name, b""))
        if WAYS in raw:
            _add(archive, WAYS, raw[WAYS])
    return stream.getvalue()


def _add(archive: zipfile.ZipFile, name: str, content: str | bytes) -> None:
    entry = zipfile.ZipInfo(name, date_time=(2020, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_STORED if name.endswith((".zip", ".mcap")) else zipfile.ZIP_DEFLATED
    archive.writestr(entry, content)
