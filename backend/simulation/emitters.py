"""What transmits in the simulated world, and where it stands."""

from __future__ import annotations

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
