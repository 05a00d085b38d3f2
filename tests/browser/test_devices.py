"""With a thumb: what is done after a flight and beside one, on a tablet and on a phone that has only touches."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from playwright.sync_api import expect
from screen import OpenScreen
from served import Server

from backend.events import BeliefUpdated, Recorded, SafetyVetoed
from backend.reasons.safety import PilotControls
from tests.browser.by_thumb import EVERY_HAND, card, slide, touched
from tests.browser.sweep import SIZES, TOO_WIDE
from tests.browser.test_after_flight import FLOWN, bring_in, checked, row

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(900)]

ANSWERED_MS = 180_000
"""The first forecast of a server waits until what it needs is compiled, where nobody did that before."""


def vetoed(flown: list[Recorded]) -> list[Recorded]:
    """The same flight, with a place that was not taken half way."""
    half = len(flown) // 2
    veto = flown[half].model_copy(update={"event": SafetyVetoed(craft_id="craft-1", reason=PilotControls())})
    told = [*flown[:half], veto, *flown[half:]]
    return [record.model_copy(update={"seq": seq}) for seq, record in enumerate(told, start=1)]


@pytest.mark.long
@pytest.mark.parametrize("size", EVERY_HAND)
def test_a_flight_is_looked_for_labelled_and_told_about_with_a_thumb(
    server: Server, open_screen: OpenScreen, size: str, tmp_path: Path
) -> None:
    mission = bring_in(server, checked(f"by-thumb-{size}", 0.0)[:-1])
    other = bring_in(server, checked(f"another-{size}", 0.0)[:-1])
    screen = open_screen(server, "", **touched(size))
    part, page = screen.part, screen.page
    found = row(screen, mission)
    found.get_by_test_id("label-mission").tap()
    part("label-name").fill(f"Owls, {size}")
    part("label-tags").fill(f"owls-{size}")
    part("label-notes").fill("fed at dusk")
    part("label-save").tap()
    expect(found).to_contain_text("fed at dusk")
    page.get_by_role("searchbox").fill(f"owls-{size}")
    expect(row(screen, other)).to_have_count(0)
    expect(found.get_by_test_id("mini-map")).to_be_visible()
    found.get_by_test_id("label-mission").tap()
    part("delete-mission").tap()
    expect(found).to_have_count(0)
    part("library-filter").locator("summary").tap()
    part("filter-deleted").check()
    found.get_by_test_id("label-mission").tap()
    part("restore-mission").tap()
    expect(found).to_have_count(0)
    part("filter-clear").tap()
    assert not screen.evaluate(TOO_WIDE)
    found.get_by_test_id("open-mission").tap()
    page.wait_for_url(f"**#/mission/{mission}")

    screen.map_ready()
    card(screen, "truth")
    if not part("truth-not-found").is_visible():  # where it has no card of its own
        part("truth").locator("summary").first.tap()
    part("truth-not-found").tap()
    expect(part("truth-told")).to_contain_text("not found")
    part("truth-write").tap()
    part("truth-place").fill("50.62400, 7.20400")
    part("truth-set").tap()
    expect(part("truth-error")).to_be_visible()
    written = part("truth-told").inner_text()
    part("truth-tap").tap()
    part("map").scroll_into_view_if_needed()
    page.touchscreen.tap(*screen.map_point(0.5, 0.5))
    card(screen, "truth")
    expect(part("truth-told")).not_to_have_text(written, use_inner_text=True)
    how = [event["how"] for event in server.events(mission) if event["kind"] == "truth_noted"]
    assert how == ["map", "typed", "map"]
    page.screenshot(path=tmp_path / "told.png")


@pytest.mark.long
@pytest.mark.parametrize("size", EVERY_HAND)
def test_a_flight_is_replayed_supposed_compared_and_printed_with_a_thumb(
    server: Server, open_screen: OpenScreen, size: str, tmp_path: Path
) -> None:
    mission = bring_in(server, vetoed(checked(f"replayed-{size}", 0.0)))
    screen = open_screen(server, f"#/mission/{mission}", **touched(size))
    part, page = screen.part, screen.page
    screen.map_ready()
    beliefs = [r.event for r in FLOWN if isinstance(r.event, BeliefUpdated) and r.event.bearings > 0]
    for count, believed in enumerate(beliefs, start=1):
        card(screen, "events")
        screen.row("bearing_measured").nth(count - 1).tap()
        screen.expect_belief(count)
        card(screen, "estimate")
        assert believed.estimate is not None
        stated = str(believed.estimate.expected_rmse_m)
        expect(part("expected-rmse")).to_have_attribute("data-value", stated)
    card(screen, "events")
    strip = part("scrub").bounding_box()
    assert strip is not None
    page.touchscreen.tap(strip["x"] + 2, strip["y"] + strip["height"] / 2)
    expect(part("go-live")).to_have_attribute("data-live", "false")
    screen.expect_belief(0)
    current = page.locator("li[aria-current=true] [data-testid=event-row]")
    for kind, shown in (("decision", "plan_chosen"), ("bearing", "bearing_measured"), ("alert", "safety_vetoed")):
        part("jump").select_option(kind)
        expect(current).to_have_attribute("data-kind", shown)
        expect(current).to_be_in_viewport()
    part("pace").select_option("50")
    part("play").tap()
    expect(current).to_have_attribute("data-kind", "truth_noted")  # told when it was over

    screen.row("bearing_measured").last.tap()
    card(screen, "plan")
    part("what-if").locator("summary").tap()
    part("what-if-sigma").fill("14")
    part("what-if-ask").tap()
    expect(part("what-if-steps")).to_be_visible()
    part("variant-name").fill("a duller ear")
    part("keep-variant").tap()
    expect(page.get_by_text("Kept as “a duller ear”")).to_be_visible()
    part("open-compare").tap()
    expect(part("compare-row")).to_have_count(2)
    expect(part("compare-line")).to_have_count(2)
    assert not screen.evaluate(TOO_WIDE)
    part("drop-variant").tap()
    expect(part("compare-row")).to_have_count(1)
    screen.go(f"#/report/{mission}")
    expect(part("report")).to_have_attribute("data-ready", "true")
    for piece in ("report-map", "report-lead", "report-truth", "report-uncertain"):
        expect(part(piece).first).to_be_visible()
    assert not screen.evaluate(TOO_WIDE)
    screen.go("#/calibration")
    expect(part("reliability").first).not_to_have_attribute("data-of", "0")
    expect(page.locator(".error-right").first).to_be_visible()
    assert not screen.evaluate(TOO_WIDE)


@pytest.mark.parametrize("size", EVERY_HAND)
def test_a_flight_is_held_sent_elsewhere_and_resumed_with_a_thumb(
    server: Server, open_screen: OpenScreen, size: str
) -> None:
    mission = server.draft(expected_rmse_m=4.0, maximum_bearings=200)
    screen = open_screen(server, f"#/mission/{mission}", **touched(size))
    part, page = screen.part, screen.page
    screen.checked()
    part("start").tap()
    slide(screen, "start-slider")
    while screen.refused("problem-start"):
        screen.checked()
        part("start").tap()
        slide(screen, "start-slider")
    screen.expect_phase("flying", "measuring")
    part("hold").tap()
    screen.expect_phase("hold")
    expect(part("control")).to_have_text("Crossfix has control")

    screen.map_ready()
    part("map").scroll_into_view_if_needed()
    page.touchscreen.tap(*screen.map_point(0.5, 0.55))
    expect(part("proposal")).to_have_attribute("data-allowed", "true", timeout=ANSWERED_MS)
    expect(part("proposal-compared")).to_contain_text(
        re.compile("(longer than|quicker than|as quick as) the planner's place")
    )
    assert ("quicker than" in part("proposal-compared").inner_text()) == (part("proposal-rule").count() > 0)
    assert not screen.evaluate(TOO_WIDE)
    slide(screen, "override-slider")
    expect(part("proposal")).to_have_count(0)
    chosen = [event for event in server.events(mission) if event["kind"] == "plan_chosen"]
    assert chosen[-1]["source"] == "operator"
    screen.offer_resume()
    slide(screen, "resume-slider")
    while screen.refused("problem-bar"):
        screen.offer_resume()
        slide(screen, "resume-slider")
    screen.expect_phase("planning", "flying", "measuring")
    card(screen, "estimate")
    expect(part("time-left")).to_be_visible()
    width, height = SIZES[size]
    page.set_viewport_size({"width": height, "height": width})
    for order in ("abort", "hold", "return"):
        expect(part(order)).to_be_in_viewport(ratio=1)
    assert not screen.evaluate(TOO_WIDE)
    box = part("map").bounding_box()
    assert box is not None
    assert box["height"] > 0.35 * width, "turned on its side, the screen still shows where it is"
    part("abort").tap()
    screen.expect_phase("returning", "landing", "aborted")
    until = time.monotonic() + 180
    while server.get("/api/vehicle")["in_air"]:
        assert time.monotonic() < until, "the vehicle is still in the air"
        time.sleep(0.5)
