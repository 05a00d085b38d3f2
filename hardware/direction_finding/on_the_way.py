"""Readings taken in flight, each at its own place, heading and time, made into stretches of about 20 m of way.

A reading whose heading or place is not known is left out and counted, as is one that could say nothing: beside a place
where the craft turns, echoes are those of that turn and would count twice; with an antenna that points one way, power
shows no direction.
"""

from __future__ import annotations

import base64
import binascii
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.sweep import IMPLAUSIBLE_DB, MAXIMUM_HEADING_GAP_S, MAXIMUM_HEADING_STEP_DEG
from hardware.frame import LocalFrame
from hardware.readings import HeadingSample, Place, PowerSample
from hardware.reasons.on_the_way import ReadingsLeftOut, WhyLeftOut

STRETCH_M = 20.0
UNSURE_M = 5.0
"""A reported place that jumps have carried further is not known."""
HEARD_DB = 6.0
BESIDE_M = 10.0
LEAST_TURN_DEG = 10.0
LOOK_M, LOOK_DEG = 4.0, 6.0
"""Readings in a row that are nearer to one another than this are averaged."""
MOST_STRETCHES = 24
"""Of a leg: 480 m of way, some 6 kB. Of more those are kept in which the antenna turned furthest."""
MOST_READINGS = 200 * MOST_STRETCHES
WHYS: tuple[WhyLeftOut, ...] = get_args(WhyLeftOut)
_STEP = 0.1
"""m, degrees and dB of what is packed."""


class WayError(ValueError):
    """Packed readings that cannot be unpacked; the message says why."""


@dataclass(frozen=True, slots=True)
class WayReadings:
    """(n,) each. stretch: to which a reading belongs, from 0 on without gaps. east_m, north_m: from `origin`.

    front_deg: antenna heading clockwise from north by the compass, continuous within a stretch. power_db: above the
    leg's least.
    """

    origin: Place
    stretch: NDArray[np.int64]
    east_m: NDArray[np.float64]
    north_m: NDArray[np.float64]
    front_deg: NDArray[np.float64]
    power_db: NDArray[np.float64]

    def packed(self) -> str:
        """In tenths of metres, degrees and decibels, deflated, base64."""
        columns = [self.stretch / 10.0, self.east_m, self.north_m, self.front_deg, self.power_db]
        rows = np.rint(np.array(columns) / _STEP).astype(np.int64)
        steps = np.diff(rows, axis=1, prepend=0).astype("<i4")  # from reading to reading little changes
        return base64.b64encode(zlib.compress(steps.tobytes(), 9)).decode("ascii")

    @classmethod
    def unpacked(cls, origin: Place, text: str) -> WayReadings:
        """What `packed` made. Raises WayError."""
        try:
            unpack = zlib.decompressobj()
            raw = unpack.decompress(base64.b64decode(text, validate=True), 20 * MOST_READINGS + 1)
            whole = unpack.eof
        except (binascii.Error, zlib.error, ValueError) as error:
            raise WayError(f"the readings of a leg are damaged ({error}); it is taken as not listened to") from error
        if len(raw) % 20 or not whole or len(raw) > 20 * MOST_READINGS:
            raise WayError(f"the readings of a leg have {len(raw)} bytes, which is no number of readings")
        rows = np.cumsum(np.frombuffer(raw, dtype="<i4").reshape(5, -1).astype(np.int64), axis=1)
        stretch, east, north, front, power = rows
        return cls(origin, stretch, _STEP * east, _STEP * north, _STEP * front, _STEP * power)


@dataclass(frozen=True, slots=True)
class OnTheWay:
    """What one leg told. counted: power samples behind `readings`; left_out: those that say nothing, by reason."""

    readings: WayReadings
    counted: int
    left_out: tuple[ReadingsLeftOut, ...]


def heard_on_the_way(
    samples: Sequence[PowerSample],
    headings: Sequence[HeadingSample],
    offset_to_nose_deg: float,
    origin: Place,
    turned_at: Sequence[Place],
) -> OnTheWay:
    """Of one leg. samples, headings: any order, headings with their places. turned_at: where the craft has turned and
    listened, or will. Never raises: what cannot be used is left out."""
    heard = sorted((s for s in samples if s.detected), key=lambda s: s.at_s)
    why = np.full(len(heard), "", dtype=object)
    at = np.array([s.at_s for s in heard])
    power = np.array([s.power_db for s in heard], dtype=np.float64)
    floor = np.array([-np.inf if s.noise_floor_db is None else s.noise_floor_db for s in heard])
    east, north, nose, heading_known, place_known = _poses(at, headings, LocalFrame(origin))
    beside = np.zeros(len(heard), dtype=bool)
    for place in turned_at:
        x, y = LocalFrame(origin).to_enu(place)
        beside |= np.hypot(east - x, north - y) < BESIDE_M
    with np.errstate(invalid="ignore"):
        causes: list[tuple[WhyLeftOut, NDArray[np.bool_]]] = [
            ("heading_unknown", ~heading_known),
            ("place_unknown", ~place_known),
            ("overdriven", np.array([s.clipped for s in heard], dtype=bool)),
            ("at_noise", ~((power >= floor + HEARD_DB) & (np.abs(power) < IMPLAUSIBLE_DB))),
            ("beside_a_turn", beside),
        ]
    for name, where in causes:
        why[where & (why == "")] = name
    kept = np.flatnonzero(why == "")
    front = nose + offset_to_nose_deg
    parts = _widest(_stretches(kept, east, north), front, why)
    looks = [_looks(np.array([east[part], north[part], front[part], power[part]])) for part in parts]
    index = np.repeat(np.arange(len(looks)), [one.shape[1] for one in looks]) if looks else np.zeros(0, np.int64)
    rows = np.concatenate(looks, axis=1) if looks else np.zeros((4, 0))
    rows[3] -= rows[3].min(initial=np.inf) if rows.size else 0.0
    readings = WayReadings(origin, index, rows[0], rows[1], rows[2], rows[3])
    counts: list[tuple[WhyLeftOut, int]] = [(name, int((why == name).sum())) for name in WHYS]
    left_out = tuple(ReadingsLeftOut(name, count) for name, count in counts if count)
    return OnTheWay(readings, int((why == "").sum()), left_out)


