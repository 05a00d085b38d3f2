"""Pulsed tags: find the pulses in IQ and give one power sample a pulse."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hardware.iq import IqBlock
from hardware.readings import PowerSample
from hardware.reasons.channels import ImpossiblePulses, OutsideBand, SampleRateTooLow
from hardware.sdr.spectrum import (
    CLIPPED_SHARE,
    FEWEST_SAMPLES,
    LEVEL_FLOOR,
    SpectrumError,
    mean_over_median,
    outside_band,
)


@dataclass(frozen=True, slots=True)
class PulseSetting:
    """What the tag sends and how sure a detection must be.

    width_s, period_s: of the pulses; jitter_s: how far one may stray from the period. search_hz: frequency drift to
    either side. threshold_db: a pulse must stand this far above the noise in its own bandwidth (about 1 / width).
    """

    width_s: float = 0.02
    period_s: float = 1.3
    jitter_s: float = 0.03
    search_hz: float = 2000.0
    threshold_db: float = 13.0

    def __post_init__(self) -> None:
        if not 0.0 < self.width_s < self.period_s:
            raise SpectrumError(ImpossiblePulses(self.width_s, self.period_s))

    @property
    def reach_hz(self) -> float:
        """What must be sampled to either side of the nominal frequency."""
        return self.search_hz


@dataclass(frozen=True, slots=True)
class _Cells:
    """Power by time and frequency. starts: (r,) first samples. power: (r, b). near: (b,) bins in which the tag may be.
    noise: mean of a cell; times `threshold` is a pulse."""

    starts: NDArray[np.int64]
    power: NDArray[np.float64]
    near: NDArray[np.bool_]
    noise: float
    threshold: float

    @property
    def eligible(self) -> NDArray[np.float64]:
        """(r, b) power, -1 where the tag cannot be."""
        return np.where(self.near[None, :], self.power, -1.0)

    @property
    def loudest(self) -> NDArray[np.float64]:
        """(r,) of each moment."""
        return self.eligible.max(axis=1)

    @property
    def heard(self) -> NDArray[np.bool_]:
        """(r,) whether that is loud enough for a pulse."""
        return self.loudest > self.threshold * max(self.noise, LEVEL_FLOOR)


@dataclass(slots=True)
class PulseMeter:
    """Feeds on IQ blocks, gives one PowerSample for each pulse heard, at the pulse's own time.

    A sliding spectrum of the pulse's width, hopped by a quarter of it; the loudest cell of time and frequency within
    half a period is a pulse when it passes the threshold and, once the rhythm is known, falls where one is due.
    """

    frequency_hz: float
    centre_hz: float
    sample_rate_hz: float
    gain_db: float = 0.0
    setting: PulseSetting = field(default_factory=PulseSetting)
    _samples: NDArray[np.complex64] = field(init=False)
    _clipped: NDArray[np.bool_] = field(init=False)
    _start_s: float = field(default=math.nan, init=False)
    _skip: int = field(default=0, init=False)
    _last_pulse_s: float | None = field(default=None, init=False)
    _size: int = field(init=False)
    _bins_hz: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        needed_hz = FEWEST_SAMPLES / self.setting.width_s
        if not self.sample_rate_hz >= needed_hz:
            raise SpectrumError(SampleRateTooLow(self.sample_rate_hz, needed_hz))
        if outside_band(self.frequency_hz, self.setting.reach_hz, self.centre_hz, self.sample_rate_hz):
            raise SpectrumError(OutsideBand(self.sample_rate_hz, self.centre_hz, (self.frequency_hz,)))
        self._size = int(self.setting.width_s * self.sample_rate_hz)
        self._bins_hz = np.asarray(np.fft.fftfreq(self._size, 1.0 / self.sample_rate_hz), dtype=np.float64)
        self._samples = np.empty(0, dtype=np.complex64)
        self._clipped = np.empty(0, dtype=bool)

    def feed(self, block: IqBlock) -> list[PowerSample]:
        """Pulses found in what has been heard so far, and where a whole period brought none (detected False)."""
        off_s = block.at_s - (self._start_s + self._samples.size / self.sample_rate_hz)
        if block.lost or not abs(off_s) < self.setting.period_s / 2.0:
            self._samples, self._clipped = np.empty(0, dtype=np.complex64), np.empty(0, dtype=bool)
            self._start_s, self._skip = block.at_s, 0
            if not block.lost:
                self._last_pulse_s = None  # the clock was set: the rhythm's old times mean nothing
        else:
            self._start_s += off_s
        self._samples = np.concatenate([self._samples, block.samples])
        self._clipped = np.concatenate([self._clipped, block.clipped])
        self._advance()
        found: list[PowerSample] = []
        window = int(self.setting.period_s * self.sample_rate_hz)
        while self._samples.size >= window + self._size:
            pulse, self._skip = self._search(window)
            found.append(pulse)
            self._advance()
        return found

    def _advance(self) -> None:
        """Drop what is to be skipped, as far as it has been heard."""
        used = min(self._skip, self._samples.size)
        self._samples, self._clipped = self._samples[used:], self._clipped[used:]
        self._start_s += used / self.sample_rate_hz
        self._skip -= used

    def _search(self, window: int) -> tuple[PowerSample, int]:
        """The loudest pulse in one period from the front (or that there is none), and how many samples to step on."""
        cells = self._cells(window)
        row = int(np.argmax(np.where(self._due(cells.starts), cells.loudest, -1.0)))
        if not cells.heard[row]:
            return self._nothing(window, cells.noise), window // 2
        begin = int(cells.starts[row])
        pulse = self._pulse(cells, row)
        self._last_pulse_s = pulse.at_s
        # go on just before the earliest time at which the next pulse can come
        step = self.setting.period_s - self.setting.jitter_s - self.setting.width_s
        return pulse, max(begin + int(step * self.sample_rate_hz), self._size)

    def _cells(self, window: int) -> _Cells:
        """The sliding spectrum from the front, `window` samples long."""
        starts = np.arange(0, window, max(self._size // 4, 1))
        pieces = np.lib.stride_tricks.sliding_window_view(self._samples, self._size)[starts]
        power = np.abs(np.fft.fft(pieces, axis=1)) ** 2 / self._size**2
        near = np.abs(self._bins_hz - (self.frequency_hz - self.centre_hz)) <= self.setting.search_hz
        noise = float(np.median(power[:, near])) * mean_over_median(1)
        return _Cells(starts, power, near, noise, 10.0 ** (self.setting.threshold_db / 10.0))

    def _nothing(self, window: int, noise: float) -> PowerSample:
        middle_s = self._start_s + window / 2.0 / self.sample_rate_hz
        floor_db = self._floor_db(noise)
        return PowerSample(middle_s, self.frequency_hz, floor_db, floor_db, detected=False)

    def _pulse(self, cells: _Cells, row: int) -> PowerSample:
        begin = int(cells.starts[row])
        # a tone between two bins leaks into its neighbours: sum the three
        around = [(int(np.argmax(cells.eligible[row])) + k) % self._size for k in (-1, 0, 1)]
        level = float(cells.power[row, around].sum())
        return PowerSample(
            at_s=self._start_s + (begin + self._size / 2.0) / self.sample_rate_hz,
            frequency_hz=self.frequency_hz,
            power_db=10.0 * math.log10(level) - self.gain_db,
            noise_floor_db=self._floor_db(cells.noise),
            clipped=bool(self._clipped[begin : begin + self._size].mean() > CLIPPED_SHARE),
        )

    def _floor_db(self, noise: float) -> float:
        return 10.0 * math.log10(max(3.0 * noise, LEVEL_FLOOR)) - self.gain_db

    def _due(self, starts: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which starts fit the rhythm: a whole number of periods after the last pulse, give or take jitter."""
        if self._last_pulse_s is None:
            return np.ones(starts.size, dtype=bool)
        since = self._start_s + (starts + self._size / 2.0) / self.sample_rate_hz - self._last_pulse_s
        periods = np.maximum(np.round(since / self.setting.period_s), 1.0)
        if periods.max() > 8:
            return np.ones(starts.size, dtype=bool)  # heard nothing for so long that the rhythm is lost
        slack = self.setting.jitter_s * np.sqrt(periods) + self.setting.width_s
        return np.abs(since - periods * self.setting.period_s) <= slack
