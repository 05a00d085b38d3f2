"""Entering, and the ways in that must stay shut."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from entrance import DAY_S, PASSWORD, Clocks, again, everything_in, opened, who, with_admin
from refusals import refusing

from backend.auth.access import Access, Visit
from backend.auth.keeping import Denied
from backend.auth.registry import shown_key
from backend.auth.sessions import IDLE_S, LONGEST_S, SESSIONS_EACH
from backend.reasons import access as reasons


async def test_the_first_admin_needs_the_code_and_it_works_once(access: Access) -> None:
    code = access.begin_first_admin() or ""
    for wrong in ("", "AAAA-AAAA-AAAA-AAAA", code[:-1]):
        with refusing(reasons.CodeUnusable("unknown"), Denied):
            await access.make_first_admin(wrong, "Eve", PASSWORD, Visit("10.0.0.9", ""))
    secret = await access.make_first_admin(f" {code.lower()} ", "Ada", PASSWORD, Visit("10.0.0.2", ""))
    assert who(access, secret) == "Ada"
    with refusing(reasons.FirstAdminExists(), Denied):
        await access.make_first_admin(code, "Eve", PASSWORD, Visit("10.0.0.9", ""))
    assert access.begin_first_admin() is None


async def test_of_two_first_admins_at_once_one_is_made(access: Access) -> None:
    code = access.begin_first_admin() or ""
    tries = [access.make_first_admin(code, name, PASSWORD, Visit(f"10.0.0.{i}", "")) for i, name in enumerate("ABCD")]
    done = await asyncio.gather(*tries, return_exceptions=True)
    assert sum(isinstance(one, str) for one in done) == 1
    assert {type(one.reason) for one in done if isinstance(one, Denied)} == {reasons.FirstAdminExists}
    assert len(access.people.by_name) == 1


async def test_a_new_code_replaces_the_old_one_and_a_refused_password_costs_no_code(access: Access) -> None:
    old = access.begin_first_admin() or ""
    new = access.begin_first_admin() or ""
    with refusing(reasons.CodeUnusable("unknown"), Denied):
        await access.make_first_admin(old, "Ada", PASSWORD, Visit("a", ""))
    with refusing(reasons.PasswordWeak("short", 10), Denied):
        await access.make_first_admin(new, "Ada", "short", Visit("a", ""))
    assert await access.make_first_admin(new, "Ada", PASSWORD, Visit("a", ""))


async def test_where_one_person_sits_alone_nobody_becomes_admin(url: str, clocks: Clocks) -> None:
    access = opened(url, clocks, expected=False)
    assert access.mode == "alone"
    assert access.begin_first_admin() is None
    with refusing(reasons.NoPeopleHere(), Denied):
        await access.make_first_admin("", "Eve", PASSWORD, Visit("a", ""))
    await access.close()


async def test_once_there_are_people_loopback_needs_a_sign_in_too(access: Access, url: str, clocks: Clocks) -> None:
    await with_admin(access)
    alone = opened(url, clocks, expected=False)
    await alone.load()
    assert alone.mode == "people"
    await alone.close()


async def test_each_sign_in_makes_a_new_secret(access: Access) -> None:
    """A session that somebody else has set before (fixation) is worth nothing."""
    first = await with_admin(access)
    second = await access.sign_in("ada", PASSWORD, Visit("10.0.0.2", "phone"))
    third = await access.sign_in(" ADA ", PASSWORD, Visit("10.0.0.2", "phone"))
    assert len({first, second, third}) == 3
    assert who(access, "set-by-eve") is None


@pytest.mark.parametrize(("name", "password"), [("Ada", "wrong password"), ("Eve", PASSWORD), ("", "")])
async def test_a_wrong_name_and_a_wrong_password_are_answered_alike(access: Access, name: str, password: str) -> None:
    await with_admin(access)
    with refusing(reasons.WrongNameOrPassword(), Denied):
        await access.sign_in(name, password, Visit("10.0.0.9", ""))


async def test_tries_are_limited_by_address_and_others_still_enter(access: Access, clocks: Clocks) -> None:
    await with_admin(access)
    reasons_got = list[type]()
    for _ in range(30):
        try:
            await access.sign_in("Ada", "wrong password", Visit("10.0.0.9", ""))
        except Denied as error:
            reasons_got.append(type(error.reason))
    assert reasons_got.count(reasons.WrongNameOrPassword) == 10
    with refusing(reasons.TooManyTries, Denied):
        await access.sign_in("Ada", PASSWORD, Visit("10.0.0.9", ""))
    assert await access.sign_in("Ada", PASSWORD, Visit("10.0.0.2", ""))
    clocks.wall_s += 365 * DAY_S
    with refusing(reasons.TooManyTries, Denied):
        await access.sign_in("Ada", PASSWORD, Visit("10.0.0.9", ""))
    clocks.steady_s += 300
    assert await access.sign_in("Ada", PASSWORD, Visit("10.0.0.9", ""))


async def test_tries_side_by_side_are_counted(access: Access) -> None:
    await with_admin(access)
    tries = [access.sign_in("Ada", f"wrong password {i}", Visit("10.0.0.9", "")) for i in range(40)]
    done = await asyncio.gather(*tries, return_exceptions=True)
    assert sum(isinstance(one, Denied) and isinstance(one.reason, reasons.WrongNameOrPassword) for one in done) <= 10


async def test_one_ipv6_network_is_one_address(access: Access) -> None:
    await with_admin(access)
    for number in range(10):
        with refusing(reasons.WrongNameOrPassword, Denied):
            await access.sign_in("Ada", "wrong password", Visit(f"2001:db8::{number:x}", ""))
    with refusing(reasons.TooManyTries, Denied):
        await access.sign_in("Ada", "wrong password", Visit("2001:db8::ffff:1", ""))


async def test_a_session_ends_when_idle_and_when_old(access: Access, clocks: Clocks) -> None:
    secret = await with_admin(access)
    clocks.go(IDLE_S - 1)
    found = access.signed_in(secret, "")
    assert found is not None
    access.sessions.seen(found[1])
    clocks.go(IDLE_S - 1)
    assert who(access, secret) == "Ada"
    clocks.go(2)
    assert who(access, secret) is None
    secret = await access.sign_in("Ada", PASSWORD, Visit("10.0.0.2", ""))
    for _ in range(int(LONGEST_S / IDLE_S) + 2):
        if (found := access.signed_in(secret, "")) is not None:
            access.sessions.seen(found[1])
        clocks.go(IDLE_S / 1.1)
    assert who(access, secret) is None


@pytest.mark.parametrize("jump_s", [20 * 365 * DAY_S, -20 * 365 * DAY_S])
async def test_a_clock_that_jumps_signs_nobody_out_and_brings_nobody_back(
    access: Access, clocks: Clocks, jump_s: float
) -> None:
    """A field laptop hears its first satellite in flight; its operator must still reach abort."""
    kept, idle = await with_admin(access), await access.sign_in("Ada", PASSWORD, Visit("10.0.0.2", "old phone"))
    clocks.wall_s += jump_s
    assert who(access, kept) == "Ada"
    clocks.steady_s += IDLE_S
    assert who(access, idle) is None


async def test_sessions_people_and_invitations_outlast_a_restart_and_secrets_are_not_stored(
    access: Access, url: str, clocks: Clocks, tmp_path: Path
) -> None:
    secret = await with_admin(access)
    link, _ = await access.invitations.make("operator", False, 3600, "x")
    token, _ = await access.machines.make("box", "payload", None, "x")
    clocks.go(60)
    access = await again(url, clocks, access)
    assert access.mode == "people"
    assert who(access, secret) == "Ada"
    assert access.look_at_invitation(link, "a").role == "operator"
    assert access.machines.found(token, "a") is not None
    stored = everything_in(tmp_path)
    for shown in (secret, link, token, PASSWORD):
        assert shown.encode() not in stored
    await access.close()


async def test_across_a_restart_time_goes_on_and_a_clock_set_back_revives_nothing_for_long(
    access: Access, url: str, clocks: Clocks
) -> None:
    secret = await with_admin(access)
    clocks.go(IDLE_S + 1)
    access = await again(url, clocks, access)
    assert who(access, secret) is None
    clocks.wall_s -= 10 * DAY_S
    access = await again(url, clocks, access)
    clocks.steady_s += IDLE_S
    assert who(access, secret) is None
    await access.close()


@pytest.mark.parametrize(
    "name",
    [
        "ada",
        " Ada",
        "\uff21da",
        "A\u0064a",
        "Ada\u200b",
        "A\u00adda",
        "\ufeffAda",
        "A\u200dda",
        "Ada\ufe0f",
        "A\u034fda",
        "Ada\u3164",
        "\u2800Ada",
    ],
)
async def test_no_two_people_have_names_that_look_alike(access: Access, name: str) -> None:
    """Else an operator could give orders, and report bearings, as what every list shows as somebody else."""
    await with_admin(access)
    link, _ = await access.invitations.make("viewer", False, 3600, "x")
    with refusing(reasons.NameTaken, Denied):
        await access.accept_invitation(link, name, PASSWORD, Visit("a", ""))
    assert shown_key(name) == "ada"


async def test_signing_out_everywhere_ends_all_at_once_and_for_good(access: Access, url: str, clocks: Clocks) -> None:
    first = await with_admin(access)
    second = await access.sign_in("Ada", PASSWORD, Visit("10.0.0.2", "phone"))
    found = access.signed_in(second, "")
    assert found is not None
    person = access.people.by_name[0].person_id
    await access.sessions.end_all(person)
    assert found[1].ended.is_set(), "its websockets close"
    access = await again(url, clocks, access)
    assert (who(access, first), who(access, second)) == (None, None)
    await access.close()


async def test_who_is_shut_out_is_out_and_the_last_admin_stays(access: Access) -> None:
    await with_admin(access)
    ada = access.people.by_name[0].person_id
    for role, admin, active in (("pilot", False, True), ("pilot", True, False)):
        with refusing(reasons.LastAdmin(), Denied):
            await access.change_person(ada, role, admin, active)  # type: ignore[arg-type]
    link, _ = await access.invitations.make("operator", False, 60, ada)
    secret = await access.accept_invitation(link, "Ben", PASSWORD, Visit("b", ""))
    ben = next(person.person_id for person in access.people.by_name if person.name == "Ben")
    assert access.people.operates(ben)
    await access.change_person(ben, "viewer", False, True)
    assert not access.people.operates(ben)
    await access.change_person(ben, "operator", False, False)
    assert not access.people.operates(ben)
    assert who(access, secret) is None
    with refusing(reasons.WrongNameOrPassword(), Denied):
        await access.sign_in("Ben", PASSWORD, Visit("b", ""))


async def test_a_new_password_ends_all_other_sessions(access: Access) -> None:
    secret = await with_admin(access)
    other = await access.sign_in("Ada", PASSWORD, Visit("10.0.0.3", "phone"))
    found = access.signed_in(secret, "a")
    assert found is not None
    ada, own = access.people.by_name[0].person_id, found[0].session
    with refusing(reasons.WrongNameOrPassword(), Denied):
        await access.change_password(ada, "not it at all", "another horse battery", "a", own)
    with refusing(reasons.PasswordWeak, Denied):
        await access.change_password(ada, PASSWORD, "aaaaaaaaaaaa", "a", own)
    assert who(access, other) == "Ada"
    await access.change_password(ada, PASSWORD, "another horse battery", "a", own)
    assert (who(access, secret), who(access, other)) == ("Ada", None)
    with refusing(reasons.WrongNameOrPassword(), Denied):
        await access.sign_in("Ada", PASSWORD, Visit("b", ""))
    assert await access.sign_in("Ada", "another horse battery", Visit("b", ""))


async def test_one_person_has_a_bounded_number_of_sessions(access: Access, clocks: Clocks) -> None:
    first = last = await with_admin(access)
    for _ in range(SESSIONS_EACH):
        clocks.go(10)
        last = await access.sign_in("Ada", PASSWORD, Visit("10.0.0.2", ""))
    assert who(access, first) is None
    assert who(access, last) == "Ada"
    assert len(access.sessions.of(access.people.by_name[0].person_id)) == SESSIONS_EACH


async def test_a_token_lasts_as_long_as_it_was_made_for_and_a_revoked_one_not_at_all(
    access: Access, clocks: Clocks
) -> None:
    await with_admin(access)
    secret, made = await access.machines.make("box", "exports", 3600, "x")
    found = access.machines.found(secret, "a")
    assert found is not None
    assert found[0].scope == "exports"
    assert found[1] is not None
    await access.machines.revoke(made.token_id)
    assert found[1].ended.is_set()
    assert access.machines.found(secret, "a") is None
    secret, _ = await access.machines.make("box", "exports", 3600, "x")
    clocks.go(3600)
    assert access.machines.found(secret, "a") is None
    configured = access.machines.found("a configured token of a payload", "a")
    assert configured is not None
    assert configured[0].scope == "payload"


async def test_guessing_tokens_is_slowed_down_and_the_right_one_always_enters(access: Access) -> None:
    await with_admin(access)
    secret, _ = await access.machines.make("box", "payload", None, "x")
    for number in range(10):
        assert access.machines.found(f"guess {number}", "10.0.0.9") is None
    with refusing(reasons.TooManyTries, Denied):
        access.machines.found("another guess", "10.0.0.9")
    assert access.machines.found(secret, "10.0.0.9") is not None


async def test_a_program_that_still_shows_its_ended_token_takes_nobodys_tries(access: Access, clocks: Clocks) -> None:
    """It guesses nothing, and people enter from its address, too."""
    await with_admin(access)
    revoked, made = await access.machines.make("box", "payload", None, "x")
    expired, _ = await access.machines.make("box", "exports", 3600, "x")
    await access.machines.revoke(made.token_id)
    clocks.go(3600)
    for _ in range(50):
        assert access.machines.found(revoked, "10.0.0.9") is None
        assert access.machines.found(expired, "10.0.0.9") is None
    assert who(access, await access.sign_in("Ada", PASSWORD, Visit("10.0.0.9", "laptop"))) == "Ada"
