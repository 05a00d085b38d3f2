"""Places in a table: degrees, decimal or with minutes, whose hemisphere is a sign, a letter beside the number or in a
column of its own; or UTM, as biologists' hand-held receivers write it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import utm

from hardware.direction_finding.table_file import Row, column_of, number_of
from hardware.readings import Place
from hardware.reasons.table import Quantity

LATITUDE = ("lat", "lat_deg", "latitude", "latitude_deg")
LONGITUDE = ("lon", "lon_deg", "lng", "long", "longitude", "longitude_deg")
EASTING = ("easting", "easting_m", "utm_easting", "utm_e", "utm_x")
NORTHING = ("northing", "northing_m", "utm_northing", "utm_n", "utm_y")
ZONE = ("utm_zone", "utmzone", "zone")
"""Names of their columns."""

_Axis = Literal["latitude", "longitude"]

_OWN = ("dir", "ref", "hem", "hemisphere")
_LETTERS: dict[_Axis, tuple[str, ...]] = {
    "latitude": ("ns", "n_s", *(f"{axis}_{own}" for axis in ("lat", "latitude") for own in ("ns", "n_s", *_OWN))),
    "longitude": ("ew", "e_w", *(f"{axis}_{own}" for axis in ("lon", "longitude") for own in ("ew", "e_w", *_OWN))),
}
_OF_ZONE = (*(f"{of}hemisphere" for of in ("", "utm_", "zone_")), *_LETTERS["latitude"])
_SIGNS: dict[_Axis, dict[str, float]] = {"latitude": {"N": 1.0, "S": -1.0}, "longitude": {"E": 1.0, "W": -1.0}}
_WORDS = {"NORTH": "N", "NORD": "N", "SOUTH": "S", "SÜD": "S", "SUD": "S", "EAST": "E", "EST": "E", "WEST": "W"}
_UNSURE = {"O", "OST", "OUEST", "OESTE"}
"""O is east in German, west in French and Spanish."""
_PARTS = tuple(f"{axis}_{part}" for axis in ("lat", "lon") for part in ("min", "minutes", "sec", "seconds"))
"""Names of columns that hold a part of a place: it is read from one cell alone."""
_MOST_DEG: dict[_Axis, float] = {"latitude": 90.0, "longitude": 180.0}
_FINE_DEG = re.compile(r"[+-]?\d{1,3}[.,]\d{4,}")
"""Degrees of places, to ten metres and finer."""

_MINUTES = re.compile(r"(\d{1,3})[°º: ] ?(\d{1,2}(?:[.,]\d{1,9})?)['′’]?")
_SECONDS = re.compile(r"(\d{1,3})[°º: ] ?(\d{1,2})['′’: ] ?(\d{1,2}(?:[.,]\d{1,9})?)(?:\"|″|”|'')?")
"""Of no sign: which parts it would hold for is written in more than one way."""
_SENT: dict[_Axis, re.Pattern[str]] = {
    "latitude": re.compile(r"[+-]?(\d\d)(\d\d(?:[.,]\d{1,9})?)"),
    "longitude": re.compile(r"[+-]?(\d{3})(\d\d(?:[.,]\d{1,9})?)"),
}
"""Degrees and minutes in one number, as in the sentences that receivers send (NMEA 0183): without a sign, for which
they have letters."""

_ZONE = re.compile(r"(?:UTM ?)?0?(\d{1,2})(?:[ -]?([C-HJ-NP-X])((?<=N)ORTH|(?<=S)OUTH)?)?")
_EPSG = re.compile(r"(?:EPSG:)?32([67])(\d\d)")
_ZONES, _ZONE_DEG = 60, 6.0
MOST_ZONES = 2
"""Of one file: more are no zones of UTM, but parts of a study's area."""
_WIDEST_DEG = 7.0
"""From a zone's middle: Svalbard's reach 6 degrees."""
_EASTINGS_M = (100_000.0, 1_000_000.0)
_NORTHINGS_M = {True: (0.0, 9.34e6), False: (1.1e6, 1e7)}
"""North and south of the equator: to 84 and 80 degrees."""
_BAND_S_M = (3.5e6, 4.5e6)
"""32 to 40 degrees north, rounded outwards."""
_BANDS, _BAND_DEG = "CDEFGHJKLMNPQRSTUVWX", 8.0
"""From 80 degrees south; the last one ends at 84 north."""
_BAND_EDGE_DEG = 0.5


