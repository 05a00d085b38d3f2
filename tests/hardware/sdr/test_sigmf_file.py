"""SigMF recordings: the first of several channels is read, and each sample has the time of its capture."""

from __future__ import annotations

import json
import pickle
import tarfile
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest
from refusals import refusing

from hardware.direction_finding.table_file import LONGEST_CELL, RecordingError
from hardware.reasons.iq_recording import FirstChannelUsed, SigmfFieldUnusable
from hardware.reasons.table import FileUnreadable
from hardware.sdr.rotation import IqReading, read_rotation
from hardware.sdr.rotation_headings import annotated_headings
from hardware.sdr.sigmf_file import AZIMUTH_KEY, Azimuth, load_sigmf, write_sigmf
from hardware.sdr.sigmf_playback import SigmfSource

RATE_HZ = 2000.0
CENTRE_HZ = 150e6
BEGAN_S = 1_780_000_000.0


def changed(path: Path, captures: list[dict[str, Any]] | None = None, **of_all: Any) -> Path:
    meta = json.loads(path.read_text())
    meta["global"] |= {f"core:{name}": value for name, value in of_all.items()}
    meta["captures"] = meta["captures"] if captures is None else captures
    path.write_text(json.dumps(meta))
    return path


def ramp(count: int) -> np.ndarray:
    return (np.arange(1, count + 1) / count + 0j).astype(np.complex64)


def capture(first: Any, stamp: str | None = None) -> dict[str, Any]:
    when = {} if stamp is None else {"core:datetime": stamp}
    return {"core:sample_start": first, "core:frequency": CENTRE_HZ} | when


def in_two(folder: Path, first: str | None, second: str | None) -> Path:
    """2000 samples; those from 1000 on are a capture of their own."""
    azimuths = [Azimuth(0, 1000, 0.0), Azimuth(500, 1000, 10.0)]
    path = write_sigmf(folder / "two", ramp(2000), RATE_HZ, CENTRE_HZ, BEGAN_S, azimuths)
    return changed(path, [capture(0, first), capture(1000, second)])


@pytest.mark.parametrize("channels", [2, 3])
def test_the_first_of_several_channels_is_read(tmp_path: Path, channels: int) -> None:
    own = ramp(1000)
    interleaved = np.stack([own, *[-own] * (channels - 1)], axis=1).ravel()
    path = changed(write_sigmf(tmp_path / "two", interleaved, RATE_HZ, CENTRE_HZ, BEGAN_S), num_channels=channels)
    recorded = load_sigmf(path)
    assert recorded.samples.size == 1000
    assert recorded.duration_s == pytest.approx(0.5)
    assert np.array_equal(recorded.samples.part(0, 1000), own)
    assert np.array_equal(np.concatenate(list(recorded.samples.parts(7))), own)
    assert np.array_equal(recorded.samples.part(990, 2000), own[990:])


def test_of_several_channels_the_first_gives_the_bearing_and_it_is_said(tmp_path: Path) -> None:
    t = np.arange(24_000) / RATE_HZ
    tone = (1.2 + np.cos(2 * np.pi * t / 12.0)) * np.exp(2j * np.pi * 300.0 * t)
    noise = 1e-3 * np.random.default_rng(1).normal(size=(3, t.size))
    azimuths = [Azimuth(k * 200, 200, 3.0 * k) for k in range(120)]
    one = write_sigmf(tmp_path / "one", (tone + noise[0]).astype(np.complex64), RATE_HZ, CENTRE_HZ, BEGAN_S, azimuths)
    both = np.stack([tone + noise[0], noise[1] + 1j * noise[2]], axis=1).ravel().astype(np.complex64)
    two = changed(write_sigmf(tmp_path / "two", both, RATE_HZ, CENTRE_HZ, BEGAN_S, azimuths), num_channels=2)
    iq = IqReading(frequency_hz=CENTRE_HZ + 300.0)
    alone, together = read_rotation(one, iq=iq), read_rotation(two, iq=iq)
    assert np.array_equal(alone.sweeps[0].sweep.power_db, together.sweeps[0].sweep.power_db)
    assert (alone.remarks, together.remarks) == ((), (FirstChannelUsed(str(two), 2),))


@pytest.mark.parametrize("channels", [0, -1, 1.5, "2"])
def test_a_number_of_channels_that_cannot_be_is_named(tmp_path: Path, channels: Any) -> None:
    path = write_sigmf(tmp_path / "two", ramp(1000), RATE_HZ, CENTRE_HZ, BEGAN_S)
    with refusing(SigmfFieldUnusable(str(path), "core:num_channels", str(channels)), RecordingError):
        load_sigmf(changed(path, num_channels=channels))


