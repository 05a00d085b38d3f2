"""Power of a carrier from IQ: level, noise floor, drift, clipping, rates that do not fit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refusing

from hardware.iq import IqBlock, clipped_at_full_scale, from_unsigned_bytes
from hardware.readings import PowerSample
from hardware.reasons.channels import OutsideBand, SampleRateTooLow
from hardware.sdr.spectrum import SpectrumError, ToneMeter, ToneSetting
from planner.reason import Reason

RATE_HZ = 48_000.0
CENTRE_HZ = 868_300_000.0


def tone(
    seconds: float,
    offset_hz: float,
    level_db: float,
    noise_db_hz: float = -130.0,
    drift_hz_s: float = 0.0,
    seed: int = 1,
) -> np.ndarray:
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    noise = np.sqrt(10.0 ** (noise_db_hz / 10.0) * RATE_HZ / 2.0)
    wave = 10.0 ** (level_db / 20.0) * np.exp(2j * np.pi * (offset_hz * t + 0.5 * drift_hz_s * t**2))
    return (wave + noise * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))).astype(np.complex64)


def measured(samples: np.ndarray, meter: ToneMeter, block: int = 1000) -> list[PowerSample]:
    readings: list[PowerSample] = []
    for start in range(0, samples.size, block):
        part = samples[start : start + block]
        readings += meter.feed(IqBlock(100.0 + start / RATE_HZ, part, clipped_at_full_scale(part)))
    return readings


@settings(max_examples=25, deadline=None)
@given(offset=st.floats(-15_000, 15_000), level=st.floats(-60, -5), block=st.integers(100, 6000))
def test_level_is_right_at_any_offset_and_block_length(offset: float, level: float, block: int) -> None:
    meter = ToneMeter(CENTRE_HZ + offset, CENTRE_HZ, RATE_HZ)
    readings = measured(tone(1.0, offset, level), meter, block)
    assert len(readings) == 20
    assert np.allclose([r.power_db for r in readings], level, atol=0.3)
    assert np.diff([r.at_s for r in readings]) == pytest.approx(0.05, abs=1e-6)
    assert readings[0].at_s == pytest.approx(100.025, abs=1e-6)


def test_noise_floor_is_the_noise_in_the_measured_bandwidth() -> None:
    setting = ToneSetting(bandwidth_hz=400.0)
    readings = measured(
        tone(3.0, 5000.0, -40.0, noise_db_hz=-100.0), ToneMeter(CENTRE_HZ + 5000, CENTRE_HZ, RATE_HZ, 0.0, setting)
    )
    floor = np.mean([r.noise_floor_db for r in readings if r.noise_floor_db is not None])
    assert floor == pytest.approx(-100.0 + 10 * np.log10(400.0), abs=1.5)


def test_gain_is_taken_out() -> None:
    plain = measured(tone(0.5, 0.0, -40.0), ToneMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ))
    amplified = measured(tone(0.5, 0.0, -20.0), ToneMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ, 20.0))
    assert np.allclose([r.power_db for r in plain], [r.power_db for r in amplified], atol=0.3)


def test_drift_is_followed() -> None:
    meter = ToneMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ)
    readings = measured(tone(20.0, 0.0, -40.0, drift_hz_s=100.0), meter)
    assert meter.offset_hz == pytest.approx(2000.0, abs=60.0)
    assert np.allclose([r.power_db for r in readings[5:]], -40.0, atol=1.0)


def test_noise_alone_does_not_pull_the_tracker_away() -> None:
    meter = ToneMeter(CENTRE_HZ + 1000.0, CENTRE_HZ, RATE_HZ)
    measured(tone(10.0, 0.0, -300.0, noise_db_hz=-100.0), meter)
    assert abs(meter.offset_hz - 1000.0) < 600.0


def test_clipping_is_flagged() -> None:
    samples = np.clip((3.0 * tone(0.5, 1000.0, 0.0)).real, -1, 1) + 0j
    assert all(
        r.clipped for r in measured(samples.astype(np.complex64), ToneMeter(CENTRE_HZ + 1000, CENTRE_HZ, RATE_HZ))
    )
    assert not any(r.clipped for r in measured(tone(0.5, 1000.0, -20.0), ToneMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ)))


def test_a_gap_in_the_stream_starts_a_new_reading() -> None:
    meter = ToneMeter(CENTRE_HZ, CENTRE_HZ, RATE_HZ)
    part = tone(0.03, 0.0, -30.0)
    none = np.zeros(part.size, dtype=bool)
    assert meter.feed(IqBlock(0.0, part, none)) == []
    assert meter.feed(IqBlock(9.0, part, none, lost=1000)) == []
    (reading,) = meter.feed(IqBlock(9.03, part, none))
    assert reading.at_s == pytest.approx(9.025, abs=1e-6)


@pytest.mark.parametrize(
    ("frequency", "rate", "reason"),
    [
        (CENTRE_HZ + 1e6, RATE_HZ, OutsideBand(RATE_HZ, CENTRE_HZ, (CENTRE_HZ + 1e6,))),
        (CENTRE_HZ, 0.0, SampleRateTooLow(0.0, 320.0)),
        (CENTRE_HZ, 6000.0, OutsideBand(6000.0, CENTRE_HZ, (CENTRE_HZ,))),
    ],
)
def test_rates_that_do_not_go_together_are_refused(frequency: float, rate: float, reason: Reason) -> None:
    with refusing(reason, SpectrumError):
        ToneMeter(frequency, CENTRE_HZ, rate)


def test_unsigned_bytes_are_centred_and_clipping_is_seen() -> None:
    samples, clipped = from_unsigned_bytes(bytes([0, 127, 128, 255, 100, 150]))
    assert samples[0] == pytest.approx(-1.0 - 0.5j / 127.5)
    assert clipped.tolist() == [True, True, False]
