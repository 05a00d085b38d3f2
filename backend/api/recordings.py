"""Recordings, uploaded into a mission: UAV-RT rotations, plain tables of heading and power, SigMF of a turn, and files
of bearings (UAV-RT's, ours, KrakenSDR's)."""

from __future__ import annotations

import asyncio
import hashlib
import shutil
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Form, Response, UploadFile
from pydantic import AfterValidator, Field, StringConstraints

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.services import Services
from backend.api.upload_folder import upload_folder
from backend.bearing_file import read_bearing_file
from backend.events import BearingMeasured, Recorded, RecordingImported, SweepRejected
from backend.reasons import request as reasons
from backend.search.errors import MissionInputError
from backend.search.importing import Upload, imported_before, must_be_few
from backend.spec import Id, Model, Place
from backend.wire.resources import ImportedSweep, RecordingImport
from backend.workers import Workers
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import PatternError, parse_pattern
from hardware.direction_finding.recordings import Recording
from hardware.direction_finding.table_file import RecordingError, decoded, listed
from hardware.reasons.iq_recording import NotIq
from hardware.reasons.renamed import renamed
from hardware.sdr.pulses import PulseSetting
from hardware.sdr.sigmf_names import ARCHIVE, DATA, META, is_sigmf
from hardware.sdr.spectrum import SpectrumError

router = APIRouter(prefix="/api/missions/{mission_id}", tags=["review"], responses=PROBLEM_RESPONSES)

SIGMF = (META, DATA, ARCHIVE)
MOST_FILES = 3


def _past(moment: datetime | None) -> datetime | None:
    """Radio has been recorded since there are computers; a date outside of that is a slip."""
    if moment is None:
        return None
    moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    if not 1970 < moment.year < 2100:
        raise ValueError("a recording is from the years 1971 to 2099")
    return moment


Name = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=80)]
Finite = Annotated[float, Field(allow_inf_nan=False)]


class RecordingForm(Model):
    """What goes with the files. lat, lon, at_utc: where and when it was recorded, when the files do not tell or tell it
    wrongly. tag: whose pulses count (default: the tag heard most; needed where that is not the same one in each turn),
    whose bearings in a file of those (needed when it holds several), else the sweep's name. offset_deg: the antenna's
    front, clockwise of the nose. antenna: the pattern of the antenna that took the sweeps (as in
    hardware.direction_finding.pattern_file), None: ours did. emitter_id: whose sweeps or bearings these are, None: the
    only emitter's, or those of the only one on the file's frequency.
    frequency_hz, pulse_width_s, pulse_period_s: what to look for in IQ."""

    files: list[UploadFile]
    antenna: UploadFile | None = None
    lat: Annotated[Finite, Field(ge=-90, le=90)] | None = None
    lon: Annotated[Finite, Field(ge=-180, le=180)] | None = None
    at_utc: Annotated[datetime | None, AfterValidator(_past)] = None
    tag: Name | None = None
    emitter_id: Id | None = None
    offset_deg: Annotated[Finite, Field(ge=-360, le=360)] | None = None
    frequency_hz: Annotated[Finite, Field(gt=0, le=1e12)] | None = None
    pulse_width_s: Annotated[Finite, Field(gt=0, le=10)] | None = None
    pulse_period_s: Annotated[Finite, Field(gt=0, le=100)] | None = None


@router.post("/recordings", status_code=201, responses={200: {"model": RecordingImport}})
async def import_recording(
    mission_id: MissionId,
    form: Annotated[RecordingForm, Form(media_type="multipart/form-data")],
    services: ServicesDep,
    principal: PrincipalDep,
    response: Response,
) -> RecordingImport:
    """Import recorded sweeps or bearings of an emitter into a mission, as if they had been flown there; in flight, too.

    One file, or for SigMF its meta and data file (which are kept) and, when the recording carries no headings, a CSV of
    time and heading. The same files again (with the same words beside them) change nothing: 200. All sweeps or none.
    """
    with upload_folder() as folder:
        upload = await _read(form, services.workers, folder)
        await _must_fit(services, mission_id, upload)
        facts, already = await services.missions.drafts.import_recording(mission_id, upload, principal.name)
        iq_kept = await asyncio.to_thread(services.iq.keep, mission_id, upload.recording_id, folder)
    if already:
        response.status_code = 200
    return _reply(facts, already, iq_kept)


async def _must_fit(services: Services, mission_id: str, upload: Upload) -> None:
    """Raises ApiProblem unless there is room for its raw sweeps, or they are there already."""
    imports = await services.journal.read_kinds(mission_id, ("recording_imported",))
    if imported_before(mission_id, imports, upload):
        return
    sweeps = [recorded.sweep for recorded in upload.recording.sweeps]
    size_bytes = sum(sweep.at_s.nbytes + sweep.heading_deg.nbytes + sweep.power_db.nbytes for sweep in sweeps)
    await services.stocks["recordings"].must_take(len(sweeps), size_bytes)


