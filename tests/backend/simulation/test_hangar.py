from __future__ import annotations

import json
from pathlib import Path

from backend.settings import Settings
from backend.simulation.hangar import Hangar
from hardware.sim.autopilot.launch import find_simulated


async def test_a_simulated_vehicle_left_in_flight_is_found_again_and_another_is_not(tmp_path: Path) -> None:
    hangar = Hangar(Settings(data_dir=tmp_path, seed=4))
    first = await hangar.enter(in_flight=False)
    again = await hangar.enter(in_flight=True)
    assert again.connect_port == first.connect_port
    other = Hangar(Settings(data_dir=tmp_path, seed=5))
    fresh = await other.enter(in_flight=True)
    assert fresh.connect_port != first.connect_port
    await first.stop()
    await other.leave(fresh)
    assert not (tmp_path / "simulated_vehicle.json").exists()
    assert await find_simulated(fresh.connect_port, fresh.control_port) is None


async def test_a_register_that_cannot_be_read_is_no_vehicle(tmp_path: Path) -> None:
    for content in ("", "[]", json.dumps({"connect_port": "x"})):
        (tmp_path / "simulated_vehicle.json").write_text(content)
        assert await Hangar(Settings(data_dir=tmp_path))._left_behind() is None
