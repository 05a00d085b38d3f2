"""Pulsed tags: every pulse heard once, at its time and level; noise gives none."""

from __future__ import annotations

import numpy as np
import pytest
from refusals import refusing

from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.readings import PowerSample
from hardware.reasons.channels import ImpossiblePulses, SampleRateTooLow
from hardware.sdr.pulses import PulseMeter, PulseSetting
from hardware.sdr.spectrum import SpectrumError

RATE_HZ = 12_000.0
CENTRE_HZ = 148_500_000.0
SETTING = PulseSetting(width_s=0.02, period_s=1.3, jitter_s=0.03)


def stream(seconds: float, level_db: float, seed: int = 1, jitter_s: float = 0.02) -> tuple[np.ndarray, np.ndarray]:
    """(samples, pulse centres in s): a tag 700 Hz off the centre in noise of -90 dB a hertz."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    noise = np.sqrt(1e-9 * RATE_HZ / 2.0)
    samples = noise * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))
    begins = np.arange(0.4, seconds - 1.0, SETTING.period_s)
    begins = begins + rng.uniform(-jitter_s, jitter_s, begins.size)
    for begin in begins:
        inside = (t >= begin) & (t < begin + SETTING.width_s)
        samples[inside] += 10.0 ** (level_db / 20.0) * np.exp(2j * np.pi * 700.0 * t[inside])
    return samples.astype(np.complex64), begins + SETTING.width_s / 2.0


def heard(samples: np.ndarray, block: int = 600, missed: bool = False) -> list[PowerSample]:
    meter = PulseMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ, setting=SETTING)
    pulses: list[PowerSample] = []
    for start in range(0, samples.size, block):
        part = samples[start : start + block]
        pulses += meter.feed(IqBlock(start / RATE_HZ, part, clipped_at_full_scale(part)))
    return pulses if missed else [pulse for pulse in pulses if pulse.detected]


@pytest.mark.parametrize("block", [100, 600, 5000])
def test_every_pulse_is_heard_once_at_its_time_and_level(block: int) -> None:
    samples, centres = stream(40.0, -40.0)
    pulses = heard(samples, block)
    found = np.array([p.at_s for p in pulses])
    # the last periods may still be in the meter's buffer
    due = centres[centres < 40.0 - 2.5 * SETTING.period_s]
    assert all(np.abs(found - centre).min() < 0.012 for centre in due)
    assert all(np.abs(centres - at).min() < 0.012 for at in found)
    assert np.allclose([p.power_db for p in pulses], -40.0, atol=2.5)


def test_noise_gives_hardly_a_pulse() -> None:
    samples, _ = stream(120.0, -300.0)
    assert len(heard(samples)) <= 3


def test_silence_is_told_at_least_once_a_period() -> None:
    samples, _ = stream(30.0, -300.0)
    told = heard(samples, missed=True)
    assert not told[5].detected
    assert told[5].power_db == told[5].noise_floor_db
    assert max(np.diff([sample.at_s for sample in told])) <= SETTING.period_s


def test_weak_pulses_are_mostly_heard() -> None:
    samples, centres = stream(60.0, -57.0)
    found = np.array([p.at_s for p in heard(samples)])
    hits = sum(bool(found.size and np.abs(found - centre).min() < 0.015) for centre in centres)
    assert hits > 0.7 * centres.size


@pytest.mark.parametrize("bad", [{"width_s": 2.0}, {"width_s": 0.0}])
def test_impossible_pulses_are_refused(bad: dict[str, float]) -> None:
    with refusing(ImpossiblePulses, SpectrumError):
        PulseSetting(**bad)


def test_too_slow_sampling_is_refused() -> None:
    with refusing(SampleRateTooLow(500.0, 3200.0), SpectrumError):
        PulseMeter(CENTRE_HZ, CENTRE_HZ, 500.0, setting=PulseSetting(width_s=0.005, search_hz=100.0))


def test_blocks_whose_times_are_corrected_and_a_clock_that_is_set_carry_the_pulses_with_them() -> None:
    samples, centres = stream(40.0, -40.0)
    meter = PulseMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ, setting=SETTING)
    pulses: list[PowerSample] = []
    for start in range(0, samples.size, 600):
        part, at_s = samples[start : start + 600], start / RATE_HZ
        off_s = 0.4 if at_s < 0.2 else 0.0 if at_s < 20.0 else -86_400.0
        pulses += [p for p in meter.feed(IqBlock(at_s + off_s, part, clipped_at_full_scale(part))) if p.detected]
    before = [p.at_s for p in pulses if p.at_s > 0.0]
    after = [p.at_s + 86_400.0 for p in pulses if p.at_s < 0.0]
    assert all(np.abs(centres - at).min() < 0.012 for at in before + after)
    assert len(before) >= 13
    assert len(after) >= 11
