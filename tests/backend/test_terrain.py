from __future__ import annotations

import numpy as np
import pytest
from relief import HOME, M_LAT, M_LON, hill, level, terrain

from backend.terrain import Terrain, TerrainDamaged, terrain_from, unknown_terrain


def height(ground: Terrain, east: float, north: float) -> float:
    return float(ground.at(np.array([HOME.lat + north / M_LAT]), np.array([HOME.lon + east / M_LON]))[0])


def test_between_its_nodes_a_slope_stays_a_slope() -> None:
    slope = terrain(lambda east, north: 100.0 + 0.2 * east - 0.1 * north, spacing_m=30.0)
    for east, north in ((0.0, 0.0), (7.0, 13.0), (-411.0, 222.2)):
        assert height(slope, east, north) == pytest.approx(100.0 + 0.2 * east - 0.1 * north, abs=0.01)


def test_outside_and_beside_a_node_without_a_height_nothing_is_known() -> None:
    ground = terrain(level(), spacing_m=20.0, reach_m=100.0)
    ground.heights[5, 5] = np.nan  # home
    assert np.isnan(height(ground, 9.0, 9.0))
    assert height(ground, 21.0, 0.0) == 100.0
    assert height(ground, 112.0, 0.0) == 100.0
    assert np.isnan(height(ground, 118.0, 0.0))


def test_files_side_by_side_leave_no_gap() -> None:
    west = Terrain(50.01, 6.99, 0.001, 0.001, np.full((20, 10), 1.0, np.float32))
    east = Terrain(50.01, 7.0, 0.001, 0.001, np.full((20, 10), 2.0, np.float32))
    lon = np.linspace(6.9985, 7.0005, 50)
    known = [np.isfinite(each.at(np.full(50, 50.0), lon)) for each in (west, east)]
    assert (known[0] | known[1]).all()


def test_a_stored_terrain_is_the_same_and_one_changed_height_has_another_name() -> None:
    ground = terrain(hill(100.0, 50.0, 40.0), reach_m=500.0)
    again = terrain_from(ground.to_bytes())
    assert np.array_equal(again.heights, ground.heights)
    assert again.digest == ground.digest
    other = ground.heights.copy()
    other[3, 3] += 1.0
    changed = Terrain(
        ground.north_deg, ground.west_deg, ground.lat_step_deg, ground.lon_step_deg, other, ground.sources
    )
    assert changed.digest != ground.digest


@pytest.mark.parametrize("broken", [b"", b"{}", b"not json\nabc", terrain(level(), reach_m=60.0).to_bytes()[:-9]])
def test_a_damaged_one_is_refused(broken: bytes) -> None:
    with pytest.raises(TerrainDamaged):
        terrain_from(broken)


def test_of_lost_ground_nothing_is_known() -> None:
    assert np.isnan(height(unknown_terrain(HOME), 0.0, 0.0))
