"""Backups as they are made, and as somebody makes them who wishes us ill."""

from __future__ import annotations

import asyncio
import hashlib
import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from facts import SPEC

from backend.backup.making import make_backup
from backend.backup.manifest import BackupError
from backend.backup.restoring import restore
from backend.events import MissionDrafted
from backend.settings import Settings
from backend.store.opening import open_journal

Parts = dict[str, bytes]


async def sound_archive(folder: Path) -> bytes:
    here = Settings(data_dir=folder / "data", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    async with open_journal(here, lambda: 1.7e9) as journal:
        await journal.append("m", [MissionDrafted(spec=SPEC)])
    (folder / "data" / "maps").mkdir()
    (folder / "data" / "maps" / "1.json").write_text('{"name": "a map"}')
    await asyncio.to_thread(make_backup, here, folder / "sound.zip")
    return (folder / "sound.zip").read_bytes()


def parts_of(archive: bytes) -> Parts:
    with zipfile.ZipFile(io.BytesIO(archive)) as opened:
        return {name: opened.read(name) for name in opened.namelist()}


def packed(parts: Parts, change: Callable[[zipfile.ZipInfo], None] = lambda _: None) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            info = zipfile.ZipInfo(name)
            info.compress_type = zipfile.ZIP_DEFLATED
            change(info)
            archive.writestr(info, content)
    return stream.getvalue()


def relisted(parts: Parts, **changes: Any) -> Parts:
    """With a manifest that agrees with the parts, as an attacker would make it."""
    manifest = json.loads(parts["manifest.json"])
    rows = {member["name"]: member["rows"] for member in manifest["members"]}
    rest = {name: content for name, content in parts.items() if name != "manifest.json"}
    members = [
        {"name": n, "size_bytes": len(c), "sha256": hashlib.sha256(c).hexdigest(), "rows": rows.get(n)}
        for n, c in rest.items()
    ]
    return {**rest, "manifest.json": json.dumps({**manifest, "members": members, **changes}).encode()}


def refused(content: bytes, folder: Path) -> str:
    """What is said; nothing may be left in or beside the target."""
    archive = folder / "a.zip"
    archive.write_bytes(content)
    target = Settings(data_dir=folder / "target" / "data", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    with pytest.raises(BackupError) as error:
        restore(target, archive)
    left = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    ours = {"a.zip", *(f"target/data/crossfix.sqlite{end}" for end in ("", "-wal", "-shm", ".server"))}
    assert left <= ours, left
    text = str(error.value)
    assert "\n" not in text
    return text


def changed_row(parts: Parts, table: str, column: str, value: object) -> Parts:
    names, *rows = parts[f"database/{table}.jsonl"].splitlines()
    at = json.loads(names).index(column)
    told = [[*row[:at], value, *row[at + 1 :]] for row in map(json.loads, rows)]
    content = b"\n".join([names, *(json.dumps(row).encode() for row in told)]) + b"\n"
    return relisted({**parts, f"database/{table}.jsonl": content})
