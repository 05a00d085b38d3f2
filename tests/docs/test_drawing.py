"""The picture of the architecture: it says what the imports say, and looks the same on every machine."""

from __future__ import annotations

from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from docs.drawing.layout import ROOM_HEIGHT, lay_out
from docs.drawing.rooms import HOUSE, ImportCircle, Room, Rooms, without_shortcuts
from docs.drawing.svg import draw

NAMES = [f"{floor}.{letter * 4}" for floor in HOUSE for letter in "abcdef"]


LATER = [st.sets(st.sampled_from(NAMES[number:]), max_size=4) for number in range(1, len(NAMES))]
IMPORTS = st.tuples(*LATER, st.just(set())).map(lambda several: dict(zip(NAMES, several, strict=True)))
"""Imports that point down: from a name to later ones."""


def house_of(imports: dict[str, set[str]]) -> Rooms:
    return Rooms(tuple(Room(name, is_package=True) for name in sorted(NAMES)), without_shortcuts(imports))


def reached(arrows: tuple[tuple[str, str], ...], start: str) -> set[str]:
    found: set[str] = set()
    for importer, imported in arrows:
        if importer == start:
            found |= {imported} | reached(arrows, imported)
    return found


def test_an_arrow_that_follows_from_others_is_left_out():
    imports = {"a": {"b", "c", "d"}, "b": {"c"}, "c": set(), "d": set()}
    assert without_shortcuts(imports) == (("a", "b"), ("a", "d"), ("b", "c"))


@given(IMPORTS)
def test_what_can_be_reached_stays_so(imports: dict[str, set[str]]):
    all_arrows = tuple((name, below) for name, several in imports.items() for below in several)
    for name in imports:
        assert reached(without_shortcuts(imports), name) == reached(all_arrows, name)


def test_a_circle_is_named():
    with pytest.raises(ImportCircle, match=r"a, b, a|b, a, b"):
        without_shortcuts({"a": {"b"}, "b": {"a"}})


@settings(max_examples=25)
@given(IMPORTS.map(house_of))
def test_rooms_do_not_overlap_and_arrows_point_down(house: Rooms):
    layout = lay_out(house)
    for one, other in combinations(layout.boxes.values(), 2):
        apart = abs(one.x - other.x) > (one.width + other.width) / 2
        assert apart or abs(one.y - other.y) > ROOM_HEIGHT
    for importer, imported in house.arrows:
        assert layout.boxes[importer].y < layout.boxes[imported].y
    for room in house.rooms:
        top, bottom = layout.floors[room.floor]
        assert top < layout.boxes[room.name].y < bottom


@given(IMPORTS)
def test_the_order_in_which_imports_are_read_does_not_matter(imports: dict[str, set[str]]):
    assert without_shortcuts(dict(reversed(imports.items()))) == without_shortcuts(imports)


def test_draws_every_room_once():
    rooms = (Room("backend.api", is_package=True), Room("planner.types", is_package=False))
    house = Rooms(rooms, (("backend.api", "planner.types"),))
    drawn = draw(house, lay_out(house))
    assert drawn.count(">api<") == drawn.count(">types<") == drawn.count('class="arrow"') == 1
    assert "prefers-color-scheme: dark" in drawn
