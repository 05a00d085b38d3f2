"""The operator's day: draw, start, watch, hold, override, abort; what he sees is what the server knows."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect
from screen import OpenScreen, Screen
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(480)]

ENDLESS = {"expected_rmse_m": 0.1, "maximum_bearings": 200}
"""A goal that is never reached, so that a slow machine's mission does not end before the test has looked."""

# Around the suggested area as the map first shows it.
DRAWN = [(0.25, 0.2), (0.75, 0.2), (0.8, 0.75), (0.2, 0.75)]


def test_an_area_is_drawn_flown_and_the_emitter_localized(server: Server, screen: Screen) -> None:
    screen.part("new-mission").click()
    screen.map_ready("edit-map")
    screen.page.wait_for_timeout(500)
    screen.draw(DRAWN)
    expect(screen.part("area-size")).to_have_attribute("data-suggested", "false")
    screen.part("field-name").fill("Meadow behind the mill")
    screen.part("save").click()
    screen.checked()
    stored = server.get(f"/api/missions/{screen.mission_id}")
    assert stored["name"] == "Meadow behind the mill"
    assert len(stored["spec"]["area"]["coordinates"][0]) == 5

    screen.start()
    screen.map_ready()
    expect(screen.part("sweep-running")).to_be_visible(timeout=60_000)
    expect(screen.part("candidate").first).to_be_visible(timeout=60_000)
    expect(screen.part("polar-fit")).to_be_visible(timeout=60_000)
    screen.expect_phase("done", "returning", "landing", seconds=180)
    expect(screen.part("outcome")).to_be_visible(timeout=120_000)

    told = server.get(f"/api/missions/{screen.mission_id}")
    verdict = screen.part("verdict").get_attribute("data-localized")
    assert verdict == str(told["localized"]).lower()
    if told["estimate"]:
        shown = screen.part("estimate-coordinates")
        assert float(shown.get_attribute("data-lat") or "nan") == told["estimate"]["lat"]
        rmse = float(screen.part("expected-rmse").get_attribute("data-value") or "nan")
        assert rmse == told["estimate"]["expected_rmse_m"]
    look_back(screen)


def look_back(screen: Screen) -> None:
    """The mission opens again from the list, and its beliefs scrub."""
    screen.go("#/")
    screen.part("open-mission").first.click()
    screen.map_ready()
    expect(screen.part("outcome")).to_be_visible()
    last = float(screen.part("scrub").get_attribute("max") or 0)
    assert last > 0
    screen.page.locator("[data-testid=event-row][data-kind=plan_chosen]").nth(1).click()
    expect(screen.part("state-words")).to_contain_text("Review of")
    expect(screen.part("verdict")).to_have_attribute("data-localized", "false")
    screen.expect_belief(1)
    suppose_a_worse_sensor(screen)
    screen.page.locator("[data-testid=event-row][data-kind=mission_started]").click()
    expect(screen.part("outcome")).to_have_count(0)
    screen.expect_belief(0)
    screen.page.keyboard.press("l")
    expect(screen.part("outcome")).to_be_visible()
    screen.expect_belief(len(screen.page.locator("[data-kind=bearing_measured]").all()))


def suppose_a_worse_sensor(screen: Screen) -> None:
    """What would have been believed and chosen here, and back to what was."""
    flown = screen.part("expected-rmse").get_attribute("data-value")
    screen.part("what-if").locator("summary").click()
    screen.part("what-if-sigma").fill("20")
    screen.part("what-if-ask").click()
    expect(screen.part("supposed")).to_be_visible()
    expect(screen.part("what-if-steps").locator("tbody tr")).to_have_count(1)
    assert float(screen.part("expected-rmse").get_attribute("data-value") or "nan") > float(flown or "nan")
    screen.part("what-if-back").click()
    expect(screen.part("supposed")).to_have_count(0)
    expect(screen.part("expected-rmse")).to_have_attribute("data-value", flown or "")


def test_abort_is_one_tap_and_reaches_the_vehicle(server: Server, screen: Screen) -> None:
    made = server.draft(**ENDLESS)
    screen.fly(made)
    screen.expect_phase("flying")
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)
    kinds = [r["event"]["kind"] for r in server.get(f"/api/missions/{made}/events")["events"]]
    assert "abort_ordered" in kinds
    expect(screen.part("event-row").and_(screen.page.locator("[data-kind=abort_ordered]"))).to_be_visible()


def test_hold_override_and_resume(server: Server, screen: Screen) -> None:
    made = server.draft(**ENDLESS)
    screen.fly(made)
    screen.expect_phase("flying")
    screen.part("hold").click()
    screen.expect_phase("hold", seconds=30)
    screen.map_ready()

    x, y = screen.map_point(0.5, 0.5)
    screen.page.mouse.click(x, y)
    expect(screen.part("proposal")).to_have_attribute("data-allowed", "true")
    expect(screen.part("proposal-cost")).to_contain_text("Localized in about")
    before = [r["event"]["kind"] for r in server.get(f"/api/missions/{made}/events")["events"]]
    assert before.count("plan_chosen") == 1, "a click alone flies nowhere"

    screen.slide("override-slider")
    expect(screen.part("proposal")).to_have_count(0)
    chosen = [
        r["event"] for r in server.get(f"/api/missions/{made}/events")["events"] if r["event"]["kind"] == "plan_chosen"
    ]
    assert chosen[-1]["source"] == "operator"

    if screen.phase() == "hold":
        screen.part("resume").click()
        screen.slide("resume-slider")
    screen.expect_phase("flying", "measuring", seconds=40)
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)


