"""The flight: the path behind the vehicle, the vehicle itself, and the places it may fly to next."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from backend.scene.colours import Palette, between, flat
from backend.scene.content import CandidateMark, Content, NextPlace, VehicleMark
from backend.scene.items import Item, Label, Lines, Surface
from backend.scene.shapes import Mesh, at_height, ball, box, circle, disc, fan, join, segments
from backend.scene.surroundings import one_line

PIECE = 200
"""Points a piece of the path: a live scene sends only the last piece again."""

VEHICLE_SIZE = 0.075
"""In extents: far larger than true, to be seen."""

SHADES = 4


def flight(content: Content, palette: Palette, extent_m: float) -> Iterator[Item]:
    """Path, vehicle, candidates and next places; extent_m scales what has no size of its own."""
    yield from moving(content, palette, extent_m)
    yield from _candidates(content, palette, extent_m)
    for place in content.next_places:
        yield from _next_place(place, content, palette, extent_m)


def moving(content: Content, palette: Palette, extent_m: float) -> Iterator[Item]:
    """What changes while the vehicle flies without any event."""
    yield from _path(content, palette)
    if content.vehicle is not None:
        yield from _vehicle(content.vehicle, palette, extent_m)


def _path(content: Content, palette: Palette) -> Iterator[Item]:
    """Strong where it flies now, fainter where it was long ago; a thin shadow on the ground."""
    path = content.path
    pieces = max(1, -(-(len(path) - 1) // PIECE))
    for number in range(pieces):
        piece = path[number * PIECE : (number + 1) * PIECE + 1]
        if len(piece) < 2:
            return
        freshness = 1.0 if pieces == 1 else number / (pieces - 1)
        line = segments(piece)
        yield one_line(
            f"path/{number}", "path", line, between(palette.grid_major, palette.path, 0.45 + 0.55 * freshness), 3.0
        )
        shadow = segments(at_height(piece[:, :2], 0.05))
        yield one_line(f"path/shadow/{number}", "path", shadow, palette.grid_major, 1.5)


def _vehicle(mark: VehicleMark, palette: Palette, extent_m: float) -> Iterator[Item]:
    position = (mark.x, mark.y, mark.z)
    vertices, faces, colours = multicopter(extent_m * VEHICLE_SIZE, palette)
    heading = mark.heading_deg
    yield Surface("vehicle/body", "vehicle", vertices, faces, colours, position, heading or 0.0)
    post = segments([(mark.x, mark.y, 0.0), position])
    yield one_line("vehicle/post", "vehicle", post, palette.accent, 1.2)
    foot = segments(circle(mark.x, mark.y, 0.15, extent_m * VEHICLE_SIZE * 0.5), closed=True)
    yield one_line("vehicle/foot", "vehicle", foot, palette.accent, 1.2)
    words = f"{mark.z:.0f} m" if heading is not None else f"{mark.z:.0f} m, heading unknown"
    above = (mark.x, mark.y, mark.z + extent_m * VEHICLE_SIZE * 0.35)
    yield Label("vehicle/label", "labels", words, above, size=0.85)


def multicopter(span_m: float, palette: Palette) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Body, four arms with rotors, and an antenna to the front (north). span_m: from rotor to rotor across."""
    half, arm = span_m / 2, span_m / 2 / np.sqrt(2)
    body = box((-0.16 * half, -0.24 * half, -0.10 * half), (0.16 * half, 0.24 * half, 0.10 * half))
    arms: list[Mesh] = []
    for side in (1, -1):
        turn = np.array([[np.cos(np.pi / 4), side * -np.sin(np.pi / 4)], [side * np.sin(np.pi / 4), np.cos(np.pi / 4)]])
        vertices, faces = box((-half, -0.045 * half, -0.03 * half), (half, 0.045 * half, 0.03 * half))
        arms.append((np.column_stack((vertices[:, :2] @ turn.T, vertices[:, 2])), faces))
    front = [disc(x, arm, 0.08 * half, 0.42 * half) for x in (-arm, arm)]
    back = [disc(x, -arm, 0.08 * half, 0.42 * half) for x in (-arm, arm)]
    nose = fan((0, 1.35 * half, 0), [(-0.2 * half, 0.55 * half, 0), (0, 0.72 * half, 0), (0.2 * half, 0.55 * half, 0)])
    parts = (
        (join([body, *arms]), palette.ink, 1.0),
        (join(front), palette.accent, 0.85),
        (join(back), palette.faint, 0.75),
        (nose, palette.rose, 1.0),
    )
    vertices, faces = join([mesh for mesh, _, _ in parts])
    return vertices, faces, np.concatenate([flat(colour, alpha, len(mesh[0])) for mesh, colour, alpha in parts])


def _candidates(content: Content, palette: Palette, extent_m: float) -> Iterator[Item]:
    """Discs at flight height: the longer a candidate stayed in the race, the larger and the brighter."""
    if not content.candidates:
        return
    last_round = max((mark.dropped_in_round or 0 for mark in content.candidates), default=0)
    meshes: list[Mesh] = []
    colours: list[NDArray[np.uint8]] = []
    for mark in content.candidates:
        shade = _shade(mark, last_round)
        mesh = disc(mark.x, mark.y, content.flight_altitude_m, extent_m * (0.005 + 0.0022 * shade), 16)
        meshes.append(mesh)
        colours.append(flat(palette.rounds[shade], 0.55 + 0.1 * shade, len(mesh[0])))
    vertices, faces = join(meshes)
    yield Surface("candidates/discs", "candidates", vertices, faces, np.concatenate(colours))
    posts = [
        [(mark.x, mark.y, 0.0), (mark.x, mark.y, content.flight_altitude_m)]
        for mark in content.candidates
        if mark.dropped_in_round is None
    ]
    if posts:
        points = np.array(posts, np.float32)
        colour = np.tile(np.array(palette.rounds[SHADES], np.uint8), (len(points), 2, 1))
        yield Lines("candidates/posts", "candidates", points, colour, 1.0)


def _shade(mark: CandidateMark, last_round: int) -> int:
    """0 (dropped first) .. 4 (survived)."""
    if mark.dropped_in_round is None or last_round == 0:
        return SHADES
    return min(SHADES - 1, (mark.dropped_in_round - 1) * SHADES // last_round)


def _next_place(place: NextPlace, content: Content, palette: Palette, extent_m: float) -> Iterator[Item]:
    height, name = content.flight_altitude_m, f"next/{place.number}"
    post = segments([(place.x, place.y, 0.0), (place.x, place.y, height)])
    yield one_line(f"{name}/post", "candidates", post, palette.accent, 2.0)
    ring = segments(circle(place.x, place.y, height, 0.028 * extent_m), closed=True)
    yield one_line(f"{name}/ring", "candidates", ring, palette.accent, 3.0)
    vertices, faces = ball(0.011 * extent_m)
    colours = flat(palette.accent, 1.0, len(vertices))
    yield Surface(f"{name}/ball", "candidates", vertices, faces, colours, position=(place.x, place.y, height))
    words = f"next: {place.number}"
    if place.expected_time_s is not None:
        words += f"  ({clock(place.expected_time_s)})"
    yield Label(f"{name}/label", "labels", words, (place.x, place.y, height + 0.03 * extent_m))


def clock(seconds: float) -> str:
    """Minutes and seconds, "2:05"."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"
