"""`crossfix payload` at its edge: configuration that survives, a unit for boot, errors in one line."""

from __future__ import annotations

import stat
import subprocess
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from backend.cli.payload import payload
from hardware.payload.configuration import load_configuration

APP = typer.Typer()
APP.command()(payload)
GOOD = [
    "--server", "ws://10.0.0.1:8600", "--token", "a-token-of-some-length", "--receiver", "soapy:driver=rtlsdr",
    "--frequency-hz", "148520000", "--pulse-width-s", "0.02", "--pulse-period-s", "1.3",
]  # fmt: skip


def test_saved_configuration_is_read_again_and_is_private(tmp_path: Path) -> None:
    path = tmp_path / "payload.toml"
    result = CliRunner().invoke(APP, [*GOOD, "--config", str(path), "--save"])
    assert result.exit_code == 0, result.stderr
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    again = load_configuration(path, {"gain_db": 12.0})
    assert again.servers == ("ws://10.0.0.1:8600/api/payload",)
    assert (again.frequency_hz, again.gain_db, again.pulse_period_s) == (148_520_000.0, 12.0, 1.3)


def test_systemd_unit_starts_this_agent_at_boot(tmp_path: Path) -> None:
    result = CliRunner().invoke(APP, ["--config", str(tmp_path / "payload.toml"), "--systemd"])
    assert "Restart=always" in result.stdout
    assert f"payload --config {tmp_path / 'payload.toml'}" in result.stdout


def test_systemd_unit_without_crossfix_on_the_path_starts_a_program_that_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda program: None)
    unit = CliRunner().invoke(APP, ["--systemd"]).stdout
    program = unit.partition("ExecStart=")[2].partition(" --config")[0]
    assert (
        "Listen with this computer's radio"
        in subprocess.run([*program.split(), "--help"], capture_output=True, text=True).stdout
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"--server": "http://x"}, "websocket address"),
        ({"--token": "short"}, "token"),
        ({"--receiver": "radio"}, "is not understood"),
        ({"--receiver": "sigmf:nothing.sigmf-meta"}, "nothing.sigmf-meta"),
        ({"--receiver": "rtl_tcp://host:port"}, "port"),
        ({"--frequency-hz": "-5"}, "frequency_hz"),
        ({"--pulse-width-s": None}, "both"),
        ({"--pulse-width-s": "9"}, "is impossible"),
        ({"--server": None}, "--server"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(tmp_path: Path, changes: dict[str, str | None], words: str) -> None:
    given = dict(zip(GOOD[::2], GOOD[1::2], strict=True)) | changes
    arguments = [part for key, value in given.items() if value is not None for part in (key, value)]
    result = CliRunner().invoke(APP, [*arguments, "--config", str(tmp_path / "none.toml"), "--data-dir", str(tmp_path)])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1
    assert words in result.stderr


def test_broken_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "payload.toml"
    path.write_text("servers = [")
    result = CliRunner().invoke(APP, ["--config", str(path)])
    assert result.exit_code == 2
    assert "payload.toml" in result.stderr
