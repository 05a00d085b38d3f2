"""Several tags at one frequency: every pulse that is heard there, whenever it comes and whoever sent it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hardware.readings import PowerSample, Pulses
from hardware.sdr.pulses import PulseMeter, PulseSetting

LOOKED_AT_S = 0.5
APART = 1.25
"""Widths from one pulse's middle to where the next can be told from it."""


@dataclass(slots=True)
class EveryPulseMeter(PulseMeter):
    """As a PulseMeter, without its rhythm: the first moment that is loud enough begins a pulse, which is where it is
    loudest within a width. What overlaps with it is heard as one with it. Whose it is, its time says to others
    (hardware.direction_finding.rhythm)."""

    longest_s: float = 0.0
    """Of the pulses that are sent there."""

    @classmethod
    def of(
        cls, rhythms: Sequence[Pulses], frequency_hz: float, centre_hz: float, sample_rate_hz: float, gain_db: float
    ) -> EveryPulseMeter:
        """For these tags. Raises SpectrumError as PulseMeter does."""
        return cls(
            frequency_hz,
            centre_hz,
            sample_rate_hz,
            gain_db,
            every_pulse_setting(rhythms),
            longest_s=max(pulses.width_s for pulses in rhythms),
        )

    def _search(self, window: int) -> tuple[PowerSample, int]:
        """The next pulse (or that there is none in the window), and how many samples to step on."""
        cells = self._cells(window)
        if not cells.heard.any():
            return self._nothing(window, cells.noise), window
        first = int(np.argmax(cells.heard))
        hold = int(APART * self.longest_s * self.sample_rate_hz)
        begin = int(cells.starts[first])
        if begin > 0 and begin + hold > window:  # not all of it is in the window
            return self._nothing(begin, cells.noise), begin
        inside = cells.starts <= begin + int(self.longest_s * self.sample_rate_hz)
        row = first + int(np.argmax(np.where(inside, cells.loudest, -1.0)[first:]))
        return self._pulse(cells, row), int(cells.starts[row]) + hold


def every_pulse_setting(rhythms: Sequence[Pulses]) -> PulseSetting:
    """Of the shortest pulses among them. Raises SpectrumError for pulses that cannot be."""
    settings = [PulseSetting(pulses.width_s, pulses.period_s, pulses.jitter_s) for pulses in rhythms]
    width_s = min(setting.width_s for setting in settings)
    longest_s = max(setting.width_s for setting in settings)
    return PulseSetting(width_s, max(LOOKED_AT_S, 8.0 * longest_s), 0.0)
