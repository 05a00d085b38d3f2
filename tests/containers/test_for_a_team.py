"""deploy/for-a-team.sh with a docker that only plays its part."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from backend.cli.serve import who_may_enter

SCRIPT = Path(__file__).parents[2] / "deploy" / "for-a-team.sh"
CODE = "AB2C-DE3F-GH4J-KL5M"
DOCKER = """#!/bin/sh
echo "$*" >> "$SAID/asked"
case "$*" in
    *" logs "*) cat "$SAID/log" ;;
    inspect*) echo 2026-11-23T18:00:00Z ;;
    *"/api/session"*) cat "$SAID/mode" ;;
    *"printenv CROSSFIX_PUBLIC_URL") cat "$SAID/page" ;;
    *" exec "*) echo "QR of $(eval echo \\"\\${$#}\\")" ;;
esac
"""


@pytest.fixture
def team(tmp_path: Path) -> Path:
    """A folder of sources with nothing but the script, and a docker first on its path."""
    (tmp_path / "deploy").mkdir()
    shutil.copy(SCRIPT, tmp_path / "deploy")
    docker = tmp_path / "docker"
    docker.write_text(DOCKER)
    docker.chmod(0o755)
    return tmp_path


def brought_up(
    team: Path, log: str, *arguments: str, mode: str = "waiting", page: str = "https://box.local:443"
) -> subprocess.CompletedProcess[str]:
    (team / "log").write_text(log)
    (team / "mode").write_text(mode)
    (team / "page").write_text(f"{page}\n")
    surroundings = {**os.environ, "PATH": f"{team}:{os.environ['PATH']}", "SAID": str(team)}
    command = [str(team / "deploy" / "for-a-team.sh"), *arguments]
    return subprocess.run(command, env=surroundings, capture_output=True, text=True, timeout=60, check=False)


def test_one_command_ends_with_the_link_of_the_first_admin_to_scan(team: Path) -> None:
    earlier = who_may_enter("waiting", "https://192.168.1.10:443", "ZZZZ-ZZZZ-ZZZZ-ZZZZ")
    log = f"{earlier}\n{who_may_enter('waiting', 'https://192.168.1.10:443', CODE)}\n"
    done = brought_up(team, log, "192.168.1.10")
    link = f"https://192.168.1.10:443/#/first-admin/{CODE}"
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-2:] == [f"QR of {link}", link], "the newest code: those of before are void"
    assert (team / ".env").read_text() == "ADDRESS=192.168.1.10\nLISTEN=0.0.0.0\nCOMPOSE_PROFILES=simulated\n"
    assert "compose up --detach" in (team / "asked").read_text().splitlines()


def test_with_people_there_it_says_where_they_sign_in_and_keeps_the_settings(team: Path) -> None:
    (team / ".env").write_text("ADDRESS=box.local\nVEHICLE_URL=serial:///dev/ttyUSB0:57600\n")
    done = brought_up(team, who_may_enter("people", "https://box.local:443", None))
    assert done.stdout.splitlines()[-1] == "It is up at https://box.local: whoever uses it signs in."
    assert "VEHICLE_URL" in (team / ".env").read_text()


def test_where_they_sign_in_is_said_with_the_port_that_was_set(team: Path) -> None:
    (team / ".env").write_text("HTTPS_PORT=8443\nCOMPOSE_PROFILES=simulated\n")
    done = brought_up(team, who_may_enter("people", "https://localhost:8443", None), page="https://localhost:8443")
    assert done.stdout.splitlines()[-1] == "It is up at https://localhost:8443: whoever uses it signs in."


def test_an_address_beside_settings_that_are_there_is_refused_before_anything_starts(team: Path) -> None:
    (team / ".env").write_text("ADDRESS=box.local\n")
    done = brought_up(team, "", "192.168.1.10")
    assert done.returncode == 2
    assert not (team / "asked").exists()


def test_the_address_is_found_where_none_is_given(team: Path) -> None:
    ip = team / "ip"
    ip.write_text("#!/bin/sh\necho '192.0.2.1 via 10.1.2.254 dev eth0 src 10.1.2.3 uid 0'\n")
    ip.chmod(0o755)
    brought_up(team, who_may_enter("people", "https://10.1.2.3:443", None))
    assert (team / ".env").read_text().startswith("ADDRESS=10.1.2.3\n")


def test_a_link_that_was_used_since_the_start_is_not_shown_again(team: Path) -> None:
    (team / ".env").write_text("ADDRESS=box.local\n")
    done = brought_up(team, who_may_enter("waiting", "https://box.local:443", CODE), mode="people")
    assert done.returncode == 0, done.stderr
    assert CODE not in done.stdout
    assert done.stdout.splitlines()[-1] == "It is up at https://box.local: whoever uses it signs in."


@pytest.mark.parametrize("address", ["https://192.168.1.10", "box local", "box\nLISTEN=1", '"]', "$(id)", "--help"])
def test_what_is_no_address_is_refused_before_it_is_written_down(team: Path, address: str) -> None:
    done = brought_up(team, "", address)
    assert done.returncode == 2
    assert not (team / ".env").exists()
    assert not (team / "asked").exists()
