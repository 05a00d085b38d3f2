"""The antenna turned by hand before a known emitter: right, wrong by its offset, dead, not turned; kept in the list."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator
from dataclasses import replace
from uuid import uuid4

import numpy as np
import pytest
from doubles import HOME, Stage, spec

from backend import commands
from backend.commands import CommandRequest
from backend.events import CheckFact
from backend.mission.errors import MissionConflict
from backend.mission.service import MissionService
from backend.spec import Place
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.readings import HeadingSample, PowerSample

PATTERN: AntennaPattern = load_pattern(SMALL_YAGI)
BEARING = 70.0


class Hand:
    """Turns the vehicle back and forth on the ground; the receiver hears an emitter at BEARING by `pattern`."""

    def __init__(self, stage: Stage, pattern: AntennaPattern, turned_deg: float = 400.0, late_s: float = 0.0) -> None:
        self.stage, self.pattern, self.turned, self.late_s = stage, pattern, turned_deg, late_s
        self.began_s = stage.clock.now()
        self.rng = np.random.default_rng(1)

    def heading(self, at_s: float) -> float:
        """To one side, then back: a constant rate could not tell a clock that is late."""
        since = (at_s - self.began_s) / 20.0
        return self.turned * (0.5 - 0.5 * math.cos(math.pi * min(max(since, 0.0), 2.0)))

    async def open(self, frequency_hz: float) -> None: ...

    async def close(self) -> None: ...

    async def samples(self) -> AsyncIterator[PowerSample]:
        heard_s = self.stage.clock.now()
        while True:
            await self.stage.clock.sleep(0.2)
            while heard_s < self.stage.clock.now():
                heard_s += 0.05
                nose = self.heading(heard_s)
                gain = float(self.pattern.gain_at(np.array([BEARING - nose]))[0])
                self.stage.vehicle.headings_heard.append(HeadingSample(heard_s, nose % 360.0, HOME))
                noise = float(self.rng.normal(0.0, 0.5))
                yield PowerSample(heard_s + self.late_s, 868.3e6, -60.0 + gain + noise)


async def checked(
    pattern: AntennaPattern, wait_s: float = 1.2, **hand: float
) -> tuple[Stage, MissionService, str, CheckFact]:
    """pattern: of the antenna that is really mounted; the server believes it is PATTERN."""
    stage = Stage(factor=50.0)
    stage.receiver = Hand(stage, pattern, **hand)  # type: ignore[assignment]
    service = stage.new_service(PATTERN)
    mission_id = await service.create(spec(), "ann")
    fact = await service.check_antenna(mission_id, BEARING, wait_s, "ann")
    return stage, service, mission_id, fact.check


async def test_a_sound_antenna_passes_and_stays_in_the_checklist_until_an_edit() -> None:
    stage, service, mission_id, check = await checked(PATTERN)
    assert check.ok, check.detail
    assert "measured 7" in check.detail or "measured 69" in check.detail
    assert "antenna" in [c.name for c in (await service.preflight(mission_id)).checks]
    await service.edit(mission_id, spec(), "ann")
    assert "antenna" not in [c.name for c in (await service.preflight(mission_id)).checks]
    assert stage.journal.kinds(mission_id)[1] == "antenna_checked"


async def test_a_turned_antenna_refuses_the_start_and_names_the_offset() -> None:
    _, service, mission_id, check = await checked(turned(40.0))
    assert not check.ok
    assert check.blocking
    assert "off by" in check.detail
    assert "offset to 40" in check.remedy or "offset to 39" in check.remedy or "offset to 41" in check.remedy
    assert not (await service.preflight(mission_id)).passed


def turned(by_deg: float) -> AntennaPattern:
    """The same antenna, mounted that much clockwise."""
    return replace(PATTERN, relative_bearing_deg=np.asarray(PATTERN.relative_bearing_deg) + by_deg)


async def test_a_dead_antenna_and_a_late_clock_are_told() -> None:
    flat = replace(PATTERN, gain_db=np.zeros_like(PATTERN.gain_db))
    assert "seems dead" in (await checked(flat))[3].detail
    late = (await checked(PATTERN, late_s=0.6))[3]
    assert not late.ok
    assert "clock is +0.6" in late.detail


async def test_a_vehicle_that_is_not_turned_round_passes_nothing() -> None:
    assert not (await checked(PATTERN, turned_deg=90.0))[3].ok


async def test_nothing_is_checked_while_a_mission_flies() -> None:
    stage = Stage()
    await stage.service.start_up()
    try:
        mission_id = await stage.service.create(spec(), "ann")
        start = CommandRequest(command_id=uuid4(), command=commands.Start())
        assert (await stage.service.command(mission_id, start, "ann")).accepted
        with pytest.raises(MissionConflict, match="flying"):
            await stage.service.check_antenna(mission_id, Place(lat=50.0, lon=7.1), 1.0, "ann")
    finally:
        await stage.service.shut_down()
