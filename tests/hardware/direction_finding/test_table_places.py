"""Where rows were taken: whatever way the hemisphere is written, and never on the other one."""

from __future__ import annotations

import pytest

from hardware.direction_finding.table_file import Row, cells_of
from hardware.direction_finding.table_places import place_columns
from hardware.readings import Place


def place_in(line: str, header: str = "lat,lon,note") -> object:
    row = Row(1, cells_of(line))
    columns = place_columns(cells_of(header), [row])
    assert columns is not None
    return columns.place(row)


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("50.5,7.25", Place(50.5, 7.25)),
        ("-50.5,-7.25", Place(-50.5, -7.25)),
        ("50.5N,7.25W", Place(50.5, -7.25)),
        ("S 50.5°,E7.25", Place(-50.5, 7.25)),
        ("-50.5 S,7.25", Place(-50.5, 7.25)),
        ("50,5° s;7,25° w", Place(-50.5, -7.25)),
        ("50.5 degrees,7.25 deg", Place(50.5, 7.25)),
        ("50.5,7.25,W", Place(50.5, 7.25)),
        ("50.5,7.25,O", Place(50.5, 7.25)),
    ],
)
def test_the_hemisphere_is_read_beside_the_number_and_not_in_notes(line: str, place: Place) -> None:
    assert place_in(line) == place
    for header in ("lat,lon,station", "lat,lon,observer", "lat,lon,wind", "lat,lon"):
        assert place_in(line, header) == place


@pytest.mark.parametrize(
    ("cell", "lat"),
    [
        ("50°30'00\"N", 50.5),
        ("50° 30' 36\" S", -50.51),
        ("N50 30.6", 50.51),
        ("50 30.6", 50.51),
        ("50:30:36", 50.51),
        ("50°30′36″", 50.51),
        ("S 50°30.6'", -50.51),
        ("50 30 36.0N", 50.51),
        ("50°60'N", None),
        ("50°30'61\"N", None),
        ("50°30.5'36\"N", None),
        ("-50°30'", None),
        ("50°30'30'30", None),
        ("90°30'N", None),
        ("50 / 30", None),
        ("50 123", None),
        ("12 345", None),
        ("50 3045", None),
        ("50 30.05.5", None),
        ("50:30:36s", None),
    ],
)
def test_minutes_and_seconds_are_read(cell: str, lat: float | None) -> None:
    place = place_in(f"{cell},7.25")
    if lat is None:
        assert place == (0, "latitude")
    else:
        assert isinstance(place, Place)
        assert (place.lat, place.lon) == (pytest.approx(lat, abs=1e-9), 7.25)


@pytest.mark.parametrize("header", ["lat,N/S,lon,E/W", "lat,lat dir,lon,lon dir", "latitude,ns,long,longitude_ref"])
@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("33.9,S,18.4,E", Place(-33.9, 18.4)),
        ("-33.9,S,18.4,E", Place(-33.9, 18.4)),
        ("33.9,N,118.4,w", Place(33.9, -118.4)),
        ("33.9,South,118.4,°W", Place(-33.9, -118.4)),
        ("0,N,7.25,E", Place(0.0, 7.25)),
        ("33.9,O,18.4,E", (0, "latitude")),
        ("33.9", (2, "longitude")),
        ("33.9,S,18.4,O", (2, "longitude")),
        ("33.9,S,18.4,Ouest", (2, "longitude")),
        ("33.9,S,-18.4,E", (2, "longitude")),
        ("33.9S,S,18.4,E", (0, "latitude")),
    ],
)
def test_the_hemisphere_stands_in_a_column_that_is_named_for_it(header: str, line: str, place: object) -> None:
    assert place_in(line, header) == place


@pytest.mark.parametrize(
    ("line", "column", "axis"),
    [
        ("0,0", 0, "latitude"),
        ("0.0,-0.0", 0, "latitude"),
        ("-50.5N,7", 0, "latitude"),
        ("N50.5S,7", 0, "latitude"),
        ("50.5E,7", 0, "latitude"),
        ("50.5N,7O", 1, "longitude"),
        ("91N,7E", 0, "latitude"),
        ("50,181W", 1, "longitude"),
        ("N,7", 0, "latitude"),
        (",7", 0, "latitude"),
        ("50,nan", 1, "longitude"),
    ],
)
def test_what_is_of_no_hemisphere_or_two_is_no_place(line: str, column: int, axis: str) -> None:
    assert place_in(line) == (column, axis)


@pytest.mark.parametrize(
    ("zone", "lat", "lon"),
    [
        ("22N", 48.349526, -53.980103),
        ("22 u", 48.349526, -53.980103),
        ("EPSG:32622", 48.349526, -53.980103),
        ("UTM 22 North", 48.349526, -53.980103),
        ("022-N", 48.349526, -53.980103),
        ("22 South", -41.886131, -53.661074),
        ("32722", -41.886131, -53.661074),
        ("22S", -41.886131, -53.661074),
        ("22G", -41.886131, -53.661074),
    ],
)
def test_utm_is_read_with_its_zone_and_hemisphere(zone: str, lat: float, lon: float) -> None:
    row = Row(1, cells_of(f"279215,5359442,{zone}"))
    columns = place_columns(("Easting", "Northing", "UTM Zone"), [row])
    assert columns is not None
    place = columns.place(row)
    assert isinstance(place, Place)
    assert (place.lat, place.lon) == pytest.approx((lat, lon), abs=1e-6)


