"""IQ of a turn becomes a sweep: by annotations or a table of headings, carrier or tag; what is unusable is named."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import sigmf
from refusals import refusing

from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.direction_finding.recordings import Recording
from hardware.direction_finding.table_file import RecordingError
from hardware.readings import Place
from hardware.reasons.iq_recording import HeadingsOfOtherLength, SamplesUnusable, StrongestUsed
from hardware.reasons.table import CellUnusable
from hardware.sdr.pulses import PulseSetting
from hardware.sdr.rotation import SPECTRUM_SIZE, IqReading, mean_spectrum, read_rotation, read_sweeps
from hardware.sdr.rotation_headings import headings_from
from hardware.sdr.sigmf_file import Azimuth, load_sigmf, write_sigmf
from hardware.sdr.spectrum import averaged_spectrum

RATE_HZ = 12_000.0
CENTRE_HZ = 148_500_000.0
START_S = 1_780_000_000.0
PLACE = Place(50.0, 7.0)


def turn_iq(bearing_deg: float, offset_hz: float = 2000.0, seconds: float = 12.0, seed: int = 1) -> np.ndarray:
    """A carrier heard during one turn at 30 degrees a second, beginning north."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    gain_db = load_pattern(SMALL_YAGI).gain_at(bearing_deg - 30.0 * t)
    noise = 1e-4 * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))
    return (10.0 ** ((gain_db - 20.0) / 20.0) * np.exp(2j * np.pi * offset_hz * t) + noise).astype(np.complex64)


def azimuths_of_turn(seconds: float = 12.0, every_s: float = 0.1) -> list[Azimuth]:
    count = int(every_s * RATE_HZ)
    return [
        Azimuth(int(t * RATE_HZ), count, float(30.0 * (t + every_s / 2.0) % 360.0))
        for t in np.arange(0.0, seconds, every_s)
    ]


def table(path: Path, begin_s: float = 0.0, seconds: float = 12.0, header: str = "at_s,heading_deg") -> Path:
    rows = [f"{begin_s + t:.2f},{30.0 * t % 360.0:.2f}" for t in np.arange(-0.5, seconds + 0.5, 0.1)]
    path.write_text("\n".join([header, *rows]))
    return path


def bearing_of(recording: Recording) -> float:
    (recorded,) = recording.sweeps
    reading = SparseDirectionFinder().estimate(recorded.sweep, load_pattern(SMALL_YAGI))
    assert reading.accepted, reading.reason
    return reading.bearing_deg


@pytest.mark.parametrize("offset_hz", [2000.0, -4500.0, 0.0])
def test_annotated_turn_gives_its_bearing_wherever_the_carrier_lies(tmp_path: Path, offset_hz: float) -> None:
    iq = turn_iq(123.0, offset_hz)
    path = write_sigmf(tmp_path / "turn", iq, RATE_HZ, CENTRE_HZ, START_S, azimuths_of_turn(), PLACE)
    recording = read_rotation(path)
    assert bearing_of(recording) == pytest.approx(123.0, abs=1.0)
    (recorded,) = recording.sweeps
    assert recorded.of_antenna
    assert recorded.place_known
    assert recorded.sweep.position == PLACE
    assert recorded.sweep.frequency_hz == pytest.approx(CENTRE_HZ + offset_hz, abs=10.0)
    assert recorded.sweep.at_s[0] == pytest.approx(START_S, abs=0.2)
    assert isinstance(recording.remarks[0], StrongestUsed)
    assert recording.remarks[0].frequency_hz == pytest.approx(CENTRE_HZ + offset_hz, abs=10.0)


@pytest.mark.parametrize("begin_s", [0.0, START_S])
def test_headings_of_a_table_are_matched_by_time(tmp_path: Path, begin_s: float) -> None:
    path = write_sigmf(tmp_path / "turn", turn_iq(200.0), RATE_HZ, CENTRE_HZ, START_S)
    headings = table(tmp_path / "nose.csv", begin_s)
    recording = read_sweeps(path, iq=IqReading(headings, CENTRE_HZ + 2000.0))
    assert bearing_of(recording) == pytest.approx(200.0, abs=1.0)
    assert not recording.sweeps[0].of_antenna
    assert not recording.sweeps[0].place_known
    assert recording.remarks == ()


def test_an_archive_is_read_like_its_two_files(tmp_path: Path) -> None:
    path = write_sigmf(tmp_path / "turn", turn_iq(77.0), RATE_HZ, CENTRE_HZ, START_S, azimuths_of_turn())
    recording = sigmf.fromfile(str(path))
    assert isinstance(recording, sigmf.SigMFFile)
    made = recording.archive(str(tmp_path / "packed.sigmf"))
    assert bearing_of(read_rotation(made)) == bearing_of(read_rotation(path))


