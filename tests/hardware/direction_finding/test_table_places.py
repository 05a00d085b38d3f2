"""Where rows were taken: whatever way the hemisphere is written, and never on the other one."""

from __future__ import annotations

import pytest

from hardware.direction_finding.table_file import Row, cells_of
from hardware.direction_finding.table_places import degree_columns, place_columns
from hardware.readings import Place


def place_in(line: str, *others: int) -> object:
    row = Row(1, cells_of(line))
    return degree_columns([row], 0, 1 if row.cells[1][:1] not in ("N", "S") else 2, others).place(row)


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("50.5,7.25", Place(50.5, 7.25)),
        ("-50.5,-7.25", Place(-50.5, -7.25)),
        ("50.5N,7.25W", Place(50.5, -7.25)),
        ("S 50.5°,E7.25", Place(-50.5, 7.25)),
        ("50,5° s;7,25° w", Place(-50.5, -7.25)),
        ("33.9,S,18.4,E", Place(-33.9, 18.4)),
        ("33.9,N,118.4,w", Place(33.9, -118.4)),
        ("0,N,7.25,E", Place(0.0, 7.25)),
        ("50.5,7.25,hill", Place(50.5, 7.25)),
        ("50.5,-7.25,F", Place(50.5, -7.25)),
    ],
)
def test_the_hemisphere_is_read_however_it_is_written(line: str, place: Place) -> None:
    assert place_in(line) == place


@pytest.mark.parametrize(
    ("line", "column", "axis"),
    [
        ("0,0", 0, "latitude"),
        ("0.0,-0.0", 0, "latitude"),
        ("-50.5S,7", 0, "latitude"),
        ("N50.5S,7", 0, "latitude"),
        ("50.5E,7", 0, "latitude"),
        ("50.5N,7O", 1, "longitude"),
        ("91N,7E", 0, "latitude"),
        ("50,181W", 1, "longitude"),
        ("N,7", 0, "latitude"),
        (",7", 0, "latitude"),
        ("50,nan", 1, "longitude"),
        ("33.9,S,-18.4,E", 2, "longitude"),
        ("33.9S,S,18.4,E", 0, "latitude"),
        ("33.9,S,18.4,O", 2, "longitude"),
    ],
)
def test_what_is_of_no_hemisphere_or_two_is_no_place(line: str, column: int, axis: str) -> None:
    assert place_in(line) == (column, axis)


def test_letters_of_stations_are_no_hemispheres() -> None:
    rows = [Row(k, cells_of(f"50.5,-7.25,{station}")) for k, station in enumerate("ABCDEW")]
    assert {degree_columns(rows, 0, 1).place(row) for row in rows} == {Place(50.5, -7.25)}


def test_a_column_that_holds_something_else_is_none_of_hemispheres() -> None:
    row = Row(1, cells_of("50.5,7.25,W"))
    assert degree_columns([row], 0, 1).place(row) == Place(50.5, -7.25)
    assert degree_columns([row], 0, 1, {2}).place(row) == Place(50.5, 7.25)


def test_a_row_without_the_letter_that_others_have_is_left_out() -> None:
    rows = [Row(1, cells_of("33.9,S,18.4,E")), Row(2, cells_of("33.9,,18.4,E"))]
    columns = degree_columns(rows, 0, 2)
    assert [columns.place(row) for row in rows] == [Place(-33.9, 18.4), (0, "latitude")]


@pytest.mark.parametrize(
    ("zone", "lat", "lon"),
    [
        ("22N", 48.349526, -53.980103),
        ("22 u", 48.349526, -53.980103),
        ("EPSG:32622", 48.349526, -53.980103),
        ("32722", -41.886131, -53.661074),
        ("22S", -41.886131, -53.661074),
        ("22G", -41.886131, -53.661074),
    ],
)
def test_utm_is_read_with_its_zone_and_hemisphere(zone: str, lat: float, lon: float) -> None:
    row = Row(1, cells_of(f"279215,5359442,{zone}"))
    columns = place_columns(("Easting", "Northing", "UTM Zone"), [row], ())
    assert columns is not None
    place = columns.place(row)
    assert isinstance(place, Place)
    assert (place.lat, place.lon) == pytest.approx((lat, lon), abs=1e-6)


@pytest.mark.parametrize(
    ("line", "column"),
    [
        ("279215,5359442,22", 2),
        ("279215,5359442,", 2),
        ("279215,5359442", 2),
        ("279215,5359442,61N", 2),
        ("279215,5359442,0N", 2),
        ("279215,5359442,22I", 2),
        ("279215,4000000,17S", 2),
        ("279215,10000001,22N", 1),
        ("279215,,22N", 1),
        ("79215,5359442,22N", 0),
        ("nan,5359442,22N", 0),
    ],
)
def test_utm_that_tells_no_place_is_refused(line: str, column: int) -> None:
    row = Row(1, cells_of(line))
    columns = place_columns(("easting", "northing", "zone"), [row], ())
    assert columns is not None
    assert columns.place(row) == (column, "utm")


def test_degrees_in_columns_of_a_grid_are_degrees_and_metres_without_a_zone_are_nothing() -> None:
    degrees, metres = Row(1, cells_of("-53.98,48.35")), Row(1, cells_of("279215,5359442"))
    columns = place_columns(("Easting", "Northing"), [degrees], ())
    assert columns is not None
    assert columns.place(degrees) == Place(48.35, -53.98)
    assert place_columns(("Easting", "Northing"), [metres], ()) is None
