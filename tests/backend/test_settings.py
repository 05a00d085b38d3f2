"""Settings of a server: what they refuse, and what follows from them."""

import pytest
from pydantic import ValidationError

from backend.settings import Settings


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


@pytest.mark.parametrize("url", ["mysql://localhost/x", "crossfix.sqlite", ""])
def test_an_unknown_database_is_refused_with_the_two_that_work(url: str) -> None:
    with pytest.raises(ValidationError, match=r"sqlite:/// or postgresql://"):
        Settings(database_url=url)


@pytest.mark.parametrize(
    ("url", "driven"),
    [
        ("sqlite:////data/missions.sqlite", "sqlite+aiosqlite:////data/missions.sqlite"),
        ("postgresql://crossfix@db/missions", "postgresql+asyncpg://crossfix@db/missions"),
    ],
)
def test_the_database_is_opened_with_the_asynchronous_driver(url: str, driven: str) -> None:
    assert Settings(database_url=url).async_database_url == driven
