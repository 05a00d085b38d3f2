"""The terrain folder: uploaded heights on this machine's disk, and the ground that missions were flown over.

`ID.pmtiles` is an archive as it came; of a GeoTIFF its heights are kept as `ID.npy`, so that it is decoded once.
`ID.json` names either and says where it lies. `flown/DIGEST` is the ground of a mission. Blocking, but for `store` and
what missions ask; use threads.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path
from typing import Any

import anyio.to_thread
import numpy as np

from backend.maps.archive import HEADER_BYTES, read_header
from backend.maps.features import storable
from backend.maps.geotiff import read_geotiff
from backend.maps.refusal import MapRefused, NotStored
from backend.maps.terrain_cut import Source, around, bounds_of, whereabouts
from backend.maps.terrarium import Terrarium
from backend.maps.upload import Upload, received, replace_text, room_bytes, sync_directory
from backend.reasons import Reason
from backend.reasons.terrain import NotTerrain, TerrainLabelDamaged, TerrainTooLarge
from backend.terrain import METRES_PER_DEGREE, Terrain, TerrainDamaged, terrain_from
from backend.wire.terrain import TerrainFile
from backend.workers import Workers
from hardware.readings import Place

MOST_BYTES = 2 * 2**30
TIFF_MAGIC = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")
FLOWN = "flown"


@dataclass(frozen=True)
class TerrainFolder:
    """`reserve_bytes`: disk that no upload may take, kept for the journal."""

    directory: Path
    reserve_bytes: int

    def room_bytes(self) -> int:
        """How large an upload may be."""
        return room_bytes(self.directory, self.reserve_bytes)

    def terrains(self) -> tuple[list[TerrainFile], list[Reason]]:
        """All terrain by name, and the files that are none."""
        found: list[TerrainFile] = []
        unusable: list[Reason] = []
        for path in sorted(self.directory.glob("*.json")):
            try:
                found.append(self._described(path.stem))
            except (OSError, ValueError, KeyError, TypeError, MapRefused):
                unusable.append(TerrainLabelDamaged(path.name))
        return sorted(found, key=lambda terrain: terrain.name.casefold()), unusable

    def terrain(self, terrain_id: str) -> TerrainFile:
        """NotStored when there is none."""
        if not (self.directory / f"{terrain_id}.json").is_file():
            raise NotStored("terrain", terrain_id)
        return self._described(terrain_id)

    def delete(self, terrain_id: str) -> None:
        """What missions were flown over stays."""
        label = self.directory / f"{terrain_id}.json"
        if not label.is_file():
            raise NotStored("terrain", terrain_id)
        label.unlink()
        for suffix in ("npy", "pmtiles"):
            (self.directory / f"{terrain_id}.{suffix}").unlink(missing_ok=True)

    def sources(self) -> list[Source]:
        """Everything that can be read; what cannot is left out."""
        found: list[Source] = []
        for path in sorted(self.directory.glob("*.json")):
            try:
                found.append(self._source(path.stem))
            except (OSError, ValueError, KeyError, TypeError, MapRefused):
                continue
        return found

    async def store(
        self, body: AsyncIterator[bytes], name: str, announced_bytes: int | None, now: datetime, workers: Workers
    ) -> TerrainFile:
        """Write an upload to disk, check it, and make it terrain. MapRefused, WorkStopped: nothing is left of it."""
        async with received(body, announced_bytes, self.directory, self.reserve_bytes, _look, now) as upload:
            label = storable((name.strip() or f"Terrain {upload.content_id[:6]}")[:120])
            said = {"name": label, "added_at_utc": now.isoformat(), "size_bytes": upload.size}
            heights = upload.path.with_name(f"{upload.path.stem}-heights.part")
            try:
                said |= await workers.run(read_terrain, upload.path, label, heights)
                return await anyio.to_thread.run_sync(self._keep, upload, said, heights)
            finally:
                heights.unlink(missing_ok=True)

    def _keep(self, upload: Upload, said: dict[str, Any], heights: Path) -> TerrainFile:
        terrain_id = upload.content_id
        if said["format"] == "geotiff":
            os.replace(heights, self.directory / f"{terrain_id}.npy")
        else:
            os.replace(upload.path, self.directory / f"{terrain_id}.pmtiles")
        replace_text(self.directory / f"{terrain_id}.json", json.dumps(said))
        sync_directory(self.directory)
        return self._described(terrain_id)

    def _described(self, terrain_id: str) -> TerrainFile:
        said = json.loads((self.directory / f"{terrain_id}.json").read_text("utf-8"))
        source = self._source(terrain_id)
        box = bounds_of(source)
        middle = (box[1] + box[3]) / 2
        metres = source.step_deg(middle) * METRES_PER_DEGREE if isinstance(source, Terrarium) else source.lat_spacing_m
        return TerrainFile(
            terrain_id=terrain_id,
            name=str(said["name"]),
            format=said["format"],
            bounds=box,
            spacing_m=metres,
            size_bytes=int(said["size_bytes"]),
            added_at_utc=datetime.fromisoformat(said["added_at_utc"]),
        )

    def _source(self, terrain_id: str) -> Source:
        """Opened again when one of its files was rewritten."""
        files = [path for path in sorted(self.directory.glob(f"{terrain_id}.*")) if path.suffix != ".part"]
        return _opened(self.directory, terrain_id, tuple(path.stat().st_mtime_ns for path in files))

    # What missions ask

    async def around(self, home: Place) -> Terrain | None:
        """The ground within reach of a home, None where no terrain knows any of it."""
        return await asyncio.to_thread(self.cut, home)

    def cut(self, home: Place) -> Terrain | None:
        """The same, blocking."""
        labels = tuple((path.stem, path.stat().st_mtime_ns) for path in sorted(self.directory.glob("*.json")))
        return _cut(self, labels, *whereabouts(home))

    async def keep(self, terrain: Terrain) -> None:
        """For a mission that is about to fly over it. Raises OSError."""
        await asyncio.to_thread(self._keep_flown, terrain)

    def _keep_flown(self, terrain: Terrain) -> None:
        path = self.directory / FLOWN / terrain.digest
        if path.is_file():
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part")
        with part.open("wb") as file:
            file.write(terrain.to_bytes())
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
        sync_directory(path.parent)

    async def kept(self, digest: str) -> Terrain | None:
        """The ground that a mission was flown over, None when it is lost or no longer the same."""
        return await asyncio.to_thread(self._kept, digest)

    def _kept(self, digest: str) -> Terrain | None:
        if not re.fullmatch(r"[0-9a-f]{64}", digest):
            return None
        try:
            found = terrain_from((self.directory / FLOWN / digest).read_bytes())
        except (OSError, TerrainDamaged):
            return None
        return found if found.digest == digest else None


def read_terrain(path: Path, name: str, heights: Path) -> dict[str, Any]:
    """A file checked: its format, and of a GeoTIFF the grid, whose heights are written to `heights`. MapRefused."""
    with path.open("rb") as file:
        tiff = file.read(4) in TIFF_MAGIC
    if not tiff:
        Terrarium(path, name).check()
        return {"format": "terrarium"}
    read = read_geotiff(path, name, heights)
    return {"format": "geotiff", "grid": [read.north_deg, read.west_deg, read.lat_step_deg, read.lon_step_deg]}


def _look(first_bytes: bytes, size: int) -> None:
    """Refuse what is no terrain by its first bytes, and any file that grows too large."""
    if size > MOST_BYTES:
        raise MapRefused(TerrainTooLarge(MOST_BYTES))
    if first_bytes[:7] == b"PMTiles":
        read_header(first_bytes[:HEADER_BYTES])
    elif (first_bytes or size == 0) and first_bytes[:4] not in TIFF_MAGIC:
        raise MapRefused(NotTerrain())


@lru_cache(maxsize=2)
def _cut(folder: TerrainFolder, _labels: tuple[tuple[str, int], ...], lat: float, lon: float) -> Terrain | None:
    return around(Place(lat, lon), folder.sources())


@lru_cache(maxsize=64)
def _opened(directory: Path, terrain_id: str, _written_ns: tuple[int, ...]) -> Source:
    said = json.loads((directory / f"{terrain_id}.json").read_text("utf-8"))
    if said["format"] == "terrarium":
        return Terrarium(directory / f"{terrain_id}.pmtiles", str(said["name"]))
    heights = np.load(directory / f"{terrain_id}.npy", mmap_mode="r", allow_pickle=False)
    if heights.ndim != 2 or heights.dtype != np.float32:
        raise ValueError("not a grid of heights")
    north, west, lat_step, lon_step = (float(value) for value in said["grid"])
    return Terrain(north, west, lat_step, lon_step, heights, (str(said["name"]),))