def test_a_turn_in_steps_has_a_capture_a_step(tmp_path: Path) -> None:
    step_s, steps = 1.5, 24
    gains = load_pattern(SMALL_YAGI).gain_at(90.0 - 15.0 * np.arange(steps, dtype=float))
    t = np.arange(int(step_s * RATE_HZ)) / RATE_HZ
    rng = np.random.default_rng(2)
    tone = np.exp(2j * np.pi * 1000.0 * t)
    parts = [10.0 ** ((g - 20.0) / 20.0) * tone + 1e-4 * rng.normal(size=t.size) for g in gains]
    path = write_sigmf(tmp_path / "steps", np.concatenate(parts).astype(np.complex64), RATE_HZ, CENTRE_HZ, START_S)
    meta = json.loads(path.read_text())
    meta["captures"] = [
        {"core:sample_start": k * t.size, "core:frequency": CENTRE_HZ, "antenna:azimuth_angle": 15.0 * k}
        for k in range(steps)
    ]
    path.write_text(json.dumps(meta))
    assert bearing_of(read_rotation(path)) == pytest.approx(90.0, abs=2.0)


def test_pulses_of_a_tag_are_the_readings(tmp_path: Path) -> None:
    seconds, period_s, width_s = 36.0, 0.5, 0.02
    carrier = turn_iq(250.0, 1500.0, seconds)
    t = np.arange(carrier.size) / RATE_HZ
    gain_db = load_pattern(SMALL_YAGI).gain_at(250.0 - 10.0 * t)
    rng = np.random.default_rng(3)
    keyed = 10.0 ** ((gain_db - 20.0) / 20.0) * np.exp(2j * np.pi * 1500.0 * t) * (t % period_s < width_s)
    iq = (keyed + 1e-4 * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))).astype(np.complex64)
    path = write_sigmf(tmp_path / "tag", iq, RATE_HZ, CENTRE_HZ, START_S)
    rows = [f"{s:.1f},{10.0 * s % 360.0:.1f}" for s in np.arange(0.0, seconds, 0.1)]
    (tmp_path / "nose.csv").write_text("\n".join(rows))
    pulses = PulseSetting(width_s, period_s)
    recording = read_rotation(path, iq=IqReading(tmp_path / "nose.csv", CENTRE_HZ + 1500.0, pulses))
    assert recording.sweeps[0].sweep.power_db.size == pytest.approx(seconds / period_s, abs=3)
    assert bearing_of(recording) == pytest.approx(250.0, abs=3.0)


def test_rows_of_the_headings_that_are_not_understood_are_named(tmp_path: Path) -> None:
    path = write_sigmf(tmp_path / "turn", turn_iq(200.0), RATE_HZ, CENTRE_HZ, START_S)
    headings = table(tmp_path / "nose.csv")
    headings.write_text(headings.read_text() + "\nnonsense,here\n12.0,nan\n")
    recording = read_rotation(path, iq=IqReading(headings, CENTRE_HZ + 2000.0))
    assert recording.remarks == (
        CellUnusable(str(headings), 132, 1, "nonsense", "time"),
        CellUnusable(str(headings), 133, 2, "nan", "heading"),
    )


def test_a_wrong_sample_rate_is_suspected_aloud(tmp_path: Path) -> None:
    path = write_sigmf(tmp_path / "turn", turn_iq(200.0), 2 * RATE_HZ, CENTRE_HZ, START_S)
    recording = read_rotation(path, iq=IqReading(table(tmp_path / "nose.csv")))
    (doubt,) = (remark for remark in recording.remarks if isinstance(remark, HeadingsOfOtherLength))
    assert doubt.sample_rate_hz == 24000.0


def broken(path: Path, **changes: object) -> Path:
    meta = json.loads(path.read_text())
    for key, value in changes.items():
        meta["global"][f"core:{key}"] = value
    path.write_text(json.dumps(meta))
    return path


@pytest.mark.parametrize("rate", [0, -5.0, "fast", 1e-3])
def test_rates_that_cannot_be_are_refused(tmp_path: Path, rate: object) -> None:
    path = write_sigmf(tmp_path / "turn", turn_iq(0.0, seconds=1.0), RATE_HZ, CENTRE_HZ, START_S, azimuths_of_turn(1.0))
    with pytest.raises(RecordingError, match=r"rate|fit"):
        read_rotation(broken(path, sample_rate=rate))


