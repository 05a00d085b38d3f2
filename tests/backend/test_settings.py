"""Settings of a server: what they refuse, and what follows from them."""

from contextlib import nullcontext
from pathlib import Path

import httpx
import pytest
from pydantic import ValidationError

from backend.api.application import make_application
from backend.settings import Settings, settings_of


@pytest.mark.parametrize(
    ("host", "reachable"),
    [
        ("127.0.0.1", False),
        ("127.8.0.1", False),
        ("::1", False),
        ("localhost", False),
        ("0.0.0.0", True),
        ("::", True),
        ("192.168.1.10", True),
        ("field-laptop", True),
    ],
)
def test_a_server_beyond_loopback_is_known_as_such(host: str, reachable: bool) -> None:
    assert Settings(host=host).reachable_from_outside is reachable


def test_the_default_is_loopback() -> None:
    assert not Settings().reachable_from_outside


def test_a_wrong_value_is_named_as_it_was_given(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match=r"^--speedup: Input should be greater than 0$"):
        settings_of(time_factor=0.0)
    with pytest.raises(ValueError, match=r"^--database: the database URL must begin"):
        settings_of(database_url="foo")
    monkeypatch.setenv("CROSSFIX_TIME_FACTOR", "0")
    with pytest.raises(ValueError, match=r"^CROSSFIX_TIME_FACTOR: Input should be greater than 0$"):
        settings_of(host="127.0.0.1")


@pytest.mark.parametrize("url", ["mysql://localhost/x", "crossfix.sqlite", ""])
def test_an_unknown_database_is_refused_with_the_two_that_work(url: str) -> None:
    with pytest.raises(ValidationError, match=r"sqlite:/// or postgresql://"):
        Settings(database_url=url)


@pytest.mark.parametrize("port", ["nan", "70000", "0", "-1", "5432:x"])
def test_a_databases_port_that_is_no_number_is_refused_and_not_shown(port: str) -> None:
    with pytest.raises(ValueError, match=r"^--database: the database URL's port must be a number") as refused:
        settings_of(database_url=f"postgresql://crossfix@db:{port}/missions")
    assert f":{port}" not in str(refused.value)


@pytest.mark.parametrize("place", ["db", "db:5432", "[::1]:5432", "u:p:w@db:5432", "u:a/b@db", "", "db:", ":5432"])
def test_a_databases_port_is_read_where_one_is_named(place: str) -> None:
    assert Settings(database_url=f"postgresql://{place}/missions?host=/run:5433").async_database_url.count(place)


@pytest.mark.parametrize(
    ("url", "driven"),
    [
        ("sqlite:////data/missions.sqlite", "sqlite+aiosqlite:////data/missions.sqlite"),
        ("postgresql://crossfix@db/missions", "postgresql+asyncpg://crossfix@db/missions"),
    ],
)
def test_the_database_is_opened_with_the_asynchronous_driver(url: str, driven: str) -> None:
    assert Settings(database_url=url).async_database_url == driven


@pytest.mark.parametrize(
    "url",
    [
        "crossfix.example",
        "javascript:alert(1)//x",
        "https://",
        "https://a/?b",
        "https://a/#/join/x",
        "https://a@b",
        "//a",
    ],
)
def test_an_address_that_no_link_can_be_made_of_is_refused(url: str) -> None:
    with pytest.raises(ValidationError, match="public address"):
        Settings(public_url=url)


def test_the_pages_address_is_one_to_add_to() -> None:
    assert Settings(public_url="https://192.168.1.10:8443/").public_url == "https://192.168.1.10:8443"
    assert Settings(public_url="").public_url is None
    assert Settings(public_url="https://192.168.1.10:443").public_url == "https://192.168.1.10", "as compose sets it"
    assert Settings(public_url="http://field:80/").public_url == "http://field"
    assert Settings(public_url="http://field:443").public_url == "http://field:443"


async def test_a_link_to_the_pages_address_is_not_turned_away(tmp_path: Path) -> None:
    settings = Settings(public_url="https://Field.example:8443", page_dir=tmp_path)
    app = make_application(settings, lambda _: nullcontext())
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://127.0.0.1") as client:
        told = {
            host: (await client.get("/", headers={"host": host})).status_code
            for host in ("field.example:8443", "e.example")
        }
    assert told == {"field.example:8443": 503, "e.example": 421}


@pytest.mark.parametrize(
    "url",
    [
        "postgresql://app:hush@h:5/x",
        "postgresql://app:o?hush@h:5/x",
        "postgresql://h:5/x?user=app&password=hush&ssl=require",
        "postgresql://app@h/x?password=o@hush",
    ],
)
def test_the_shown_database_holds_no_password(url: str) -> None:
    shown = Settings(database_url=url).shown_database
    assert shown.removeprefix("postgresql+asyncpg://") in ("h:5/x", "h/x")
    assert not any(word in shown for word in ("hush", "app"))


def test_of_a_database_url_that_cannot_be_read_its_kind_is_shown() -> None:
    assert Settings(database_url="postgresql:app:hush@h/x").shown_database == "postgresql+asyncpg"


def test_the_shown_database_names_the_whole_file() -> None:
    assert Settings(database_url="sqlite:////a@b/c.sqlite").shown_database == "sqlite+aiosqlite:////a@b/c.sqlite"
