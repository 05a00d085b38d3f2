"""SigMF: a rotation recorded as IQ is played back and gives its bearing; unusable recordings are refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.direction_finding.sweep import assemble_sweep
from hardware.ports import ReceiverError
from hardware.readings import Channel, HeadingSample, Place
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.sigmf_file import write_sigmf
from hardware.sdr.sigmf_playback import SigmfSource

RATE_HZ = 24_000.0
CENTRE_HZ = 868_300_000.0
START_S = 1_780_000_000.0


def rotation_iq(bearing_deg: float, seconds: float = 12.0) -> np.ndarray:
    rng = np.random.default_rng(1)
    t = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    gain_db = load_pattern(SMALL_YAGI).gain_at(bearing_deg - 30.0 * t)
    noise = 1e-4 * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))
    return (10.0 ** ((gain_db - 20.0) / 20.0) * np.exp(2j * np.pi * 2000.0 * t) + noise).astype(np.complex64)


async def test_recorded_rotation_gives_its_bearing(tmp_path: Path) -> None:
    path = write_sigmf(tmp_path / "rotation", rotation_iq(123.0), RATE_HZ, CENTRE_HZ, START_S)
    receiver = IqReceiver(SigmfSource(path))
    await receiver.open([Channel(CENTRE_HZ + 2000.0)])
    heard = [sample async for sample in receiver.samples()]
    assert heard[0].at_s == pytest.approx(START_S + 0.025, abs=1e-3)
    place = Place(50.0, 7.0)
    headings = [HeadingSample(START_S + t, 30.0 * t % 360.0, place) for t in np.arange(0.0, 12.5, 0.1)]
    sweep = assemble_sweep(heard, headings, frequency_hz=CENTRE_HZ, altitude_amsl_m=0.0)
    reading = SparseDirectionFinder().estimate(sweep, load_pattern(SMALL_YAGI))
    assert reading.accepted, reading.reason
    assert reading.bearing_deg == pytest.approx(123.0, abs=1.5)


async def test_recording_of_another_frequency_is_refused(tmp_path: Path) -> None:
    path = write_sigmf(tmp_path / "rotation", rotation_iq(0.0, 0.2), RATE_HZ, CENTRE_HZ, START_S)
    with pytest.raises(ReceiverError, match="was made at"):
        await IqReceiver(SigmfSource(path)).open([Channel(433e6)])


@pytest.mark.parametrize("missing", ["core:sample_rate", "core:frequency"])
def test_recording_without_rate_or_frequency_is_refused(tmp_path: Path, missing: str) -> None:
    path = write_sigmf(tmp_path / "rotation", rotation_iq(0.0, 0.1), RATE_HZ, CENTRE_HZ, START_S)
    meta = json.loads(path.read_text())
    meta["global"].pop(missing, None)
    meta["captures"][0].pop(missing, None)
    path.write_text(json.dumps(meta))
    with pytest.raises(ReceiverError, match=missing):
        SigmfSource(path)


def test_missing_and_foreign_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "x.sigmf-meta").write_text("{}")
    for name in ("nothing.sigmf-meta", "x.sigmf-meta"):
        with pytest.raises(ReceiverError, match=name):
            SigmfSource(tmp_path / name)
