"""`crossfix sweep`: bearing of each rotation in a recorded file."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import typer

from backend.cli.edge import parse_place, print_json, remark, stop
from backend.settings import settings_of
from hardware.direction_finding.estimate import MINIMUM_QUALITY, SparseDirectionFinder
from hardware.direction_finding.heading import HeadingError, made_true
from hardware.direction_finding.pattern_file import PatternError, borrowed_pattern, load_pattern
from hardware.direction_finding.recordings import RecordedSweep, mounted
from hardware.direction_finding.table_file import RecordingError, listed
from hardware.readings import BearingReading, Place
from hardware.sdr.pulses import PulseSetting
from hardware.sdr.rotation import IqReading, read_sweeps
from hardware.sdr.spectrum import SpectrumError
from planner.reason import sentence_of


def sweep(
    file: Annotated[
        Path,
        typer.Argument(
            help="UAV-RT rotation file, CSV with columns heading_deg, power_db[, time, lat, lon, tag, sweep], or SigMF."
        ),
    ],
    pattern: Annotated[
        Path | None,
        typer.Option(
            help="Antenna pattern: JSON, or a turntable table (angle_deg, gain_db) as CSV. "
            "Default: the small Yagi that ships with crossfix, another antenna's: the bearing says so and is wider."
        ),
    ] = None,
    offset: Annotated[
        float | None,
        typer.Option(
            min=-360.0,
            max=360.0,
            help="Degrees the antenna's front points clockwise of the nose. Default: the file's, else the pattern's.",
        ),
    ] = None,
    tag: Annotated[str | None, typer.Option(help="Use this tag's pulses. Default: the tag heard most.")] = None,
    at: Annotated[str | None, typer.Option(help="LAT,LON of the sweep when the file does not tell.")] = None,
    headings: Annotated[
        Path | None,
        typer.Option(
            help="For SigMF: CSV of time, heading_deg[, lat, lon] of the nose. Times: seconds since the recording "
            "began, UTC epoch seconds or ISO 8601. Default: antenna:azimuth_angle of the recording's annotations."
        ),
    ] = None,
    frequency_hz: Annotated[
        float | None, typer.Option(min=1.0, help="For SigMF: the emitter's frequency. Default: the strongest signal's.")
    ] = None,
    pulse_width_s: Annotated[float | None, typer.Option(help="For SigMF of a pulsed tag: length of a pulse.")] = None,
    pulse_period_s: Annotated[
        float | None, typer.Option(help="For SigMF of a pulsed tag: from pulse to pulse.")
    ] = None,
    magnetic: Annotated[
        datetime | None,
        typer.Option(
            formats=["%Y-%m-%d"],
            help="The headings are a magnetic compass's, of this day: made true by the World Magnetic Model.",
        ),
    ] = None,
    heading_sigma_deg: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=45.0,
            help="What headings are uncertain by. Default: CROSSFIX_HEADING_SIGMA_DEG, as in flight.",
        ),
    ] = None,
    minimum_quality: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Sweeps less similar to the antenna pattern are rejected.")
    ] = MINIMUM_QUALITY,
    json_: Annotated[
        bool, typer.Option("--json", help="Print one JSON value: an object, or an array for several.")
    ] = False,
) -> None:
    """Turn recorded sweeps (power against heading) into bearings in degrees clockwise from true north.

    Example: crossfix sweep rotation.csv --pattern my_yagi.json --json. IQ: crossfix sweep turn.sigmf-meta --headings
    nose.csv --json
    """
    try:
        antenna = borrowed_pattern() if pattern is None else load_pattern(pattern)
        iq = IqReading(headings, frequency_hz, _pulses(pulse_width_s, pulse_period_s))
        recording = read_sweeps(file, tag, iq)
        place = parse_place(at) if at is not None else None
        sweeps = (
            recording.sweeps if magnetic is None else [_made_true(one, place, magnetic) for one in recording.sweeps]
        )
        heading_sigma = settings_of(heading_sigma_deg=heading_sigma_deg).heading_sigma_deg
    except (RecordingError, PatternError, SpectrumError, HeadingError, ValueError) as error:
        stop(error)
    remark(*map(sentence_of, listed(file, recording.remarks)))
    finder = SparseDirectionFinder(minimum_quality=minimum_quality, heading_sigma_deg=heading_sigma)
    answers: list[dict[str, Any]] = []
    for recorded in sweeps:
        reading = finder.estimate(recorded.sweep, mounted(antenna, recorded, offset))
        answers.append(_answer(recorded, reading, place))
    if json_:
        print_json(answers[0] if len(answers) == 1 else answers)
    else:
        for answer in answers:
            typer.echo(_sentence(answer))


def _made_true(recorded: RecordedSweep, place: tuple[float, float] | None, day: datetime) -> RecordedSweep:
    """Raises HeadingError, and ValueError where nobody says where the sweep was taken."""
    if place is None and not recorded.place_known:
        raise ValueError("magnetic headings are made true where they were taken: give --at LAT,LON")
    here = recorded.sweep.position if place is None else Place(*place)
    return replace(recorded, sweep=made_true(recorded.sweep, here, day.replace(tzinfo=UTC).timestamp()))


def _pulses(width_s: float | None, period_s: float | None) -> PulseSetting | None:
    """Raises ValueError when only one is given, SpectrumError when they cannot be."""
    if width_s is None and period_s is None:
        return None
    if width_s is None or period_s is None:
        raise ValueError("a pulsed tag needs both --pulse-width-s and --pulse-period-s")
    return PulseSetting(width_s, period_s)


def _answer(recorded: RecordedSweep, reading: BearingReading, place: tuple[float, float] | None) -> dict[str, Any]:
    position = recorded.sweep.position
    here = place or ((position.lat, position.lon) if recorded.place_known else (None, None))
    known = reading.sigma_deg < 180.0
    return {
        "bearing_deg": round(reading.bearing_deg, 3) % 360.0 if known else None,
        "sigma_deg": round(reading.sigma_deg, 3) if known else None,
        "quality": round(reading.quality, 4),
        "accepted": reading.accepted,
        "reason": "" if reading.reason is None else sentence_of(reading.reason),
        "remarks": [sentence_of(remark) for remark in reading.remarks],
        "tag": recorded.sweep.tag,
        "lat": here[0],
        "lon": here[1],
        "frequency_hz": recorded.sweep.frequency_hz or None,
        "samples": int(recorded.sweep.power_db.size),
        "peaks": [{"bearing_deg": round(p.bearing_deg, 2), "weight": round(p.weight, 3)} for p in reading.peaks],
    }


def _sentence(answer: dict[str, Any]) -> str:
    what = f"tag {answer['tag']}" if answer["tag"] else "sweep"
    if answer["bearing_deg"] is None:
        return f"{what}: no bearing: {answer['reason']}"
    place = "" if answer["lat"] is None else f" from {answer['lat']:.6f}, {answer['lon']:.6f}"
    text = f"{what}: bearing {answer['bearing_deg']:.1f} +- {answer['sigma_deg']:.1f} degrees{place}"
    text += f", quality {answer['quality']:.2f}, {answer['samples']} samples"
    text = text if answer["accepted"] else f"{text}; rejected: {answer['reason']}"
    return "\n".join([text, *(f"  {remark}" for remark in answer["remarks"])])
