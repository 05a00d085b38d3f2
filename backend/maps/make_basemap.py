"""Make the small basemap that ships: land, lakes, rivers and towns of the world, for low zoom, out of Natural Earth.

python -m backend.maps.make_basemap FOLDER

FOLDER holds the GeoJSON of Natural Earth's 1:50m themes under their own names (ne_50m_land.json and so on), which is in
the public domain (naturalearthdata.com). Written: basemap.json.gz beside this file, the same bytes from the same files.
"""

from __future__ import annotations

import argparse
import gzip
import json
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from shapely.geometry import Polygon, shape
from shapely.geometry.base import BaseGeometry

MADE = Path(__file__).with_name("basemap.json.gz")
LIMIT_BYTES = 150_000

TOLERANCE_DEG = 0.02
"""About 2 km, as the source's own lines stray: two pixels of the page at zoom 7, where it begins to fade them out."""
SCALE = 100
SMALLEST_DEG2 = 0.004
"""Islands and lakes below some 30 km2 are left out."""

TOWNS = "ne_50m_populated_places_simple"


def features_of(folder: Path, name: str) -> list[dict[str, Any]]:
    """Raises FileNotFoundError where Natural Earth's theme is not in the folder."""
    path = folder / f"{name}.json"
    if not path.exists():
        raise FileNotFoundError(f"{path} is missing: the 1:50m themes of Natural Earth as GeoJSON belong there")
    return json.loads(path.read_text())["features"]


def steps(line: Iterable[Sequence[float]]) -> list[int]:
    """A line as x, y of its first point and the step to each point that follows, in units of 1/SCALE degree."""
    points = [(round(x * SCALE), round(y * SCALE)) for x, y, *_ in line]
    kept = points[:1] + [here for before, here in pairwise(points) if here != before]
    moves = [(x - x0, y - y0) for (x0, y0), (x, y) in pairwise([(0, 0), *kept])]
    return [value for move in moves for value in move]


def parts(geometry: BaseGeometry) -> Iterator[BaseGeometry]:
    """Each polygon or line of a geometry that may hold several."""
    yield from getattr(geometry, "geoms", [geometry])


def surfaces(folder: Path, name: str) -> list[list[list[int]]]:
    """Polygons that are still to be seen when they are simplified, each by its rings."""
    simplified = [shape(one["geometry"]).simplify(TOLERANCE_DEG) for one in features_of(folder, name)]
    shown = [part for one in simplified for part in parts(one) if isinstance(part, Polygon)]
    return [
        [steps(ring.coords) for ring in (part.exterior, *part.interiors)]
        for part in shown
        if part.area >= SMALLEST_DEG2
    ]


def lines(folder: Path, name: str) -> list[list[int]]:
    """Lines, simplified."""
    shown = [one["geometry"] for one in features_of(folder, name) if one["geometry"]]
    return [steps(part.coords) for one in shown for part in parts(shape(one).simplify(TOLERANCE_DEG))]


def towns(folder: Path) -> list[tuple[int, int, int, str]]:
    """x, y, rank (0 for the largest, which show first), name."""
    found: list[tuple[int, int, int, str]] = []
    for feature in features_of(folder, TOWNS):
        x, y = steps([feature["geometry"]["coordinates"]])
        found.append((x, y, int(feature["properties"]["scalerank"]), feature["properties"]["name"]))
    return found


def basemap(folder: Path) -> bytes:
    """What basemap.json.gz holds: see `frontend/src/map/world.ts`, which reads it."""
    made = {
        "scale": SCALE,
        "land": surfaces(folder, "ne_50m_land"),
        "lakes": surfaces(folder, "ne_50m_lakes"),
        "rivers": lines(folder, "ne_50m_rivers_lake_centerlines"),
        "towns": towns(folder),
    }
    text = json.dumps(made, separators=(",", ":"), ensure_ascii=False)
    return gzip.compress(text.encode(), 9, mtime=0)


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    made = basemap(parser.parse_args().folder)
    if len(made) > LIMIT_BYTES:
        raise SystemExit(f"The basemap would be {len(made)} bytes, more than {LIMIT_BYTES}: simplify it further.")
    MADE.write_bytes(made)
    print(f"{MADE.name}: {len(made)} bytes")


if __name__ == "__main__":
    main()
