"""The ways and barriers of missions, which lie beside the database: a file for each mission. Blocking; use threads."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from backend.settings import Settings

ENDING = ".json"


@dataclass(frozen=True, slots=True)
class WaysFiles:
    """Where they are, whatever they hold."""

    directory: Path

    @classmethod
    def of_settings(cls, settings: Settings) -> WaysFiles:
        """Where a server with these settings keeps them."""
        return cls(settings.data_dir / "ways")

    def path(self, mission_id: str) -> Path:
        """Of the mission's file, if there is one."""
        return self.directory / f"{mission_id}{ENDING}"

    def content(self, mission_id: str) -> bytes | None:
        """As it was stored; None when there are none. Raises OSError."""
        try:
            return self.path(mission_id).read_bytes()
        except FileNotFoundError:
            return None

    def missions(self) -> list[str]:
        """Of which ways are kept."""
        return sorted(path.name.removesuffix(ENDING) for path in self.directory.glob(f"*{ENDING}"))

    def forget(self, mission_ids: Collection[str]) -> None:
        """Nothing happens to a mission that has none. Raises OSError."""
        for mission_id in mission_ids:
            self.path(mission_id).unlink(missing_ok=True)
