"""Names with letters that are not shown, which a keyboard may not have: whoever sees the name can type it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from entrance import PASSWORD, Clocks, who, with_admin
from refusals import refusing

from backend.auth.access import Access, Visit
from backend.auth.keeping import Denied
from backend.auth.registry import key_of
from backend.reasons import access as reasons

PERSIAN, HINDI = "Amir\u200cHossein", "\u0915\u094d\u200d\u0937"
HERE = Visit("10.0.0.3", "")


@pytest.mark.parametrize("name", [PERSIAN, HINDI])
async def test_whoever_has_such_a_letter_enters_without_it_too(access: Access, name: str) -> None:
    await with_admin(access)
    link, _ = await access.invitations.make("viewer", False, 3600, "x")
    await access.accept_invitation(link, name, PASSWORD, HERE)
    for typed in (name, name.replace("\u200c", "").replace("\u200d", "").upper()):
        assert who(access, await access.sign_in(typed, PASSWORD, HERE)) == name


async def test_of_two_of_before_who_look_alike_each_enters_by_their_own_letters(access: Access) -> None:
    await with_admin(access)
    ada = access.people.by_name[0]
    for number, name in enumerate((PERSIAN, "AmirHos\u200csein")):
        access.people.put(replace(ada, person_id=str(number), name=name, name_key=key_of(name)))
    assert [found.name for found in map(access.people.named, (PERSIAN, "AmirHos\u200csein")) if found] == [
        PERSIAN,
        "AmirHos\u200csein",
    ]
    assert access.people.named("AmirHossein") is None


async def test_letters_that_are_not_shown_give_nobody_more_tries(access: Access, clocks: Clocks) -> None:
    await with_admin(access)
    for number in range(50):
        with refusing(reasons.WrongNameOrPassword(), Denied):
            await access.sign_in("Ada" + "\u200c" * number, "wrong password", Visit(f"10.1.0.{number}", ""))
    with refusing(reasons.TooManyTries, Denied):
        await access.sign_in("A\u200dda", "wrong password", HERE)
