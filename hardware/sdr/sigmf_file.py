"""SigMF recordings as files: IQ with its rate, frequency, times, and the antenna's direction where it is annotated."""

from __future__ import annotations

import errno
import json
import os
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, TypeGuard

import numpy as np
import sigmf
from jsonschema.exceptions import ValidationError
from numpy.typing import NDArray

from hardware.direction_finding.table_file import LARGEST, LONGEST_CELL, RecordingError
from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.readings import Place
from hardware.reasons.iq_recording import (
    Field,
    SamplesUnusable,
    SigmfFieldMissing,
    SigmfFieldUnusable,
    SigmfFileMissing,
)
from hardware.reasons.table import FileUnreadable
from hardware.sdr.sigmf_names import DATA, META

NUM_CHANNELS_KEY: Final = "core:num_channels"
AZIMUTH_KEY: Final = "antenna:azimuth_angle"
"""Of the antenna extension to SigMF: direction of the main beam from north, degrees clockwise."""
HEADER_BYTES_KEY: Final = "core:header_bytes"
OFFSET_KEY: Final = "core:offset"
"""Number of the file's first sample: where one recording is kept in several files, all numbers go on from file to
file."""


@dataclass(frozen=True, slots=True)
class Segment:
    """A capture: samples from `first` on. at_s: UTC epoch seconds of its first sample, None where no capture states a
    time."""

    first: int
    at_s: float | None


@dataclass(frozen=True, slots=True)
class Azimuth:
    """The antenna's front points to `azimuth_deg` (true) during `count` samples from `first` on."""

    first: int
    count: int
    azimuth_deg: float


class Samples:
    """Of a recording, read from its file piece by piece: as complex64 they take four times as much as on most disks.

    Of several channels, whose samples lie interleaved in the file, the first one's. size: how many there are.
    """

    def __init__(self, recording: sigmf.SigMFFile) -> None:
        self._recording = recording
        self.size = int(recording.sample_count)  # of bytes that are stated as 8.0 it is a float

    def part(self, first: int, end: int) -> NDArray[np.complex64]:
        """(end - first,), 1.0 = full scale; fewer at the end of the recording."""
        count = min(end, self.size) - first
        if count <= 0:
            return np.empty(0, np.complex64)
        read = np.asarray(self._recording.read_samples(first, count), dtype=np.complex64)
        return read if read.ndim == 1 else np.ascontiguousarray(read[:, 0])

    def parts(self, length: int) -> Iterator[NDArray[np.complex64]]:
        """All of them, `length` at a time, fewer in the last."""
        return (self.part(first, first + length) for first in range(0, self.size, length))


@dataclass(frozen=True, slots=True)
class SigmfRecording:
    """segments: at least one, ascending as are the times that they state. Samples before the first are its, too."""

    path: Path
    samples: Samples
    channels: int
    sample_rate_hz: float
    centre_hz: float
    segments: tuple[Segment, ...]
    azimuths: tuple[Azimuth, ...]
    place: Place | None

    @property
    def start_s(self) -> float:
        """UTC epoch seconds of the first sample; 0 when no capture states a time."""
        return self.time_of(0)

    @property
    def dated(self) -> bool:
        """Whether a capture states its time."""
        return self.segments[0].at_s is not None

    @property
    def duration_s(self) -> float:
        """From the first sample to the last, with what went by between captures."""
        return self.time_of(self.samples.size - 1) + 1.0 / self.sample_rate_hz - self.start_s

    def time_of(self, sample: int) -> float:
        """UTC epoch seconds of a sample, counted on from its capture's first, or back from the first capture's."""
        if not self.dated:
            return sample / self.sample_rate_hz
        its = self.segments[max(bisect_right(self.segments, sample, key=lambda one: one.first) - 1, 0)]
        return (its.at_s or 0.0) + (sample - its.first) / self.sample_rate_hz

    def blocks(self, size: int) -> Iterator[IqBlock]:
        """`size` samples each, capture by capture at its own time; that time went by between two counts as loss."""
        last = self.samples.size
        for begin, end in pairwise(sorted({0, *(min(segment.first, last) for segment in self.segments), last})):
            gap_s = self.time_of(begin) - self.time_of(begin - 1) - 1.0 / self.sample_rate_hz if begin > 0 else 0.0
            lost = 1 if abs(gap_s) > 1.0 / self.sample_rate_hz else 0
            for first in range(begin, end, size):
                part = self.samples.part(first, min(first + size, end))
                yield IqBlock(self.time_of(first), part, clipped_at_full_scale(part), lost if first == begin else 0)


