"""Where scenes get their facts from, as a protocol; the application gives it the journal and the mission room."""

from __future__ import annotations

from typing import Protocol

from backend.events import Recorded
from backend.ports import TrackPoint
from backend.terrain import Terrain
from hardware.readings import Telemetry


class SceneSource(Protocol):
    """May raise OSError or RuntimeError while the database is away: the scene then stays as it was."""

    def flying(self) -> str | None:
        """The mission that flies now."""
        ...

    def telemetry(self) -> Telemetry:
        """Of the craft that the scene shows; never blocks."""
        ...

    def now_s(self) -> float:
        """UTC epoch seconds of the mission's clock."""
        ...

    async def last_seq(self, mission_id: str) -> int | None:
        """None: there is no such mission. Asked several times a second."""
        ...

    async def read(self, mission_id: str) -> list[Recorded]:
        """The whole journal of a mission, in order."""
        ...

    async def track(self, mission_id: str) -> list[TrackPoint]:
        """All that was flown, in order."""
        ...

    async def ground(self, digest: str) -> Terrain | None:
        """What a mission was flown over; None when it is lost."""
        ...
