"""Meshes have the size and the place they say."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon, Point, Polygon, box

from backend.scene import shapes


def mesh_area(mesh: shapes.Mesh) -> float:
    corners = mesh[0].astype(float)[mesh[1]]
    return float(
        np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    )


@pytest.mark.parametrize(
    "geometry",
    [
        box(0, 0, 10, 5),
        Polygon([(0, 0), (10, 0), (10, 10), (5, 2), (0, 10)]),
        box(0, 0, 10, 10).difference(box(3, 3, 6, 6)),
        MultiPolygon([box(0, 0, 1, 1), box(5, 5, 7, 7)]),
    ],
)
def test_a_plate_covers_its_polygons_and_leaves_holes_out(geometry) -> None:
    vertices, faces = shapes.plate(geometry, 3.0)
    assert mesh_area((vertices, faces)) == pytest.approx(geometry.area)
    assert (vertices[:, 2] == 3.0).all()
    centres = vertices[faces].mean(axis=1)
    assert all(geometry.covers(Point(x, y)) for x, y, _ in centres.tolist())


def test_nothing_makes_an_empty_plate() -> None:
    vertices, faces = shapes.plate(Polygon(), 0.0)
    assert len(vertices) == len(faces) == 0


def test_an_outline_is_as_long_as_the_polygon_is_around() -> None:
    geometry = box(0, 0, 10, 10).difference(box(3, 3, 6, 6))
    lines = shapes.outline(geometry, 1.0)
    assert np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum() == pytest.approx(geometry.length)


def test_a_wall_has_the_area_of_length_times_height() -> None:
    ring = shapes.rings(box(0, 0, 10, 4))[0]
    assert mesh_area(shapes.wall(ring, 0.0, 3.0)) == pytest.approx(28 * 3)
    assert mesh_area(shapes.wall([(0, 0), (10, 0)], 0.0, 3.0, closed=False)) == pytest.approx(30)


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(0.5, 500))
def test_a_disc_is_round(x: float, y: float, radius: float) -> None:
    vertices, _ = shapes.disc(x, y, 2.0, radius)
    distance = np.hypot(vertices[1:, 0] - x, vertices[1:, 1] - y)
    assert distance == pytest.approx(radius, abs=2e-3)


@pytest.mark.parametrize(("bearing", "way"), [(0, (0, 1)), (90, (1, 0)), (180, (0, -1)), (270, (-1, 0))])
def test_bearings_point_clockwise_from_north(bearing: float, way: tuple[float, float]) -> None:
    assert shapes.towards(bearing) == pytest.approx(way, abs=1e-12)


def test_a_ball_is_a_ball() -> None:
    vertices, faces = shapes.ball(2.0)
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(2.0)
    assert mesh_area((vertices, faces)) == pytest.approx(4 * np.pi * 4, rel=0.07)


def test_joined_meshes_keep_their_faces() -> None:
    parts = [shapes.disc(0, 0, 0, 1), shapes.disc(5, 0, 0, 2)]
    assert mesh_area(shapes.join(parts)) == pytest.approx(sum(map(mesh_area, parts)))
