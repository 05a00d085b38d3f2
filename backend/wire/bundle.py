"""All files of a mission in one zip: for the archive, or for a colleague whose tools are not known."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Sequence

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


def bundle(recorded: Sequence[Recorded], tracks: export.Tracks) -> bytes:
    """The zip; the same mission gives the same bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        contents = "".join(f"{name:16} {words}\n" for name, (_, words) in FILES.items())
        notice = "Positions are WGS84, bearings degrees clockwise from true north, times UTC."
        _add(archive, "README.txt", f"A mission of crossfix {VERSION}.\n{notice}\n\n{contents}")
        for name, (make, _) in FILES.items():
            _add(archive, name, make(recorded, tracks))
    return stream.getvalue()


def _add(archive: zipfile.ZipFile, name: str, content: str | bytes) -> None:
    entry = zipfile.ZipInfo(name, date_time=(2020, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_STORED if name.endswith((".zip", ".mcap")) else zipfile.ZIP_DEFLATED
    archive.writestr(entry, content)
