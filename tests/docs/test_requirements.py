"""What `make setup` installs by hashes is all that pyproject.toml asks for."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def asked(*extras: str) -> set[str]:
    lines = [*PROJECT["dependencies"], *(line for extra in extras for line in PROJECT["optional-dependencies"][extra])]
    return {str(canonicalize_name(Requirement(line).name)) for line in lines} - {"crossfix"}


@pytest.mark.parametrize(
    ("file", "extras"),
    [
        ("server.txt", ("server",)),
        ("run.txt", ("server", "study")),
        ("development.txt", ("server", "study", "dev")),
    ],
)
def test_every_package_that_is_asked_for_is_pinned_with_its_hashes(file: str, extras: tuple[str, ...]) -> None:
    text = (ROOT / "requirements" / file).read_text()
    pinned = {canonicalize_name(line.split("==")[0]) for line in text.splitlines() if "==" in line and line[0] != " "}
    assert asked(*extras) <= pinned, "run `make requirements`"
    assert text.count("--hash=sha256:") >= len(pinned)
