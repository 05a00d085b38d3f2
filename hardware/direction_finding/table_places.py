"""Places in a table: decimal degrees, whose hemisphere is a sign, a letter beside the number or in the next column; or
UTM, as biologists' hand-held receivers write it."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Literal

import utm

from hardware.direction_finding.table_file import Row, column_of, number_of
from hardware.readings import Place
from hardware.reasons.table import Quantity

LATITUDE = ("lat", "lat_deg", "latitude", "latitude_deg")
LONGITUDE = ("lon", "lon_deg", "lng", "long", "longitude", "longitude_deg")
"""Names of their columns."""

EASTING = ("easting", "easting_m", "utm_easting", "utm_e", "utm_x")
NORTHING = ("northing", "northing_m", "utm_northing", "utm_n", "utm_y")
ZONE = ("utm_zone", "utmzone", "zone")
_ZONE = re.compile(r"(\d{1,2}) ?([C-HJ-NP-X])")
_EPSG = re.compile(r"(?:EPSG:)?32([67])(\d\d)", re.IGNORECASE)
_ZONES = 60
_EASTINGS_M = (100_000.0, 1_000_000.0)
_MOST_NORTHING_M = 10_000_000.0
_BAND_S_M = (3.5e6, 4.5e6)
"""32 to 40 degrees north, rounded outwards."""

_Axis = Literal["latitude", "longitude"]

_SIGNS: dict[_Axis, dict[str, float]] = {"latitude": {"N": 1.0, "S": -1.0}, "longitude": {"E": 1.0, "W": -1.0}}
_UNSURE = "O"
"""East in German, west in French and Spanish."""
_MOST_DEG: dict[_Axis, float] = {"latitude": 90.0, "longitude": 180.0}


@dataclass(frozen=True, slots=True)
class PlaceColumns:
    """Indices from 0. lat_letter, lon_letter: those that hold nothing but hemispheres; None: there is none."""

    lat: int
    lon: int
    lat_letter: int | None = None
    lon_letter: int | None = None

    @property
    def columns(self) -> tuple[int | None, ...]:
        """All of them."""
        return (self.lat, self.lon, self.lat_letter, self.lon_letter)

    def place(self, row: Row) -> Place | tuple[int, Quantity]:
        """Where the row was taken, or the column that does not tell it. Receivers without a fix write 0, 0."""
        lat = _degrees(row, self.lat, self.lat_letter, "latitude")
        lon = _degrees(row, self.lon, self.lon_letter, "longitude")
        if lat is None or lat == lon == 0.0:
            return self.lat, "latitude"
        return (self.lon, "longitude") if lon is None else Place(lat, lon)


@dataclass(frozen=True, slots=True)
class UtmColumns:
    """Indices from 0 of places in the Universal Transverse Mercator grid."""

    easting: int
    northing: int
    zone: int

    @property
    def columns(self) -> tuple[int, ...]:
        """All of them."""
        return (self.easting, self.northing, self.zone)

    def place(self, row: Row) -> Place | tuple[int, Quantity]:
        """Where the row was taken, or the column that does not tell it."""
        easting, northing = row.number(self.easting), row.number(self.northing)
        if easting is None or not _EASTINGS_M[0] <= easting < _EASTINGS_M[1]:
            return self.easting, "utm"
        if northing is None or not 0.0 <= northing <= _MOST_NORTHING_M:
            return self.northing, "utm"
        zone = _zone(row.cells[self.zone] if self.zone < len(row.cells) else "", northing)
        if zone is None:
            return self.zone, "utm"
        number, northern = zone
        return Place(*map(float, utm.to_latlon(easting, northing, number, northern=northern)))


def _zone(cell: str, northing_m: float) -> tuple[int, bool] | None:
    """(number, whether it is north of the equator) of "22N", the band "22U" or EPSG:32622; None where it does not tell,
    as "17S" between 32 and 40 degrees, which is either the band there or the hemisphere."""
    found = _EPSG.fullmatch(cell)
    if found is not None:
        number, northern = int(found[2]), found[1] == "6"
    else:
        found = _ZONE.fullmatch(cell.upper())
        if found is None or (found[2] == "S" and _BAND_S_M[0] <= northing_m <= _BAND_S_M[1]):
            return None
        number, northern = int(found[1]), found[2] >= "N" and found[2] != "S"
    return (number, northern) if 1 <= number <= _ZONES else None


Places = PlaceColumns | UtmColumns


def place_columns(names: tuple[str, ...], rows: Sequence[Row], others: Collection[int | None]) -> Places | None:
    """By a header's names; None: it names none. others: columns that hold something else."""
    easting, northing, zone = (column_of(names, *some) for some in (EASTING, NORTHING, ZONE))
    lat, lon = column_of(names, *LATITUDE), column_of(names, *LONGITUDE)
    if lat is not None and lon is not None:
        return degree_columns(rows, lat, lon, others)
    if easting is None or northing is None:
        return None
    if zone is not None:
        return UtmColumns(easting, northing, zone)
    in_degrees = all(abs(row.number(easting) or 0.0) <= _MOST_DEG["longitude"] for row in rows)
    return degree_columns(rows, northing, easting, others) if in_degrees else None


def degree_columns(rows: Sequence[Row], lat: int, lon: int, others: Collection[int | None] = ()) -> PlaceColumns:
    """With the columns of letters beside them."""
    taken = {lat, lon, *others}
    beside = _letters(rows, lat + 1, "latitude", taken), _letters(rows, lon + 1, "longitude", taken)
    return PlaceColumns(lat, lon, *beside)


def _letters(rows: Sequence[Row], column: int, axis: _Axis, taken: Collection[int | None]) -> int | None:
    """The column, if each of its cells that is not empty is one letter of a hemisphere."""
    if column in taken:
        return None
    cells = {row.cells[column].upper() for row in rows if column < len(row.cells)} - {""}
    return column if cells and cells <= {*_SIGNS[axis], _UNSURE} else None


def _degrees(row: Row, column: int, letter: int | None, axis: _Axis) -> float | None:
    """None where they are missing, too many, or of no hemisphere or two."""
    if column >= len(row.cells):
        return None
    signs, cell, told = _SIGNS[axis], row.cells[column].upper(), list[str]()
    value = number_of(cell)
    if value is None:
        told = [end for end in {cell[:1], cell[-1:]} if end in signs]
        value = number_of(cell.strip("".join(signs)).strip())
    if letter is not None:
        told.append(row.cells[letter].upper() if letter < len(row.cells) else "")
    if value is None or len(told) > 1 or (told and (value < 0.0 or told[0] not in signs)):
        return None
    signed = signs[told[0]] * value if told else value
    return signed if abs(signed) <= _MOST_DEG[axis] else None
