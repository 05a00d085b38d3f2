"""What docker-compose.yml must hold besides its schema, which `make check` looks at."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from backend.settings import Settings

COMPOSE = yaml.safe_load((Path(__file__).parent.parent.parent / "docker-compose.yml").read_text())
SERVICES = COMPOSE["services"]


def test_only_this_machine_reaches_it():
    published = [port for service in SERVICES.values() for port in service.get("ports", [])]
    assert published
    assert all(unset(port).startswith("127.0.0.1:") for port in published)
    assert not [port for port in SERVICES["server"]["ports"] if port.endswith(":8600")], "TLS is the proxy's"


def unset(value: str) -> str:
    """As compose reads it when nobody sets anything."""
    return re.sub(r"\$\{\w+:-([^}]*)\}", r"\1", value)


def test_nothing_runs_as_root_or_writes_where_it_should_not():
    for name in ("server", "vehicle", "proxy"):
        assert SERVICES[name]["read_only"], name
        assert SERVICES[name]["cap_drop"] == ["ALL"], name
    assert not [name for name, service in SERVICES.items() if service.get("user") and name != "secrets"]
    assert SERVICES["secrets"]["network_mode"] == "none"


def test_no_password_stands_in_the_file():
    said = yaml.safe_dump(SERVICES)
    assert "POSTGRES_PASSWORD:" not in said
    assert re.search(r"postgresql://[^@/]*:[^@/]*@", said) is None


def test_the_server_keeps_its_journal_in_the_database_service(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    account = SERVICES["database"]["environment"]
    given = SERVICES["server"]["environment"]
    assert given["CROSSFIX_DATABASE_PASSWORD_FILE"] == account["POSTGRES_PASSWORD_FILE"]
    password = tmp_path / "database"
    password.write_text("secr/t\n")
    for name, value in given.items():
        monkeypatch.setenv(name, unset(value))
    monkeypatch.setenv("CROSSFIX_DATABASE_PASSWORD_FILE", str(password))
    user, database = account["POSTGRES_USER"], account["POSTGRES_DB"]
    settings = Settings()
    assert settings.async_database_url == f"postgresql+asyncpg://{user}:secr%2Ft@database/{database}"
    assert "secr" not in settings.shown_database
    assert settings.allowed_hosts == ("server", "localhost")
    assert settings.payload_tokens == ()


def test_the_vehicle_reports_to_the_server_and_the_database_does_not_know_it():
    assert "--connect=server:14540" in SERVICES["vehicle"]["command"]
    assert unset(SERVICES["server"]["environment"]["CROSSFIX_VEHICLE_URL"]) == "udpin://0.0.0.0:14540"
    assert not set(SERVICES["vehicle"]["networks"]) & set(SERVICES["database"]["networks"])