def test_silence_noise_and_numbers_that_are_none_are_refused(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    size = int(2.0 * RATE_HZ)
    noise = (rng.normal(size=size) + 1j * rng.normal(size=size)).astype(np.complex64) * 1e-3
    poisoned = turn_iq(0.0, seconds=2.0)
    poisoned[6000] = np.nan
    for name, iq, words in (
        ("zeros", np.zeros(size, np.complex64), "every sample is zero"),
        ("noise", noise, "nothing stands 10 dB above the noise"),
        ("nan", poisoned, "1 sample is not a number, the first after 0.50 s"),
    ):
        path = write_sigmf(tmp_path / name, iq, RATE_HZ, CENTRE_HZ, START_S, azimuths_of_turn(2.0))
        with pytest.raises(RecordingError, match=words):
            read_rotation(path)
    with pytest.raises(RecordingError, match="is silent at"):
        read_rotation(tmp_path / "noise.sigmf-meta", iq=IqReading(frequency_hz=CENTRE_HZ + 1000.0))
    with pytest.raises(RecordingError, match="No pulse was heard"):
        read_rotation(
            tmp_path / "noise.sigmf-data", iq=IqReading(frequency_hz=CENTRE_HZ, pulses=PulseSetting(0.02, 0.5))
        )


def test_missing_parts_are_named(tmp_path: Path) -> None:
    path = write_sigmf(tmp_path / "turn", turn_iq(0.0, seconds=1.0), RATE_HZ, CENTRE_HZ, START_S)
    with pytest.raises(RecordingError, match="does not state antenna:azimuth_angle"):
        read_rotation(path)
    with pytest.raises(RecordingError, match="does not hold"):
        read_rotation(
            write_sigmf(tmp_path / "b", turn_iq(0.0, seconds=1.0), RATE_HZ, CENTRE_HZ, START_S, azimuths_of_turn(1.0)),
            iq=IqReading(frequency_hz=CENTRE_HZ + 50_000.0),
        )
    with pytest.raises(RecordingError, match="The headings run from"):
        read_rotation(path, iq=IqReading(table(tmp_path / "late.csv", 500.0)))
    with pytest.raises(RecordingError, match="core:dataset cannot be used"):
        read_rotation(broken(write_sigmf(tmp_path / "c", turn_iq(0.0), RATE_HZ, CENTRE_HZ, START_S), dataset="../x"))
    path.with_suffix(".sigmf-data").unlink()
    with pytest.raises(RecordingError, match=r"lacks its file turn.sigmf-data"):
        read_rotation(path)
    with pytest.raises(RecordingError, match=r"lacks its file gone.sigmf-meta"):
        read_rotation(tmp_path / "gone.sigmf-data")


def test_a_recording_read_in_pieces_is_the_whole_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    iq = turn_iq(140.0)
    meta = write_sigmf(tmp_path / "turn", iq, RATE_HZ, CENTRE_HZ, START_S, azimuths_of_turn(), PLACE)
    samples = load_sigmf(meta).samples
    assert np.array_equal(np.concatenate([*samples.parts(7_001)]), iq)
    assert np.array_equal(samples.part(iq.size - 5, iq.size + 5), iq[-5:])
    assert samples.part(iq.size, iq.size + 5).size == 0
    whole = read_rotation(meta)
    monkeypatch.setattr("hardware.sdr.rotation.PIECE", SPECTRUM_SIZE)
    pieces = read_rotation(meta)
    assert pieces.remarks == whole.remarks
    assert np.array_equal(pieces.sweeps[0].sweep.power_db, whole.sweeps[0].sweep.power_db)
    window = np.hanning(SPECTRUM_SIZE)
    assert np.allclose(mean_spectrum(samples, window), averaged_spectrum(iq, window), rtol=1e-12)


@pytest.mark.parametrize(
    ("columns", "cells"),
    [("lat,ns,lon,ew", "36.5,S,174.25,W"), ("lat,ns,lon,ew", "3630.0,S,17415.0,W"), ("lat,lon", "36°30.0S,174°15.0W")],
)
def test_the_places_of_a_table_of_headings_are_read_as_those_of_other_tables(
    tmp_path: Path, columns: str, cells: str
) -> None:
    """Half the world away: letters were not looked at, and degrees with minutes were taken for none or for degrees."""
    recorded = load_sigmf(write_sigmf(tmp_path / "turn", turn_iq(80.0), RATE_HZ, CENTRE_HZ, START_S))
    path = tmp_path / "nose.csv"
    path.write_text(f"at_s,heading_deg,{columns}\n" + "\n".join(f"{t},{30 * t},{cells}" for t in range(13)))
    places = {heading.position for heading in headings_from(path, recorded, [])}
    assert places == {Place(-36.5, -174.25)}


@pytest.mark.parametrize("pulses", [None, PulseSetting()], ids=["carrier", "tag"])
def test_a_recording_that_is_too_short_for_one_reading_at_its_rate_is_refused(
    tmp_path: Path, pulses: PulseSetting | None
) -> None:
    """A window as long as a reading was made first, for which there was no memory."""
    path = write_sigmf(tmp_path / "turn", turn_iq(80.0), 1e12, CENTRE_HZ, START_S, azimuths_of_turn())
    with refusing(SamplesUnusable(str(path), "too_short"), RecordingError):
        read_rotation(path, iq=IqReading(frequency_hz=CENTRE_HZ, pulses=pulses))