def _poses(
    at: NDArray[np.float64], headings: Sequence[HeadingSample], frame: LocalFrame
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]:
    """East, north (m), nose (degrees, continuous) at times (n,), and whether heading and place are known there."""
    track = sorted((h for h in headings if np.isfinite(h.heading_deg) and np.isfinite(h.at_s)), key=lambda h: h.at_s)
    if len(track) < 2 or at.size == 0:
        unknown, nowhere = np.zeros(at.size, dtype=bool), np.full(at.size, np.nan)
        return nowhere, nowhere, np.zeros(at.size), unknown, unknown
    track_s = np.array([h.at_s for h in track])
    nose = np.unwrap(np.array([h.heading_deg for h in track]), period=360.0)
    after = np.clip(np.searchsorted(track_s, at), 1, track_s.size - 1)
    known = (at >= track_s[0]) & (at <= track_s[-1])
    known &= track_s[after] - track_s[after - 1] <= MAXIMUM_HEADING_GAP_S
    known &= np.abs(nose[after] - nose[after - 1]) <= MAXIMUM_HEADING_STEP_DEG
    sure = np.array([h.position is not None and h.displaced_m <= UNSURE_M for h in track]) & ~_held_up(track)
    nowhere = (np.nan, np.nan)
    lon_lat = np.array([nowhere if h.position is None else (h.position.lon, h.position.lat) for h in track])
    x, y = frame.to_enu_points(lon_lat).T
    share = (at - track_s[after - 1]) / np.maximum(track_s[after] - track_s[after - 1], 1e-9)
    east, north = (one[after - 1] + share * (one[after] - one[after - 1]) for one in (x, y))
    there = known & sure[after] & sure[after - 1] & np.isfinite(east) & np.isfinite(north)
    return east, north, np.interp(at, track_s, nose), known, there


def _held_up(track: Sequence[HeadingSample]) -> NDArray[np.bool_]:
    """True where the reported place stayed the same to the last digit for too long to be a live report."""
    found, begin = np.zeros(len(track), dtype=bool), 0
    for k in range(1, len(track) + 1):
        if k == len(track) or track[k].position != track[begin].position:
            found[begin:k] = track[k - 1].at_s - track[begin].at_s > MAXIMUM_HEADING_GAP_S
            begin = k
    return found


def _way(east: NDArray[np.float64], north: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) m flown until each point, in steps of LOOK_M at least: a place that jitters is no way."""
    way = np.zeros(east.size)
    last = 0
    for k in range(1, east.size):
        step = float(np.hypot(east[k] - east[last], north[k] - north[last]))
        way[k] = way[last] + step
        if step >= LOOK_M:
            last = k
    return np.maximum.accumulate(way)


def _stretches(
    kept: NDArray[np.int64], east: NDArray[np.float64], north: NDArray[np.float64]
) -> list[NDArray[np.int64]]:
    """The kept readings in pieces of equal way, each about STRETCH_M."""
    if kept.size == 0:
        return []
    way = _way(east[kept], north[kept])
    pieces = max(round(way[-1] / STRETCH_M), 1)
    piece = np.minimum((way / max(way[-1], 1e-9) * pieces).astype(np.int64), pieces - 1)
    return [kept[piece == k] for k in range(pieces) if (piece == k).any()]


def _widest(
    parts: list[NDArray[np.int64]], front: NDArray[np.float64], why: NDArray[np.object_]
) -> list[NDArray[np.int64]]:
    """The stretches in which the antenna turned, at most MOST_STRETCHES, in their order; `why` takes the others."""
    turned = [float(np.ptp(front[part])) for part in parts]
    turning = [k for k, turn in enumerate(turned) if turn >= LEAST_TURN_DEG]
    most = sorted(sorted(turning, key=lambda k: -turned[k])[:MOST_STRETCHES])
    for k, part in enumerate(parts):
        if k not in turning:
            why[part] = "pointed_one_way"
        elif k not in most:
            why[part] = "too_many"
    return [parts[k] for k in most]


def _looks(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """(4, m) means of readings (4, n) that follow one another within LOOK_M and LOOK_DEG; at most 200."""
    east, north, front, _ = rows
    turned = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(front)))])
    moved = _way(east, north) / LOOK_M + turned / LOOK_DEG
    number = np.minimum(moved, moved * 199.0 / max(moved[-1], 199.0)).astype(np.int64)
    _, number = np.unique(number, return_inverse=True)
    return np.array([np.bincount(number, row) for row in rows]) / np.bincount(number)
