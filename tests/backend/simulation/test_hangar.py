from __future__ import annotations

import json
import logging
from pathlib import Path

import pytest

from backend.settings import Settings
from backend.simulation.hangar import Hangar
from hardware.sim.autopilot.launch import find_simulated


async def test_a_simulated_vehicle_left_behind_is_found_again_and_another_is_not(tmp_path: Path) -> None:
    hangar = Hangar(Settings(data_dir=tmp_path, seed=4))
    first = await hangar.enter()
    again = await hangar.enter()
    assert again.connect_port == first.connect_port
    other = Hangar(Settings(data_dir=tmp_path, seed=5))
    fresh = await other.enter()
    assert fresh.connect_port != first.connect_port
    await first.stop()
    await other.leave(fresh)
    assert not (tmp_path / "simulated_vehicle.json").exists()
    assert await find_simulated(fresh.connect_port, fresh.control_port) is None


async def test_a_battery_survives_a_server_that_died_and_is_full_after_one_that_ended(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO, "crossfix")
    hangar = Hangar(Settings(data_dir=tmp_path))
    vehicle = await hangar.enter()
    await vehicle.order("battery", percent=40)
    left = await hangar.enter()
    assert (await left.order("truth"))["battery_percent"] == pytest.approx(40.0, abs=1.0)
    assert "battery is full" not in caplog.text.partition("taken over")[2]
    await hangar.leave(vehicle)
    caplog.clear()
    new = await hangar.enter()
    assert (await new.order("truth"))["battery_percent"] == pytest.approx(100.0, abs=1.0)
    assert "its battery is full" in caplog.text
    await hangar.leave(new)


async def test_a_register_that_cannot_be_read_is_no_vehicle(tmp_path: Path) -> None:
    beyond = json.dumps({"connect_port": 14540, "control_port": 1_454_000})
    for content in ("", "[]", json.dumps({"connect_port": "x"}), beyond, beyond.replace("14540", "1e999")):
        (tmp_path / "simulated_vehicle.json").write_text(content)
        assert await Hangar(Settings(data_dir=tmp_path))._left_behind() is None


async def test_a_vehicle_of_another_data_directory_is_neither_taken_over_nor_stopped(tmp_path: Path) -> None:
    """After a restart of the machine, one may fly at the ports that another directory's register still names."""
    theirs = Hangar(Settings(data_dir=tmp_path / "theirs"))
    flying = await theirs.enter()
    kept = json.loads((tmp_path / "theirs" / "simulated_vehicle.json").read_text())
    own = Hangar(Settings(data_dir=tmp_path / "own"))
    gone = await own.enter()
    await gone.stop()
    register = tmp_path / "own" / "simulated_vehicle.json"
    ports = {name: kept[name] for name in ("connect_port", "control_port")}
    register.write_text(json.dumps(json.loads(register.read_text()) | ports))
    assert await own.address_left() is None
    fresh = await own.enter()
    assert fresh.control_port != flying.control_port
    assert await theirs.address_left() == flying.url
    await own.leave(fresh)
    await theirs.leave(flying)
