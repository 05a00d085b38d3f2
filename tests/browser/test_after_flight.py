"""After the flight: what a season of checked missions suggests is taken over, missions are found by a rectangle, an
emitter is not found, and bearings are brought in from a file."""

from __future__ import annotations

import gzip
import json
import math
import re
from datetime import timedelta
from pathlib import Path

import httpx
import numpy as np
import pytest
from playwright.sync_api import Locator, expect
from screen import OpenScreen, Screen
from served import REPOSITORY, Server

from backend.events import BearingMeasured, BeliefUpdated, Event, PlanChosen, Recorded, TruthNoted
from backend.spec import Place
from backend.store.brought import raw_files
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM
from backend.wire.bundle import bundle
from hardware.frame import LocalFrame
from tests.browser.by_thumb import EVERY_HAND, card, touched
from tests.browser.stock import search_of_tags

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(480)]

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
ROWS = [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]]
FLOWN = to_records(STORED["mission_id"], ROWS)
PROFILE = "[data-testid=profile]"


def checked(mission_id: str, off_deg: float) -> list[Recorded]:
    """The stored flight under another id: its emitter found where the estimate was, its bearings off by this."""
    estimate = [r.event for r in FLOWN if isinstance(r.event, BeliefUpdated)][-1].estimate
    assert estimate is not None
    found = Place(lat=estimate.lat, lon=estimate.lon)

    def off(measured: BearingMeasured, own_deg: float) -> BearingMeasured:
        east, north = LocalFrame(measured.place).to_enu(found)
        true_deg = math.degrees(math.atan2(east, north))
        return measured.model_copy(update={"bearing_deg": (true_deg + off_deg + own_deg) % 360.0})

    own_deg = iter((-2.0, 0.0, 2.0))
    flown = [off(r.event, next(own_deg)) if isinstance(r.event, BearingMeasured) else r.event for r in FLOWN]
    told = TruthNoted(emitter_id="emitter-1", place=found, accuracy_m=3.0, how="map", by="anna")
    events: list[Event] = [*flown, told]
    times = [record.at_utc for record in FLOWN]
    return [
        Recorded(seq=seq, mission_id=mission_id, at_utc=at_utc, event=event)
        for seq, (event, at_utc) in enumerate(zip(events, [*times, times[-1]], strict=True), start=1)
    ]


def bring_in(server: Server, recorded: list[Recorded]) -> str:
    mission_id = recorded[0].mission_id
    content = bundle(recorded, {}, raw_files(mission_id, (), {}))
    address = server.url.rstrip("/") + "/api/bundles"
    answer = httpx.post(address, content=content, headers={"content-type": "application/zip"}, timeout=60)
    answer.raise_for_status()
    return mission_id


def row(screen: Screen, mission_id: str) -> Locator:
    return screen.page.locator(f"[data-testid=mission-row][data-mission='{mission_id}']")


