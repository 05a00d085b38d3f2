"""The picture as SVG text: plain shapes and a style that follows the reader's light or dark setting."""

from __future__ import annotations

from itertools import pairwise
from xml.sax.saxutils import escape

from docs.drawing.layout import ROOM_HEIGHT, Layout
from docs.drawing.rooms import Rooms

STYLE = """
    svg { --ground: #ffffff; --floor: #f3f5f8; --room: #ffffff; --ink: #1b2430; --quiet: #5d6b7c; --line: #7d8da1 }
    @media (prefers-color-scheme: dark) {
      svg { --ground: #12171e; --floor: #1a212b; --room: #263140; --ink: #e8edf3; --quiet: #9fb0c3; --line: #71849b }
    }
    text { font: 13px ui-sans-serif, system-ui, sans-serif; fill: var(--ink) }
    text { text-anchor: middle; dominant-baseline: central }
    .ground { fill: var(--ground) } .floor { fill: var(--floor) }
    .title { fill: var(--quiet); font-weight: 600; text-anchor: start }
    .room { fill: var(--room); stroke: var(--quiet) } .file { stroke-dasharray: 3 3 }
    .arrow { fill: none; stroke: var(--line); stroke-width: 1.3; marker-end: url(#head) }
    #head path { fill: var(--line) }
"""
HEAD = (
    '<marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
    '<path d="M0 0 8 4 0 8z"/></marker>'
)


def draw(house: Rooms, layout: Layout) -> str:
    half = ROOM_HEIGHT // 2
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {layout.width} {layout.height}" role="img">',
        "<title>Which room imports which</title>",
        f"<style>{STYLE}</style>",
        f"<defs>{HEAD}</defs>",
        '<rect class="ground" width="100%" height="100%" rx="8"/>',
    ]
    for floor, (top, bottom) in layout.floors.items():
        size = f'width="{layout.width - 16}" height="{bottom - top}"'
        lines.append(f'<rect class="floor" x="8" y="{top}" {size} rx="6"/>')
        lines.append(f'<text class="title" x="18" y="{top + 14}">{escape(floor)}/</text>')
    lines += [f'<path class="arrow" d="{_curve(points)}"/>' for points in layout.lines.values()]
    for room in house.rooms:
        box, kind = layout.boxes[room.name], "room" if room.is_package else "room file"
        left, top = box.x - box.width // 2, box.y - half
        lines.append(
            f'<rect class="{kind}" x="{left}" y="{top}" width="{box.width}" height="{ROOM_HEIGHT}" rx="5"/>'
            f'<text x="{box.x}" y="{box.y}">{escape(room.name.split(".")[1])}</text>'
        )
    return "\n".join([*lines, "</svg>", ""])


def _curve(points: tuple[tuple[int, int], ...]) -> str:
    """Leaves a room downwards, passes between the others, and ends on top of the imported one."""
    half = ROOM_HEIGHT // 2
    path = [f"M{points[0][0]} {points[0][1] + half}"]
    for (x0, y0), (x1, y1) in pairwise(points):
        middle = (y0 + y1) // 2
        path.append(f"C{x0} {middle} {x1} {middle} {x1} {y1 - half} V{y1 + half}")
    path[-1] = path[-1].rpartition(" ")[0]
    return " ".join(path)