@pytest.mark.parametrize(
    ("first", "second", "began_s", "later_s"),
    [
        ("2026-05-28T20:26:40Z", "2026-05-28T20:26:50Z", BEGAN_S, 10.0),
        ("2026-05-28T20:26:40Z", None, BEGAN_S, 0.5),
        (None, "2026-05-28T20:26:50Z", BEGAN_S + 9.5, 0.5),
        (None, None, 0.0, 0.5),
    ],
)
async def test_each_sample_has_its_captures_time(
    tmp_path: Path, first: str | None, second: str | None, began_s: float, later_s: float
) -> None:
    path = in_two(tmp_path, first, second)
    recorded = load_sigmf(path)
    assert [recorded.time_of(k) - began_s for k in (0, 999, 1000, 1500)] == pytest.approx(
        [0.0, 0.4995, later_s, later_s + 0.25], abs=1e-6
    )
    assert recorded.start_s == pytest.approx(began_s)
    assert recorded.duration_s == pytest.approx(later_s + 0.5)
    # the turn of 10 degrees lies across the two captures
    inside = [h.at_s - began_s for h in annotated_headings(recorded) if h.heading_deg == 10.0]
    assert inside == pytest.approx([0.375, later_s + 0.125])
    source = SigmfSource(path, block_s=0.2)
    await source.open(CENTRE_HZ)
    blocks = [block async for block in source.blocks()]
    assert [block.at_s - began_s for block in blocks] == pytest.approx(
        [0.0, 0.2, 0.4, later_s, later_s + 0.2, later_s + 0.4], abs=1e-6
    )
    assert [bool(block.lost) for block in blocks] == [False] * 3 + [later_s > 0.5] + [False] * 2
    assert np.array_equal(np.concatenate([block.samples for block in blocks]), ramp(2000))


EARLIER, LATER = "2026-05-01T10:00:00Z", "2026-05-01T10:00:30Z"


def as_stated(folder: Path, *captures: dict[str, Any]) -> Path:
    """2000 samples, a second."""
    return changed(write_sigmf(folder / "stated", ramp(2000), RATE_HZ, CENTRE_HZ, BEGAN_S), list(captures))


def test_captures_out_of_order_keep_their_times(tmp_path: Path) -> None:
    recorded = load_sigmf(as_stated(tmp_path, capture(1000, LATER), capture(0, EARLIER)))
    assert [(s.first, recorded.time_of(s.first) - recorded.start_s) for s in recorded.segments] == [(0, 0), (1000, 30)]
    assert [(block.samples.size, block.lost) for block in recorded.blocks(5000)] == [(1000, 0), (1000, 1)]


@pytest.mark.parametrize("beyond", [2000, 10**9])
async def test_a_capture_beyond_the_samples_is_of_none(tmp_path: Path, beyond: int) -> None:
    path = as_stated(tmp_path, capture(0, EARLIER), capture(beyond, LATER))
    sizes = [block.samples.size async for block in SigmfSource(path).blocks()]
    assert sizes == [100] * 20


@pytest.mark.parametrize("beyond", [2000, 10**12])
def test_captures_that_all_begin_beyond_the_samples_are_refused(tmp_path: Path, beyond: int) -> None:
    """Counted on from an earlier file, they gave each sample a time from long before the recording."""
    with pytest.raises(RecordingError) as refused:
        load_sigmf(as_stated(tmp_path, capture(beyond, EARLIER), capture(beyond + 10, LATER)))
    assert isinstance(refused.value.reason, FileUnreadable)
    assert refused.value.reason.detail == (
        f"core:sample_start: {beyond} lies beyond its 2000 samples, count from the first sample of the data file"
    )


@pytest.mark.filterwarnings("ignore:Data source ends before")
def test_samples_that_are_numbered_on_from_another_file_have_their_own_times_and_directions(tmp_path: Path) -> None:
    """core:offset says how many were in the files before."""
    alone = load_sigmf(in_two(tmp_path, EARLIER, LATER))
    meta = json.loads(alone.path.read_text())
    for one in (*meta["captures"], *meta["annotations"]):
        one["core:sample_start"] += 1500
    alone.path.write_text(json.dumps(meta))
    part = load_sigmf(changed(alone.path, offset=1500))
    assert (part.segments, part.azimuths) == (alone.segments, alone.azimuths)


@pytest.mark.parametrize("offset", [1, 10**12])
def test_captures_that_are_not_numbered_on_are_counted_from_the_files_first_sample(tmp_path: Path, offset: int) -> None:
    alone = load_sigmf(in_two(tmp_path, EARLIER, LATER))
    part = load_sigmf(changed(alone.path, offset=offset))
    assert (part.segments, part.azimuths) == (alone.segments, alone.azimuths)


@pytest.mark.parametrize("offset", [-1, 1.5, "7"])
def test_an_offset_that_cannot_be_is_named(tmp_path: Path, offset: Any) -> None:
    with pytest.raises(RecordingError) as refused:
        load_sigmf(changed(in_two(tmp_path, EARLIER, LATER), offset=offset))
    assert isinstance(refused.value.reason, FileUnreadable)


def test_samples_before_the_first_capture_are_read_too(tmp_path: Path) -> None:
    recorded = load_sigmf(as_stated(tmp_path, capture(1000.0, EARLIER)))
    assert sum(block.samples.size for block in recorded.blocks(300)) == 2000
    assert recorded.time_of(1000) - recorded.start_s == 0.5


