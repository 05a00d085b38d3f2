"""Several tags at one frequency: every pulse is heard once, whoever sent it; two at once are heard as one."""

from __future__ import annotations

import numpy as np
import pytest
from refusals import refusing

from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.readings import PowerSample, Pulses
from hardware.reasons.channels import ImpossiblePulses
from hardware.sdr.every_pulse import EveryPulseMeter, every_pulse_setting
from hardware.sdr.spectrum import SpectrumError

RATE_HZ, CENTRE_HZ, WIDTH_S = 12_000.0, 148_500_000.0, 0.02
TAGS = (Pulses(WIDTH_S, 1.3), Pulses(WIDTH_S, 1.05))


def stream(trains: dict[float, np.ndarray], seconds: float, seed: int = 1) -> np.ndarray:
    """Pulses of -40 dB that begin at these times, by the offset (Hz) of the tone, in noise of -90 dB a hertz."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    samples = np.sqrt(1e-9 * RATE_HZ / 2.0) * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))
    for tone_hz, begins in trains.items():
        for begin in begins:
            inside = (t >= begin) & (t < begin + WIDTH_S)
            samples[inside] += 0.01 * np.exp(2j * np.pi * tone_hz * t[inside])
    return samples.astype(np.complex64)


def heard(samples: np.ndarray, block: int = 600) -> list[PowerSample]:
    meter = EveryPulseMeter.of(TAGS, CENTRE_HZ, CENTRE_HZ, RATE_HZ, 0.0)
    found: list[PowerSample] = []
    for start in range(0, samples.size, block):
        part = samples[start : start + block]
        found += meter.feed(IqBlock(start / RATE_HZ, part, clipped_at_full_scale(part)))
    return found


@pytest.mark.parametrize("block", [100, 600, 5000])
def test_every_pulse_of_both_tags_and_of_a_stranger_is_heard_once(block: int) -> None:
    first, second, stranger = np.arange(0.4, 38.0, 1.3), np.arange(0.75, 38.0, 1.05), np.array([5.11, 6.42, 20.03])
    begins = np.sort(np.concatenate([first, second, stranger]))
    found = heard(stream({700.0: first, -400.0: second, 100.0: stranger}, 40.0), block)
    at_s = np.array([pulse.at_s for pulse in found if pulse.detected])
    alone = begins[np.array([np.sort(np.abs(begins - one))[1] > 1.5 * WIDTH_S for one in begins])]
    assert alone.size > 0.9 * begins.size
    off = [np.abs(at_s - (one + WIDTH_S / 2.0)).min() for one in alone]
    assert max(off) < 0.006
    assert at_s.size <= begins.size
    levels = [p.power_db for p in found if p.detected and np.abs(alone + WIDTH_S / 2.0 - p.at_s).min() < 0.006]
    assert np.allclose(levels, -40.0, atol=2.5)


def test_two_at_once_are_one_pulse() -> None:
    found = heard(stream({700.0: np.array([1.0, 2.0]), -400.0: np.array([1.006, 3.0])}, 5.0))
    assert [round(pulse.at_s, 1) for pulse in found if pulse.detected] == [1.0, 2.0, 3.0]


def test_silence_is_told_and_has_no_pulse() -> None:
    found = heard(stream({}, 60.0))
    assert not [pulse for pulse in found if pulse.detected]
    assert np.diff([pulse.at_s for pulse in found]).max() < 1.0


def test_impossible_pulses_are_refused() -> None:
    with refusing(ImpossiblePulses, SpectrumError):
        every_pulse_setting((TAGS[0], Pulses(2.0, 1.0)))
