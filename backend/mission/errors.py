"""What the mission room answers when it cannot do what is asked, in the operator's words."""

from __future__ import annotations


class MissionInputError(ValueError):
    """The specification makes no sense. `field`: path into it, dots between names and indices."""

    def __init__(self, message: str, remedy: str, field: str) -> None:
        super().__init__(message)
        self.remedy = remedy
        self.field = field


class MissionNotFound(LookupError):
    """There is no mission with this id."""

    def __init__(self, mission_id: str) -> None:
        super().__init__(f"there is no mission {mission_id}")
        self.remedy = "look at the list of missions"


class MissionConflict(RuntimeError):
    """The mission's phase does not allow it."""

    def __init__(self, message: str, remedy: str) -> None:
        super().__init__(message)
        self.remedy = remedy