@pytest.mark.long
def test_what_checked_missions_suggest_goes_into_the_equipment_and_into_the_next_mission(
    server: Server, open_screen: OpenScreen
) -> None:
    for number in range(5):
        bring_in(server, checked(f"season-{number}", 6.0))
    bring_in(server, checked("season-wrong", 90.0))
    screen = open_screen(server, "#/new")
    part = screen.part
    expect(part("area-size")).to_have_attribute("data-suggested", "true")
    screen.page.get_by_text("Keep this equipment for later").click()
    part("profile-name").fill("quad with yagi")
    part("profile-save").click()
    expect(screen.page.locator(f"{PROFILE} option")).to_have_count(2)

    screen.go("#/calibration")
    suggestion = part("suggestion")
    expect(suggestion).to_contain_text("read +6.0° ± ")
    suggested = server.get("/api/calibration")["suggested"]
    how_sharp(server, screen)
    expect(screen.page.locator(".error-outlier")).to_have_count(3)
    expect(screen.page.locator(".error-right")).to_have_count(15)
    for _ in range(2):
        part("take-over").click()
    expect(suggestion.get_by_role("status")).to_contain_text("quad with yagi")

    screen.go("#/new")
    offset = part("field-sensor-bearing_offset_deg")
    expect(offset).to_have_value("0")
    part("profile").select_option("quad with yagi")
    expect(offset).to_have_value("6")
    part("save").click()
    expect(part("preflight")).to_be_visible()
    sensor = server.get(f"/api/missions/{screen.mission_id}")["spec"]["sensor"]
    assert sensor["bearing_offset_deg"] == 6.0, "once, however often it was taken over"
    taken_over = {name: sensor[name] for name in ("sigma_deg", "outlier_probability")}
    assert taken_over == {name: suggested[name] for name in taken_over}
    assert taken_over["outlier_probability"] == 0.17
    moved = server.get(f"/api/missions/{screen.mission_id}")["spec"]["planner"]["motion"]
    assert moved == {"kind": "linear_constant"} | {name: suggested[name] for name in ("speed_m_s", "constant_s")}

    screen.go("#/new")
    part("profile").select_option("quad with yagi")
    screen.page.get_by_text("Keep this equipment for later").click()
    for _ in range(2):
        part("profile-back").click()
    expect(part("profile-back")).to_have_count(0)
    part("profile").select_option("quad with yagi")
    expect(offset).to_have_value("0")


def how_sharp(server: Server, screen: Screen) -> None:
    """Beside how often it was right stands how much was stated: of bearings, places and times."""
    events = [record.event for record in FLOWN]
    sigmas = [e.sigma_deg for e in events if isinstance(e, BearingMeasured)]
    done = next(r.at_utc for r in FLOWN if isinstance(r.event, BeliefUpdated) and r.event.localized)
    said = [
        (r.event.time_90_s, (done - r.at_utc).total_seconds())
        for r in FLOWN
        if isinstance(r.event, PlanChosen) and r.event.time_90_s is not None and r.at_utc < done
    ]
    stated, took = np.mean(said, axis=0)
    held = round(100 * sum(took <= stated for stated, took in said) / len(said))

    def minutes(seconds: float) -> str:
        return "{}:{:02d}".format(*divmod(round(seconds), 60))

    estimate = [e for e in events if isinstance(e, BeliefUpdated)][-1].estimate
    assert estimate is not None
    lines = screen.page.locator(".reliabilities tbody tr")
    shown = [line.get_by_test_id("sharpness").inner_text() for line in lines.all()]
    assert shown[0] == f"±{np.mean(sigmas):.1f}°"
    assert re.fullmatch(rf"±{estimate.expected_rmse_m:.1f}\s?m", shown[2])
    assert shown[3] == f"{minutes(stated)}; it took {minutes(took)}"
    assert lines.nth(3).locator("td").first.inner_text() == f"{held} %"
    assert server.get("/api/calibration")["forecast_90"]["of"] == 6 * len(said)


@pytest.mark.long
def test_missions_are_found_by_a_rectangle_over_them(server: Server, open_screen: OpenScreen) -> None:
    here = server.draft()
    spec = server.get(f"/api/missions/{here}")["spec"]
    ring = spec["area"]["coordinates"][0]
    spec["name"] = "further east"
    spec["area"]["coordinates"][0] = [[lon + 0.05, lat] for lon, lat in ring]
    there = httpx.post(server.url.rstrip("/") + "/api/missions", json=spec, timeout=20).json()["mission_id"]
    screen = open_screen(server)
    page, part = screen.page, screen.part
    expect(row(screen, there)).to_be_visible()
    part("library-filter").locator("summary").click()
    field = part("filter-place")
    field.scroll_into_view_if_needed()

    def drag(one: Locator) -> None:
        area, frame = one.bounding_box(), field.bounding_box()
        assert area is not None
        assert frame is not None
        page.mouse.move(area["x"] - 4, max(area["y"] - 4, frame["y"] + 1))
        page.mouse.down()
        page.mouse.move(area["x"] + area["width"] + 4, area["y"] + area["height"] + 4, steps=5)
        page.mouse.up()

    expect(row(screen, there).get_by_test_id("mini-map")).to_be_visible()
    area_there = field.locator("path").filter(has_text="further east")
    drag(area_there)
    expect(row(screen, here)).to_have_count(0)
    expect(row(screen, there)).to_be_visible()
    expect(page.locator(".place-box")).to_have_count(1)
    part("filter-clear").click()
    expect(row(screen, here)).to_be_visible()
    expect(page.locator(".place-box")).to_have_count(0)


