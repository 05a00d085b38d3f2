"""Recorded sweeps of every kind; IQ of a turn is made into power here, its headings come from rotation_headings.py."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.recordings import RecordedSweep, Recording, read_recording
from hardware.direction_finding.sweep import SweepError, assemble_sweep
from hardware.direction_finding.table_file import RecordingError
from hardware.readings import Place, PowerSample
from hardware.reasons.channels import SampleRateTooLow
from hardware.reasons.iq_recording import (
    FirstChannelUsed,
    NoPulseAt,
    NoSignalFound,
    NotIq,
    ReadingsWithoutHeading,
    RecordingUnusable,
    SamplesNotNumbers,
    SamplesUnusable,
    SilentAt,
    StrongestUsed,
)
from hardware.reasons.union import RecordingReason
from hardware.sdr.pulses import PulseMeter, PulseSetting
from hardware.sdr.rotation_headings import annotated_headings, apart, headings_from
from hardware.sdr.sigmf_file import Samples, SigmfRecording, load_sigmf
from hardware.sdr.sigmf_names import is_sigmf
from hardware.sdr.spectrum import SpectrumError, ToneMeter, ToneSetting, averaged_spectrum

BLOCK_S = 0.5
SLOWEST_HZ = 1000.0
HEARD_DB = 6.0
"""A carrier that never stands this far above the noise was not received."""
FOUND_DB = 10.0
SPECTRUM_SIZE = 4096
PIECE = 2**20
"""Samples that are looked at together; a multiple of half a window of the spectrum."""
DC_BINS = 8
"""Cheap receivers have a spike at the centre of the band, this many bins wide to either side."""
UNKNOWN_PLACE = Place(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class IqReading:
    """How to read IQ. headings: a table (time, heading of the nose) instead of what the recording carries.

    frequency_hz None: the strongest signal's. pulses: of a pulsed tag; None: a carrier.
    """

    headings: Path | None = None
    frequency_hz: float | None = None
    pulses: PulseSetting | None = None


def read_sweeps(path: Path | str, tag: str | None = None, iq: IqReading | None = None) -> Recording:
    """Any recorded sweep: SigMF of a rotation, UAV-RT rotation file or plain CSV. Raises RecordingError."""
    if is_sigmf(path):
        return read_rotation(path, tag, iq)
    if iq is not None and iq.headings is not None:
        raise RecordingError(NotIq(str(path), "headings"))
    return read_recording(path, tag)


def read_rotation(path: Path | str, tag: str | None = None, iq: IqReading | None = None) -> Recording:
    """One sweep from a SigMF recording of a turn. Raises RecordingError; every doubt is a remark."""
    iq = iq or IqReading()
    recorded = load_sigmf(path)
    _refuse_unusable_samples(recorded)
    remarks: list[RecordingReason] = []
    if recorded.channels > 1:
        remarks.append(FirstChannelUsed(str(path), recorded.channels))
    frequency_hz = iq.frequency_hz
    if frequency_hz is None:
        frequency_hz = _strongest_hz(recorded)
        remarks.append(StrongestUsed(str(path), frequency_hz))
    of_antenna = iq.headings is None
    headings = annotated_headings(recorded) if iq.headings is None else headings_from(iq.headings, recorded, remarks)
    heard = _heard(recorded, frequency_hz, iq.pulses)
    place = recorded.place
    stands = [h.position for h in headings if h.position is not None]
    try:
        sweep = assemble_sweep(
            heard,
            headings,
            frequency_hz=frequency_hz,
            altitude_amsl_m=0.0,
            position=place if place is not None or stands else UNKNOWN_PLACE,
            tag=tag,
        )
    except SweepError as error:
        raise RecordingError(apart(recorded, headings) or RecordingUnusable(str(path), error.reason)) from error
    unheard = len(heard) - sweep.power_db.size
    if unheard > 0.02 * len(heard):
        remarks.append(ReadingsWithoutHeading(str(path), unheard, len(heard)))
    known = place is not None or bool(stands)
    return Recording((RecordedSweep(sweep, None, known, of_antenna),), tuple(remarks))


def _refuse_unusable_samples(recorded: SigmfRecording) -> None:
    file = str(recorded.path)
    if recorded.sample_rate_hz < SLOWEST_HZ:
        raise RecordingError(RecordingUnusable(file, SampleRateTooLow(recorded.sample_rate_hz, SLOWEST_HZ)))
    bad, first, heard = 0, 0, False
    for k, part in enumerate(recorded.samples.parts(PIECE)):
        wrong = np.flatnonzero(~np.isfinite(part))
        if wrong.size and not bad:
            first = k * PIECE + int(wrong[0])
        bad, heard = bad + wrong.size, heard or bool(part.any())
    if bad:
        raise RecordingError(SamplesNotNumbers(file, bad, first / recorded.sample_rate_hz))
    if not heard:
        raise RecordingError(SamplesUnusable(file, "zero"))


def _strongest_hz(recorded: SigmfRecording) -> float:
    """The strongest line of the mean spectrum, the receiver's spike at the centre only when there is nothing else."""
    size = min(SPECTRUM_SIZE, 2 ** int(math.log2(max(recorded.samples.size, 2))))
    window = np.hanning(size + 1)[:-1]
    spectrum = mean_spectrum(recorded.samples, window)
    bins_hz = np.fft.fftfreq(size, 1.0 / recorded.sample_rate_hz)
    noise = float(np.median(spectrum))
    width_hz = recorded.sample_rate_hz / size
    centre = np.abs(bins_hz) <= DC_BINS * width_hz
    for eligible in (~centre, centre):
        peak = int(np.argmax(np.where(eligible, spectrum, -1.0)))
        if spectrum[peak] > 10.0 ** (FOUND_DB / 10.0) * noise:
            return recorded.centre_hz + float(bins_hz[peak])
    raise RecordingError(NoSignalFound(str(recorded.path), FOUND_DB))