def load_sigmf(path: Path | str) -> SigmfRecording:
    """One recording: its meta file, its data file beside it, or an archive. Raises RecordingError."""
    path = Path(path)
    recording = _opened(path)
    before = _numbered_on(path, recording)
    captures = [_counted_here(path, capture, before) for capture in recording.get_captures()]
    captures.sort(key=lambda capture: capture[sigmf.SAMPLE_START_KEY])
    for capture in captures:
        _whole(path, capture, HEADER_BYTES_KEY)
    rate = recording.get_global_field(sigmf.SAMPLE_RATE_KEY)
    if rate is None:
        raise RecordingError(SigmfFieldMissing(str(path), "core:sample_rate"))
    if not _is_number(rate) or rate <= 0:
        raise _unusable(path, "core:sample_rate", rate)
    tuned = [capture[sigmf.FREQUENCY_KEY] for capture in captures if sigmf.FREQUENCY_KEY in capture]
    if not tuned:
        raise RecordingError(SigmfFieldMissing(str(path), "core:frequency"))
    for stated in tuned:
        if not _is_number(stated):
            raise _unusable(path, "core:frequency", stated)
    if len(set(tuned)) > 1:
        raise _unusable(path, "core:frequency", ", ".join(map(str, sorted(set(tuned)))))
    centre = tuned[0]
    try:
        samples = Samples(recording)
        first = recording.read_samples(0, 1) if samples.size else None
    except (OSError, ValueError, KeyError, TypeError, sigmf.error.SigMFError) as error:
        raise RecordingError(FileUnreadable(str(path), str(error))) from error
    if first is None:
        raise RecordingError(SamplesUnusable(str(path), "none"))
    begins = _whole(path, captures[0], sigmf.SAMPLE_START_KEY)
    if begins >= samples.size:
        detail = f"lies beyond its {samples.size} samples, count from the first sample of the data file"
        raise RecordingError(FileUnreadable(str(path), f"{sigmf.SAMPLE_START_KEY}: {begins} {detail}"))
    if not np.iscomplexobj(first):
        raise RecordingError(SamplesUnusable(str(path), "real"))
    return SigmfRecording(
        path,
        samples,
        recording.num_channels,
        float(rate),
        float(centre),
        _segments(path, captures, rate),
        _azimuths(path, [_counted_here(path, a, before) for a in recording.get_annotations()], captures, samples.size),
        _place(path, recording, captures),
    )


def _unusable(path: Path, field: Field, value: object) -> RecordingError:
    return RecordingError(SigmfFieldUnusable(str(path), field, str(value)[:LONGEST_CELL]))


def _is_number(value: object) -> TypeGuard[int | float]:
    """JSON knows whole numbers that no float holds."""
    return isinstance(value, int | float) and abs(value) <= LARGEST


def _opened(path: Path) -> sigmf.SigMFFile:
    if path.suffix.lower() in (META, DATA):
        meta, data = path.with_suffix(META), path.with_suffix(DATA)
        if not meta.is_file():
            raise RecordingError(SigmfFileMissing(str(path), meta.name))
        _refuse_unread(meta)
        if not data.is_file():
            raise RecordingError(SigmfFileMissing(str(path), data.name))
    elif not path.is_file():
        raise RecordingError(FileUnreadable(str(path), os.strerror(errno.ENOENT)))
    try:
        recording = sigmf.fromfile(str(path))
    except (OSError, ArithmeticError, ValueError, KeyError, TypeError, AttributeError, sigmf.error.SigMFError) as error:
        raise RecordingError(FileUnreadable(str(path), str(error))) from error
    except ValidationError as error:  # with its schema it can leave no worker process
        raise RecordingError(FileUnreadable(str(path), error.message[:LONGEST_CELL])) from None
    if not isinstance(recording, sigmf.SigMFFile):
        raise RecordingError(SamplesUnusable(str(path), "collection"))
    return recording


def _refuse_unread(meta: Path) -> None:
    """A foreign meta file must not make us read another file than its own data, nor divide it by no channels."""
    try:
        of_all = json.loads(meta.read_bytes())["global"]
        dataset, channels = of_all.get(sigmf.DATASET_KEY), of_all.get(NUM_CHANNELS_KEY, 1)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise RecordingError(FileUnreadable(str(meta), str(error))) from error
    if dataset is not None:
        raise _unusable(meta, "core:dataset", dataset)
    if not isinstance(channels, int) or channels < 1:
        raise _unusable(meta, "core:num_channels", channels)


def _whole(path: Path, stated: dict[str, Any], key: str) -> int:
    """How many samples or bytes, 0 where it is not stated."""
    count = stated.get(key) or 0
    if not _is_number(count) or count < 0 or count % 1 != 0:
        raise RecordingError(FileUnreadable(str(path), f"{key}: {count!r}"[:LONGEST_CELL]))
    return int(count)


def _numbered_on(path: Path, recording: sigmf.SigMFFile) -> int:
    """How many samples lay in the files before; 0 where captures are counted from this file's first all the same."""
    before = _whole(path, {OFFSET_KEY: recording.get_global_field(OFFSET_KEY)}, OFFSET_KEY)
    firsts = [_whole(path, capture, sigmf.SAMPLE_START_KEY) for capture in recording.get_captures()]
    return before if before <= min(firsts, default=0) else 0


def _counted_here(path: Path, stated: dict[str, Any], before: int) -> dict[str, Any]:
    """A capture or annotation with its first sample counted from the file's."""
    return {**stated, sigmf.SAMPLE_START_KEY: max(_whole(path, stated, sigmf.SAMPLE_START_KEY) - before, 0)}


