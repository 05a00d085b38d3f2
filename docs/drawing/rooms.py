"""Who imports whom, between rooms: the packages and modules directly inside planner, hardware and backend."""

from __future__ import annotations

from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

import grimp

HOUSE = ("backend", "hardware", "planner")
"""From top to bottom, as imports point."""

Arrow = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Room:
    """name: "backend.wire". is_package: a folder, not a single file."""

    name: str
    is_package: bool

    @property
    def floor(self) -> str:
        return self.name.split(".")[0]


@dataclass(frozen=True, slots=True)
class Rooms:
    """arrows: (importer, imported), without those that follow from others; both sorted by name."""

    rooms: tuple[Room, ...]
    arrows: tuple[Arrow, ...]


class ImportCircle(ValueError):
    """Rooms import one another, so that none of them is the lower one."""


def read_rooms() -> Rooms:
    """Of the sources that Python finds first. Raises ImportCircle."""
    graph = grimp.build_graph(*HOUSE, cache_dir=None)
    names = {room for module in graph.modules if (room := _room(module)) is not None}
    imports: dict[str, set[str]] = {name: set() for name in names}
    for module in graph.modules:
        importer = _room(module)
        for imported in map(_room, graph.find_modules_directly_imported_by(module)):
            if importer is not None and imported is not None and imported != importer:
                imports[importer].add(imported)
    rooms = tuple(Room(name, bool(graph.find_children(name))) for name in sorted(names))
    return Rooms(rooms, without_shortcuts(imports))


def _room(module: str) -> str | None:
    """None for a package's own __init__ at the top."""
    parts = module.split(".")
    return ".".join(parts[:2]) if len(parts) > 1 else None


def without_shortcuts(imports: dict[str, set[str]]) -> tuple[Arrow, ...]:
    """The transitive reduction: an arrow is left out when a longer way leads to the same room. Raises ImportCircle."""
    reached: dict[str, set[str]] = {}
    try:
        order = tuple(TopologicalSorter(imports).static_order())
    except CycleError as error:
        raise ImportCircle(f"These rooms import one another: {', '.join(error.args[1])}.") from error
    for name in order:
        reached[name] = set().union(imports[name], *(reached[below] for below in imports[name]))
    return tuple(
        (name, below)
        for name in sorted(imports)
        for below in sorted(imports[name])
        if not any(below in reached[other] for other in imports[name])
    )
