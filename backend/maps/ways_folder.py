"""The ways folder: what can be gone along and what cannot be crossed, a file for each mission. Blocking; use threads.

Advice only is made of it, which nobody has to follow: it is no fact of the mission, and may be replaced at any time.
"""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

from shapely.geometry import shape

from backend.maps.overlay_folder import MOST_OVERLAY_BYTES
from backend.maps.refusal import MapRefused
from backend.maps.upload import received, replace_text
from backend.maps.ways import read_ways
from backend.reasons.request import BodyTooLarge
from backend.search.ground_ways import Traced
from backend.spec import LonLat
from backend.store.ways_files import WaysFiles
from backend.wire.ways import MissionWays
from backend.workers import Workers


@dataclass(frozen=True, slots=True)
class WaysFolder:
    """reserve_bytes: disk that no upload may take, kept for the journal."""

    files: WaysFiles
    reserve_bytes: int = 0

    def json(self, mission_id: str) -> bytes:
        """Of MissionWays, as it was stored; empty ways when there are none."""
        return self.files.content(mission_id) or MissionWays().model_dump_json().encode()

    def traced(self, mission_id: str) -> tuple[Traced, ...]:
        """Shapes; read once until they change."""
        path = self.files.path(mission_id)
        try:
            return _traced(path, path.stat().st_mtime_ns)
        except FileNotFoundError:
            return ()

    def keep(self, mission_id: str, ways: MissionWays) -> None:
        """In the place of what was there. Raises OSError."""
        self.files.directory.mkdir(parents=True, exist_ok=True)
        replace_text(self.files.path(mission_id), ways.model_dump_json())

    def forget(self, mission_id: str) -> None:
        """Nothing happens when there are none. Raises OSError."""
        self.files.forget([mission_id])

    async def store(
        self,
        mission_id: str,
        area: Sequence[LonLat],
        body: AsyncIterator[bytes],
        name: str,
        announced_bytes: int | None,
        now: datetime,
        workers: Workers,
    ) -> MissionWays:
        """Read an upload and keep what it holds in the place of what was there. Raises MapRefused, WorkStopped."""
        async with received(body, announced_bytes, self.files.directory, self.reserve_bytes, _look, now) as upload:
            return await workers.run(self.keep_file, mission_id, area, upload.path, name, now)

    def keep_file(self, mission_id: str, area: Sequence[LonLat], path: Path, name: str, now: datetime) -> MissionWays:
        """What is kept, but for its features, of which there may be many; the file itself is not needed any more.

        Raises MapRefused.
        """
        ways = read_ways(path.read_bytes(), area, name, now)
        self.keep(mission_id, ways)
        return ways.model_copy(update={"features": []})


@lru_cache(maxsize=4)
def _traced(path: Path, _changed_ns: int) -> tuple[Traced, ...]:
    """Whatever notes another version wrote beside the features."""
    features = json.loads(path.read_bytes())["features"]
    return tuple(Traced(one["properties"]["kind"], shape(one["geometry"])) for one in features)


def _look(first_bytes: bytes, size: int) -> None:
    if size > MOST_OVERLAY_BYTES:
        raise MapRefused(BodyTooLarge(MOST_OVERLAY_BYTES, "other"))
