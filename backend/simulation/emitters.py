"""What transmits in the simulated world, and where it stands."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from backend.api.suggestion import HEIGHT_M, WIDTH_M
from backend.spec import EmitterSpec
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sim.walk import Gait

EDGE_M = 10.0
"""An emitter stays so far inside the suggested area."""
CLOCK_ERROR, STRAY_S = 0.005, 0.003
"""Of a tag's oscillator, and by how much its pulses stray, where they have to be told from another's."""
LIMITS = ((0.001, 1e6), (0.01, 3600.0), (0.0, 100.0))
"""Of a frequency (MHz), a pulse period (s) and a speed (m/s), as somebody writes them."""


class Signal(NamedTuple):
    """What tells an emitter from the others. pulse_period_s None: a carrier."""

    frequency_hz: float
    pulse_period_s: float | None = None


@dataclass(frozen=True, slots=True)
class SimulatedEmitter:
    """pulse_period_s None: a carrier. gait, speed_m_s: how it moves, None: it stands still."""

    frequency_hz: float
    pulse_period_s: float | None = None
    gait: Gait | None = None
    speed_m_s: float = 0.0

    @property
    def signal(self) -> Signal:
        """By which it is known."""
        return Signal(self.frequency_hz, self.pulse_period_s)


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
    named twice, unless it is that of tags of different periods."""
    own = [read_emitter(text) for text in texts]
    taken = {emitter.frequency_hz for emitter in own}
    for frequency_hz in taken:
        periods = [emitter.pulse_period_s for emitter in own if emitter.frequency_hz == frequency_hz]
        if len(set(periods)) < len(periods) or (len(periods) > 1 and None in periods):
            raise ValueError(
                "two simulated emitters have one frequency, where only tags of different periods can be told apart"
            )
    return (*(other for other in EMITTERS if other.frequency_hz not in taken), *own)


def emitter_places(seed: int, home: Place, emitters: Sequence[SimulatedEmitter]) -> Mapping[Signal, Place]:
    """Where each stands: anywhere in the area that is suggested around `home`.

    By the seed and the whole megahertz; of several in one megahertz, the first has the first place drawn, and so on.
    """
    frame = LocalFrame(home)
    draws: dict[int, np.random.Generator] = {}
    places: dict[Signal, Place] = {}
    for emitter in emitters:
        megahertz = int(emitter.frequency_hz / 1e6)
        rng = draws.setdefault(megahertz, np.random.default_rng([seed, megahertz]))
        east = rng.uniform(-WIDTH_M / 2 + EDGE_M, WIDTH_M / 2 - EDGE_M)
        north = rng.uniform(EDGE_M, HEIGHT_M - EDGE_M)
        places[emitter.signal] = frame.to_geo(float(east), float(north))
    return places


def beats(seed: int, emitters: Sequence[SimulatedEmitter]) -> Mapping[Signal, Mapping[str, float]]:
    """Phase, clock and straying (as in hardware.sim's Beat) of the tags that share a frequency; one that sends alone
    begins with the clock."""
    found: dict[Signal, Mapping[str, float]] = {}
    for number, emitter in enumerate(emitters):
        alone = sum(other.frequency_hz == emitter.frequency_hz for other in emitters) == 1
        if alone or emitter.pulse_period_s is None:
            continue
        rng = np.random.default_rng([seed, number, round(emitter.frequency_hz)])
        found[emitter.signal] = {
            "pulse_phase_s": float(rng.uniform(0.0, emitter.pulse_period_s)),
            "clock_error": float(rng.uniform(-CLOCK_ERROR, CLOCK_ERROR)),
            "pulse_stray_s": STRAY_S,
        }
    return found