async def _read(form: RecordingForm, workers: Workers, folder: Path) -> Upload:
    """folder: where the files are put. Raises MissionInputError."""
    if (form.lat is None) != (form.lon is None):
        raise MissionInputError(reasons.HalfGiven("place"), "lat")
    if (form.pulse_width_s is None) != (form.pulse_period_s is None):
        raise MissionInputError(reasons.HalfGiven("pulses"), "pulse_period_s")
    place = None if form.lat is None or form.lon is None else Place(lat=form.lat, lon=form.lon)
    names = await asyncio.to_thread(_stored, form.files, folder)
    owners = {str(path): name for path, name in names.items()}
    recording_id = await asyncio.to_thread(_identity, names, form)
    try:
        pulses = _pulses(form)
        recording = await workers.run(_parsed, names, form.tag, form.frequency_hz, pulses)
    except (RecordingError, SpectrumError) as error:
        raise MissionInputError(renamed(error.reason, owners), "files") from error
    pattern = None if form.antenna is None else await _pattern(form.antenna, workers, folder)
    first = next(iter(names.values()))
    return Upload(
        recording_id,
        first,
        replace(recording, remarks=tuple(renamed(remark, owners) for remark in recording.remarks)),
        place,
        None if form.at_utc is None else form.at_utc.timestamp(),
        form.offset_deg,
        form.emitter_id,
        pattern,
    )


async def _pattern(file: UploadFile, workers: Workers, folder: Path) -> AntennaPattern:
    """Raises MissionInputError."""
    path = folder / "antenna"
    await asyncio.to_thread(_put, file, path)
    try:
        return await workers.run(_parsed_pattern, path, _called(file))
    except PatternError as error:
        raise MissionInputError(error.reason, "antenna") from error


def _parsed_pattern(path: Path, called: str) -> AntennaPattern:
    return parse_pattern(called, decoded(path.read_bytes()))


def _put(file: UploadFile, path: Path) -> None:
    with path.open("wb") as stream:
        shutil.copyfileobj(file.file, stream)


def _called(file: UploadFile) -> str:
    """By its owner, as far as it can be shown."""
    name = Path((file.filename or "").replace("\\", "/")).name
    return "".join(letter for letter in name if letter.isprintable())[-120:] or "recording"


def _stored(files: Sequence[UploadFile], folder: Path) -> dict[Path, str]:
    """Where each file lies under a name of ours, and what its owner calls it; the recording itself first."""
    if len(files) > MOST_FILES:
        raise MissionInputError(reasons.TooManyFiles(len(files)), "files")
    kept: dict[Path, str] = {}
    called = [_called(file) for file in files]
    sigmf = any(name.lower().endswith(SIGMF) for name in called)
    for file, name in zip(files, called, strict=True):
        ending = next((e for e in SIGMF if name.lower().endswith(e)), None)
        path = folder / (f"recording{ending}" if ending else ("headings.csv" if sigmf else "recording.csv"))
        if path in kept:
            raise MissionInputError(reasons.TwoRecordings(kept[path], name), "files")
        _put(file, path)
        kept[path] = name
    return dict(sorted(kept.items(), key=lambda item: item[0].name == "headings.csv"))


def _identity(names: dict[Path, str], form: RecordingForm) -> str:
    digest = hashlib.sha256()
    for path in sorted(names):
        with path.open("rb") as stream:
            digest.update(hashlib.file_digest(stream, "sha256").digest())
    digest.update(form.model_dump_json(exclude={"files", "antenna"}).encode())
    if form.antenna is not None:
        digest.update(hashlib.sha256(form.antenna.file.read()).digest())
        form.antenna.file.seek(0)
    return digest.hexdigest()


def _pulses(form: RecordingForm) -> PulseSetting | None:
    width, period = form.pulse_width_s, form.pulse_period_s
    return None if width is None or period is None else PulseSetting(width, period)


def _parsed(
    names: dict[Path, str], tag: str | None, frequency_hz: float | None, pulses: PulseSetting | None
) -> Recording:
    from hardware.sdr.rotation import IqReading, read_sweeps  # sigmf comes with it: this process reads files, no other

    recording = next(iter(names))
    headings = next((path for path in names if path.name == "headings.csv"), None)
    bearings = None if is_sigmf(recording) or headings is not None else read_bearing_file(recording, tag)
    read = bearings or read_sweeps(recording, tag, IqReading(headings, frequency_hz, pulses))
    must_be_few(max(len(read.sweeps), len(read.bearings)))
    read = replace(read, remarks=listed(recording, read.remarks))
    if is_sigmf(recording) or (frequency_hz is None and pulses is None):
        return read
    return replace(read, remarks=(*read.remarks, NotIq(str(recording), "signal")))


def _reply(facts: Sequence[Recorded], already: bool, iq_kept: bool) -> RecordingImport:
    imported = facts[0].event
    assert isinstance(imported, RecordingImported)
    sweeps = [
        ImportedSweep(
            sweep_id=fact.sweep_id or "",
            place_number=fact.place_number,
            place=fact.place,
            accepted=isinstance(fact, BearingMeasured),
            bearing_deg=fact.bearing_deg if isinstance(fact, BearingMeasured) else None,
            sigma_deg=fact.sigma_deg if isinstance(fact, BearingMeasured) else None,
            quality=fact.quality,
            reason=fact.reason if isinstance(fact, SweepRejected) else None,
        )
        for fact in (record.event for record in facts)
        if isinstance(fact, BearingMeasured | SweepRejected)
    ]
    return RecordingImport(
        recording_id=imported.recording_id,
        filename=imported.filename,
        already=already,
        iq_kept=iq_kept,
        sweeps=sweeps,
        remarks=imported.remarks,
        last_seq=facts[-1].seq,
    )
