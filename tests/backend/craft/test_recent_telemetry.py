from __future__ import annotations

import pytest

from backend.craft import recent_telemetry as module
from backend.craft.recent_telemetry import recent
from backend.craft.safety import Situation
from hardware.readings import Telemetry


class Asked:
    """A vehicle whose position is `ages` old, one look after the other; the last one stays."""

    def __init__(self, *ages: float | None, connected: bool = True) -> None:
        self.ages = list(ages)
        self.connected = connected
        self.looks = 0

    def __call__(self) -> Situation:
        self.looks += 1
        age = self.ages.pop(0) if len(self.ages) > 1 else self.ages[0]
        at = None if age is None else 1000.0 - age
        return Situation(Telemetry(self.connected, 1000.0, position_at_s=at), 1000.0)


async def test_a_position_that_was_held_up_is_waited_for() -> None:
    asked = Asked(4.0, 3.5, 0.2)
    assert (await recent(asked)).position_age_s == pytest.approx(0.2)
    assert asked.looks == 3


async def test_one_that_does_not_come_is_told_as_old_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE_WALL_S", 0.05)
    asked = Asked(4.0)
    assert (await recent(asked)).position_age_s == pytest.approx(4.0)
    assert asked.looks >= 2


@pytest.mark.parametrize("asked", [Asked(0.5), Asked(None), Asked(9.0, connected=False)])
async def test_there_is_nothing_to_wait_for(asked: Asked) -> None:
    await recent(asked)
    assert asked.looks == 1
