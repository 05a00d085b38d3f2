"""The wheel: built here, installed where nothing of the repository is, and served from there with its page."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parent.parent
PAGE = REPOSITORY / "frontend" / "dist" / "index.html"
ASK = """
import json, sys
from pathlib import Path
from fastapi.testclient import TestClient
from backend.settings import Settings
from backend.store.engine import known_revisions
from backend.version import VERSION
import backend

settings = Settings(data_dir=Path("data"), port=0)
from backend.api.application import make_application
from contextlib import asynccontextmanager

@asynccontextmanager
async def nothing(_):
    yield

with TestClient(make_application(settings, nothing), base_url="http://127.0.0.1") as client:
    page = client.get("/")
print(json.dumps({
    "where": backend.__file__, "version": VERSION, "revisions": sorted(known_revisions()),
    "status": page.status_code, "page": page.text[:40],
}))
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built from a copy without build leftovers; no package is fetched."""
    source, out = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("wheel")
    kept = ["pyproject.toml", "setup.py", "README.md", "LICENSE", "planner", "hardware", "backend", "migrations"]
    subprocess.run(["cp", "-r", *(REPOSITORY / name for name in kept), source], check=True)
    if PAGE.exists():
        (source / "frontend").mkdir()
        subprocess.run(["cp", "-r", PAGE.parent, source / "frontend"], check=True)
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", out, source]
    subprocess.run(command, check=True, capture_output=True)
    (made,) = out.glob("crossfix-*.whl")
    return made


def test_a_wheel_holds_what_the_server_reads_and_no_tests(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    for needed in (
        "hardware/direction_finding/patterns/small_yagi.json",
        "planner/policy/ellipse_table.json",
        "planner/policy/shipped_table.npz",
        "migrations/env.py",
        "migrations/versions/0001_journal.py",
    ):
        assert needed in names
    rooms = (REPOSITORY / room for room in ("planner", "hardware", "backend", "migrations"))
    kept = [path for room in rooms for path in room.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    assert not [name for path in kept if (name := path.relative_to(REPOSITORY).as_posix()) not in names]
    assert not [name for name in names if name.startswith(("tests/", "docs/"))]
    assert ("backend/page/index.html" in names) == PAGE.exists()


@pytest.mark.timeout(600)
def test_installed_in_a_clean_place_it_serves_its_page(wheel: Path, tmp_path: Path) -> None:
    """Its own environment; only the packages it depends on are lent, so that nothing is fetched."""
    home = tmp_path / "clean"
    venv.create(home / "venv", with_pip=False)
    python = home / "venv" / "bin" / "python"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def run(*command: str | Path) -> str:
        done = subprocess.run(command, cwd=home, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    run(sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-deps", "--no-index", wheel)
    ours = run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip()
    (Path(ours) / "lent.pth").write_text(sysconfig.get_path("purelib") + "\n")
    told = json.loads(run(python, "-c", ASK))
    assert told["where"].startswith(str(home))
    assert "0002" in told["revisions"]
    assert told["status"] == (200 if PAGE.exists() else 503)
    assert "<!doctype html" in told["page"].lower()
    assert "backup" in run(home / "venv" / "bin" / "crossfix", "--help")
