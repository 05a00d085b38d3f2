"""What docker-compose.yml must hold besides its schema, which `make check` looks at."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from backend.settings import Settings

COMPOSE = yaml.safe_load((Path(__file__).parent.parent.parent / "docker-compose.yml").read_text())
SERVICES = COMPOSE["services"]


def test_only_this_machine_reaches_it():
    published = [port for service in SERVICES.values() for port in service.get("ports", [])]
    assert published
    assert all(port.startswith("127.0.0.1:") for port in published)


def test_the_server_keeps_its_journal_in_the_database_service(monkeypatch: pytest.MonkeyPatch):
    environment = SERVICES["server"]["environment"] | {"CROSSFIX_TIME_FACTOR": "1"}
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    account = SERVICES["database"]["environment"]
    user, password, database = (account[f"POSTGRES_{name}"] for name in ("USER", "PASSWORD", "DB"))
    assert Settings().async_database_url == f"postgresql+asyncpg://{user}:{password}@database/{database}"


def test_the_vehicle_reports_to_the_server_and_the_database_does_not_know_it():
    assert "--connect=server:14540" in SERVICES["vehicle"]["command"]
    assert SERVICES["server"]["environment"]["CROSSFIX_VEHICLE_URL"] == "udpin://0.0.0.0:14540"
    assert not set(SERVICES["vehicle"]["networks"]) & set(SERVICES["database"]["networks"])