def _segments(path: Path, captures: Sequence[dict[str, Any]], rate_hz: float) -> tuple[Segment, ...]:
    """Where a capture states no time, counted on from the last that states one, or back from the first."""
    firsts, times = [_whole(path, c, sigmf.SAMPLE_START_KEY) for c in captures], [_time(path, c) for c in captures]
    stated = [(first, at_s) for first, at_s in zip(firsts, times, strict=True) if at_s is not None]
    if not stated:
        return tuple(Segment(first, None) for first in firsts)
    segments: list[Segment] = []
    known, known_s = stated[0]
    for capture, first, at_s in zip(captures, firsts, times, strict=True):
        if at_s is not None:
            if at_s < known_s:
                raise _unusable(path, "core:datetime", capture[sigmf.DATETIME_KEY])
            known, known_s = first, at_s
        segments.append(Segment(first, known_s + (first - known) / rate_hz))
    return tuple(segments)


def _time(path: Path, capture: dict[str, Any]) -> float | None:
    stamp = capture.get(sigmf.DATETIME_KEY)
    if stamp is None:
        return None
    try:
        moment = datetime.fromisoformat(stamp)
    except (TypeError, ValueError):
        raise _unusable(path, "core:datetime", stamp) from None
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def _azimuths(
    path: Path, annotations: Sequence[dict[str, Any]], captures: Sequence[dict[str, Any]], size: int
) -> tuple[Azimuth, ...]:
    """Of annotations, else of captures (each holds until the next), in time order."""
    found = [
        Azimuth(
            _whole(path, a, sigmf.SAMPLE_START_KEY),
            _whole(path, a, sigmf.SAMPLE_COUNT_KEY),
            _degrees(path, a[AZIMUTH_KEY]),
        )
        for a in annotations
        if AZIMUTH_KEY in a
    ]
    if not found:
        firsts = [min(_whole(path, c, sigmf.SAMPLE_START_KEY), size) for c in captures]
        for capture, (first, end) in zip(captures, pairwise([*firsts, size]), strict=True):
            if AZIMUTH_KEY in capture and end > first:
                found.append(Azimuth(first, end - first, _degrees(path, capture[AZIMUTH_KEY])))
    return tuple(sorted(found, key=lambda a: a.first))


def _degrees(path: Path, value: object) -> float:
    if not _is_number(value):
        raise _unusable(path, AZIMUTH_KEY, value)
    return float(value) % 360.0


def _place(path: Path, recording: sigmf.SigMFFile, captures: Sequence[dict[str, Any]]) -> Place | None:
    """core:geolocation of a capture or of the whole, a GeoJSON point."""
    stated = [c[sigmf.GEOLOCATION_KEY] for c in captures if sigmf.GEOLOCATION_KEY in c]
    stated = stated or [g for g in (recording.get_global_field(sigmf.GEOLOCATION_KEY),) if g is not None]
    if not stated:
        return None
    try:
        lon, lat = (float(value) for value in stated[0]["coordinates"][:2])
    except (TypeError, ValueError, KeyError, OverflowError):
        raise _unusable(path, "core:geolocation", stated[0]) from None
    if not (abs(lat) <= 90.0 and abs(lon) <= 180.0):
        raise _unusable(path, "core:geolocation", stated[0])
    return Place(lat, lon)


def write_sigmf(
    path: Path | str,
    samples: NDArray[np.complex64],
    sample_rate_hz: float,
    centre_hz: float,
    start_s: float,
    azimuths: Sequence[Azimuth] = (),
    place: Place | None = None,
    antenna: str = "unknown",
) -> Path:
    """Write `path` (.sigmf-meta and .sigmf-data beside it); returns the meta file's path.

    start_s: UTC epoch seconds. azimuths: where the antenna's front pointed; antenna: its name.
    """
    base = Path(path).with_suffix("")
    data = base.with_suffix(DATA)
    samples.astype(np.complex64).tofile(data)
    about: dict[str, Any] = {
        sigmf.DATATYPE_KEY: "cf32_le",
        sigmf.SAMPLE_RATE_KEY: sample_rate_hz,
        sigmf.DESCRIPTION_KEY: "IQ recorded by crossfix",
    }
    if place is not None:
        about[sigmf.GEOLOCATION_KEY] = {"type": "Point", "coordinates": [place.lon, place.lat]}
    if azimuths:
        about[sigmf.EXTENSIONS_KEY] = [{"name": "antenna", "version": "1.0.0", "optional": True}]
        about["antenna:model"] = antenna
    meta = sigmf.SigMFFile(data_file=str(data), global_info=about)
    stamp = datetime.fromtimestamp(start_s, UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    meta.add_capture(0, metadata={sigmf.FREQUENCY_KEY: centre_hz, sigmf.DATETIME_KEY: stamp})
    for azimuth in azimuths:
        meta.add_annotation(azimuth.first, azimuth.count, metadata={AZIMUTH_KEY: azimuth.azimuth_deg})
    target = base.with_suffix(META)
    meta.tofile(str(target), overwrite=True)
    return target