@pytest.mark.long
def test_missions_are_found_by_date_vehicle_emitter_and_result(server: Server, open_screen: OpenScreen) -> None:
    flown = bring_in(server, checked("found-by-words", 0.0))
    spec = server.get(f"/api/missions/{server.draft()}")["spec"]
    spec["emitters"][0]["label"] = "lynx 7"
    drafted = httpx.post(server.url.rstrip("/") + "/api/missions", json=spec, timeout=20).json()["mission_id"]
    flown_on = FLOWN[0].at_utc.date()
    screen = open_screen(server)
    part = screen.part
    part("library-filter").locator("summary").click()
    for field, value, found, left_out in (
        ("until", flown_on.isoformat(), flown, drafted),
        ("since", (flown_on + timedelta(days=1)).isoformat(), drafted, flown),
        ("vehicle", "craft-1", flown, drafted),
        ("emitter", "Lynx 7", drafted, flown),
    ):
        part(f"filter-{field}").fill(value)
        expect(row(screen, left_out)).to_have_count(0)
        expect(row(screen, found)).to_be_visible()
        part("filter-clear").click()
        expect(row(screen, left_out)).to_be_visible()
    part("filter-outcome").select_option("localized")
    expect(row(screen, drafted)).to_have_count(0)
    expect(row(screen, flown)).to_be_visible()


@pytest.mark.long
def test_two_missions_are_one_report_with_an_overview(server: Server, open_screen: OpenScreen) -> None:
    first, second = (bring_in(server, checked(f"of-one-sequence-{n}", 0.0)) for n in (1, 2))
    screen = open_screen(server, f"#/report/{first}/{second}")
    expect(screen.part("report")).to_have_attribute("data-ready", "true")
    expect(screen.part("report-mission")).to_have_count(2)
    expect(screen.part("report-overview")).to_be_visible()
    for part in ("report-map", "report-truth", "report-uncertain"):
        expect(screen.part(part)).to_have_count(2)
    screen.go(f"#/compare/{first}")
    screen.part("compare-add").select_option(second)
    expect(screen.part("compare-line")).to_have_count(2)
    expect(screen.part("compare-row")).to_have_count(2)