def test_a_place_outside_the_fence_cannot_be_slid_to(server: Server, screen: Screen) -> None:
    screen.fly(server.draft(**ENDLESS))
    screen.expect_phase("flying")
    screen.part("hold").click()
    screen.expect_phase("hold", seconds=30)
    screen.map_ready()
    x, y = screen.map_point(0.02, 0.5)
    screen.page.mouse.click(x, y)
    expect(screen.part("proposal")).to_have_attribute("data-allowed", "false")
    expect(screen.part("override-slider")).to_have_count(0)
    screen.part("abort").click()


def test_a_slider_let_go_half_way_starts_nothing(server: Server, screen: Screen) -> None:
    made = server.draft(**ENDLESS)
    screen.open(made)
    screen.checked()
    screen.part("start").click()
    screen.drag_slider("start-slider", 0.6)
    screen.page.wait_for_timeout(500)
    assert server.get(f"/api/missions/{made}")["phase"] == "ready"
    screen.drag_slider("start-slider", 1.0)
    screen.expect_phase("taking_off", "planning", "flying")
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)


def test_each_place_waits_for_the_operator_when_automatic_is_off(server: Server, screen: Screen) -> None:
    screen.go("#/new")
    screen.part("field-flight-automatic").uncheck()
    screen.part("save").click()
    screen.checked()
    screen.start()
    screen.expect_phase("waiting")
    expect(screen.part("waits-for")).to_contain_text("accept")
    first = server.get(f"/api/missions/{screen.mission_id}/events")["events"]
    place = next(r["event"]["place"] for r in first if r["event"]["kind"] == "plan_chosen")
    screen.part("veto").click()
    expect(screen.page.locator("[data-testid=event-row][data-kind=plan_vetoed]")).to_be_visible()
    screen.expect_phase("waiting")
    screen.part("accept").click()
    screen.expect_phase("flying", "measuring", seconds=40)
    flown = server.get(f"/api/missions/{screen.mission_id}/events")["events"]
    target = next(r["event"]["place"] for r in flown if r["event"]["kind"] == "flight_started")
    assert target != place
    screen.part("automatic").click()
    expect(screen.part("automatic")).to_have_attribute("aria-checked", "true")
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)


def test_a_second_browser_sees_the_same(server: Server, screen: Screen, open_screen: OpenScreen) -> None:
    made = server.draft(**ENDLESS)
    screen.fly(made)
    second = open_screen(server)
    expect(second.part("mission-row")).to_have_attribute("data-mission", made)
    second.part("open-mission").click()
    for one in (screen, second):
        expect(one.part("sweep-bearing")).to_be_visible(timeout=90_000)
    screen.part("hold").click()
    second.expect_phase("hold", seconds=30)
    expect(second.part("sweep-bearing")).to_have_text(screen.part("sweep-bearing").inner_text())
    expect(second.part("expected-rmse")).to_have_text(screen.part("expected-rmse").inner_text())
    for _ in range(100):  # an event may reach one of them a moment before the other
        if second.part("event-row").count() == screen.part("event-row").count():
            break
        second.page.wait_for_timeout(100)
    assert second.part("event-row").all_inner_texts() == screen.part("event-row").all_inner_texts()
    second.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)


def test_a_reload_in_flight_shows_the_same_and_stops_nothing(server: Server, screen: Screen) -> None:
    made = server.draft(**ENDLESS)
    screen.fly(made)
    expect(screen.part("sweep-bearing")).to_be_visible(timeout=90_000)
    bearing = screen.part("sweep-bearing").get_attribute("data-value")
    screen.page.reload()
    screen.map_ready()
    expect(screen.part("sweep-bearing").first).to_be_visible()
    assert bearing is not None
    screen.part("hold").click()
    screen.expect_phase("hold", seconds=30)
    events = server.get(f"/api/missions/{made}/events")["events"]
    assert [r["event"]["kind"] for r in events].count("mission_started") == 1
    screen.part("abort").click()


def test_the_pilot_takes_over_and_keeps_control_until_resume(server: Server, screen: Screen) -> None:
    screen.fly(server.draft(**ENDLESS))
    screen.expect_phase("flying")
    server.order("pilot_mode", mode="POSCTL")
    screen.expect_phase("manual", seconds=30)
    expect(screen.part("control")).to_contain_text("pilot has control")
    screen.page.wait_for_timeout(1500)
    assert screen.phase() == "manual"
    expect(screen.part("resume")).to_be_visible()
    server.order("give_back")
    screen.part("resume").click()
    screen.slide("resume-slider")
    screen.expect_phase("planning", "flying", "measuring", seconds=40)
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)


def test_the_server_is_killed_in_flight_and_comes_back_in_hold(
    unhurried_server: Server, open_screen: OpenScreen
) -> None:
    server = unhurried_server
    screen = open_screen(server)
    made = server.draft(**ENDLESS)
    screen.fly(made)
    expect(screen.part("sweep-bearing")).to_be_visible(timeout=90_000)
    server.kill()
    expect(screen.part("state-words")).to_have_text(re.compile("No connection to the server"), timeout=20_000)
    expect(screen.part("abort")).to_be_enabled()
    server.start_again()
    screen.expect_phase("hold", seconds=60)
    expect(screen.part("sweep-bearing")).to_be_visible()
    numbers = [int(row.get_attribute("data-seq") or 0) for row in screen.part("event-row").all()]
    assert numbers == sorted(set(numbers)), "every event once, in order"
    assert server.get(f"/api/missions/{made}")["phase"] == "hold"
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning", seconds=30)
