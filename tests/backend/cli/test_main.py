from __future__ import annotations

import json
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from backend.cli import main
from backend.cli.main import COMMANDS, app, load

runner = CliRunner()


def test_help_names_every_command_without_importing_one() -> None:
    script = (
        "import sys, json; from typer.testing import CliRunner; from backend.cli.main import app;"
        "r = CliRunner().invoke(app, ['--help']);"
        "heavy = [m for m in ('numpy', 'numba', 'fastapi', 'mavsdk', 'sqlalchemy') if m in sys.modules];"
        "print(json.dumps([r.exit_code, r.output, heavy]))"
    )
    answer = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    code, output, heavy = json.loads(answer.stdout)
    assert code == 0
    assert heavy == []
    for name in COMMANDS:
        assert name in output


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_there_and_explains_itself(name: str) -> None:
    result = runner.invoke(app, [name, "--help"])
    assert result.exit_code == 0
    assert len(result.output) > 200
    assert load(name).name == name


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["serve", "--port", "99999"],
        ["serve", "--flavour", "boeing"],
        ["demo", "--seed", "-1"],
        ["demo", "--speedup", "0"],
        ["demo", "--vehicle", "nonsense", "--headless", "--json"],
        ["bench", "--repeats", "0"],
    ],
)
def test_bad_use_ends_with_exit_code_2_and_no_traceback(arguments: list[str]) -> None:
    result = runner.invoke(app, arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "Traceback" not in result.output
    assert result.stderr.strip()


def test_an_error_nobody_foresaw_is_one_line_and_exit_code_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(name: str) -> None:
        raise RuntimeError("the disk\nis on fire")

    monkeypatch.setattr(main, "load", broken)
    monkeypatch.delenv("CROSSFIX_DEBUG", raising=False)
    with pytest.raises(SystemExit) as ended:
        app(["bench"])
    assert ended.value.code == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "the disk is on fire" in error
