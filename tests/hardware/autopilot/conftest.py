from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from paper import IN_AIR, PLACE, Scene, heartbeat

from hardware.autopilot.px4 import HOLD


@pytest.fixture
async def flying() -> Scene:
    """A PX4 found in HOLD in the air; nothing is commanded yet."""
    scene = Scene(
        heartbeat(HOLD, True), ("EXTENDED_SYS_STATE", {"landed_state": IN_AIR}), ("GLOBAL_POSITION_INT", PLACE)
    )
    await scene.monitor.connect(1.0)
    await scene.monitor.close()
    scene.monitor.connected = True
    scene.link.sent.clear()
    return scene