@pytest.mark.parametrize("first", [-10, "x", 1.5, float("inf"), [1]])
def test_a_capture_that_begins_nowhere_is_named(tmp_path: Path, first: Any) -> None:
    with pytest.raises(RecordingError) as refused:
        load_sigmf(as_stated(tmp_path, capture(0), capture(first)))
    assert isinstance(refused.value.reason, FileUnreadable)
    assert repr(first) in refused.value.reason.detail


def test_captures_whose_time_goes_back_are_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError) as refused:
        load_sigmf(as_stated(tmp_path, capture(0, LATER), capture(1000, EARLIER)))
    assert isinstance(refused.value.reason, SigmfFieldUnusable)
    assert refused.value.reason.field == "core:datetime"


def test_a_time_that_goes_back_beyond_all_years_is_refused(tmp_path: Path) -> None:
    before_christ = "0001-01-01T00:00:00+14:00"
    with refusing(
        SigmfFieldUnusable(str(tmp_path / "stated.sigmf-meta"), "core:datetime", before_christ), RecordingError
    ):
        load_sigmf(as_stated(tmp_path, capture(0, EARLIER), capture(1000, before_christ)))


@pytest.mark.parametrize("frequency", [[CENTRE_HZ], {}, "150 MHz", 10**400], ids=["list", "object", "text", "huge"])
def test_a_frequency_that_is_no_number_is_named(tmp_path: Path, frequency: Any) -> None:
    path = as_stated(tmp_path, capture(0), capture(1000) | {"core:frequency": frequency})
    with refusing(SigmfFieldUnusable(str(path), "core:frequency", str(frequency)[:LONGEST_CELL]), RecordingError):
        load_sigmf(path)


@pytest.mark.filterwarnings("ignore:Data source does not contain an integer number")
@pytest.mark.parametrize(
    "stated",
    [
        {"captures": [capture(10**400)]},
        {"captures": [capture(0) | {"core:header_bytes": 1.5}]},
        {"captures": [capture(0) | {"core:header_bytes": -8}]},
        {"captures": [capture(0) | {AZIMUTH_KEY: 10**400}]},
        {"captures": [capture(0) | {"core:geolocation": {"type": "Point", "coordinates": [10**400, 1]}}]},
        {"sample_rate": 10**400},
    ],
)
def test_numbers_that_count_nothing_or_that_no_float_holds_are_refused(tmp_path: Path, stated: dict[str, Any]) -> None:
    path = changed(write_sigmf(tmp_path / "two", ramp(2000), RATE_HZ, CENTRE_HZ, BEGAN_S), **stated)
    with pytest.raises(RecordingError):
        load_sigmf(path)


def test_thousands_of_captures_are_read_in_no_time(tmp_path: Path) -> None:
    """A receiver that loses samples begins one at each loss: every one looked at all the others, for minutes."""
    path = write_sigmf(tmp_path / "many", ramp(6000), RATE_HZ, CENTRE_HZ, BEGAN_S)
    stamps = (datetime.fromtimestamp(BEGAN_S + k, UTC).isoformat() for k in range(6000))
    recorded = load_sigmf(changed(path, [capture(k, stamp) for k, stamp in enumerate(stamps)]))
    began_s = process_time()
    times = [block.at_s for block in recorded.blocks(1000)]
    assert times == pytest.approx(BEGAN_S + np.arange(6000))
    assert process_time() - began_s < 5.0


def test_an_archive_whose_meta_file_breaks_the_standard_is_refused(tmp_path: Path) -> None:
    """With a reason that a worker process can hand over: the validator's own error holds its schema."""
    meta = write_sigmf(tmp_path / "one", ramp(1000), RATE_HZ, CENTRE_HZ, BEGAN_S)
    changed(meta, [capture(-5)])
    archive = tmp_path / "one.sigmf"
    with tarfile.open(archive, "w") as tar:
        for path in (meta, meta.with_suffix(".sigmf-data")):
            tar.add(path, f"one/{path.name}")
    with pytest.raises(RecordingError) as refused:
        load_sigmf(archive)
    assert isinstance(pickle.loads(pickle.dumps(refused.value)), RecordingError)


def test_an_archive_reads_no_other_file_of_this_machine(tmp_path: Path) -> None:
    meta = write_sigmf(tmp_path / "one", ramp(1000), RATE_HZ, CENTRE_HZ, BEGAN_S)
    other = tmp_path / "other.bin"
    other.write_bytes(ramp(777).tobytes())
    changed(meta, dataset=str(other))
    archive = tmp_path / "one.sigmf"
    with tarfile.open(archive, "w") as tar:
        tar.add(meta, f"one/{meta.name}")
        tar.add(meta.with_suffix(".sigmf-data"), f"one/{meta.with_suffix('.sigmf-data').name}")
    with suppress(RecordingError):
        assert load_sigmf(archive).samples.size == 1000
