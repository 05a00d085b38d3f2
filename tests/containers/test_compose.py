"""What docker-compose.yml must hold besides its schema, which `make check` looks at."""

from __future__ import annotations

import ipaddress
import json
import re
from pathlib import Path

import pytest
import yaml

from backend.auth.registry import new_code
from backend.settings import Settings
from tests.containers.boxes import CODE, EMPTIED

DEPLOY = Path(__file__).parent.parent.parent / "deploy"
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


def test_what_is_brought_down_leaves_no_volume_without_a_name():
    """Docker makes one wherever nothing is mounted at a `VOLUME` of the image, and `down` keeps it."""
    place = re.search(r"^VOLUME (\S+)$", (DEPLOY.parent / "Dockerfile").read_text(), re.MULTILINE)
    assert place is not None
    ours = {name: service for name, service in SERVICES.items() if service["image"] == "crossfix"}
    assert {"server", "vehicle", "secrets"} <= set(ours)
    for name, service in ours.items():
        mounted = [*service["tmpfs"], *(volume.split(":")[1] for volume in service.get("volumes", []))]
        assert place[1] in mounted, name


def test_the_server_is_never_given_the_address_that_the_proxy_needs():
    """Docker gives the lowest one that is free, and the server is up before the proxy."""
    web = COMPOSE["networks"]["web"]["ipam"]["config"][0]
    subnet = ipaddress.ip_network(unset(web["subnet"]))
    proxy = ipaddress.ip_address(unset(SERVICES["proxy"]["networks"]["web"]["ipv4_address"]))
    assert proxy in subnet
    beside = [name for name, service in SERVICES.items() if name != "proxy" and "web" in service.get("networks", [])]
    assert int(proxy) > int(subnet.network_address) + 1 + len(beside), "the first address is the gateway's"
    assert json.loads(unset(SERVICES["server"]["environment"]["CROSSFIX_TRUSTED_PROXIES"])) == [str(proxy)]


def test_who_comes_without_tls_is_sent_to_the_port_that_was_set():
    assert SERVICES["proxy"]["environment"]["HTTPS_PORT"] in SERVICES["proxy"]["ports"][1]
    assert "redir https://{host}:{$HTTPS_PORT:443}{uri}" in (DEPLOY / "Caddyfile").read_text()


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


def test_prometheus_finds_its_token_where_it_is_written():
    """In a volume of its own: it sees no other secret. (Not in `configs`, which some compose programs leave out.)"""
    scrape = yaml.safe_load((DEPLOY / "prometheus.yml").read_text())["scrape_configs"][0]
    folder, name = scrape["authorization"]["credentials_file"].rsplit("/", 1)
    read = next(volume for volume in SERVICES["prometheus"]["volumes"] if volume.endswith(f":{folder}:ro"))
    written = next(v for v in SERVICES["secrets"]["volumes"] if v.split(":")[0] == read.split(":")[0])
    assert f"> {written.split(':')[1]}/{name}" in SERVICES["secrets"]["command"][-1]
    assert not any(volume.startswith("secrets:") for volume in SERVICES["prometheus"]["volumes"])


def test_an_archive_that_was_copied_in_can_be_read_by_the_server():
    """`docker compose cp` makes root its owner, archives are for their owner only, and the server is somebody else."""
    service = SERVICES["secrets"]
    assert "chown --recursive crossfix:crossfix /backups\n" in service["command"][-1]
    assert "CHOWN" in service["cap_add"]
    assert SERVICES["server"]["depends_on"]["secrets"]["condition"] == "service_completed_successfully"


def test_the_page_for_teams_names_what_the_file_has():
    page = (DEPLOY.parent / "docs" / "install-for-a-team.md").read_text()
    named = {name for row in re.findall(r"^\| (`[A-Z].*?) \|", page, re.MULTILINE) for name in re.findall(r"\w+", row)}
    assert named - {"COMPOSE_PROFILES"} <= set(re.findall(r"\$\{(\w+):-", yaml.safe_dump(COMPOSE)))
    assert {"ADDRESS", "LISTEN"} <= named


def test_an_upgrade_does_not_go_on_with_the_old_image():
    """`up` alone builds only what is not there."""
    page = (DEPLOY.parent / "docs" / "install-for-a-team.md").read_text()
    upgrade = page[page.index("To upgrade:") :]
    assert "    docker compose up --build --detach\n" in upgrade
    assert SERVICES["server"]["build"]


def test_a_restore_empties_all_that_a_backup_holds():
    """Not the archives, nor the password with which the database is made again."""
    page = (DEPLOY.parent / "docs" / "install-for-a-team.md").read_text()
    emptied = re.search(r"docker volume rm (.+)", page)
    assert emptied is not None
    kept = {volume.split(":")[0] for name in ("server", "database") for volume in SERVICES[name]["volumes"]}
    kept -= {"backups", "secrets"}
    assert set(emptied[1].split()) == {f"{COMPOSE['name']}_{volume}" for volume in kept}
    assert set(EMPTIED) == kept, "what `make containers` restores into"


def test_the_code_of_the_first_admin_is_found_in_the_log():
    """`make containers` reads it there."""
    log = "server-1  | Nobody can use it yet. Open the page and make the first admin; the code for it works once: "
    assert CODE.findall(f"{log}{new_code()}\n")
