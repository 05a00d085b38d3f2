"""Archives that were cut off, changed, made later or by somebody who wishes us ill: refused, and nothing is left."""

from __future__ import annotations

import io
import stat
import warnings
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest
from archives import packed, parts_of, refused, relisted
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from backend.backup.archive import Archive
from backend.backup.manifest import BackupError
from backend.backup.restoring import restore
from backend.settings import Settings


def test_the_sound_one_is_sound(sound, tmp_path):
    (tmp_path / "a.zip").write_bytes(packed(relisted(parts_of(sound))))
    target = Settings(data_dir=tmp_path / "target", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    assert restore(target, tmp_path / "a.zip").missions == 1


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 0.999])
def test_a_truncated_archive_is_refused(sound, tmp_path, share):
    assert "cut off" in refused(sound[: int(share * len(sound))], tmp_path)


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.data())
def test_no_changed_byte_passes_or_breaks_it(sound, tmp_path, data):
    """Bytes that mean nothing (a time stamp of the zip) may pass: then every part is what it was."""
    at = data.draw(st.integers(0, len(sound) - 1))
    changed = bytearray(sound)
    changed[at] ^= data.draw(st.integers(1, 255))
    path = tmp_path / "changed.zip"
    path.write_bytes(bytes(changed))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Archive(path) as archive:
                archive.verify()
                members = {member.name: member.sha256 for member in archive.manifest.members}
    except BackupError:
        return
    with Archive(_written(tmp_path, sound)) as before:
        assert members == {member.name: member.sha256 for member in before.manifest.members}


def _written(folder: Path, content: bytes) -> Path:
    path = folder / "sound.zip"
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(
    "name",
    [
        "files/../../outside",
        "/etc/outside",
        "files//outside",
        "files/./outside",
        "..\\outside",
        "files/c:/outside",
        "files/crossfix.sqlite",
        "files/crossfix.sqlite-wal",
        "files/simulated_vehicle.json",
        "files/new\nline",
        "elsewhere/outside",
        "files/" + "long/" * 100,
    ],
)
def test_no_part_leaves_its_folder_or_takes_the_servers_place(sound, tmp_path, name):
    assert "no backup of Crossfix has" in refused(packed(relisted({**parts_of(sound), name: b"x"})), tmp_path)


def test_a_link_is_no_file(sound, tmp_path):
    def linked(info: zipfile.ZipInfo) -> None:
        if info.filename == "files/maps/1.json":
            info.external_attr = (stat.S_IFLNK | 0o777) << 16

    assert "no plain file" in refused(packed(parts_of(sound), linked), tmp_path)


def test_a_bomb_is_refused_before_it_is_unpacked(sound, tmp_path):
    parts = relisted(parts_of(sound))
    grown = {**parts, "files/maps/1.json": bytes(50_000_000)}  # the list still says 17 bytes
    assert "not as long as its list says" in refused(packed(grown), tmp_path)


def test_an_archive_that_does_not_fit_on_the_disk_is_refused_before_it_is_unpacked(sound, tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=10_000))
    large = relisted({**parts_of(sound), "files/maps/2.json": bytes(50_000)})
    assert "10,000 are free" in refused(packed(large), tmp_path)


def test_parts_and_list_must_agree(sound, tmp_path):
    parts = parts_of(sound)
    assert "does not hold what its list says" in refused(packed({**parts, "files/maps/2.json": b""}), tmp_path)
    fewer = {name: content for name, content in parts.items() if name != "files/maps/1.json"}
    assert "does not hold what its list says" in refused(packed(fewer), tmp_path)
    assert "checksum" in refused(packed({**parts, "files/maps/1.json": b'{"name": "A map"}'}), tmp_path)
    unlisted = {name: content for name, content in parts.items() if name != "manifest.json"}
    assert "holds no list" in refused(packed(unlisted), tmp_path)


def test_a_part_that_is_there_twice_is_refused(sound, tmp_path):
    stream = io.BytesIO(packed(parts_of(sound)))
    with warnings.catch_warnings(), zipfile.ZipFile(stream, "a") as archive:
        warnings.simplefilter("ignore")
        archive.writestr("files/maps/1.json", b"other")
    assert "its list says" in refused(stream.getvalue(), tmp_path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"format": 2, "software": "9.0"}, "later Crossfix (9.0)"),
        ({"schema_revision": "0999", "software": "9.0"}, "later Crossfix (9.0, schema 0999)"),
        ({"schema_revision": None}, "damaged"),
        ({"members": [{"name": "x"}]}, "damaged"),
        ({"format": "1; DROP TABLE"}, "damaged"),
    ],
)
def test_a_later_version_and_a_damaged_list_are_told_apart(sound, tmp_path, change, said):
    assert said in refused(packed(relisted(parts_of(sound), **change)), tmp_path)


@pytest.mark.parametrize(
    ("member", "content", "said"),
    [
        ("database/missions.jsonl", b"not json\n", "is not JSON"),
        ("database/missions.jsonl", b'{"a": 1}\n', "is no list"),
        ("database/missions.jsonl", b'["mission_id", "no such column"]\n', "other columns"),
        ("database/missions.jsonl", b'["mission_id"]\n["m", 2]\n', "has 2 values"),
        ("database/missions.jsonl", b'["mission_id"]\n["m"]\n', "refuses"),
        ("database/sweeps.jsonl", b'["samples"]\n["***"]\n', "cannot be read"),
        ("database/events.jsonl", b"[" * 100_000 + b"\n", "is not JSON"),
        ("database/sqlite_master.jsonl", b"[]\n", "its schema does not have"),
    ],
)
def test_rows_that_are_none_are_refused_and_roll_everything_back(sound, tmp_path, member, content, said):
    assert said in refused(packed(relisted({**parts_of(sound), member: content})), tmp_path)


@pytest.mark.parametrize("content", [b"", b"PK", b"not a zip", b"\x1f\x8b" + bytes(100)])
def test_something_else_is_no_archive(tmp_path, content):
    assert "no whole archive" in refused(content, tmp_path)


def test_a_file_that_is_not_there_is_said(tmp_path):
    with pytest.raises(BackupError, match="there is no file"):
        restore(Settings(data_dir=tmp_path / "d"), tmp_path / "none.zip")