@pytest.mark.long
def test_a_report_of_eight_tags_draws_those_of_which_anything_is_known(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    """Three of them were heard: five empty pictures would be three sheets of paper."""
    screen = open_screen(server, f"#/report/{search_of_tags(server)}")
    expect(screen.part("report")).to_have_attribute("data-ready", "true")
    expect(screen.part("report-emitter")).to_have_count(8)
    expect(screen.part("report-map")).to_have_count(3)
    for emitter, drawn in zip(screen.part("report-emitter").all(), (1, 1, 1, 0, 0, 0, 0, 0), strict=True):
        expect(emitter.get_by_test_id("report-map")).to_have_count(drawn)
    sheet = screen.page.pdf(path=tmp_path / "tags.pdf", prefer_css_page_size=True)
    assert sheet.count(b"/Type /Page\n") <= 4


@pytest.mark.long
def test_before_the_first_bearing_no_place_is_said_and_a_pointer_scrolls_nothing_away(
    server: Server, open_screen: OpenScreen
) -> None:
    screen = open_screen(server, f"#/mission/{bring_in(server, checked('looked-at', 0.0))}")
    part = screen.part
    screen.map_ready()
    expect(part("estimate-coordinates")).to_be_visible()
    screen.row("mission_started").click()
    expect(part("estimate-coordinates")).to_have_count(0)
    expect(part("sweep-bearing")).to_have_count(0)

    screen.row("plan_chosen").last.click()
    part("candidates").scroll_into_view_if_needed()
    lit = screen.page.locator(".candidates tr.lit")
    before = part("candidates").bounding_box()
    for right, down in ((0.02 * n, 0.04 * m) for m in range(5, 20) for n in range(10, 40)):
        screen.page.mouse.move(*screen.map_point(right, down))
        if lit.count() == 1:
            break
    expect(lit).to_be_in_viewport()
    after = part("candidates").bounding_box()
    assert before is not None
    assert after is not None
    within = screen.evaluate("document.querySelector('.candidate-box').scrollTop")
    assert after["y"] + within == pytest.approx(before["y"], abs=1), "only the table scrolls, not the panel"


def test_an_emitter_that_was_not_found_counts_and_a_found_place_replaces_it(
    server: Server, open_screen: OpenScreen
) -> None:
    facts = [record for record in checked("in-vain", 0.0) if not isinstance(record.event, TruthNoted)]
    mission_id = bring_in(server, facts)
    screen = open_screen(server, f"#/mission/{mission_id}")
    part = screen.part
    part("truth").locator("summary").first.click()
    part("truth-not-found").click()
    expect(part("truth-told")).to_contain_text("not found")
    expect(part("truth-error")).to_have_count(0)
    told = [e for e in server.events(mission_id) if e["kind"] == "truth_noted"]
    assert [(one["place"], one["emitter_id"]) for one in told] == [(None, "emitter-1")]
    known = server.get("/api/calibration")
    assert known["not_found"] >= 1
    assert all(fix["mission_id"] != mission_id for fix in known["fixes"]), "no error is made up for it"

    screen.page.reload()
    expect(part("truth-told")).to_contain_text("not found")
    part("truth-write").click()
    part("truth-place").fill("50.62400, 7.20400")
    part("truth-set").click()
    expect(part("truth-error")).to_be_visible()
    assert server.get("/api/calibration")["not_found"] == known["not_found"] - 1

    written = part("truth-told").inner_text()
    screen.map_ready()
    part("truth-tap").click()
    screen.page.mouse.click(*screen.map_point(0.5, 0.5))
    expect(part("truth-told")).not_to_have_text(written, use_inner_text=True)
    assert [e["how"] for e in server.events(mission_id) if e["kind"] == "truth_noted"] == ["map", "typed", "map"]


@pytest.mark.long
def test_bearings_that_were_taken_elsewhere_are_brought_in_from_a_file(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    """What a KrakenSDR wrote, and a bearing file as UAV-RT writes them: two sources, each muted on its own."""
    mission_id = server.draft()
    ring = server.get(f"/api/missions/{mission_id}")["spec"]["area"]["coordinates"][0]
    lon, lat = (sum(corner[i] for corner in ring[:4]) / 4 for i in (0, 1))

    def towards(place: list[float]) -> float:
        east = (lon - place[0]) * math.cos(math.radians(lat))
        return math.degrees(math.atan2(east, lat - place[1])) % 360.0

    kraken = tmp_path / "kraken.csv"
    kraken.write_text(
        "\n".join(
            f"{1700000000000 + 90_000 * n}, {towards(place):.1f}, 80, -31, 868300000, UCA, 412, roof,"
            f" {place[1]}, {place[0]}, 0.0, 0.0, GPS, R"
            for n, place in enumerate(ring[:3])
        )
    )
    uavrt = tmp_path / "uavrt.csv"
    rows = [(3, "rot.csv", f"{towards(place):.3f}", 0.9, place[1], place[0], 30, 130, 0, 30) for place in ring[1:3]]
    uavrt.write_text("\n".join(",".join(map(str, row)) for row in [*rows, (3, "rot.csv", "north", *rows[0][3:])]))

    screen = open_screen(server, f"#/mission/{mission_id}")
    part = screen.part
    part("recording").locator("summary").first.click()
    for path, bearings in ((kraken, 3), (uavrt, 2)):
        part("recording-files").set_input_files(path)
        part("recording-send").click()
        expect(part("recording-found").locator("ul").first.locator("li")).to_have_count(bearings)
    expect(part("recording-remarks")).to_contain_text("Line 3 of uavrt.csv")
    measured = [e for e in server.events(mission_id) if e["kind"] == "bearing_measured"]
    assert [round(e["bearing_deg"], 1) for e in measured] == [
        round(towards(place), 1) for place in (*ring[:3], *ring[1:3])
    ]
    assert len({e["source"]["recording_id"] for e in measured}) == 2
    screen.expect_belief(5)
    expect(screen.row("bearing_measured")).to_have_count(5)
    part("recording-files").set_input_files(kraken)
    part("recording-send").click()
    expect(part("recording-found")).to_contain_text("imported before")
    assert len([e for e in server.events(mission_id) if e["kind"] == "bearing_measured"]) == 5


@pytest.mark.parametrize("size", [pytest.param("laptop", marks=pytest.mark.long), *EVERY_HAND])
def test_our_own_bearing_files_are_brought_in_on_the_page(
    server: Server, open_screen: OpenScreen, size: str, tmp_path: Path
) -> None:
    """The file that a flown mission offers, and a table that somebody typed, into a search that has flown nowhere."""
    flown = bring_in(server, checked(f"file-of-{size}", 0.0))
    screen = open_screen(server, "", **touched(size))
    part = screen.part
    row(screen, flown).locator("details.export summary").click()
    with screen.page.expect_download() as taken:
        row(screen, flown).get_by_test_id("export-csv").click()
    exported = tmp_path / "flown.csv"
    taken.value.save_as(exported)
    typed = tmp_path / "typed.csv"
    typed.write_bytes(
        "\ufefflat;lon;bearing_deg;sigma_deg\r\n50,6236;7,2032;47,5;8\r\n50,6250;7,2050;nowhere;8\r\n"
        "50,6245;7,2064;231;12,5\r\n".encode()
    )
    theirs = [e for e in server.events(flown) if e["kind"] == "bearing_measured"]

    spec = server.get(f"/api/missions/{flown}")["spec"]
    here = httpx.post(server.url.rstrip("/") + "/api/missions", json=spec, timeout=20).json()["mission_id"]
    screen.open(here)
    screen.map_ready()
    card(screen, "checks")
    part("recording").locator("summary").first.click()
    for path, bearings in ((exported, len(theirs)), (typed, 2)):
        part("recording-files").set_input_files(path)
        part("recording-send").click()
        expect(part("recording-found").locator("ul").first.locator("li")).to_have_count(bearings)
    expect(part("recording-remarks")).to_contain_text("Line 3 of typed.csv")
    measured = [e for e in server.events(here) if e["kind"] == "bearing_measured"]
    ours, read = measured[: len(theirs)], measured[len(theirs) :]
    assert [(e["place"], e["bearing_deg"]) for e in ours] == [
        (
            {name: pytest.approx(value, abs=1e-7) for name, value in e["place"].items()},
            pytest.approx(e["bearing_deg"], abs=1e-5),
        )
        for e in theirs
    ]
    assert [(e["place"], e["bearing_deg"], e["sigma_deg"]) for e in read] == [
        ({"lat": 50.6236, "lon": 7.2032}, 47.5, 8.0),
        ({"lat": 50.6245, "lon": 7.2064}, 231.0, 12.5),
    ]
    expect(screen.row("bearing_measured")).to_have_count(len(measured))
    screen.expect_belief(len(measured))