@pytest.mark.parametrize("name", ["hemisphere", "utm_hemisphere", "N/S"])
@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("279215,5359442,22,N", (48.349526, -53.980103)),
        ("279215,5359442,22,south", (-41.886131, -53.661074)),
        ("279215,5359442,22N,N", (48.349526, -53.980103)),
        ("279215,5359442,22G,S", (-41.886131, -53.661074)),
        ("279215,5359442,32622,N", (48.349526, -53.980103)),
        ("279215,4000000,17S,N", (36.119590, -83.453172)),
        ("279215,4000000,17S,S", (-54.100711, -84.376981)),
        ("279215,5359442,22N,S", 2),
        ("279215,5359442,22,", 2),
        ("279215,5359442,22,E", 2),
        ("500000,7500000,33,W", 2),
        ("279215,4000000,17S,E", 2),
        ("279215,5359442,22", 2),
    ],
)
def test_the_hemisphere_of_a_zone_may_have_a_column(name: str, line: str, place: tuple[float, float] | int) -> None:
    row = Row(1, cells_of(line))
    columns = place_columns(("easting", "northing", "zone", name), [row, Row(2, ("", "", "", "N"))])
    assert columns is not None
    found = columns.place(row)
    if isinstance(place, int):
        assert found == (place, "utm")
    else:
        assert isinstance(found, Place)
        assert (found.lat, found.lon) == pytest.approx(place, abs=1e-6)


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("5006.508N,00712.3E", Place(50.10846666666667, 7.205)),
        ("0050.5N,00712.3E", Place(0.8416666666666667, 7.205)),
        ("S 0050.5,W 11730", Place(-0.8416666666666667, -117.5)),
        ("0050,5N;00712,3E", Place(0.8416666666666667, 7.205)),
        ("0050.5,00712.3", (0, "latitude")),
        ("0060.5N,00712.3E", (0, "latitude")),
        ("9030N,00712.3E", (0, "latitude")),
        ("0050.5N,0712.3E", (1, "longitude")),
        ("050.5N,007.3E", Place(50.5, 7.3)),
        ("5006.508n,00712.3w", Place(50.10846666666667, -7.205)),
        ("-0050.5S,00712.3E", (0, "latitude")),
        ("+0050.5N,00712.3E", (0, "latitude")),
        ("-0050.5,7.3", (0, "latitude")),
        ("5106.508N,12.3W", (1, "longitude")),
        ("50.5N,00712.3E", (0, "latitude")),
    ],
)
def test_degrees_and_minutes_are_read_as_receivers_send_them(line: str, place: Place | tuple[int, str]) -> None:
    found = place_in(line)
    if isinstance(place, Place):
        assert isinstance(found, Place)
        assert (found.lat, found.lon) == pytest.approx((place.lat, place.lon), abs=1e-9)
    else:
        assert found == place


def test_receivers_degrees_and_minutes_have_their_hemispheres_in_columns() -> None:
    row = Row(1, cells_of("5006.508,N,00712.3,W"))
    columns = place_columns(("lat", "ns", "lon", "ew"), [row])
    assert columns is not None
    place = columns.place(row)
    assert isinstance(place, Place)
    assert (place.lat, place.lon) == pytest.approx((50.10846666666667, -7.205), abs=1e-9)


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
        ("999999,9300000,32N", 0),
        ("500000,9999999,32N", 1),
        ("500000,0,60S", 1),
        ("500000,500000,33U", 2),
        ("500000,4000000,17Q", 2),
        ("500000,5500000,33M", 2),
        ("279215,,22N", 1),
        ("79215,5359442,22N", 0),
        ("nan,5359442,22N", 0),
    ],
)
def test_utm_that_tells_no_place_is_refused(line: str, column: int) -> None:
    row = Row(1, cells_of(line))
    columns = place_columns(("easting", "northing", "zone"), [row])
    assert columns is not None
    assert columns.place(row) == (column, "utm")


def test_degrees_in_columns_of_a_grid_are_degrees_and_metres_without_a_zone_are_nothing() -> None:
    degrees = Row(1, cells_of("-53.98013,48.34954"))
    columns = place_columns(("Easting", "Northing"), [degrees])
    assert columns is not None
    assert columns.place(degrees) == Place(48.34954, -53.98013)
    for metres in ("279215,5359442", "10,20", "10.25,20.75"):
        assert place_columns(("Easting", "Northing"), [degrees, Row(2, cells_of(metres))]) is None


@pytest.mark.parametrize("cells", ["50.5,WGS,7.25,WGS", "50.5,9,7.25,12", "50.5,,7.25,", "50.5,station,7.25,Wald"])
def test_a_column_of_references_or_satellites_turns_no_place(cells: str) -> None:
    row = Row(1, cells_of(cells))
    columns = place_columns(("lat", "lat_ref", "lon", "lon_ref"), [row])
    assert columns is not None
    assert columns.place(row) == Place(50.5, 7.25)


def test_a_row_without_the_letter_that_others_have_is_left_out() -> None:
    rows = [Row(k, cells_of(line)) for k, line in enumerate(("33.9,S,18.4,E", "33.9,,18.4,E", "33.9,S,18.4,Wald"))]
    columns = place_columns(("lat", "ns", "lon", "ew"), rows)
    assert columns is not None
    assert [columns.place(row) for row in rows] == [Place(-33.9, 18.4), (0, "latitude"), (2, "longitude")]


def test_minutes_in_columns_of_their_own_and_zones_of_a_study_name_no_place() -> None:
    row = Row(1, cells_of("50,30.5,7,15.2"))
    assert place_columns(("lat_deg", "lat_min", "lon_deg", "lon_min"), [row]) is None
    study = [Row(k, cells_of(f"350000,5540000,{k}N")) for k in (1, 2, 3)]
    assert place_columns(("easting", "northing", "zone"), study) is None
    assert place_columns(("easting", "northing", "zone"), study[:2]) is not None
