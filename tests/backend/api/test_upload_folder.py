"""The folders of uploads: none stays, whatever ends the server, and none that is in use is taken away."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from backend.api.upload_folder import PREFIX, remove_left_behind, upload_folder
from backend.settings import Settings
from backend.wiring import open_services

HOLDS = """
import sys, time
from backend.api.upload_folder import upload_folder
with upload_folder() as folder:
    (folder / "recording.csv").write_text("1")
    print(folder, flush=True)
    time.sleep(60)
"""


@pytest.fixture(autouse=True)
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path


def test_a_folder_is_gone_after_its_use(temporary: Path) -> None:
    with upload_folder() as folder:
        (folder / "recording.csv").write_text("1")
        remove_left_behind()
        assert (folder / "recording.csv").is_file()
    assert not list(temporary.iterdir())


def test_the_folder_of_a_server_that_runs_stays_until_it_is_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", HOLDS], stdout=subprocess.PIPE, text=True) as other:
        try:
            assert other.stdout is not None
            folder = Path(other.stdout.readline().strip())
            remove_left_behind()
            assert (folder / "recording.csv").is_file()
        finally:
            other.kill()
    assert folder.is_dir()
    remove_left_behind()
    assert not folder.exists()


def test_a_link_leads_nowhere(temporary: Path) -> None:
    (temporary / "elsewhere").mkdir()
    (temporary / f"{PREFIX}link").symlink_to(temporary / "elsewhere")
    remove_left_behind()
    assert (temporary / "elsewhere").is_dir()


async def test_a_server_that_starts_removes_what_was_left(temporary: Path) -> None:
    left = temporary / f"{PREFIX}abc"
    left.mkdir()
    (left / "recording.sigmf-data").write_bytes(b"1")
    async with open_services(Settings(data_dir=temporary / "data")):
        assert not left.exists()
