"""A leg that was listened on: its record, and that record as the planner takes it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from backend.events import BearingSource, HeardOnTheWay, StretchFact
from backend.spec import SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.on_the_way import OnTheWay, WayError, WayReadings, heard_on_the_way
from hardware.direction_finding.silence import relative_gain_db
from hardware.frame import LocalFrame
from hardware.readings import HeadingSample, Place, PowerSample
from hardware.reasons.on_the_way import NoseSwung
from planner.on_the_way import Stretch


@dataclass(frozen=True, slots=True)
class Leg:
    """begin: where it led from. turned_at: where the craft turned and listened, or will. place_number: of its end.
    nose: what it did meanwhile, where it swung."""

    source: BearingSource
    place_number: int
    begin: Place
    turned_at: tuple[Place, ...]
    nose: tuple[NoseSwung, ...] = ()


def way_fact(
    leg: Leg,
    emitter_id: str,
    sensor: SensorSpec,
    pattern: AntennaPattern,
    samples: Sequence[PowerSample],
    headings: Sequence[HeadingSample],
) -> HeardOnTheWay:
    """samples: of the emitter's channel, of the leg's time."""
    found = heard_on_the_way(samples, headings, pattern.offset_to_nose_deg, leg.begin, leg.turned_at)
    return HeardOnTheWay(
        emitter_id=emitter_id,
        source=leg.source,
        leg_id=str(uuid4()),
        place_number=leg.place_number,
        counted=found.counted,
        left_out=list(found.left_out),
        nose=list(leg.nose),
        stretches=_drawn(found),
        origin=leg.begin,
        readings=found.readings.packed() if found.counted else None,
        gain_db=[round(gain, 2) for gain in relative_gain_db(pattern)],
        sigma_deg=sensor.sigma_deg,
    )


def _drawn(found: OnTheWay) -> list[StretchFact]:
    frame, readings = LocalFrame(found.readings.origin), found.readings
    drawn: list[StretchFact] = []
    for here in _of_each(readings):
        first, last = here[0], here[-1]
        begin, end = (frame.to_geo(float(readings.east_m[k]), float(readings.north_m[k])) for k in (first, last))
        drawn.append(StretchFact(begin=begin, end=end, turned_deg=float(np.ptp(readings.front_deg[here]))))
    return drawn


def _of_each(readings: WayReadings) -> list[NDArray[np.int64]]:
    return [np.flatnonzero(readings.stretch == k) for k in np.unique(readings.stretch)]


def stretches_of(fact: HeardOnTheWay, frame: LocalFrame, source: str) -> tuple[Stretch, ...]:
    """In metres of `frame` and rad ccw from east. None of a record that cannot be unpacked."""
    if fact.readings is None:
        return ()
    try:
        readings = WayReadings.unpacked(fact.origin, fact.readings)
    except WayError:
        return ()
    east, north = frame.to_enu(fact.origin)
    gain = np.array(fact.gain_db)[-np.arange(len(fact.gain_db)) % len(fact.gain_db)]
    front = np.radians(90.0 - readings.front_deg)
    return tuple(
        Stretch(
            source=source,
            x=tuple((east + readings.east_m[here]).tolist()),
            y=tuple((north + readings.north_m[here]).tolist()),
            front=tuple(front[here].tolist()),
            power_db=tuple(readings.power_db[here].tolist()),
            gain_db=tuple(gain.tolist()),
            sigma=math.radians(fact.sigma_deg),
            leg=fact.leg_id,
        )
        for here in _of_each(readings)
    )
