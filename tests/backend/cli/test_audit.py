"""`crossfix audit verify` on the command line."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from backend.auth.audit_chain import Head, linked
from backend.cli.audit import app

RUN = CliRunner()


def written(folder: Path, entries: int) -> list[bytes]:
    head, lines = Head(), list[bytes]()
    for number in range(entries):
        line, head = linked(head, {"call": f"call {number}"})
        lines.append(line)
    (folder / "audit.jsonl").write_bytes(b"".join(lines))
    return lines


def test_a_whole_log_is_whole_and_its_end_can_be_noted(tmp_path: Path) -> None:
    written(tmp_path, 3)
    told = RUN.invoke(app, ["verify", "--data-dir", str(tmp_path)])
    assert told.exit_code == 0
    noted = told.stdout.split("the last is ")[1].strip()
    assert noted.startswith("3:")
    assert RUN.invoke(app, ["verify", "--data-dir", str(tmp_path), "--noted", noted]).exit_code == 0
    written(tmp_path, 2)
    cut = RUN.invoke(app, ["verify", "--data-dir", str(tmp_path), "--noted", noted])
    assert cut.exit_code == 1
    assert "cut off" in cut.stderr


def test_a_changed_entry_is_named_by_its_line(tmp_path: Path) -> None:
    lines = written(tmp_path, 3)
    (tmp_path / "audit.jsonl").write_bytes(lines[0] + lines[1].replace(b"call 1", b"call 9") + lines[2])
    told = RUN.invoke(app, ["verify", "--data-dir", str(tmp_path)])
    assert told.exit_code == 1
    assert "the entry in line 2 was changed" in told.stderr
    as_json = RUN.invoke(app, ["verify", "--data-dir", str(tmp_path), "--json"])
    assert as_json.exit_code == 1
    assert json.loads(as_json.stdout)["fault"] == "changed"


def test_what_cannot_be_read_is_said_in_one_line(tmp_path: Path) -> None:
    for arguments in (["verify", "--data-dir", str(tmp_path)], ["verify", "--noted", "x"]):
        told = RUN.invoke(app, arguments)
        assert told.exit_code == 2
        assert len(told.stderr.strip().splitlines()) == 1
