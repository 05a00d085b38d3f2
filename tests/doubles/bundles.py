"""A recorded mission as a bundle, and bundles taken apart and packed again."""

from __future__ import annotations

import gzip
import io
import json
import zipfile
from collections.abc import Callable

import numpy as np

from backend.events import BearingMeasured
from backend.ports import TrackPoint
from backend.settings import REPOSITORY
from backend.store.brought import raw_files
from backend.store.entries import EventRow, sweep_entry, to_records
from backend.store.upgrade import FIRST_FORM
from backend.wire.bundle import bundle
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.readings import Sweep

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
FLOWN = to_records(
    STORED["mission_id"], [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]]
)
ID = STORED["mission_id"]
PATH = [
    TrackPoint(1.7e9 + n / 3, 50.6 + n * 1e-5, 7.2, 140.1, 40.0, None if n == 1 else 90.0, 80.0, "AUTO")
    for n in range(3)
]
YAGI = load_pattern(SMALL_YAGI)


def sweep_of(fact: BearingMeasured) -> Sweep:
    """One turn with an emitter at the fact's bearing, heard by the small Yagi over the nose."""
    nose = np.arange(0.0, 360.0, 1.0)
    return Sweep(
        at_s=1.7e9 + nose / 30.0,
        heading_deg=nose,
        power_db=-60.0 + YAGI.gain_at(fact.bearing_deg - nose),
        frequency_hz=148.5e6,
        position=fact.place,
        altitude_amsl_m=140.0,
        noise_floor_db=-110.0,
    )


SWEEPS = [
    sweep_entry(ID, record.event.sweep_id, "craft-1", record.event.emitter_id, 1, 1, sweep_of(record.event))
    for record in FLOWN
    if isinstance(record.event, BearingMeasured) and record.event.sweep_id
]
SOUND = bundle(FLOWN, {"craft-1": PATH}, raw_files(ID, SWEEPS, {"craft-1": PATH}))


def files_of(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def packed(files: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return stream.getvalue()


def repacked(content: bytes, name: str, change: Callable[[bytes], bytes]) -> bytes:
    files = files_of(content)
    changed = change(files[name])
    assert changed != files[name]
    return packed(files | {name: changed})


def without(content: bytes, *names: str) -> bytes:
    return packed({name: text for name, text in files_of(content).items() if name not in names})


def added(name: str, text: bytes = b"x") -> Callable[[bytes], bytes]:
    return lambda content: packed(files_of(content) | {name: text})
