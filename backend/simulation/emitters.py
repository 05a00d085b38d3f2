"""What transmits in the simulated world, and where it stands."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from backend.api.suggestion import HEIGHT_M, WIDTH_M
from backend.spec import EmitterSpec
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sim.walk import Gait

EDGE_M = 10.0
"""An emitter stays so far inside the suggested area."""
LIMITS = ((0.001, 1e6), (0.01, 3600.0), (0.0, 100.0))
"""Of a frequency (MHz), a pulse period (s) and a speed (m/s), as somebody writes them."""


@dataclass(frozen=True, slots=True)
class SimulatedEmitter:
    """pulse_period_s None: a carrier. gait, speed_m_s: how it moves, None: it stands still."""

    frequency_hz: float
    pulse_period_s: float | None = None
    gait: Gait | None = None
    speed_m_s: float = 0.0


EMITTERS = (
    SimulatedEmitter(EmitterSpec().frequency_hz),
    SimulatedEmitter(150_000_000.0, EmitterSpec().pulse_period_s),
    SimulatedEmitter(121_500_000.0),
    SimulatedEmitter(1_575_420_000.0),
)
"""The suggested mission's emitter, and those of the page's presets (wildlife tag, rescue beacon, interference)."""

GAITS: tuple[Gait, ...] = ("animal", "walking", "drifting")
FORM = "MHZ, MHZ/PULSE_PERIOD_S, and ,GAIT:SPEED behind either, as in 150.1, 150.1/1.5 or 150.1/1.5,animal:0.2"


def read_emitter(text: str) -> SimulatedEmitter:
    """An emitter as somebody writes it (FORM). Raises ValueError that shows the form."""
    radio, _, motion = text.partition(",")
    frequency, _, period = radio.partition("/")
    gait, _, speed = motion.partition(":")
    known: Gait | None = next((one for one in GAITS if one == gait.strip()), None)
    try:
        numbers = [float(part) for part in (frequency, period or "1", speed if motion else "1")]
    except ValueError:
        numbers = [math.nan]
    in_limits = all(low <= number <= high for number, (low, high) in zip(numbers, LIMITS, strict=False))  # NaN: in none
    if not in_limits or ("/" in radio and not period) or ("," in text and known is None):
        raise ValueError(f"{text!r} is no simulated emitter: write {FORM}; gaits: {', '.join(GAITS)}")
    mhz, period_s, speed_m_s = numbers
    frequency_hz = float(round(mhz * 1e6))
    return SimulatedEmitter(frequency_hz, period_s if period else None, known, speed_m_s if known else 0.0)


def world_of(texts: Sequence[str]) -> tuple[SimulatedEmitter, ...]:
    """What is always there, and what these texts add or put in its place. Raises ValueError also for one frequency
    named twice."""
    own = {emitter.frequency_hz: emitter for emitter in map(read_emitter, texts)}
    if len(own) < len(texts):
        raise ValueError("two simulated emitters have one frequency: a receiver could not tell them apart")
    return (*(other for other in EMITTERS if other.frequency_hz not in own), *own.values())


def emitter_places(seed: int, home: Place, emitters: Sequence[SimulatedEmitter]) -> Mapping[float, Place]:
    """Where each stands, by its frequency: anywhere in the area that is suggested around `home`.

    By the seed and the whole megahertz; of several in one megahertz, the first has the first place drawn, and so on.
    """
    frame = LocalFrame(home)
    draws: dict[int, np.random.Generator] = {}
    places: dict[float, Place] = {}
    for emitter in emitters:
        megahertz = int(emitter.frequency_hz / 1e6)
        rng = draws.setdefault(megahertz, np.random.default_rng([seed, megahertz]))
        east = rng.uniform(-WIDTH_M / 2 + EDGE_M, WIDTH_M / 2 - EDGE_M)
        north = rng.uniform(EDGE_M, HEIGHT_M - EDGE_M)
        places[emitter.frequency_hz] = frame.to_geo(float(east), float(north))
    return places
