from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point

from backend.api.suggestion import suggested_mission
from backend.search.area import target_area
from backend.simulation.emitters import EMITTERS, Signal, SimulatedEmitter, emitter_places
from backend.simulation.walls import walls
from hardware.frame import LocalFrame
from hardware.readings import Place

HOME = Place(50.0, 7.0)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**31 - 1), lat=st.floats(-70, 70), lon=st.floats(-179, 179))
def test_the_simulated_emitters_stand_in_the_suggested_area_by_the_seed(seed: int, lat: float, lon: float) -> None:
    home = Place(lat, lon)
    frame = LocalFrame(home)
    area = target_area(suggested_mission(home), frame)
    places = emitter_places(seed, home, EMITTERS)
    assert places == emitter_places(seed, home, EMITTERS)
    assert all(area.contains(Point(frame.to_enu(place))) for place in places.values())


def test_another_seed_is_another_place() -> None:
    assert len({emitter_places(seed, HOME, EMITTERS)[Signal(868.3e6)] for seed in range(20)}) == 20


def test_emitters_of_one_megahertz_stand_apart_and_move_no_other() -> None:
    close = [SimulatedEmitter(868.3e6), SimulatedEmitter(868.4e6), SimulatedEmitter(150e6, 1.3)]
    places = emitter_places(3, HOME, close)
    assert len(set(places.values())) == 3
    usual = emitter_places(3, HOME, EMITTERS)
    assert all(places[signal] == usual[signal] for signal in (Signal(868.3e6), Signal(150e6, 1.3)))


def test_the_walls_of_the_multipath_world_stand_around_the_area_by_its_seed() -> None:
    frame = LocalFrame(HOME)
    around = target_area(suggested_mission(HOME), frame).buffer(90.0)
    assert walls(3, HOME) == walls(3, HOME) != walls(4, HOME)
    assert all(around.contains(Point(frame.to_enu(wall.place))) for seed in range(20) for wall in walls(seed, HOME))
