from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point

from backend.api.suggestion import suggested_mission
from backend.mission.area import target_area
from backend.settings import Settings
from backend.spec import Place
from backend.wiring import EmitterAroundHome, Hangar, emitter_place, open_simulation, walls
from hardware.clock import ScaledClock
from hardware.frame import LocalFrame
from hardware.ports import ReceiverError
from hardware.readings import GeoPoint, Telemetry
from hardware.sim.autopilot.launch import find_simulated


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**31 - 1), lat=st.floats(-70, 70), lon=st.floats(-179, 179))
def test_the_simulated_emitter_stands_in_the_suggested_area_by_its_seed(seed: int, lat: float, lon: float) -> None:
    home = GeoPoint(lat, lon)
    frame = LocalFrame(home)
    area = target_area(suggested_mission(Place(lat=lat, lon=lon)), frame)
    assert emitter_place(seed, home) == emitter_place(seed, home)
    assert area.contains(Point(frame.to_enu(emitter_place(seed, home))))


def test_another_seed_is_another_place() -> None:
    home = GeoPoint(50.0, 7.0)
    assert len({emitter_place(seed, home) for seed in range(20)}) == 20


def test_the_walls_of_the_multipath_world_stand_around_the_area_by_its_seed() -> None:
    home = GeoPoint(50.0, 7.0)
    frame = LocalFrame(home)
    around = target_area(suggested_mission(Place(lat=50.0, lon=7.0)), frame).buffer(90.0)
    assert walls(3, home) == walls(3, home) != walls(4, home)
    assert all(around.contains(Point(frame.to_enu(wall.place))) for seed in range(20) for wall in walls(seed, home))


class ParkedVehicle:
    """Only its telemetry is asked."""

    def __init__(self) -> None:
        self.heard = Telemetry(connected=True, at_s=0.0)

    def telemetry(self) -> Telemetry:
        return self.heard


async def test_the_emitter_waits_for_the_vehicle_to_know_its_home() -> None:
    vehicle = ParkedVehicle()
    receiver = EmitterAroundHome(vehicle, ScaledClock(), seed=3)  # type: ignore[arg-type]
    with pytest.raises(ReceiverError, match="home"):
        await receiver.open(868.3e6)
    assert receiver.truth is None
    home = GeoPoint(50.0, 7.0)
    vehicle.heard = Telemetry(connected=True, at_s=0.0, home=home, home_amsl_m=100.0)
    await receiver.open(868.3e6)
    assert receiver.truth == emitter_place(3, home)
    await receiver.close()


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


@pytest.mark.parametrize(
    ("given_settings", "says"),
    [
        ({"vehicle_url": "nonsense"}, "no vehicle address"),
        ({"receiver": "nonsense", "vehicle_url": "udpin://127.0.0.1:1"}, "not understood"),
        ({"receiver": "payload", "vehicle_url": "udpin://127.0.0.1:1"}, "CROSSFIX_PAYLOAD_TOKENS"),
        ({"antenna_pattern": "/nowhere/pattern.json"}, "pattern"),
    ],
)
async def test_settings_that_name_nothing_are_refused_with_a_sentence(
    tmp_path: Path, given_settings: dict[str, str], says: str
) -> None:
    with pytest.raises((ValueError, ReceiverError), match=says):
        async with open_simulation(Settings(data_dir=tmp_path, **given_settings)):  # type: ignore[arg-type]
            pass
