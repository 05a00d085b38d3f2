"""A team on one server: the first admin by code, a phone by invitation, and who steers among them."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest
from legible import serious
from playwright.sync_api import expect
from screen import OpenScreen, Screen
from served import Server
from team import PASSWORD, PHONE, Shared, team_server

NEW = "another horse battery"


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Shared]:
    with team_server(tmp_path_factory.mktemp("team")) as made:
        yield made


def enter(screen: Screen, name: str) -> None:
    screen.part("entry-name").fill(name)
    screen.part("entry-password").fill(PASSWORD)
    screen.part("entry-submit").click()


def invited(admin: Screen, role: str) -> str:
    """The link of a new invitation."""
    admin.go("#/people")
    admin.part("invite").wait_for()
    admin.page.get_by_label(re.compile("^(Role|Rolle)$")).select_option(role)
    admin.part("invite").click()
    return admin.part("invitation-link").input_value()


def recovered(shared: Shared, name: str) -> str:
    """The code that the command on the server's machine prints."""
    command = [sys.executable, "-m", "backend.cli.main", "recover", name, "--data-dir", str(shared.server.data_dir)]
    done = subprocess.run([*command, "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["code"]


def opened(open_screen: OpenScreen, shared: Shared, path: str = "", **options: Any) -> Screen:
    return open_screen(shared.server, path, **options)


def drafted(admin: Screen) -> str:
    """A mission with the suggested area; its id."""
    ask = "async () => (await (await fetch('/api/defaults')).json()).spec"
    draft = (
        "async spec => (await (await fetch('/api/missions', {method: 'POST', body: JSON.stringify(spec),"
        " headers: {'content-type': 'application/json'}})).json()).mission_id"
    )
    return admin.page.evaluate(draft, admin.page.evaluate(ask))


def steers(screen: Screen, name: str) -> None:
    expect(screen.part("who-steers")).to_contain_text(name)


def control(screen: Screen, kind: str) -> None:
    screen.part("who-steers").click()
    screen.part(kind).click()


def middle(screen: Screen, name: str) -> float:
    """Of a part, px from the left edge."""
    box = screen.part(name).bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2


@pytest.mark.browser
def test_a_team_enters_and_hands_control_around(shared: Shared, open_screen: OpenScreen) -> None:
    """One story: its steps need one another."""
    admin = opened(open_screen, shared, f"#/first-admin/{shared.code}")
    expect(admin.part("sign-in-page")).to_be_visible()
    expect(admin.part("indicators")).to_have_count(0)
    expect(admin.part("entry-code")).to_have_value(shared.code)
    assert serious(admin.page) == []
    admin.part("entry-code").fill("AAAA-AAAA-AAAA-AAAA")
    enter(admin, "Ada")
    expect(admin.page.get_by_role("alert")).to_contain_text("not known")
    admin.part("entry-code").fill(shared.code.lower())
    admin.part("entry-submit").click()
    expect(admin.part("menu")).to_be_visible()
    expect(admin.part("made-invitation")).to_have_count(1)
    admin.page.get_by_label("For how many phones").select_option("2")
    admin.part("invite").click()
    expect(admin.part("made-invitation")).to_have_count(2)
    links = {each.input_value() for each in admin.part("invitation-link").all()}
    assert len(links) == 2, "each phone has a link of its own"
    assert serious(admin.page) == []
    admin.page.get_by_role("button", name="Done").click()

    late = opened(open_screen, shared)
    expect(late.part("entry-code")).to_have_count(0)
    assert [middle(late, part) for part in ("entry-name", "entry-lost")] == pytest.approx([640, 640], abs=1)
    enter(late, "Eve")
    expect(late.page.get_by_role("alert")).to_contain_text("Name or password is wrong")

    link = invited(admin, "operator")
    expect(admin.part("made-invitation").get_by_role("img")).to_be_visible()
    phone = opened(open_screen, shared, link.split("/", 3)[3], settings={"language": "de"}, **PHONE)
    expect(phone.part("join-role")).to_contain_text("Operator")
    assert serious(phone.page) == []
    enter(phone, "Ben")
    expect(phone.part("menu")).to_be_visible()
    again = opened(open_screen, shared, link.split("/", 3)[3])
    expect(again.page.get_by_role("alert")).to_contain_text("has been used")

    mission = drafted(admin)
    for screen in (admin, phone):
        screen.go(f"#/mission/{mission}")
        steers(screen, "nobody" if screen is admin else "niemand")
    control(phone, "take_control")
    steers(phone, "Sie")
    steers(admin, "Ben")

    control(admin, "take_control")  # a pilot does not wait
    steers(admin, "you")
    steers(phone, "Ada")

    control(phone, "ask_control")
    expect(admin.part("control-asked")).to_contain_text("Ben")
    admin.part("keep_control").click()
    expect(admin.part("control-asked")).to_have_count(0)
    control(phone, "ask_control")
    admin.part("give_control").click()
    steers(phone, "Sie")
    steers(admin, "Ben")
    expect(admin.part("phase")).to_have_text(re.compile("draft|ready"))

    admin.go("#/people")
    phone_row = admin.page.locator("[data-testid=person][data-name=Ben]")
    phone_row.get_by_role("button", name="Sign out").click()
    expect(phone.part("sign-in-page")).to_be_visible()
    expect(phone.part("indicators")).to_have_count(0)
    enter(phone, "Ben")
    expect(phone.part("menu")).to_be_visible()
    steers(phone, "Sie")

    phone.go("#/people")
    for old, said in (("not it at all", "falsch"), (PASSWORD, "")):
        phone.part("password-old").fill(old)
        phone.part("password-new").fill(NEW)
        phone.part("password-submit").click()
        expect(phone.part("own-password").get_by_role("alert" if said else "status")).to_contain_text(said)
    expect(phone.part("menu")).to_be_visible()

    admin.go("#/health")
    expect(admin.part("health")).to_contain_text("SQLite answers")
    admin.go("#/people")
    admin.part("sign-out-everywhere").click()
    expect(admin.part("sign-in-page")).to_be_visible()

    code = recovered(shared, "Ada")
    admin.part("entry-lost").click()
    admin.part("entry-code").fill(code)
    admin.part("entry-password").fill(NEW)
    admin.part("entry-submit").click()
    expect(admin.part("menu")).to_be_visible()


@pytest.mark.browser
def test_alone_nobody_signs_in_and_the_page_says_so(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server)
    expect(screen.part("indicators")).to_be_visible()
    screen.go("#/people")
    expect(screen.part("people-page")).to_contain_text("nobody signs in")
    expect(screen.part("who-steers")).to_have_count(0)
