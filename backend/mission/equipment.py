"""What the mission room works with: the craft there are, and where facts are kept and shown."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from backend.craft.equipment import CraftEquipment
from backend.ports import Grounds, Journal, Lessons, NoGrounds, NoLessons, Publisher
from backend.search.lessons import knowing
from backend.spec import MissionSpec
from hardware.ports import Clock

DatabaseState = Literal["ok", "slow", "lost"]


def _ok() -> DatabaseState:
    return "ok"


@dataclass(frozen=True, slots=True)
class MissionEquipment:
    """Made by the wiring. crafts: by id. software: version, for the record. threads: how many the planner may use."""

    crafts: Mapping[str, CraftEquipment]
    journal: Journal
    publisher: Publisher
    clock: Clock
    software: str
    threads: int = 2
    database: Callable[[], DatabaseState] = _ok
    grounds: Grounds = field(default_factory=NoGrounds)
    lessons: Lessons = field(default_factory=NoLessons)

    @property
    def first(self) -> CraftEquipment:
        """The craft that a draft is planned for, while it names none."""
        return next(iter(self.crafts.values()))

    async def knowing(self, spec: MissionSpec, craft: CraftEquipment | None = None) -> MissionSpec:
        """The specification with what the flights of the craft (None: of the first) and its antenna taught."""
        craft = craft or self.first
        antenna = craft.pattern.name
        return knowing(spec, await self.lessons.of(craft.craft_id, antenna), craft.craft_id, antenna)
