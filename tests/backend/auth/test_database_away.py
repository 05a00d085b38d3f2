"""Who enters while the database is away, and what it stored though nobody heard so in time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import pytest
from entrance import PASSWORD, Clocks, again, opened, who, with_admin
from refusals import refusing

from backend.auth import keeping
from backend.auth.access import Access, Visit
from backend.auth.keeping import Denied
from backend.auth.records import Records
from backend.ports import JournalUnavailable
from backend.reasons import access as reasons


async def test_a_database_that_is_away_lets_everybody_inside_go_on(
    access: Access, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = await with_admin(access)

    async def away(*_: object, **__: object) -> None:
        raise JournalUnavailable(reasons.SignInNeeded())

    monkeypatch.setattr(Records, "change", away)
    assert who(access, secret) == "Ada"
    with pytest.raises(JournalUnavailable):
        await access.sign_in("Ada", PASSWORD, Visit("a", ""))
    with pytest.raises(JournalUnavailable):
        await access.sessions.end_all(access.people.by_name[0].person_id)
    assert who(access, secret) is None, "signed out all the same"


@pytest.mark.parametrize("until_closed", [False, True])
async def test_who_was_signed_out_while_the_database_was_away_stays_out_after_a_restart(
    access: Access, url: str, clocks: Clocks, monkeypatch: pytest.MonkeyPatch, until_closed: bool
) -> None:
    monkeypatch.setattr(keeping, "REMOVE_EVERY_S", 3600.0 if until_closed else 0.01)
    secret = await with_admin(access)
    person_id = access.people.by_name[0].person_id

    async def away(*_: object, **__: object) -> None:
        raise JournalUnavailable(reasons.SignInNeeded())

    with monkeypatch.context() as meanwhile:
        meanwhile.setattr(Records, "change", away)
        with pytest.raises(JournalUnavailable):
            await access.sessions.end_all(person_id)
        await asyncio.sleep(0.05)
    if until_closed:
        another = await again(url, clocks, access)
        assert who(another, secret) is None
        await another.close()
        return
    inside: str | None = "Ada"
    async with asyncio.timeout(60.0):  # killed at any later moment: nothing is written when it closes
        while inside is not None:
            another = opened(url, clocks)
            await another.load()
            inside = who(another, secret)
            await another.close()


@pytest.fixture
def unheard(monkeypatch: pytest.MonkeyPatch) -> Callable[[], AbstractContextManager[object]]:
    """While it is entered, whatever is stored is not heard of in time."""
    change = Records.change

    async def late(self: Records, **rows: Any) -> None:
        await change(self, **rows)
        raise JournalUnavailable(reasons.SignInNeeded())

    @contextmanager
    def entered() -> Generator[None]:
        with monkeypatch.context() as meanwhile:
            meanwhile.setattr(Records, "change", late)
            yield

    return entered


@pytest.mark.parametrize("name", ["Olga", "Olga B"])
async def test_an_account_that_was_stored_unheard_uses_its_invitation_and_enters(
    access: Access, unheard: Callable[[], AbstractContextManager[object]], name: str
) -> None:
    await with_admin(access)
    code, _ = await access.invitations.make("operator", False, 3600, access.people.by_name[0].person_id)
    with unheard(), pytest.raises(JournalUnavailable):
        await access.accept_invitation(code, "Olga", PASSWORD, Visit("a", ""))
    with refusing(reasons.CodeUnusable("used"), Denied):
        await access.accept_invitation(code, name, PASSWORD, Visit("a", ""))
    assert who(access, await access.sign_in("Olga", PASSWORD, Visit("a", ""))) == "Olga"
    assert [person.name for person in access.people.by_name] == ["Ada", "Olga"]


async def test_an_account_that_was_stored_unheard_signs_in_at_once(
    access: Access, unheard: Callable[[], AbstractContextManager[object]]
) -> None:
    code = access.begin_first_admin() or ""
    with unheard(), pytest.raises(JournalUnavailable):
        await access.make_first_admin(code, "Ada", PASSWORD, Visit("a", ""))
    assert who(access, await access.sign_in("Ada", PASSWORD, Visit("a", ""))) == "Ada"


async def test_a_first_admin_who_was_stored_unheard_is_the_only_one(
    access: Access, unheard: Callable[[], AbstractContextManager[object]]
) -> None:
    code = access.begin_first_admin() or ""
    with unheard(), pytest.raises(JournalUnavailable):
        await access.make_first_admin(code, "Ada", PASSWORD, Visit("a", ""))
    with refusing(reasons.FirstAdminExists(), Denied):
        await access.make_first_admin(code, "Eve", PASSWORD, Visit("b", ""))


async def test_a_name_that_only_the_database_knows_is_taken(access: Access, url: str, clocks: Clocks) -> None:
    """As when what was sent arrives after it was asked for."""
    beside = opened(url, clocks)
    await with_admin(beside)
    await beside.close()
    code = access.begin_first_admin() or ""
    with refusing(reasons.NameTaken("Ada"), Denied):
        await access.make_first_admin(code, "Ada", PASSWORD, Visit("a", ""))
    with refusing(reasons.FirstAdminExists(), Denied):
        await access.make_first_admin(code, "Ada", PASSWORD, Visit("a", ""))


async def test_a_password_that_was_stored_unheard_is_the_one_from_then_on(
    access: Access, unheard: Callable[[], AbstractContextManager[object]]
) -> None:
    """As after a restart, and a later change of the person does not bring the old one back."""
    await with_admin(access)
    person_id, new = access.people.by_name[0].person_id, "another good one 5"
    with unheard(), pytest.raises(JournalUnavailable):
        await access.change_password(person_id, PASSWORD, new, "a", None)
    await access.change_person(person_id, "viewer", admin=True, active=True)
    with refusing(reasons.WrongNameOrPassword(), Denied):
        await access.sign_in("Ada", PASSWORD, Visit("a", ""))
    assert who(access, await access.sign_in("Ada", new, Visit("a", ""))) == "Ada"


async def test_a_password_that_was_stored_unheard_ends_the_sessions_of_the_old_one(
    access: Access, unheard: Callable[[], AbstractContextManager[object]], url: str, clocks: Clocks
) -> None:
    await with_admin(access)
    thief = await access.sign_in("Ada", PASSWORD, Visit("b", ""))
    person_id, new = access.people.by_name[0].person_id, "another good one 5"
    with unheard(), pytest.raises(JournalUnavailable):
        await access.change_password(person_id, PASSWORD, new, "a", None)
    owner = await access.sign_in("Ada", new, Visit("a", ""))
    assert (who(access, owner), who(access, thief)) == ("Ada", None)
    another = await again(url, clocks, access)
    assert (who(another, owner), who(another, thief)) == ("Ada", None)
    await another.close()


async def test_whoever_was_shut_out_unheard_is_signed_out_for_good(
    access: Access, unheard: Callable[[], AbstractContextManager[object]]
) -> None:
    """Also from the live view, which looks at the session only, and when they are let in again."""
    secret = await with_admin(access)
    code, _ = await access.invitations.make("operator", False, 3600, access.people.by_name[0].person_id)
    shut_out = await access.accept_invitation(code, "Olga", PASSWORD, Visit("a", ""))
    found = access.signed_in(shut_out, "a")
    assert found is not None
    person_id = found[0].person or ""
    with unheard(), pytest.raises(JournalUnavailable):
        await access.change_person(person_id, "operator", admin=False, active=False)
    await access.change_person(person_id, "operator", admin=False, active=True)
    assert found[1].ended.is_set()
    assert (who(access, shut_out), who(access, secret)) == (None, "Ada")