@dataclass(frozen=True, slots=True)
class PlaceColumns:
    """Indices from 0. lat_letter, lon_letter: those of the hemispheres; None: there is none."""

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
        if lon is None:
            return self.lon, "longitude"
        lat_sent, lon_sent = _sent(row, self.lat, "latitude"), _sent(row, self.lon, "longitude")
        if (lat_sent is None) != (lon_sent is None):  # spreadsheets take the zeros in front away that tell them apart
            return (self.lon, "longitude") if lon_sent is None else (self.lat, "latitude")
        return Place(lat, lon)


def _degrees(row: Row, column: int, letter: int | None, axis: _Axis) -> float | None:
    """None where they are missing, too many, or of no hemisphere or two."""
    if column >= len(row.cells):
        return None
    signs, cell, told = _SIGNS[axis], row.cells[column], list[str]()
    value = number_of(cell)
    if value is None:
        told = [end for end in {cell[:1].upper(), cell[-1:].upper()} if end in signs]
        value = number_of(cell.strip("NSEWnsew").strip()) if told else None
        # a small letter behind seconds is their unit
        value = _sexagesimal(cell.strip("NSEW").strip()) if value is None else value
    sent = _sent(row, column, axis)
    if letter is not None:
        told.append(_hemisphere(row, letter))
    if sent is not None:
        value = _sexagesimal(f"{sent[1]}:{sent[2]}") if told and sent[0][0] not in "+-" else None
    if value is None or len(told) > 1 or not signs.keys() >= {*told}:
        return None
    if told and value < 0.0 and signs[told[0]] > 0.0:
        return None
    signed = signs[told[0]] * abs(value) if told else value
    return signed if abs(signed) <= _MOST_DEG[axis] else None


def _sent(row: Row, column: int, axis: _Axis) -> re.Match[str] | None:
    return _SENT[axis].fullmatch(row.cells[column].strip("NSEWnsew").strip())


def _hemisphere(row: Row, column: int) -> str:
    """N, S, E, W, what is unsure, or empty."""
    word = row.cells[column].strip("°. ").upper() if column < len(row.cells) else ""
    known = _WORDS.get(word, word)
    return known if known in {"N", "S", "E", "W", *_UNSURE} else ""


def _letters(names: tuple[str, ...], rows: Sequence[Row], *called: str) -> int | None:
    """The column that is called so, unless it holds something else than hemispheres, as a number of satellites."""
    column = column_of(names, *called)
    return column if column is not None and any(_hemisphere(row, column) for row in rows) else None


def _sexagesimal(cell: str) -> float | None:
    """Degrees of 50°06'30.5", 50 06.508 or 50:06:30.5; None for anything else."""
    found = _MINUTES.fullmatch(cell) or _SECONDS.fullmatch(cell)
    if found is None:
        return None
    degrees, minutes, seconds = (float(part.replace(",", ".")) for part in (*found.groups(), "0")[:3])
    return degrees + minutes / 60.0 + seconds / 3600.0 if max(minutes, seconds) < 60.0 else None


