"""The IQ that came with recordings, kept as SigMF beside the database: `MISSION/RECORDING/recording.sigmf-meta` and
`.sigmf-data`, byte for byte as they were uploaded. Blocking; use threads."""

from __future__ import annotations

import io
import logging
import os
import shutil
import tarfile
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from backend.ports import Kept
from backend.settings import Settings

log = logging.getLogger("crossfix.store")

META, DATA, ARCHIVE = ".sigmf-meta", ".sigmf-data", ".sigmf"
MOST_META_BYTES = 20 * 2**20
UNFINISHED = ".part"
PIECE_BYTES = 256 * 2**10


@dataclass(frozen=True, slots=True)
class KeptIq:
    """recording_id: as its import is recorded. size_bytes: of meta and data."""

    recording_id: str
    meta: Path
    data: Path
    size_bytes: int


@dataclass(frozen=True)
class IqFolder:
    """reserve_bytes: disk that is kept for the journal. most_bytes: of all IQ together; 0 keeps none."""

    directory: Path
    reserve_bytes: int = 0
    most_bytes: int = 2 * 10**9

    @classmethod
    def of_settings(cls, settings: Settings) -> IqFolder:
        """Where a server with these settings keeps it."""
        return cls(settings.data_dir / "iq", settings.disk_low_bytes, settings.iq_max_bytes)

    def keep(self, mission_id: str, recording_id: str, upload: Path) -> bool:
        """Keep the SigMF files that lie in the folder `upload`. False when there are none, or no room."""
        target = self.directory / mission_id / recording_id
        if target.is_dir():
            return True
        try:
            size = sum(path.stat().st_size for path in upload.glob("*.sigmf*"))
            if not size or self.kept().size_bytes + size > self.most_bytes or not self._room_for(size):
                return False
            unfinished = target.with_name(f"{recording_id}{UNFINISHED}")
            shutil.rmtree(unfinished, ignore_errors=True)
            unfinished.mkdir(parents=True)
            if not _copied(upload, unfinished):
                shutil.rmtree(unfinished)
                return False
            unfinished.rename(target)
        except (OSError, tarfile.TarError) as error:
            log.warning("mission %s: the IQ of recording %s was not kept: %s", mission_id, recording_id[:12], error)
            return False
        return True

    def of(self, mission_id: str) -> list[KeptIq]:
        """The recordings of a mission whose IQ is kept, by id."""
        found: list[KeptIq] = []
        for folder in sorted((self.directory / mission_id).glob("*")):
            meta, data = folder / f"recording{META}", folder / f"recording{DATA}"
            if folder.suffix != UNFINISHED and meta.is_file() and data.is_file():
                found.append(KeptIq(folder.name, meta, data, meta.stat().st_size + data.stat().st_size))
        return found

    def forget(self, mission_ids: Collection[str]) -> None:
        """Nothing happens to a mission that has none."""
        for mission_id in mission_ids:
            shutil.rmtree(self.directory / mission_id, ignore_errors=True)

    def missions(self) -> list[str]:
        """Of which IQ is kept."""
        return sorted(path.name for path in self.directory.glob("*") if path.is_dir())

    def sizes(self, mission_ids: Collection[str]) -> dict[str, int]:
        """Bytes that are kept, of those of the missions that have any."""
        kept = set(self.missions()).intersection(mission_ids)
        return {mission_id: sum(one.size_bytes for one in self.of(mission_id)) for mission_id in kept}

    def kept(self) -> Kept:
        """All of it."""
        sizes = [path.stat().st_size for path in self.directory.glob(f"*/*/*{DATA}")]
        return Kept(len(sizes), sum(sizes))

    def _room_for(self, size: int) -> bool:
        self.directory.mkdir(parents=True, exist_ok=True)
        return shutil.disk_usage(self.directory).free - size >= self.reserve_bytes


def archive_size(recordings: Sequence[KeptIq]) -> int:
    """Bytes that `archived` gives."""
    files = [path.stat().st_size for kept in recordings for path in (kept.meta, kept.data)]
    blocks = sum(-(-size // tarfile.BLOCKSIZE) for size in files) + 3 * len(recordings)
    return (blocks + 2) * tarfile.BLOCKSIZE


def archived(recordings: Sequence[KeptIq], name: str) -> Iterator[bytes]:
    """One SigMF archive, piece by piece: a tar with a directory for each recording (SigMF 1.2, "Rules for SigMF
    Archive files")."""
    for number, kept in enumerate(recordings):
        folder = f"{name}-{number}"
        head = tarfile.TarInfo(folder)
        head.type, head.mode = tarfile.DIRTYPE, 0o755
        yield head.tobuf(tarfile.USTAR_FORMAT)
        for path, ending in ((kept.meta, META), (kept.data, DATA)):
            yield from _member(path, f"{folder}/{folder}{ending}")
    yield bytes(2 * tarfile.BLOCKSIZE)


def _member(path: Path, name: str) -> Iterator[bytes]:
    with path.open("rb") as stream:
        size = os.fstat(stream.fileno()).st_size
        head = tarfile.TarInfo(name)
        head.size, head.mtime = size, int(path.stat().st_mtime)
        yield head.tobuf(tarfile.USTAR_FORMAT)
        while piece := stream.read(PIECE_BYTES):
            yield piece
        yield bytes(-size % tarfile.BLOCKSIZE)


def _copied(upload: Path, target: Path) -> bool:
    """The pair, or the only pair in an archive, under names of ours; whether there was one."""
    archive = upload / f"recording{ARCHIVE}"
    if archive.is_file():
        return _unpacked(archive, target)
    pair = [upload / f"recording{ending}" for ending in (META, DATA)]
    if not all(path.is_file() for path in pair):
        return False
    for path in pair:
        shutil.copyfile(path, target / path.name)
    return True


def _unpacked(archive: Path, target: Path) -> bool:
    """Names inside are compared by their ending and used for nothing else."""
    with tarfile.open(archive, "r:") as opened:
        members = [member for member in opened.getmembers() if member.isreg()]
        for ending in (META, DATA):
            found = [member for member in members if member.name.endswith(ending)]
            if len(found) != 1 or (ending == META and found[0].size > MOST_META_BYTES):
                return False
            with (target / f"recording{ending}").open("wb") as stream:
                shutil.copyfileobj(opened.extractfile(found[0]) or io.BytesIO(), stream)
    return True
