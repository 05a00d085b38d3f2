"""The operator's day, a whole mission each: draw, start, look back; decide each place; survive the server's death."""

from __future__ import annotations

import re

import httpx
import pytest
from playwright.sync_api import Route, expect
from screen import OpenScreen, Screen
from served import QUICK, Server

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(480)]

# Around the suggested area as the map first shows it.
DRAWN = [(0.25, 0.2), (0.75, 0.2), (0.8, 0.75), (0.2, 0.75)]


def test_an_area_is_drawn_flown_and_the_emitter_localized(server: Server, screen: Screen) -> None:
    screen.part("new-mission").click()
    screen.map_ready("edit-map")
    expect(screen.part("area-size")).to_have_attribute("data-suggested", "true")
    screen.draw(DRAWN)
    expect(screen.part("area-size")).to_have_attribute("data-suggested", "false")
    screen.part("field-name").fill("Meadow behind the mill")
    fly_quickly(screen)
    screen.part("save").click()
    screen.checked()
    stored = server.get(f"/api/missions/{screen.mission_id}")
    assert stored["name"] == "Meadow behind the mill"
    assert len(stored["spec"]["area"]["coordinates"][0]) == 5

    a_slider_let_go_half_way_starts_nothing(server, screen)
    screen.drag_slider("start-slider", 1.0)
    if screen.refused("problem-start"):
        screen.checked()
        screen.start()
    screen.map_ready()
    expect(screen.part("sweep-running")).to_be_visible()
    expect(screen.part("candidate").first).to_be_visible()
    expect(screen.part("polar-fit")).to_be_visible()
    screen.expect_phase("done", seconds=240)
    expect(screen.part("outcome")).to_be_visible()

    told = server.get(f"/api/missions/{screen.mission_id}")
    verdict = screen.part("verdict").get_attribute("data-localized")
    assert verdict == str(told["localized"]).lower()
    (found,) = told["found"]
    if estimate := found["estimate"]:
        shown = screen.part("estimate-coordinates")
        assert float(shown.get_attribute("data-lat") or "nan") == estimate["lat"]
        rmse = float(screen.part("expected-rmse").get_attribute("data-value") or "nan")
        assert rmse == estimate["expected_rmse_m"]
    look_back(screen)
    take_away(server, screen)


def fly_quickly(screen: Screen) -> None:
    for name, value in QUICK["flight"].items():
        screen.part(f"field-flight-{name}").fill(str(value))


def a_slider_let_go_half_way_starts_nothing(server: Server, screen: Screen) -> None:
    screen.part("start").click()
    screen.drag_slider("start-slider", 0.6)
    expect(screen.part("start-slider")).to_have_attribute("aria-valuenow", "0")
    assert server.get(f"/api/missions/{screen.mission_id}")["phase"] == "ready"


def look_back(screen: Screen) -> None:
    """The mission opens again from the list, and its beliefs scrub."""
    screen.go("#/")
    screen.part("open-mission").first.click()
    screen.map_ready()
    expect(screen.part("outcome")).to_be_visible()
    last = float(screen.part("scrub").get_attribute("max") or 0)
    assert last > 0
    screen.row("plan_chosen").nth(1).click()
    expect(screen.part("state-words")).to_contain_text("Review of")
    expect(screen.part("verdict")).to_have_attribute("data-localized", "false")
    screen.expect_belief(1)
    suppose_a_worse_sensor(screen)
    screen.row("mission_started").click()
    expect(screen.part("outcome")).to_have_count(0)
    screen.expect_belief(0)
    screen.page.keyboard.press("l")
    expect(screen.part("outcome")).to_be_visible()
    screen.expect_belief(screen.row("bearing_measured").count())


def take_away(server: Server, screen: Screen) -> None:
    """Every file that the list offers is there."""
    screen.go("#/")
    links = screen.page.locator("[data-testid=mission-row][data-phase=done]").first.locator("[data-testid^=export-]")
    expect(links).to_have_count(7)
    for link in links.all():
        address = f"{server.url.rstrip('/')}{link.get_attribute('href')}"
        assert httpx.get(address, timeout=60).status_code == 200, address


def suppose_a_worse_sensor(screen: Screen) -> None:
    """What would have been believed and chosen here, and back to what was."""
    flown = screen.part("expected-rmse").get_attribute("data-value")
    screen.part("what-if").locator("summary").click()
    screen.part("what-if-sigma").fill("60")
    screen.part("what-if-ask").click()
    expect(screen.part("supposed")).to_be_visible()
    expect(screen.part("what-if-steps").locator("tbody tr")).to_have_count(1)
    assert float(screen.part("expected-rmse").get_attribute("data-value") or "nan") > float(flown or "nan")
    screen.part("what-if-mounting").fill("25")
    screen.part("what-if-ask").click()
    expect(screen.part("what-if-antenna")).to_contain_text("25° right of the nose")
    screen.part("what-if-back").click()
    expect(screen.part("supposed")).to_have_count(0)
    expect(screen.part("expected-rmse")).to_have_attribute("data-value", flown or "")


