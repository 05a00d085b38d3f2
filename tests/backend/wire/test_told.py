"""Every sentence that the operator may be told has a translation: the English sentence is its code.

The catalogue is the page's (frontend/src/i18n/told.json), with {} where a value stands.
"""

from __future__ import annotations

import ast
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
CATALOGUE: dict[str, str] = json.loads((ROOT / "frontend/src/i18n/told.json").read_text())

ROOMS = [
    "planner/belief/verdict.py",
    "backend/api/another_antenna.py",
    "backend/api/recordings.py",
    "backend/mission/antenna_check.py",
    "backend/mission/area.py",
    "backend/mission/checklist.py",
    "backend/mission/importing.py",
    "backend/mission/listening.py",
    "backend/mission/machine.py",
    "backend/mission/measuring.py",
    "backend/mission/operator.py",
    "backend/mission/safety.py",
    "backend/mission/step.py",
    "hardware/autopilot/ardupilot.py",
    "hardware/autopilot/preflight.py",
    "hardware/autopilot/px4.py",
    "hardware/direction_finding/calibration.py",
    "hardware/direction_finding/estimate.py",
    "hardware/direction_finding/heading.py",
    "hardware/direction_finding/recordings.py",
    "hardware/direction_finding/sweep.py",
    "hardware/direction_finding/table_file.py",
    "hardware/direction_finding/uavrt.py",
    "hardware/payload/receiver.py",
    "hardware/sdr/device.py",
    "hardware/sdr/pulses.py",
    "hardware/sdr/receiver.py",
    "hardware/sdr/recorded.py",
    "hardware/sdr/rotation.py",
    "hardware/sdr/rotation_headings.py",
    "hardware/sdr/rtl_tcp.py",
    "hardware/sdr/sigmf_file.py",
    "hardware/sdr/sigmf_playback.py",
    "hardware/sdr/soapy.py",
    "hardware/sdr/spectrum.py",
    "hardware/sim/receiver.py",
]

PIECES = {"the target area", "could not be read", "= {}", "{}, {}", "{} %", "{}{}", "hole lies outside"}
"""Of which sentences are put together, or that have no words."""

WRITTEN_INTO_FILES = {"IQ recorded by crossfix"}
NAMES_OF_MODES = {"POSCTL SLOW", "PRECISION LAND", "RTK float", "RTK fixed"}


@pytest.mark.parametrize("room", ROOMS)
def test_every_sentence_of_a_room_is_in_the_catalogue(room: str) -> None:
    said = {text.strip() for text in sentences(ROOT / room)} - PIECES - WRITTEN_INTO_FILES - NAMES_OF_MODES
    missing = sorted(text for text in said if text not in CATALOGUE)
    assert missing == [], f"put these into {room}'s translations, frontend/src/i18n/told.json"


def test_names_of_checks_have_a_translation() -> None:
    calls = [
        node
        for room in ("hardware/autopilot/preflight.py", "backend/mission/checklist.py")
        for node in ast.walk(ast.parse((ROOT / room).read_text()))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in {"PreflightCheck", "_fact"}
    ]
    names = {text for call in calls if (text := template(call.args[0])) is not None}
    assert {"GPS", "Battery", "area", "receiver"} <= names
    assert sorted(names - CATALOGUE.keys()) == []


def test_the_rules_of_safety_have_a_translation() -> None:
    tree = ast.parse((ROOT / "backend/mission/safety.py").read_text())
    rules = {
        template(node.args[0])
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Veto"
    }
    assert {"fence", "battery"} <= rules
    assert sorted(rules - CATALOGUE.keys()) == []


def test_a_translation_uses_each_value_of_its_sentence() -> None:
    for english, german in CATALOGUE.items():
        used = {part for part in range(1, 10) if f"{{{part}}}" in german}
        assert used == set(range(1, english.count("{}") + 1)), english


def sentences(path: Path) -> list[str]:
    """What a module says with more than one word; not what it logs, documents or raises at programmers."""
    tree = ast.parse(path.read_text())
    silent: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            silent.add(node.value)
        elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[0] in {"log", "LOG", "ValueError"}:
            silent.update(ast.walk(node))
        elif isinstance(node, ast.JoinedStr):
            silent.update(child for part in node.values for child in ast.walk(part))
    said = [template(node) for node in ast.walk(tree) if node not in silent]
    return [text for text in said if text is not None and " " in text.strip()]


def template(node: ast.AST) -> str | None:
    """The text of a string or f-string, {} for its values; None for anything else."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in node.values)
    return None
