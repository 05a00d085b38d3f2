"""The archive itself: a zip whose last part lists all others with size and SHA-256.

Read with suspicion: it may be cut off, changed, or made by somebody who wishes us ill. Nothing is unpacked before every
part has been read once and compared with the list, and never more than the list says.
"""

from __future__ import annotations

import hashlib
import json
import stat
import zipfile
import zlib
from collections.abc import Generator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import IO, Any, cast

from pydantic import ValidationError

from backend.backup.manifest import FORMAT, MANIFEST, BackupError, Manifest, Member, checked_name
from backend.backup.rows import LONGEST_LINE

BLOCK_BYTES = 2**20
LARGEST_MANIFEST = 64 * 2**20
STORED = (".pmtiles", ".kmz", ".zip", ".png", ".gz")
"""Already compressed."""


class PartWriter:
    """Counts and digests what goes into one part."""

    def __init__(self, target: IO[bytes]) -> None:
        self._target = target
        self._digest = hashlib.sha256()
        self.size = 0

    def write(self, block: bytes) -> None:
        """Raises OSError."""
        self._target.write(block)
        self._digest.update(block)
        self.size += len(block)

    def member(self, name: str, rows: int | None) -> Member:
        """As the manifest lists it."""
        return Member(name=name, size_bytes=self.size, sha256=self._digest.hexdigest(), rows=rows)


class ArchiveWriter:
    """Parts one after the other, then `finish`."""

    def __init__(self, file: IO[bytes]) -> None:
        self._zip = zipfile.ZipFile(file, "w", allowZip64=True)
        self.members: list[Member] = []

    def __enter__(self) -> ArchiveWriter:
        return self

    def __exit__(self, *_: object) -> None:
        """What was not finished is no archive, whatever the zip still writes at its end."""
        with suppress(OSError, ValueError):
            self._zip.close()

    @contextmanager
    def part(self, name: str) -> Generator[PartWriter]:
        """For a part that is listed when the block ends without an error; `rows` may be set on the last member."""
        entry = zipfile.ZipInfo(checked_name(name), date_time=(2020, 1, 1, 0, 0, 0))
        entry.compress_type = zipfile.ZIP_STORED if name.endswith(STORED) else zipfile.ZIP_DEFLATED
        entry.external_attr = (stat.S_IFREG | 0o600) << 16
        with self._zip.open(entry, "w", force_zip64=True) as target:
            writer = PartWriter(target)
            yield writer
        self.members.append(writer.member(name, None))

    def counted(self, rows: int) -> None:
        """The last part was a table with this number of rows."""
        self.members[-1] = self.members[-1].model_copy(update={"rows": rows})

    def finish(self, manifest: Manifest) -> None:
        """The list goes last; an archive without one is no archive."""
        self._zip.writestr(MANIFEST, manifest.model_dump_json(indent=1))
        self._zip.close()


class Archive:
    """One that was opened for reading; `verify` it before anything of it is used. Raises BackupError."""

    def __init__(self, path: Path) -> None:
        try:
            self._zip = zipfile.ZipFile(path)
        except FileNotFoundError:
            raise BackupError(f"there is no file {path}") from None
        except OSError as error:
            raise BackupError(f"{path} cannot be read: {error.strerror or error}") from error
        except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise BackupError(f"{path} is no whole archive ({error}): it was cut off, or is something else") from error
        try:
            self.manifest = self._read_manifest(path)
            self._compare_lists()
        except BaseException:
            self._zip.close()
            raise

    def __enter__(self) -> Archive:
        return self

    def __exit__(self, *_: object) -> None:
        self._zip.close()

    def _read_manifest(self, path: Path) -> Manifest:
        try:
            info = self._zip.getinfo(MANIFEST)
            if info.file_size > LARGEST_MANIFEST:
                raise BackupError(f"the list of parts in {path} is {info.file_size} bytes long: no backup has that")
            content: Any = json.loads(self._zip.read(info))
            if isinstance(content, dict):
                self._must_not_be_later(path, cast(dict[str, Any], content))
            return Manifest.model_validate(content)
        except KeyError:
            raise BackupError(f"{path} holds no list of its parts: it is no backup of Crossfix") from None
        except ValidationError as error:
            wrong = error.errors()[0]
            where = ".".join(str(part) for part in wrong["loc"])
            raise BackupError(f"the list of parts in {path} is damaged ({where}: {wrong['msg']})") from error
        except (zipfile.BadZipFile, zlib.error, RuntimeError, OSError, ValueError, RecursionError) as error:
            if isinstance(error, BackupError):
                raise
            raise BackupError(f"the list of parts in {path} is damaged ({error})") from error

    @staticmethod
    def _must_not_be_later(path: Path, content: dict[str, Any]) -> None:
        made = content.get("format")
        if isinstance(made, int) and made > FORMAT:
            by = str(content.get("software"))[:40]
            raise BackupError(f"{path} was made by a later Crossfix ({by}): update this one, then restore")

    def _compare_lists(self) -> None:
        infos = self._zip.infolist()
        listed = [checked_name(member.name) for member in self.manifest.members]
        there = [info.filename for info in infos if info.filename != MANIFEST]
        if sorted(listed) != sorted(there) or len(set(listed)) < len(listed) or len(infos) != len(listed) + 1:
            odd = sorted(set(listed) ^ set(there)) or ["one of them twice"]
            raise BackupError(f"the archive does not hold what its list says, for one: {odd[0][:80]!r}")
        sizes = {member.name: member.size_bytes for member in self.manifest.members}
        for info in infos:
            kind = stat.S_IFMT(info.external_attr >> 16)
            if info.is_dir() or kind not in (0, stat.S_IFREG):
                raise BackupError(f"{info.filename[:80]!r} in the archive is no plain file")
            if info.filename != MANIFEST and info.file_size != sizes[info.filename]:
                raise BackupError(f"{info.filename[:80]!r} in the archive is not as long as its list says")

    def verify(self) -> None:
        """Every part is read and compared; nothing is kept. Raises BackupError."""
        for member in self.manifest.members:
            for _ in self.blocks(member):
                pass

    def blocks(self, member: Member) -> Generator[bytes]:
        """The content, compared with the list at its end. Raises BackupError."""
        digest, size = hashlib.sha256(), 0
        try:
            with self._zip.open(member.name) as part:
                while block := part.read(BLOCK_BYTES):
                    size += len(block)
                    if size > member.size_bytes:
                        break
                    digest.update(block)
                    yield block
        except (zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError, NotImplementedError) as error:
            raise BackupError(f"{member.name[:80]!r} in the archive is damaged ({error})") from error
        if size != member.size_bytes or digest.hexdigest() != member.sha256:
            raise BackupError(f"{member.name[:80]!r} in the archive is not what its checksum says")

    def lines(self, member: Member) -> Generator[bytes]:
        """The same, line by line. Close it when it is not read to its end."""
        rest = b""
        with closing(self.blocks(member)) as blocks:
            for block in blocks:
                *whole, rest = (rest + block).split(b"\n")
                yield from whole
                if len(rest) > LONGEST_LINE:
                    raise BackupError(
                        f"{member.name[:80]!r} has a line longer than any row: it was not made by Crossfix"
                    )
        if rest:
            yield rest
