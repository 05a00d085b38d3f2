"""Narrow-band power of a carrier from IQ: windowed spectra, a tracked bin, the noise around it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hardware.iq import IqBlock
from hardware.readings import PowerSample
from hardware.reasons.channels import ImpossiblePulses, OutsideBand, SampleRateTooLow
from planner.reason import ReasonedError

CLIPPED_SHARE = 0.001
"""A power reading in which more than this share of the IQ samples is clipped is flagged."""
LEVEL_FLOOR = 1e-20


FEWEST_SAMPLES = 16
"""A spectrum of fewer tells nothing."""


class SpectrumError(ReasonedError):
    """Rates, frequencies or pulses that do not go together."""

    def __init__(self, reason: OutsideBand | SampleRateTooLow | ImpossiblePulses) -> None:
        super().__init__(reason)
        self._spectrum_reason = reason

    @property
    def reason(self) -> OutsideBand | SampleRateTooLow | ImpossiblePulses:
        """Which rate, frequency or pulse does not fit the others."""
        return self._spectrum_reason


@dataclass(frozen=True, slots=True)
class ToneSetting:
    """How a carrier is measured.

    rate_hz: power readings a second. bandwidth_hz: width in which its power is summed. search_hz: how far to either
    side of the nominal frequency it may drift. agility: share of a newly found offset that the tracker takes over
    when the signal stands 10 dB or more above the noise (less when it is weaker).
    """

    rate_hz: float = 20.0
    bandwidth_hz: float = 200.0
    search_hz: float = 3000.0
    agility: float = 0.3

    @property
    def reach_hz(self) -> float:
        """What must be sampled to either side of the nominal frequency."""
        return self.search_hz + self.bandwidth_hz


@dataclass(slots=True)
class ToneMeter:
    """Feeds on IQ blocks, gives power samples. One meter follows one emitter.

    frequency_hz: nominal. centre_hz: what the receiver is tuned to. Spectra: Hann window, half overlapped, averaged
    over one reading. power_db: dB of full scale minus the gain; noise_floor_db: in the same bandwidth.
    """

    frequency_hz: float
    centre_hz: float
    sample_rate_hz: float
    gain_db: float = 0.0
    setting: ToneSetting = field(default_factory=ToneSetting)
    offset_hz: float = field(init=False)
    _pending: list[IqBlock] = field(default_factory=list[IqBlock], init=False)
    _window: NDArray[np.float64] = field(init=False)
    _bins_hz: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        needed_hz = FEWEST_SAMPLES * self.setting.rate_hz
        if not self.sample_rate_hz >= needed_hz:
            raise SpectrumError(SampleRateTooLow(self.sample_rate_hz, needed_hz))
        if outside_band(self.frequency_hz, self.setting.reach_hz, self.centre_hz, self.sample_rate_hz):
            raise SpectrumError(OutsideBand(self.sample_rate_hz, self.centre_hz, (self.frequency_hz,)))
        per_reading = int(self.sample_rate_hz / self.setting.rate_hz)
        wanted = 4.0 * self.sample_rate_hz / self.setting.bandwidth_hz
        size = 2 ** math.ceil(math.log2(max(wanted, 1.0)))
        if size > per_reading:
            size = 2 ** int(math.log2(max(per_reading, 1)))
        self._window = np.hanning(size + 1)[:-1]
        self._bins_hz = np.asarray(np.fft.fftfreq(size, 1.0 / self.sample_rate_hz), dtype=np.float64)
        self.offset_hz = self.frequency_hz - self.centre_hz

    def feed(self, block: IqBlock) -> list[PowerSample]:
        """Power readings that became complete with this block. A gap in the stream starts a new reading."""
        if block.lost:
            self._pending.clear()
        self._pending.append(block)
        need = int(self.sample_rate_hz / self.setting.rate_hz)
        held = sum(b.samples.size for b in self._pending)
        if held < need:
            return []
        start_s = self._pending[0].at_s
        samples = np.concatenate([b.samples for b in self._pending])
        clipped = np.concatenate([b.clipped for b in self._pending])
        readings = [
            self._measure(samples[k : k + need], clipped[k : k + need], start_s + k / self.sample_rate_hz)
            for k in range(0, held - need + 1, need)
        ]
        rest = held - len(readings) * need
        used_s = (held - rest) / self.sample_rate_hz
        self._pending = [IqBlock(start_s + used_s, samples[held - rest :], clipped[held - rest :])] if rest else []
        return readings

    def _measure(self, samples: NDArray[np.complex64], clipped: NDArray[np.bool_], start_s: float) -> PowerSample:
        spectrum = averaged_spectrum(samples, self._window)
        nominal = self.frequency_hz - self.centre_hz
        resolution = self.sample_rate_hz / self._window.size
        half = max(self.setting.bandwidth_hz / 2.0, 2.0 * resolution)
        reach = self.setting.search_hz + half + resolution
        searched = np.abs(self._bins_hz - nominal) <= reach
        quiet = searched & (np.abs(self._bins_hz - self.offset_hz) > 2.0 * half)
        # half overlapped Hann windows: about 0.75 independent averages a window
        averages = 0.75 * (2.0 * samples.size / self._window.size - 1.0)
        noise_bin = noise_of(spectrum, quiet, searched, averages)
        self._track(spectrum, nominal, noise_bin)
        inside = np.abs(self._bins_hz - self.offset_hz) <= half
        # sum |X|^2 over the band / (n sum w^2): the power in the band, whatever the window
        power = float(spectrum[inside].sum())
        noise = noise_bin * int(inside.sum())
        return PowerSample(
            at_s=start_s + samples.size / self.sample_rate_hz / 2.0,
            frequency_hz=self.frequency_hz,
            power_db=10.0 * math.log10(max(power, LEVEL_FLOOR)) - self.gain_db,
            noise_floor_db=10.0 * math.log10(max(noise, LEVEL_FLOOR)) - self.gain_db,
            clipped=bool(clipped.mean() > CLIPPED_SHARE),
        )

    def _track(self, spectrum: NDArray[np.float64], nominal: float, noise_bin: float) -> None:
        """Move towards the strongest bin, the more the clearer it stands above the noise."""
        allowed = np.abs(self._bins_hz - nominal) <= self.setting.search_hz
        peak = int(np.argmax(np.where(allowed, spectrum, -1.0)))
        above_db = 10.0 * math.log10(max(float(spectrum[peak]), LEVEL_FLOOR) / max(noise_bin, LEVEL_FLOOR))
        trust = min(max((above_db - 6.0) / 4.0, 0.0), 1.0)
        self.offset_hz += trust * self.setting.agility * (float(self._bins_hz[peak]) - self.offset_hz)


def outside_band(frequency_hz: float, reach_hz: float, centre_hz: float, sample_rate_hz: float) -> bool:
    """Whether `reach_hz` to either side of a frequency is not all sampled; a millihertz too much is rounding."""
    return abs(frequency_hz - centre_hz) + reach_hz > sample_rate_hz / 2.0 + 1e-3


def averaged_spectrum(samples: NDArray[np.complex64], window: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) Welch periodogram scaled so that its sum over all bins is the mean power of the samples."""
    size = window.size
    starts = range(0, max(samples.size - size, 0) + 1, size // 2)
    total = np.zeros(size)
    for start in starts:
        total += np.abs(np.fft.fft(samples[start : start + size] * window)) ** 2
    return total / (len(starts) * size * np.sum(window**2))


def mean_over_median(averages: float) -> float:
    """Of noise power averaged that many times (a gamma variate; Wilson & Hilferty: median = mean (1 - 1/(9 k))^3)."""
    return (1.0 - 1.0 / (9.0 * max(averages, 1.0))) ** -3


def noise_of(
    spectrum: NDArray[np.float64], quiet: NDArray[np.bool_], otherwise: NDArray[np.bool_], averages: float
) -> float:
    """Mean noise power a bin, from the median of the quiet bins (of `otherwise` when hardly any is quiet)."""
    chosen = quiet if int(quiet.sum()) >= 8 else otherwise
    return float(np.median(spectrum[chosen])) * mean_over_median(averages) if chosen.any() else 0.0