def mean_spectrum(samples: Samples, window: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) averaged_spectrum of all of them, read piece by piece: each reaches half a window into the next, where
    windows overlap."""
    total, counted = np.zeros(window.size), 0
    for first in range(0, samples.size, PIECE):
        part = samples.part(first, first + PIECE + window.size // 2)
        if part.size >= window.size:
            windows = 2 * (part.size - window.size) // window.size + 1
            total, counted = total + windows * averaged_spectrum(part, window), counted + windows
    return total / counted


def _heard(recorded: SigmfRecording, frequency_hz: float, pulses: PulseSetting | None) -> list[PowerSample]:
    reading_s = 1.0 / ToneSetting().rate_hz if pulses is None else pulses.width_s
    if recorded.samples.size < int(reading_s * recorded.sample_rate_hz):  # its window alone may fill the memory
        raise RecordingError(SamplesUnusable(str(recorded.path), "too_short"))
    meter = _meter(recorded, frequency_hz, pulses)
    size = max(int(BLOCK_S * recorded.sample_rate_hz), 1)
    heard = [sample for block in recorded.blocks(size) for sample in meter.feed(block) if sample.detected]
    if pulses is not None:
        if not heard:
            raise RecordingError(NoPulseAt(str(recorded.path), frequency_hz))
        return heard
    above = [s.power_db - s.noise_floor_db for s in heard if s.noise_floor_db is not None]
    if not above:
        raise RecordingError(SamplesUnusable(str(recorded.path), "too_short"))
    if max(above) < HEARD_DB:
        raise RecordingError(SilentAt(str(recorded.path), frequency_hz, max(above)))
    return heard


def _meter(recorded: SigmfRecording, frequency_hz: float, pulses: PulseSetting | None) -> ToneMeter | PulseMeter:
    """Searches the emitter as far to either side as the band allows."""
    rate, centre = recorded.sample_rate_hz, recorded.centre_hz
    room_hz = rate / 2.0 - abs(frequency_hz - centre)
    try:
        if pulses is not None:
            reach = min(pulses.search_hz, max(room_hz, 0.0))
            return PulseMeter(frequency_hz, centre, rate, setting=replace(pulses, search_hz=reach))
        plain = ToneSetting()
        width_hz = min(plain.bandwidth_hz, rate / 20.0)
        reach = min(plain.search_hz, max(room_hz - width_hz, 0.0))
        return ToneMeter(frequency_hz, centre, rate, setting=replace(plain, bandwidth_hz=width_hz, search_hz=reach))
    except SpectrumError as error:
        raise RecordingError(RecordingUnusable(str(recorded.path), error.reason)) from error
