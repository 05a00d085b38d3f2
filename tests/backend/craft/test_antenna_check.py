"""The antenna turned by hand before a known emitter: right, wrong by its offset, dead, not turned."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator, Sequence
from dataclasses import replace

import numpy as np
import pytest
from equipment import HOME, spec
from refusals import refusing
from stage import Stage

from backend.craft.antenna_check import check_by_hand
from backend.events import CheckFact
from backend.reasons.safety import NoPosition
from backend.search.errors import MissionInputError
from backend.spec import SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.readings import Channel, HeadingSample, PowerSample
from hardware.reasons.antenna import AntennaAgrees, AntennaAskew, AntennaDead, ReceiverClockOff

PATTERN: AntennaPattern = load_pattern(SMALL_YAGI)
BEARING = 70.0


class Hand:
    """Turns the vehicle back and forth on the ground; the receiver hears an emitter at BEARING by `pattern`."""

    lost_percent = 0.0

    def __init__(self, stage: Stage, pattern: AntennaPattern, turned_deg: float = 400.0, late_s: float = 0.0) -> None:
        self.stage, self.pattern, self.turned, self.late_s = stage, pattern, turned_deg, late_s
        self.began_s = stage.clock.now()
        self.rng = np.random.default_rng(1)

    def heading(self, at_s: float) -> float:
        """To one side, then back: a constant rate could not tell a clock that is late."""
        since = (at_s - self.began_s) / 20.0
        return self.turned * (0.5 - 0.5 * math.cos(math.pi * min(max(since, 0.0), 2.0)))

    async def open(self, channels: Sequence[Channel]) -> None: ...

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
    pattern: AntennaPattern, wait_s: float = 1.2, bearing_offset_deg: float = 0.0, **hand: float
) -> CheckFact:
    """pattern: of the antenna that is really mounted; the server believes it is PATTERN."""
    stage = Stage(factor=50.0)
    stage.receiver = Hand(stage, pattern, **hand)  # type: ignore[assignment]
    mission = spec().model_copy(update={"sensor": SensorSpec(bearing_offset_deg=bearing_offset_deg)})
    found = await check_by_hand(stage.craft(PATTERN), mission, BEARING, wait_s, "ann")
    assert found.by == "ann"
    return found.check


def turned(by_deg: float) -> AntennaPattern:
    """The same antenna, mounted that much clockwise."""
    return replace(PATTERN, relative_bearing_deg=np.asarray(PATTERN.relative_bearing_deg) + by_deg)


async def test_a_sound_antenna_passes() -> None:
    check = await checked(PATTERN)
    assert check.ok
    assert isinstance(check.reason, AntennaAgrees)
    assert check.reason.measured_deg == pytest.approx(BEARING, abs=2.0)


async def test_a_turned_antenna_refuses_the_start_and_names_the_offset() -> None:
    check = await checked(turned(40.0))
    assert not check.ok
    assert check.blocking
    assert isinstance(check.reason, AntennaAskew)
    assert check.reason.true_deg == pytest.approx(BEARING, abs=0.1)
    assert check.reason.offset_deg == pytest.approx(40.0, abs=2.0)


async def test_what_the_mission_takes_off_counts_and_the_file_is_not_asked_for_it_again() -> None:
    """Mounted 40 degrees clockwise of what the file says, its bearings read 40 too small."""
    right = await checked(turned(40.0), bearing_offset_deg=-40.0)
    assert right.ok
    assert isinstance(right.reason, AntennaAgrees)
    assert right.reason.measured_deg == pytest.approx(BEARING, abs=2.0)
    half = (await checked(turned(40.0), bearing_offset_deg=-10.0)).reason
    assert isinstance(half, AntennaAskew)
    assert half.offset_deg == pytest.approx(30.0, abs=2.0), "with the 10 of the mission that is 40"


async def test_a_dead_antenna_and_a_late_clock_are_noticed() -> None:
    flat = replace(PATTERN, gain_db=np.zeros_like(PATTERN.gain_db))
    assert isinstance((await checked(flat)).reason, AntennaDead)
    late = await checked(PATTERN, late_s=0.6)
    assert not late.ok
    assert isinstance(late.reason, ReceiverClockOff)
    assert late.reason.offset_s == pytest.approx(0.6, abs=0.05)


async def test_a_vehicle_that_is_not_turned_round_passes_nothing() -> None:
    assert not (await checked(PATTERN, turned_deg=90.0)).ok


async def test_a_vehicle_that_does_not_know_where_it_is_cannot_be_checked() -> None:
    stage = Stage()
    stage.vehicle.state = replace(stage.vehicle.state, position=None)
    with refusing(NoPosition, MissionInputError):
        await check_by_hand(stage.craft(), spec(), BEARING, 1.0, "ann")
