"""Everything that is to be found: eight tags in one search, an animal that walks, and a search on foot around a river.

The simulation goes faster than in the other stories: turns that wait for pulses take most of their time.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import serving
from legible import serious
from playwright.sync_api import Page, Position, expect
from screen import AIM_MAP, OpenScreen, Screen
from served import Server

from tests.browser.sweep import faults

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(480)]

TAGS = [f"150.{number}" for number in range(1, 9)]
PERIOD_S = 1.3
WALKER = "151.5"
SPEEDUP = 5.0
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}
METRES = 111_320.0


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    world = [*(f"{tag}/{PERIOD_S}" for tag in TAGS), f"{WALKER},animal:0.4"]
    with serving(tmp_path_factory.mktemp("served"), SPEEDUP, world) as made:
        yield made


def test_two_tags_at_one_frequency_are_asked_for_by_their_periods(server: Server, screen: Screen) -> None:
    screen.go(f"#/new/{server.draft({})}")
    screen.part("field-emitters-0-kind").select_option("pulsed")
    listed = screen.part("emitter-list")
    listed.fill("150.1/1.3 vixen\n150.1/1.28 cub")
    listed.blur()
    expect(screen.part("emitter-list-bad")).to_have_count(0)
    expect(screen.part("field-emitters-0-pulse_jitter_s")).to_have_value("0.03")
    screen.part("save").click()
    expect(screen.part("edit-problem")).to_contain_text("0.060")
    listed.fill("150.1/1.3 vixen\n150.1/1.05 cub")
    listed.blur()
    screen.part("field-receiver-band").select_option("25")
    expect(screen.part("emitter-count")).to_contain_text("one after another")
    screen.part("save").click()
    screen.checked()


def test_eight_tags_are_planned_flown_found_one_by_one_and_reported(server: Server, screen: Screen) -> None:
    alone = {"bearing_errors": "independent", "shared_errors": False, "pulses_per_heading": 1}
    screen.go(f"#/new/{server.draft(alone, expected_rmse_m=12.0, minimum_crossing_angle_deg=0)}")
    screen.part("field-emitters-0-kind").select_option("pulsed")
    screen.part("emitter-list").fill("\n".join(f"{tag} hare {number}" for number, tag in enumerate(TAGS, 1)))
    screen.part("emitter-list").blur()
    expect(screen.part("emitter-list-bad")).to_have_count(0)
    expect(screen.part("emitter-count")).to_contain_text("8")
    screen.part("save").click()
    screen.checked()
    screen.start()
    expect(screen.part("emitters")).to_have_attribute("data-found", "8", timeout=300_000)
    screen.expect_phase("done")

    found = found_after(server.events(screen.mission_id))
    assert len(found) == 8
    assert len(set(found.values())) > 1, "one by one, not all at once"
    screen.go(f"#/report/{screen.mission_id}")
    expect(screen.part("report")).to_have_attribute("data-ready", "true")
    expect(screen.part("report-emitter")).to_have_count(8)
    for number, lead in enumerate(screen.part("report-lead").all(), 1):
        expect(lead).to_contain_text("It is at")
        expect(screen.part("report-emitter").nth(number - 1).locator("h2")).to_contain_text(f"hare {number}")


def found_after(told: list[dict]) -> dict[str, int]:
    """By emitter, how many turns it took until it was localized."""
    found: dict[str, int] = {}
    turns = 0
    for event in told:
        turns += event["kind"] == "sweep_started"
        if event["kind"] == "belief_updated" and event["localized"]:
            found.setdefault(event["emitter_id"], turns)
    return found


def test_the_tag_that_is_set_first_is_flown_for_and_found_first_and_the_order_changes_in_flight(
    server: Server, screen: Screen
) -> None:
    server.order("battery", percent=100)
    alone = {"bearing_errors": "independent", "shared_errors": False, "pulses_per_heading": 1}
    screen.go(f"#/new/{server.draft(alone, expected_rmse_m=12.0, minimum_crossing_angle_deg=0)}")
    screen.part("field-emitters-0-kind").select_option("pulsed")
    lines = [f"{tag} hare {number}" for number, tag in enumerate(TAGS, 1)]
    screen.part("emitter-list").fill("\n".join([*lines[:6], f"{lines[6]} !0", lines[7]]))
    screen.part("emitter-list").blur()
    expect(screen.part("emitter-list-bad")).to_contain_text("from 1 (first) to 32")
    screen.part("emitter-list").fill("\n".join([*lines[:6], f"{lines[6]} !1", lines[7]]))
    screen.part("emitter-list").blur()
    expect(screen.part("emitter-list-bad")).to_have_count(0)
    expect(screen.part("emitter-order").locator("summary")).to_contain_text("hare 7, then the others")
    screen.part("save").click()
    screen.checked()
    screen.start()
    first = next(
        emitter["emitter_id"]
        for emitter in server.get(f"/api/missions/{screen.mission_id}")["spec"]["emitters"]
        if emitter["label"] == "hare 7"
    )
    expect(screen.part(f"place-{first}")).to_have_text("first")
    expect(screen.part("why")).to_contain_text("For hare 7 first", timeout=60_000)
    expect(screen.part(f"left-{first}")).to_be_visible()
    expect(screen.part(f"emitter-{first}")).to_have_attribute("data-localized", "true", timeout=240_000)

    others = [name for name in found_ids(server, screen) if name != first]
    open_still = [name for name in others if screen.part(f"emitter-{name}").get_attribute("data-localized") == "false"]
    assert open_still, "what comes first is found before the last"
    second = open_still[-1]
    screen.part("order").focus()
    screen.page.keyboard.press("Enter")
    assert_legible(screen)
    screen.part(f"first-{second}").focus()
    screen.page.keyboard.press("Enter")
    expect(screen.part(f"place-{second}")).to_have_text("first")
    expect(screen.part(f"place-{first}")).to_have_text("no. 2")
    expect(screen.row("priorities_changed")).to_contain_text("then hare 7")
    screen.part(f"later-{second}").click()
    expect(screen.part(f"place-{second}")).to_have_text("first")
    expect(screen.part(f"place-{first}")).to_have_text("first")
    expect(screen.part("emitters")).to_have_attribute("data-found", "8", timeout=300_000)
    screen.expect_phase("done")
    found = found_after(server.events(screen.mission_id))
    assert found[first] <= sorted(found.values())[3], "among the first half, wherever it stands"
    assert found[first] < max(found.values())
    screen.go(f"#/report/{screen.mission_id}")
    expect(screen.part("report")).to_have_attribute("data-ready", "true")
    expect(screen.part("report-order").nth(6)).to_contain_text("no. 1")
    expect(screen.part("report-order").nth(6)).to_contain_text("after the start")


def assert_legible(screen: Screen) -> None:
    """On three devices, in both themes; the screen is left as it was."""
    usual = screen.page.viewport_size
    assert usual is not None
    assert serious(screen.page) == []
    for width, height in ((390, 844), (820, 1180), (1280, 800)):
        screen.page.set_viewport_size({"width": width, "height": height})
        screen.page.wait_for_timeout(300)
        assert faults(screen.page) == [], f"{width} pixels wide"
        bar = screen.part("state-words").bounding_box()
        assert bar is None or bar["width"] > 60.0, "what it does has room for its words"
    screen.page.set_viewport_size(usual)


def found_ids(server: Server, screen: Screen) -> list[str]:
    return [one["emitter_id"] for one in server.get(f"/api/missions/{screen.mission_id}")["spec"]["emitters"]]


def test_an_animal_that_walks_is_localized_at_a_time_and_followed_on(server: Server, screen: Screen) -> None:
    server.order("battery", percent=100)
    screen.go(f"#/new/{server.draft(expected_rmse_m=30.0)}")
    screen.part("field-emitters-0-frequency_hz").fill(WALKER)
    screen.part("field-emitters-0-movement").select_option("animal")
    screen.part("field-emitters-0-movement-speed_m_s").fill("0.4")
    screen.part("field-localization-follow").check()
    screen.part("save").click()
    screen.checked()
    screen.start()
    claim = screen.part("claim")
    expect(claim).to_be_visible(timeout=240_000)
    expect(claim).to_contain_text("by now")
    assert worth(claim.get_attribute("data-now")) >= worth(claim.get_attribute("data-then"))
    heard = screen.row("bearing_measured").count()
    expect(screen.row("bearing_measured").nth(heard)).to_be_visible(timeout=90_000)
    assert "mission_ended" not in [event["kind"] for event in server.events(screen.mission_id)], "it is followed"
    screen.part("abort").click()
    screen.expect_phase("aborted", "returning")


def worth(value: str | None) -> float:
    return float(value or "nan")


class Walker:
    """Somebody on foot with a phone, who knows where the emitter stands: in the middle of the area."""

    def __init__(self, server: Server, mission: str, page: Page) -> None:
        self.page = page
        ring = server.get(f"/api/missions/{mission}")["spec"]["area"]["coordinates"][0]
        self.lon, self.lat = (sum(corner[i] for corner in ring[:4]) / 4 for i in (0, 1))
        self.east = math.cos(math.radians(self.lat))

    def at(self, east: float, north: float) -> tuple[float, float]:
        """Metres from the emitter as lon, lat."""
        return self.lon + east / METRES / self.east, self.lat + north / METRES

    def asks(self) -> dict:
        with self.page.expect_response("**/advice") as answered:
            self.page.get_by_test_id("advice-walking").click()
        assert answered.value.status == 200, answered.value.text()
        return answered.value.json()

    def goes_and_hears(self, place: dict[str, float]) -> None:
        """To the place that the map shows, and types there what the antenna tells."""
        self.page.get_by_test_id("report-mode-here").click()
        ring = self.page.locator(".aim-advised").bounding_box()
        chart = self.page.get_by_test_id("aim-map").bounding_box()
        assert ring is not None
        assert chart is not None
        middle: Position = {
            "x": ring["x"] - chart["x"] + ring["width"] / 2,
            "y": ring["y"] - chart["y"] + ring["height"] / 2,
        }
        self.page.locator(AIM_MAP).click(position=middle)
        bearing = math.degrees(math.atan2((self.lon - place["lon"]) * self.east, self.lat - place["lat"])) % 360.0
        self.page.get_by_test_id("report-direction").fill(f"{bearing:.0f}")
        self.page.get_by_test_id("report-direction").blur()
        self.page.get_by_test_id("report-sharp").click()
        self.page.get_by_test_id("report-send").click()
        expect(self.page.locator("[data-testid=report-sent] li").first).to_have_attribute("data-stage", "sent")


def ground(walker: Walker, *, bridge: bool) -> str:
    """A river all along the area's south, and perhaps a bridge over it."""
    corners = [walker.at(east, north) for east, north in ((-9000, -125), (9000, -125), (9000, -115), (-9000, -115))]
    river = {"type": "Polygon", "coordinates": [[*corners, corners[0]]]}
    way = {"type": "LineString", "coordinates": [walker.at(60.0, -160.0), walker.at(60.0, -80.0)]}
    parts = [("barrier", river)] + ([("path", way)] if bridge else [])
    features = [{"type": "Feature", "properties": {"kind": kind}, "geometry": shape} for kind, shape in parts]
    return json.dumps({"type": "FeatureCollection", "features": features})


