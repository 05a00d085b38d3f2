"""The parts behind the API, as the endpoints see them."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from backend.commands import CommandReply, CommandRequest
from backend.events import PreflightChecked
from backend.live.hub import Hub
from backend.settings import Settings
from backend.spec import MissionSpec
from backend.store.journal import SqlJournal
from hardware.readings import Telemetry


class MissionService(Protocol):
    """What the API asks of the mission room.

    Errors: `MissionNotFound` for an unknown id, `MissionConflict` when the mission's phase does not allow it,
    `ValueError` with a sentence for the operator when the input makes no sense.
    """

    async def create(self, spec: MissionSpec, by: str) -> str: ...

    async def edit(self, mission_id: str, spec: MissionSpec, by: str) -> None: ...

    async def command(self, mission_id: str, request: CommandRequest, by: str) -> CommandReply: ...

    async def preflight(self, mission_id: str) -> PreflightChecked: ...

    def telemetry(self) -> Telemetry: ...

    def vehicle_detail(self) -> str:
        """Why there is no vehicle, in the operator's words."""
        ...


@dataclass(frozen=True, slots=True)
class Services:
    """Everything the endpoints use; made once by the application's start. `now`: UTC epoch seconds of the mission's
    clock."""

    missions: MissionService
    journal: SqlJournal
    hub: Hub
    settings: Settings
    now: Callable[[], float]
    began_monotonic_s: float = field(default_factory=time.monotonic)
