"""`crossfix calibrate`: an antenna's pattern from a flight around a known emitter, or the check of one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from backend.cli.edge import parse_place, print_json, remark, stop
from hardware.direction_finding.calibration import CalibrationError, check_antenna
from hardware.direction_finding.calibration import calibrate as calibrate_sweeps
from hardware.direction_finding.pattern_file import PatternError, load_pattern, save_pattern
from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError, listed
from hardware.readings import Place, Sweep
from hardware.reasons.table import PlaceNotStated
from planner.reason import remedy_of, sentence_of, text_of


def calibrate(
    files: Annotated[list[Path], typer.Argument(help="Recorded sweeps with places (UAV-RT, or CSV with lat, lon).")],
    emitter: Annotated[str, typer.Option(help="LAT,LON of the emitter.")],
    out: Annotated[Path | None, typer.Option(help="Write the pattern here (JSON).")] = None,
    check: Annotated[
        Path | None, typer.Option(help="Check this pattern against the sweeps instead of measuring a new one.")
    ] = None,
    name: Annotated[str, typer.Option(help="The antenna's name.")] = "antenna",
    polarization: Annotated[str | None, typer.Option(help="vertical, horizontal, ...")] = None,
    tag: Annotated[str | None, typer.Option(help="Use this tag's pulses.")] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Measure an antenna on its vehicle: fly sweeps around an emitter at a known place, at least 15 m away.

    Example: crossfix calibrate sweep1.csv sweep2.csv --emitter 50.61,7.20 --out my_antenna.json
    """
    try:
        lat, lon = parse_place(emitter)
        sweeps = _sweeps(files, tag)
        if check is not None:
            _check(sweeps, check, Place(lat, lon), json_)
            return
        measured = calibrate_sweeps(sweeps, Place(lat, lon), name, polarization)
        if out is not None:
            save_pattern(measured.pattern, out)
    except (RecordingError, PatternError, CalibrationError, ValueError) as error:
        stop(error)
    except OSError as error:
        stop(f"{out}: cannot be written ({error.strerror})")
    pattern = measured.pattern
    answer = {
        "offset_to_nose_deg": round(pattern.offset_to_nose_deg, 2),
        "residual_db": round(measured.residual_db, 2),
        "sweeps": measured.sweeps,
        "samples": measured.samples,
        "range_db": round(float(pattern.gain_db.max() - pattern.gain_db.min()), 1),
        "relative_bearing_deg": [round(float(a), 2) for a in pattern.relative_bearing_deg],
        "gain_db": [round(float(g), 2) for g in pattern.gain_db],
        "file": None if out is None else str(out),
    }
    if json_:
        print_json(answer)
    else:
        typer.echo(
            f"{measured.samples} samples of {measured.sweeps} sweeps: front {pattern.offset_to_nose_deg:+.1f} degrees "
            f"from the nose, {answer['range_db']} dB from strongest to weakest, residual {measured.residual_db:.1f} dB"
        )


def _sweeps(files: list[Path], tag: str | None) -> list[Sweep]:
    sweeps: list[Sweep] = []
    for file in files:
        recording = read_recording(file, tag)
        remark(*map(sentence_of, listed(file, recording.remarks)))
        for recorded in recording.sweeps:
            if not recorded.place_known:
                raise RecordingError(PlaceNotStated(str(file)))
            sweeps.append(recorded.sweep)
    return sweeps


def _check(sweeps: list[Sweep], path: Path, emitter: Place, as_json: bool) -> None:
    pattern = load_pattern(path)
    checks = [check_antenna(sweep, pattern, emitter) for sweep in sweeps]
    if as_json:
        print_json(
            {
                "ok": all(c.ok for c in checks),
                "checks": [{"ok": c.ok, "detail": text_of(c.reason), "remedy": remedy_of(c.reason)} for c in checks],
            }
        )
    else:
        for c in checks:
            typer.echo(f"{'ok' if c.ok else 'NOT OK'}: {sentence_of(c.reason)}")
    if not all(c.ok for c in checks):
        raise typer.Exit(1)
