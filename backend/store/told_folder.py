"""What checked missions told (see search.told), kept in a file a mission beside the database: to read a hundred
bearings with all that was decided between them takes a tenth of a second a mission, and a season has hundreds.

Each file names the state of the mission that it is of, so that it counts for no other. Blocking; use threads.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from backend.search.told import RECKONING, Told, sound
from backend.settings import Settings
from backend.store.digest import MissionDigest, to_columns

log = logging.getLogger("crossfix.store")


@dataclass(frozen=True, slots=True)
class _Kept:
    state: str
    told: Told


_KEPT = TypeAdapter(_Kept)


def state_of(digest: MissionDigest) -> str:
    """Another one after each fact, since a digest counts them; and with each change of how facts are reckoned."""
    columns = json.dumps(to_columns(digest), sort_keys=True)
    return f"{RECKONING} {hashlib.sha256(columns.encode()).hexdigest()}"


@dataclass(frozen=True, slots=True)
class ToldFolder:
    """One server writes it. A file that cannot be read, or not written, costs the time to reckon again."""

    directory: Path

    @classmethod
    def of_settings(cls, settings: Settings) -> ToldFolder:
        """Where a server with these settings keeps it."""
        return cls(settings.data_dir / "told")

    def of(self, digest: MissionDigest) -> Told | None:
        """None where nothing is kept of the mission as it is now."""
        try:
            kept = _KEPT.validate_json(self._file(digest.mission_id).read_bytes())
        except (OSError, ValidationError):
            return None
        return kept.told if kept.state == state_of(digest) and sound(kept.told) else None

    def keep(self, digest: MissionDigest, told: Told) -> None:
        """In the place of what the mission told before. digest: read before the facts."""
        path = self._file(digest.mission_id)
        part = path.with_suffix(".part")
        try:
            self.directory.mkdir(parents=True, exist_ok=True)
            part.write_bytes(_KEPT.dump_json(_Kept(state_of(digest), told)))
            os.replace(part, path)
        except OSError as error:
            log.warning("mission %s: what it told was not kept: %s", digest.mission_id, error)

    def missions(self) -> list[str]:
        """Of which something is kept."""
        return sorted(path.stem for path in self.directory.glob("*.json"))

    def forget(self, mission_ids: Collection[str]) -> None:
        """Nothing happens to a mission of which nothing is kept."""
        for mission_id in mission_ids:
            try:
                self._file(mission_id).unlink(missing_ok=True)
            except OSError as error:
                log.warning("mission %s: what it told cannot be removed: %s", mission_id, error)

    def _file(self, mission_id: str) -> Path:
        return self.directory / f"{mission_id}.json"
