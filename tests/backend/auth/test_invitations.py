"""Links that let people in: once, for a while, and only as long as whoever made them may."""

from __future__ import annotations

import asyncio

import pytest
from entrance import DAY_S, PASSWORD, Clocks, again, with_admin
from refusals import refusing

from backend.auth.access import Access, Visit
from backend.auth.keeping import Denied
from backend.auth.records import Records
from backend.ports import JournalUnavailable
from backend.reasons import access as reasons
from backend.reasons.storage import DatabaseSilent


async def test_an_invitation_works_once_also_for_two_at_once(access: Access) -> None:
    await with_admin(access)
    link, _ = await access.invitations.make("operator", False, 3600, "x")
    tries = [access.accept_invitation(link, name, PASSWORD, Visit(f"10.0.1.{i}", "")) for i, name in enumerate("BCD")]
    done = await asyncio.gather(*tries, return_exceptions=True)
    assert sum(isinstance(one, str) for one in done) == 1
    with refusing(reasons.CodeUnusable("used"), Denied):
        await access.accept_invitation(link, "Eve", PASSWORD, Visit("10.0.0.9", ""))
    assert [person.role for person in access.people.by_name if person.name != "Ada"] == ["operator"]


async def test_an_expired_or_withdrawn_invitation_makes_nobody(access: Access, clocks: Clocks) -> None:
    await with_admin(access)
    link, _ = await access.invitations.make("pilot", True, 3600, "x")
    clocks.wall_s -= 10 * DAY_S
    clocks.steady_s += 3600
    with refusing(reasons.CodeUnusable("expired"), Denied):
        await access.accept_invitation(link, "Eve", PASSWORD, Visit("10.0.0.9", ""))
    link, made = await access.invitations.make("pilot", True, 3600, "x")
    await access.invitations.take_back(made.invitation_id)
    with refusing(reasons.CodeUnusable("unknown"), Denied):
        await access.accept_invitation(link, "Eve", PASSWORD, Visit("10.0.0.9", ""))
    assert len(access.people.by_name) == 1


async def test_an_invitation_falls_with_whoever_made_it(access: Access) -> None:
    """An admin who is about to be shut out may have made links for later."""
    await with_admin(access)
    ada = access.people.by_name[0].person_id
    link, _ = await access.invitations.make("pilot", True, 3600, ada)
    await access.accept_invitation(link, "Mal", PASSWORD, Visit("a", ""))
    mal = next(person.person_id for person in access.people.by_name if person.name == "Mal")
    for admin, active in ((False, True), (True, False)):
        for_later, made = await access.invitations.make("pilot", True, 3600, mal)
        await access.change_person(mal, "pilot", admin, active)
        assert not access.stands(made)
        with refusing(reasons.CodeUnusable("unknown"), Denied):
            access.look_at_invitation(for_later, "b")
        with refusing(reasons.CodeUnusable("unknown"), Denied):
            await access.accept_invitation(for_later, "Eve", PASSWORD, Visit("b", ""))
        await access.change_person(mal, "pilot", True, True)


async def test_what_the_database_could_not_forget_is_taken_back_again(
    access: Access, url: str, clocks: Clocks, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else it would be back after a restart, and nobody could find it in a list before."""
    await with_admin(access)
    ada = access.people.by_name[0].person_id
    link, invited = await access.invitations.make("pilot", True, 3600, ada)
    secret, token = await access.machines.make("agent", "exports", None, ada)

    async def away(*_: object, **__: object) -> None:
        raise JournalUnavailable(DatabaseSilent("it is away"))

    with monkeypatch.context() as gone:
        gone.setattr(Records, "change", away)
        with pytest.raises(JournalUnavailable):
            await access.invitations.take_back(invited.invitation_id)
        with pytest.raises(JournalUnavailable):
            await access.machines.revoke(token.token_id)
    assert access.machines.found(secret, "a") is None, "it is shut out at once"
    await access.invitations.take_back(invited.invitation_id)
    await access.machines.revoke(token.token_id)
    access = await again(url, clocks, access)
    assert (access.invitations.waiting, access.machines.tokens) == ([], [])
    with refusing(reasons.CodeUnusable("unknown"), Denied):
        await access.accept_invitation(link, "Eve", PASSWORD, Visit("b", ""))
    await access.close()