def test_each_place_waits_for_the_operator_until_they_abort(server: Server, screen: Screen) -> None:
    screen.go("#/new")
    screen.part("field-flight-automatic").uncheck()
    fly_quickly(screen)
    screen.part("save").click()
    screen.checked()
    screen.start()
    screen.expect_phase("waiting")
    expect(screen.part("waits-for")).to_contain_text("accept")
    place = next(e["place"] for e in server.events(screen.mission_id) if e["kind"] == "plan_chosen")
    screen.part("veto").click()
    expect(screen.row("plan_vetoed")).to_be_visible()
    screen.expect_phase("waiting")
    screen.part("accept").click()
    screen.expect_phase("flying", "measuring")
    target = next(e["place"] for e in server.events(screen.mission_id) if e["kind"] == "flight_started")
    assert target != place
    screen.part("automatic").click()
    expect(screen.part("automatic")).to_have_attribute("aria-checked", "true")

    screen.part("abort").click()
    screen.expect_phase("aborted", "returning")
    expect(screen.row("abort_ordered")).to_be_visible()
    assert "abort_ordered" in [e["kind"] for e in server.events(screen.mission_id)]


def test_the_server_is_killed_in_flight_and_comes_back_in_hold(
    unhurried_server: Server, open_screen: OpenScreen
) -> None:
    server = unhurried_server
    screen = open_screen(server)
    made = server.draft(expected_rmse_m=0.1, maximum_bearings=200)
    screen.fly(made)
    expect(screen.part("sweep-bearing")).to_be_visible(timeout=120_000)
    server.kill()
    expect(screen.part("state-words")).to_have_text(re.compile("No connection to the server"))
    expect(screen.part("abort")).to_be_enabled()
    server.start_again()
    screen.expect_phase("hold")
    expect(screen.part("sweep-bearing")).to_be_visible()
    numbers = [int(row.get_attribute("data-seq") or 0) for row in screen.part("event-row").all()]
    assert numbers == sorted(set(numbers)), "every event once, in order"
    assert server.get(f"/api/missions/{made}")["phase"] == "hold"
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning")


def test_the_last_order_counts_when_the_link_comes_back(server: Server, screen: Screen) -> None:
    made = server.draft(expected_rmse_m=0.1, maximum_bearings=200)
    screen.fly(made)
    lost = list[Route]()

    def lose(route: Route) -> None:
        lost.append(route)
        route.abort()

    screen.page.route("**/commands", lose)
    screen.part("return").click()
    screen.part("hold").click()
    screen.page.wait_for_timeout(1500)
    assert len(lost) > 2
    screen.page.unroute("**/commands", lose)
    screen.expect_phase("hold")
    screen.page.wait_for_timeout(2000)
    ordered = [e["reason"].get("order") for e in server.events(made) if e["kind"] == "phase_changed"]
    assert ordered[-1] == "hold"
    assert "return" not in ordered
    it_counts_against_a_resume_that_comes_late(server, screen, made)


def it_counts_against_a_resume_that_comes_late(server: Server, screen: Screen, made: str) -> None:
    late = list[Route]()

    def delay(route: Route) -> None:
        if (route.request.post_data_json or {})["command"]["kind"] == "resume":
            late.append(route)
        else:
            route.continue_()

    screen.page.route("**/commands", delay)
    screen.offer_resume()
    with screen.page.expect_request("**/commands"):
        screen.slide("resume-slider")
    with screen.page.expect_response("**/commands"):
        screen.part("hold").click()
    with screen.page.expect_response("**/commands") as answered:
        late[0].continue_()
    assert answered.value.json()["reason"] == {"code": "later_order_counts"}
    screen.page.wait_for_timeout(2000)
    screen.expect_phase("hold")
    assert "resume_ordered" not in [e["kind"] for e in server.events(made)]
    screen.page.unroute("**/commands", delay)
    it_goes_out_at_once_when_it_is_pressed_again(screen)


def it_goes_out_at_once_when_it_is_pressed_again(screen: Screen) -> None:
    hung = list[Route]()
    screen.page.route("**/commands", lambda route: hung.append(route), times=1)
    screen.part("abort").click()
    screen.page.wait_for_timeout(1000)
    assert len(hung) == 1
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning")
    hung[0].abort()
