"""Turns as files: what an antenna hears while it is turned around once, and an antenna that points beside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.readings import Place
from hardware.sdr.sigmf_file import Azimuth, write_sigmf

YAGI = load_pattern(SMALL_YAGI)
SQUINT_DEG = 40.0
BESIDE = replace(YAGI, name="whip on a car", gain_db=YAGI.gain_at(YAGI.relative_bearing_deg - SQUINT_DEG))
"""Its lobe lies so far clockwise of where its front is said to be."""


def turn_csv(heard_by: AntennaPattern, bearing_deg: float, every_deg: float = 4.0) -> str:
    """Heading and power, the front first to the north."""
    nose = np.arange(0.0, 360.0, every_deg)
    power = -60.0 + heard_by.gain_at(bearing_deg - nose)
    rows = [f"{heading:g},{level:.2f}" for heading, level in zip(nose, power, strict=True)]
    return "\n".join(["heading_deg,power_db", *rows])


RATE_HZ = 4000.0


def turn_sigmf(folder: Path) -> Path:
    """The meta file of 12 s of IQ beside its data: one turn of the small Yagi with its headings, a carrier at 868.3 MHz
    towards 70 degrees."""
    t = np.arange(int(12.0 * RATE_HZ)) / RATE_HZ
    gain_db = YAGI.gain_at(70.0 - 30.0 * t)
    noise = np.random.default_rng(1).normal(size=(2, t.size)) * 1e-4
    iq = 10.0 ** (gain_db / 20.0 - 1.0) * np.exp(2j * np.pi * 900.0 * t) + noise[0] + 1j * noise[1]
    azimuths = [Azimuth(int(s * RATE_HZ), 0, 30.0 * s % 360.0) for s in np.arange(0.0, 12.0, 0.3)]
    place = Place(50.605, 7.205)
    return write_sigmf(folder / "t", iq.astype(np.complex64), RATE_HZ, 868.2991e6, 1.78e9, azimuths, place)