def upload(page: Page, path: Path, text: str) -> None:
    path.write_text(text)
    page.get_by_test_id("ways-upload").set_input_files(path)


def test_a_search_on_foot_is_advised_over_the_bridge_until_it_is_localized(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    mission = server.draft(expected_rmse_m=20.0)
    page = open_screen(server, f"#/mission/{mission}/bearings", **PHONE).page
    part = page.get_by_test_id
    part("report-name").fill("Ada")
    walker = Walker(server, mission, page)
    part("ways").locator("summary").click()
    expect(part("ways-known")).to_contain_text("straight lines")
    upload(page, tmp_path / "empty.geojson", "")
    expect(part("ways-problem")).to_contain_text("is empty")
    upload(page, tmp_path / "river.geojson", ground(walker, bridge=False))
    expect(part("ways-known")).to_contain_text("barriers: 1")
    chart = part("aim-map").bounding_box()
    assert chart is not None
    south: Position = {"x": chart["width"] / 2, "y": chart["height"] - 4}
    walker.page.locator(AIM_MAP).click(position=south)
    told = walker.asks()
    assert told["unreached"] > 0, "the other shore"
    expect(part("advice-unreached")).to_contain_text("No way leads to")

    upload(page, tmp_path / "bridge.geojson", ground(walker, bridge=True))
    expect(part("ways-known")).to_contain_text("m of paths")
    expect(part("advice-said")).to_have_count(0)
    for _ in range(10):
        told = walker.asks()
        if told["localized"]:
            break
        assert told["along"] == "around"
        expect(part("advice-said")).to_have_attribute("data-state", "holds")
        expect(part("aim-way")).to_be_visible()
        walker.goes_and_hears(told["place"])
        expect(part("advice-said")).to_have_attribute("data-state", "outrun")
    expect(part("advice-done")).to_be_visible()
    said = [one for one in server.events(mission) if one["kind"] == "bearing_measured"]
    assert {one["source"]["name"] for one in said} == {"Ada"}
