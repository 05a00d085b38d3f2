"""Signing in by a provider that really answers, and every way in that must stay shut."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import pytest
from argon2 import PasswordHasher
from joserfc.jwk import OctKey
from refusals import refusing
from sign_in_provider import CLIENT, SECRET, SignInProvider, a_key, sign_in_provider

from backend.auth import provider
from backend.auth.access import Access, Visit
from backend.auth.audit import AuditLog
from backend.auth.keeping import Denied
from backend.auth.passwords import Passwords
from backend.auth.provided import UNDER_WAY_S, Provided, Rules, free_name
from backend.auth.provider import Provider
from backend.auth.records import Records
from backend.auth.registry import key_of
from backend.reasons.access import NoPasswordHere, ProviderRefused, WrongNameOrPassword
from backend.settings import settings_of
from backend.store.engine import make_engine, migrate
from backend.wiring import sign_in_provider as provider_of

PASSWORD = "correct horse battery"
BACK = "https://box.example/api/provider/return"
HERE = Visit("10.0.0.7", "phone")
CHEAP = Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))


@dataclass
class Pair:
    """here: as the server talks to it. there: the provider itself. clock: steady seconds."""

    here: Provider
    there: SignInProvider
    clock: list[float] = field(default_factory=lambda: [1000.0])

    async def begun(self) -> tuple[dict[str, str], str]:
        """What the browser comes back with, and its cookie."""
        url, browser = await self.here.begin(BACK)
        return dict(parse_qsl(self.there.agree(url))), browser

    async def found(self) -> Provided:
        return await self.here.finish(*await self.begun())


@pytest.fixture
async def pair() -> AsyncIterator[Pair]:
    async with sign_in_provider() as there:
        clock = [1000.0]
        yield Pair(Provider(there.issuer, CLIENT, SECRET, Rules(), monotonic_s=lambda: clock[0]), there, clock)


def refused(fault: Any) -> Any:
    return refusing(ProviderRefused(fault), Denied)


async def test_the_code_flow_names_whoever_agreed(pair: Pair) -> None:
    found = await pair.found()
    assert found == Provided(pair.there.issuer, "4711", ("Grace",), "viewer", False)
    assert pair.there.redirect_uri == BACK


async def test_a_way_back_works_once_in_the_browser_that_began_and_for_ten_minutes(pair: Pair) -> None:
    query, browser = await pair.begun()
    assert await pair.here.finish(query, browser)
    for cookie in (browser, None):
        with refused("return"):
            await pair.here.finish(query, cookie)
    query, browser = await pair.begun()
    with refused("return"):
        await pair.here.finish(query, (await pair.begun())[1])
    with refused("return"):  # it was tried in another browser: it is used up
        await pair.here.finish(query, browser)
    with refused("return"):
        await pair.here.finish({"code": "x", "state": ""}, browser)
    query, browser = await pair.begun()
    pair.clock[0] += UNDER_WAY_S
    with refused("return"):
        await pair.here.finish(query, browser)


async def test_a_crowd_that_only_begins_takes_no_memory(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(provider, "UNDER_WAY", 3)
    first, browser = await pair.begun()
    for _ in range(3):
        await pair.here.begin(BACK)
    with refused("return"):
        await pair.here.finish(first, browser)
    assert await pair.found()


@pytest.mark.parametrize("sent", [{"error": "access_denied"}, {}])
async def test_who_does_not_agree_does_not_enter(pair: Pair, sent: dict[str, str]) -> None:
    query, browser = await pair.begun()
    with refused("refused"):
        await pair.here.finish({"state": query["state"], **sent}, browser)


async def test_an_answer_that_another_provider_sent_is_refused(pair: Pair) -> None:
    query, browser = await pair.begun()
    with refused("answer"):
        await pair.here.finish({**query, "iss": "https://evil.example"}, browser)


def another_key(there: SignInProvider) -> None:
    there.published = a_key("another")


def unsigned(there: SignInProvider) -> None:
    there.header = {"alg": "none"}


def signed_with_the_public_key(there: SignInProvider) -> None:
    """HS256 with what everybody may read (algorithm confusion)."""
    there.published, there.key = there.key, OctKey.import_key(there.key.as_dict(private=False)["n"])
    there.header = {"alg": "HS256", "kid": "one"}


WRONG: dict[str, tuple[Callable[[SignInProvider], Any], str]] = {
    "another issuer in the token": (lambda there: there.wrong.update(iss="https://evil.example"), "answer"),
    "another issuer in the metadata": (lambda there: there.told.update(issuer="https://evil.example"), "answer"),
    "a token for another program": (lambda there: there.wrong.update(aud="another"), "answer"),
    "for another, by way of us": (lambda there: there.wrong.update(aud="another", azp=CLIENT), "answer"),
    "another sign-in's nonce": (lambda there: there.wrong.update(nonce="another"), "answer"),
    "no nonce": (lambda there: there.wrong.update(nonce=None), "answer"),
    "no subject": (lambda there: there.wrong.update(sub=None), "answer"),
    "a subject that is no text": (lambda there: there.wrong.update(sub=4711), "answer"),
    "an empty subject": (lambda there: there.wrong.update(sub=""), "answer"),
    "no end": (lambda there: there.wrong.update(exp=None), "answer"),
    "long ago": (lambda there: there.wrong.update(exp=1_000_000_000, iat=1_000_000_000), "clock"),
    "another's key": (another_key, "answer"),
    "no signature": (unsigned, "answer"),
    "the public key as a secret": (signed_with_the_public_key, "answer"),
    "no keys": (lambda there: there.told.update(jwks_uri=f"{there.issuer}/nowhere"), "away"),
    "no address for tokens": (lambda there: there.told.update(token_endpoint=None), "answer"),
}


@pytest.mark.parametrize("what", WRONG)
async def test_what_the_provider_says_is_checked(pair: Pair, what: str) -> None:
    spoil, fault = WRONG[what]
    spoil(pair.there)
    with refused(fault):
        await pair.found()


async def test_a_provider_that_is_away_is_asked_again_next_time(pair: Pair) -> None:
    away = Provider("http://127.0.0.1:9", CLIENT, SECRET, Rules())
    with refused("away"):
        await away.begin(BACK)
    pair.there.told["issuer"] = "https://evil.example"
    with refused("answer"):
        await pair.found()
    pair.there.told.clear()
    assert await pair.found()


GROUPS = Rules("realm_access.roles", {"pilots": "pilot", "watchers": "viewer", "chiefs": "admin"}, None)


@pytest.mark.parametrize("claims", [{"role": "admin"}, {"roles": ["admin", "pilot"]}, {"admin": True}])
async def test_no_claim_gives_a_role_that_no_setting_gives(pair: Pair, claims: dict[str, Any]) -> None:
    pair.there.person |= claims
    for rules in (Rules(), Rules("roles", {"pilots": "pilot"})):
        pair.here.rules = rules
        found = await pair.found()
        assert (found.role, found.admin) == ("viewer", False)


@pytest.mark.parametrize(
    ("roles", "expected"),
    [
        (["watchers", "pilots", "admin"], ("pilot", False)),
        (["chiefs"], ("viewer", True)),
        (["chiefs", "pilots"], ("pilot", True)),
        ("pilots", ("pilot", False)),
        ([7, None, {"pilots": 1}], (None, False)),
        ({"pilots": 1}, (None, False)),
    ],
)
async def test_a_claim_gives_the_highest_role_that_the_settings_know(pair: Pair, roles: Any, expected: Any) -> None:
    pair.here.rules = GROUPS
    pair.there.person["realm_access"] = {"roles": roles}
    found = await pair.found()
    assert (found.role, found.admin) == expected


@pytest.mark.parametrize(
    ("claims", "enters"),
    [
        ({"email": "grace@NAVY.example", "email_verified": True}, True),
        ({"email": "grace@navy.example", "email_verified": False}, False),
        ({"email": "grace@navy.example", "email_verified": "true"}, False),
        ({"email": "grace@navy.example"}, False),
        ({"email": "grace@navy.example@evil.example", "email_verified": True}, False),
        ({"email": "grace@evilnavy.example", "email_verified": True}, False),
        ({}, False),
    ],
)
async def test_with_domains_only_a_verified_address_enters(pair: Pair, claims: dict[str, Any], enters: bool) -> None:
    pair.here.rules = Rules(email_domains=("navy.example",))
    pair.there.person |= claims
    if enters:
        assert (await pair.found()).subject == "4711"
    else:
        with refused("email"):
            await pair.found()


async def test_names_are_printable_short_and_of_verified_addresses_only(pair: Pair) -> None:
    pair.there.person |= {
        "name": "Gr\x00ace\n\u202e" + "x" * 300,
        "preferred_username": ["g"],
        "email": "ada@a.example",
    }
    (name,) = (await pair.found()).names
    assert len(name) <= 40
    assert name.isprintable()
    pair.there.person = {"sub": "1"}
    assert (await pair.found()).names == ("somebody",)


def test_a_name_that_is_taken_gets_a_number() -> None:
    taken = frozenset({"ada", "ada 2", "x" * 34 + " 2"})
    assert free_name((" ADA ", "Lovelace"), taken, key_of) == "Lovelace"
    assert free_name(("ADA",), taken, key_of) == "ADA 3"
    assert free_name(("x" * 40,), taken | {"x" * 40}, key_of) == "x" * 34 + " 3"


# Who that is here


@pytest.fixture
async def url(tmp_path: Path) -> str:
    url = f"sqlite+aiosqlite:///{tmp_path / 'people.sqlite'}"
    await migrate(url)
    return url


async def opened(url: str) -> Access:
    records = Records(make_engine(url, 2.0), 2.0)
    access = Access(records, AuditLog(None, lambda: 0.0), people_expected=True, passwords=CHEAP)
    await access.load()
    return access


@pytest.fixture
async def access(url: str) -> AsyncIterator[Access]:
    access = await opened(url)
    await access.make_first_admin(access.begin_first_admin() or "", "Ada", PASSWORD, HERE)
    yield access
    await access.close()


def grace(role: Any = "viewer", admin: bool = False, name: str = "Grace", at: str = "https://a.example") -> Provided:
    return Provided(at, "4711", (name,), role, admin)


def people(access: Access) -> dict[str, tuple[str, bool]]:
    return {person.name: (person.role, person.admin) for person in access.people.by_name}


async def test_who_was_here_before_is_known_by_issuer_and_subject_alone(access: Access, url: str) -> None:
    for name in ("Grace", "Grace Hopper"):
        assert access.signed_in(await access.enter_provided(grace(name=name), Rules(), HERE), "a")
    again = await opened(url)
    assert again.signed_in(await again.enter_provided(grace(), Rules(), HERE), "a")
    assert people(again) == {"Ada": ("pilot", True), "Grace": ("viewer", False)}
    await again.close()
    await access.enter_provided(grace(name="ada", at="https://b.example"), Rules(), HERE)
    assert people(access)["ada 2"] == ("viewer", False), "a name is nobody's proof of being that person"


async def test_who_comes_from_the_provider_has_no_password_to_guess_or_change(access: Access) -> None:
    await access.enter_provided(grace(), Rules(), HERE)
    person = access.people.named("Grace")
    assert person is not None
    for password in ("nobody has this password", "", "4711"):  # the first stands in for nobody's
        with refusing(WrongNameOrPassword(), Denied):
            await access.sign_in("Grace", password, HERE)
    with refusing(NoPasswordHere(), Denied):
        await access.change_password(person.person_id, "", "another horse battery", "a", None)


async def test_a_role_here_stays_unless_the_provider_gives_roles(access: Access) -> None:
    await access.enter_provided(grace(), Rules(), HERE)
    person = access.people.named("Grace")
    assert person is not None
    await access.change_person(person.person_id, "pilot", True, True)
    await access.enter_provided(grace(), Rules(), HERE)
    assert people(access)["Grace"] == ("pilot", True)
    await access.enter_provided(grace("operator"), Rules("groups", {"a": "operator"}), HERE)
    assert people(access)["Grace"] == ("operator", True), "nothing there says who manages people"
    await access.enter_provided(grace("operator"), GROUPS, HERE)
    assert people(access)["Grace"] == ("operator", False)


async def test_who_has_lost_every_role_or_is_shut_out_is_out(access: Access) -> None:
    secret = await access.enter_provided(grace("pilot"), GROUPS, HERE)
    with refused("role"):
        await access.enter_provided(grace(None), GROUPS, HERE)
    assert access.signed_in(secret, "a") is None
    person = access.people.named("Grace")
    assert person is not None
    await access.change_person(person.person_id, "viewer", False, False)
    with refused("shut_out"):
        await access.enter_provided(grace("pilot"), GROUPS, HERE)


async def test_the_last_admin_stays_admin_whatever_the_provider_says(access: Access) -> None:
    await access.enter_provided(grace("viewer", True), GROUPS, HERE)
    ada = access.people.named("Ada")
    assert ada is not None
    await access.change_person(ada.person_id, "pilot", False, True)
    await access.enter_provided(grace("pilot", False), GROUPS, HERE)
    assert people(access) == {"Ada": ("pilot", False), "Grace": ("pilot", True)}


# Settings


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"oidc_issuer": "http://sso.example", "oidc_client_id": "x"}, "https"),
        ({"oidc_issuer": "https://sso.example"}, "OIDC_CLIENT_ID"),
        ({"oidc_roles": {"a": "pilot"}}, "OIDC_ROLE_CLAIM"),
        ({"oidc_role_claim": "groups"}, "OIDC_ROLES"),
        ({"oidc_role_claim": "groups", "oidc_roles": {"a": "king"}}, "oidc-roles"),
    ],
)
def test_half_a_setting_is_refused_with_what_is_missing(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        settings_of(**given)


def test_settings_make_the_provider_and_let_people_sign_in(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("s3cret\n")
    given: dict[str, Any] = {"oidc_issuer": "https://sso.example/realm", "oidc_client_id": "crossfix"}
    settings = settings_of(**given, oidc_client_secret_file=secret, oidc_default_role="none")
    assert settings.people_expected
    made = provider_of(settings)
    assert made is not None
    assert (made.name, made.rules.default) == ("sso.example", None)
    assert provider_of(settings_of()) is None
    with pytest.raises(ValueError, match="secret cannot be read"):
        provider_of(settings_of(**given, oidc_client_secret_file=tmp_path / "missing"))