@dataclass(frozen=True, slots=True)
class UtmColumns:
    """Indices from 0 of places in the Universal Transverse Mercator grid. letter: that of the hemispheres; None: there
    is none, and zones tell theirs."""

    easting: int
    northing: int
    zone: int
    letter: int | None = None

    @property
    def columns(self) -> tuple[int | None, ...]:
        """All of them."""
        return (self.easting, self.northing, self.zone, self.letter)

    def place(self, row: Row) -> Place | tuple[int, Quantity]:
        """Where the row was taken, or the column that does not tell it."""
        easting, northing = row.number(self.easting), row.number(self.northing)
        if easting is None or not _EASTINGS_M[0] <= easting < _EASTINGS_M[1]:
            return self.easting, "utm"
        if northing is None:
            return self.northing, "utm"
        zone = _zone_of(row, self.zone, self.letter, northing)
        if zone is None:
            return self.zone, "utm"
        least, most = _NORTHINGS_M[zone.northern]
        if not least <= northing <= most:
            return self.northing, "utm"
        lat, lon = map(float, utm.to_latlon(easting, northing, zone.number, northern=zone.northern))
        if abs(lon - (_ZONE_DEG * zone.number - 183.0)) > _WIDEST_DEG:
            return self.easting, "utm"
        return Place(lat, lon) if _fits(zone.band, lat) else (self.zone, "utm")


@dataclass(frozen=True, slots=True)
class _Zone:
    """band: the letter of eight degrees of latitude; empty: only the hemisphere is known."""

    number: int
    northern: bool
    band: str = ""


def _zone_of(row: Row, column: int, letter: int | None, northing_m: float) -> _Zone | None:
    """Of "22N", the band "22U", "22 North" or EPSG:32622, or of "22" beside its hemisphere; None where it does not
    tell, as "17S" between 32 and 40 degrees, which is either the band there or the hemisphere."""
    told = row.cells[column].strip().upper() if column < len(row.cells) else ""
    north = {"N": True, "S": False}.get("" if letter is None else _hemisphere(row, letter))
    by_code, found = _EPSG.fullmatch(told), _ZONE.fullmatch(told)
    if by_code is not None:
        zone = _Zone(int(by_code[2]), by_code[1] == "6")
    elif found is None or (found[2] is None and north is None):
        return None
    elif found[2] is None:
        zone = _Zone(int(found[1]), north is True)
    elif found[2] == "S" and not found[3] and north is not False:
        if north is None and _BAND_S_M[0] <= northing_m <= _BAND_S_M[1]:
            return None
        zone = _Zone(int(found[1]), north is True, "S" if north else "")
    else:
        zone = _Zone(int(found[1]), found[2] >= "N" and found[2] != "S", "" if found[2] in "NS" else found[2])
    return zone if 1 <= zone.number <= _ZONES and north in (None, zone.northern) else None


def _fits(band: str, lat: float) -> bool:
    if not band:
        return True
    south = _BAND_DEG * _BANDS.index(band) - 80.0
    north = 84.0 if band == _BANDS[-1] else south + _BAND_DEG
    return south - _BAND_EDGE_DEG <= lat <= north + _BAND_EDGE_DEG


Places = PlaceColumns | UtmColumns


def place_columns(names: tuple[str, ...], rows: Sequence[Row]) -> Places | None:
    """By a header's names; None: it names none, parts of them, metres without a zone, or zones far apart."""
    easting, northing, zone = (column_of(names, *some) for some in (EASTING, NORTHING, ZONE))
    lat, lon = column_of(names, *LATITUDE), column_of(names, *LONGITUDE)
    if lat is not None and lon is not None:
        letters = (_letters(names, rows, *called) for called in _LETTERS.values())
        return PlaceColumns(lat, lon, *letters) if column_of(names, *_PARTS) is None else None
    if easting is None or northing is None:
        return None
    if zone is not None:
        letter = _letters(names, rows, *_OF_ZONE)
        zones = {found.number for row in rows if (found := _zone_of(row, zone, letter, 0.0))}
        return UtmColumns(easting, northing, zone, letter) if len(zones) <= MOST_ZONES else None
    cells = {row.cells[k] for row in rows for k in (easting, northing) if row.number(k) is not None}
    return PlaceColumns(northing, easting) if cells and all(map(_FINE_DEG.fullmatch, cells)) else None
