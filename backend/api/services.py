"""The parts behind the API, as the endpoints see them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from backend.commands import CommandReply, CommandRequest
from backend.events import PreflightChecked
from backend.spec import MissionSpec
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


@dataclass(frozen=True, slots=True)
class Services:
    """Everything the endpoints use; made once by the application's start."""

    missions: Any
    journal: Any
    hub: Any
    settings: Any
