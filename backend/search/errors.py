"""What a mission answers when it cannot do what is asked. Each says why, as a reason."""

from __future__ import annotations

from backend.reasons import Reason
from backend.reasons.refusals import NoMission
from planner.reason import ReasonedError


class MissionInputError(ReasonedError, ValueError):
    """The specification makes no sense. `field`: path into it, dots between names and indices."""

    def __init__(self, reason: Reason, field: str) -> None:
        super().__init__(reason)
        self.field = field

    def __reduce__(self) -> tuple[type[MissionInputError], tuple[Reason, str]]:
        return type(self), (self.reason, self.field)


class MissionNotFound(ReasonedError, LookupError):
    """There is no mission with this id."""

    def __init__(self, mission_id: str) -> None:
        super().__init__(NoMission(mission_id))


class MissionConflict(ReasonedError, RuntimeError):
    """What the mission does now does not allow it."""
