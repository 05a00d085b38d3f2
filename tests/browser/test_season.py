"""After the flight: a mission brought in from elsewhere, found again, compared, printed, checked on a phone; and the
page without its server."""

from __future__ import annotations

import gzip
import io
import json
import re
import zipfile
from pathlib import Path
from typing import Any

import pytest
from conftest import serving
from legible import serious
from playwright.sync_api import Page, expect
from recorded_turn import BESIDE
from screen import OpenScreen, Screen
from served import REPOSITORY, Server

from backend.store.brought import raw_files
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM
from backend.wire.bundle import bundle
from hardware.direction_finding.pattern_file import pattern_json

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(300)]

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
ID = STORED["mission_id"]
FLOWN = to_records(ID, [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]])
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}
SIZES = {"desktop": (1280, 800), "tablet": (1024, 768), "phone": (390, 844)}


def look(page: Page, name: str, folder: Path) -> None:
    """No fault that axe calls serious in either theme, nothing wider than the screen; a picture of each size."""
    assert serious(page) == [], name
    for theme in ("indoor", "outdoor"):
        page.evaluate(f"document.documentElement.dataset.theme = '{theme}'")
        for size, (width, height) in SIZES.items():
            page.set_viewport_size({"width": width, "height": height})
            page.screenshot(path=folder / f"{name}-{theme}-{size}.png")
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), f"{name}, {size}: too wide"
    page.set_viewport_size({"width": 1280, "height": 800})


def brought_in(screen: Screen, folder: Path) -> None:
    """By the button of the library."""
    path = folder / "mission.zip"
    path.write_bytes(bundle(FLOWN, {}, raw_files(ID, (), {})))
    screen.part("bring-in").set_input_files(path)
    screen.page.wait_for_url(f"**#/mission/{ID}")


@pytest.mark.long
def test_a_mission_from_elsewhere_is_found_compared_and_printed(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    screen = open_screen(server)
    page, part = screen.page, screen.part
    hostile = tmp_path / "hostile.zip"
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("../../evil.sh", "#!/bin/sh")
    hostile.write_bytes(stream.getvalue())
    part("bring-in").set_input_files(hostile)
    expect(page.get_by_text("Crossfix writes no such file into a bundle: ../../evil.sh")).to_be_visible()
    brought_in(screen, tmp_path)
    assert len(server.events(ID)) == len(FLOWN) + 1

    # kept beside the mission, under a name
    page.locator("[data-testid=event-row][data-kind=bearing_measured]").last.click()
    part("what-if").locator("summary").click()
    part("what-if-without").locator("input").first.check()
    part("what-if-sigma").fill("14")
    part("variant-name").fill("blunter, without the first")
    part("keep-variant").click()
    everything_else_is_asked(screen, tmp_path)
    expect(page.get_by_text("The mission stays as it was flown.")).to_be_visible()
    part("open-compare").click()
    expect(part("compare-row")).to_have_count(2)
    expect(part("compare-line")).to_have_count(2)
    bearings = [int(row.locator("td").first.inner_text()) for row in part("compare-row").all()]
    assert bearings[1] == bearings[0] - 1
    look(page, "compare", tmp_path)
    part("drop-variant").click()
    expect(part("compare-row")).to_have_count(1)

    # labelled, found by its tag, deleted, brought back
    screen.go("#/")
    row = page.locator(f"[data-mission='{ID}']")
    row.get_by_test_id("label-mission").click()
    part("label-name").fill("Owls by the river")
    part("label-tags").fill("night, owls")
    part("label-notes").fill("Two of them, fed at dusk")
    part("label-save").click()
    expect(row).to_contain_text("fed at dusk")
    page.get_by_role("searchbox").fill("nobody's")
    expect(page.get_by_test_id("mission-row")).to_have_count(0)
    page.get_by_role("searchbox").fill("owls")
    expect(page.get_by_test_id("mission-row")).to_have_count(1)
    expect(row).to_contain_text("Owls by the river")
    look(page, "library", tmp_path)
    row.get_by_test_id("label-mission").click()
    part("delete-mission").click()
    expect(row).to_have_count(0)
    part("library-filter").locator("summary").click()
    part("filter-deleted").check()
    row.get_by_test_id("label-mission").click()
    part("restore-mission").click()
    expect(row).to_have_count(0)
    part("filter-clear").click()
    expect(row).to_be_visible()

    # printed
    screen.go(f"#/report/{ID}")
    expect(part("report")).to_have_attribute("data-ready", "true")
    expect(part("report-lead").first).to_be_visible()
    look(page, "report", tmp_path)
    expect(page.get_by_text("Variant “blunter")).to_have_count(0)
    for language in ("en", "de"):
        printed = open_screen(server, f"#/report/{ID}", {"language": language, "theme": "indoor"})
        expect(printed.part("report")).to_have_attribute("data-ready", "true")
        expect(printed.part("report-lead").first).to_contain_text("It is at" if language == "en" else "Er ist bei")
        sheet = printed.page.pdf(path=tmp_path / f"report-{language}.pdf", prefer_css_page_size=True)
        assert sheet.startswith(b"%PDF")
        assert sheet.count(b"/Type /Page\n") == 1, "a flight of three bearings is one sheet"


@pytest.mark.long
def test_variants_are_kept_by_name_and_the_original_stays_as_it_was_flown(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    facts = said_of(server, open_screen, tmp_path)
    flown = server.get(f"/api/missions/{ID}/courses")["courses"][0]
    screen = open_screen(server, f"#/mission/{ID}")
    page, part = screen.page, screen.part
    screen.row("bearing_measured").last.click()
    stated = part("expected-rmse").get_attribute("data-value")
    part("what-if").locator("summary").click()
    for name, sigma in (("a duller ear", "14"), ("a sharper ear", "2")):
        part("what-if-sigma").fill(sigma)
        part("variant-name").fill(name)
        part("keep-variant").click()
        expect(page.get_by_text(f"Kept as “{name}”")).to_be_visible()
    expect(part("expected-rmse")).to_have_attribute("data-value", stated or "")

    part("open-compare").click()
    rows = part("compare-row")
    expect(rows.locator("th")).to_have_text(["As it was flown", "a duller ear", "a sharper ear"])
    expect(page.locator(".compare-legend li")).to_have_text(["As it was flown", "a duller ear", "a sharper ear"])
    error = [float(re.findall(r"±([\d.]+)", row.inner_text())[0]) for row in rows.all()]
    assert error[2] < error[0] < error[1]
    original = rows.first.inner_text()
    kept = server.get(f"/api/missions/{ID}/courses")["courses"]
    assert [one["name"] for one in kept] == [None, "a duller ear", "a sharper ear"]
    assert kept[0] == flown
    page.reload()
    expect(rows).to_have_count(3)
    page.locator("[data-variant='a duller ear']").get_by_test_id("drop-variant").click()
    expect(rows.locator("th")).to_have_text(["As it was flown", "a sharper ear"])
    assert rows.first.inner_text() == original
    expect(rows.first.get_by_test_id("drop-variant")).to_have_count(0)
    beside = {"variant_kept", "variant_dropped"}
    assert [fact for fact in server.events(ID) if fact["kind"] not in beside] == [
        fact for fact in facts if fact["kind"] not in beside
    ]


def everything_else_is_asked(screen: Screen, folder: Path) -> None:
    """Outlier model, estimator, planner, budget and pattern of a what-if reach the server, and it answers."""
    part = screen.part
    pattern = folder / "beside.json"
    pattern.write_text(pattern_json(BESIDE))
    part("what-if-outliers").fill("20")
    part("what-if-errors").select_option("joint")
    part("what-if-estimator").select_option("geometric_median")
    part("what-if-planner").select_option("fisher")
    part("what-if-budget").fill("200")
    part("what-if-pattern").set_input_files(pattern)
    with screen.page.expect_response("**/what-if") as answered:
        part("what-if-ask").click()
    asked = answered.value.request.post_data_json
    wanted = {"outlier_probability": 0.2, "bearing_errors": "joint", "estimator": "geometric_median", "budget": 200}
    assert asked is not None
    assert {name: asked[name] for name in wanted} == wanted
    assert (asked["base_policy"], asked["pattern"]["filename"]) == ("fisher", "beside.json")
    assert answered.value.json()["reason"]["code"] == "samples_not_stored", "the flight came without its powers"


@pytest.mark.long
def test_found_here_from_a_phone_is_in_the_calibration(server: Server, open_screen: OpenScreen, tmp_path: Path) -> None:
    estimate = next(
        e["estimate"] for e in reversed(said_of(server, open_screen, tmp_path)) if e["kind"] == "belief_updated"
    )
    here = {"latitude": estimate["lat"], "longitude": estimate["lon"], "accuracy": 5}
    phone = open_screen(server, f"#/mission/{ID}", geolocation=here, permissions=["geolocation"], **PHONE)
    phone.part("card-truth").click()
    phone.part("truth-here").click()
    expect(phone.part("truth-error")).to_have_attribute("data-inside", "true")
    told = [e for e in server.events(ID) if e["kind"] == "truth_noted"]
    assert [(e["how"], e["accuracy_m"]) for e in told] == [("phone", 5.0)]
    phone.page.screenshot(path=tmp_path / "found-here.png")

    screen = open_screen(server, "#/calibration")
    expect(screen.part("calibration-of")).to_be_visible()
    expect(screen.part("reliability").first).not_to_have_attribute("data-of", "0")
    look(screen.page, "calibration", tmp_path)


def said_of(server: Server, open_screen: OpenScreen, folder: Path) -> list[dict[str, Any]]:
    """The events of the mission, which is brought in if it is not here yet."""
    brought_in(open_screen(server), folder)
    return server.events(ID)


@pytest.mark.long
def test_a_bundle_opened_in_another_installation_is_the_same_mission(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    """Fetched and brought in on the pages; event for event, and what is made of them: report, comparison, what-if."""
    facts = said_of(server, open_screen, tmp_path)
    here = open_screen(server)
    row = here.page.locator(f"[data-testid=mission-row][data-mission='{ID}']")
    row.locator("details.export summary").click()
    with here.page.expect_download() as taken:
        row.get_by_test_id("export-bundle").click()
    carried = tmp_path / "carried.zip"
    taken.value.save_as(carried)

    def reviewed(screen: Screen) -> list[str]:
        screen.open(ID)
        screen.row("bearing_measured").last.click()
        screen.part("what-if").locator("summary").click()
        screen.part("what-if-sigma").fill("20")
        screen.part("what-if-ask").click()
        expect(screen.part("what-if-steps")).to_contain_text("± 20.0°")
        found = [screen.part("what-if-steps").inner_text()]
        screen.go(f"#/compare/{ID}")
        found += screen.part("compare-row").first.all_inner_texts()
        screen.go(f"#/report/{ID}")
        expect(screen.part("report")).to_have_attribute("data-ready", "true")
        return [*found, screen.part("report").inner_text()]

    with serving(tmp_path / "elsewhere") as other:
        there = open_screen(other)
        there.part("bring-in").set_input_files(carried)
        there.page.wait_for_url(f"**#/mission/{ID}")
        told = other.events(ID)
        assert told[: len(facts)] == facts
        assert [fact["kind"] for fact in told[len(facts) :]] == ["mission_brought_in"]
        assert reviewed(there) == reviewed(here)
        errors = [[fix["error_m"] for fix in one.get("/api/calibration")["fixes"]] for one in (server, other)]
        assert errors[0] == errors[1]


def test_a_replay_shows_each_event_as_it_stood(server: Server, open_screen: OpenScreen, tmp_path: Path) -> None:
    """A click on a bearing: estimate, map, 3D and the stored belief are of that bearing, whatever came later."""
    events = [(r.seq, r.event) for r in FLOWN]
    screen = open_screen(server)
    page, part = screen.page, screen.part
    brought_in(screen, tmp_path)
    screen.map_ready()
    assert part("strip-minutes").locator("span").count() >= 2
    pace = part("pace")
    assert pace.locator("option").evaluate_all("all => [all[0].value, all.at(-1).value]") == ["0.5", "50"]

    beliefs = [(seq, event) for seq, event in events if event.kind == "belief_updated" and event.bearings > 0]
    settled = [seq for seq, _ in beliefs]
    for count, (seq, believed) in enumerate(beliefs, start=1):
        assert believed.estimate is not None
        row = screen.row("bearing_measured").nth(count - 1)
        row.click()
        screen.expect_belief(count)
        stated = str(believed.estimate.expected_rmse_m)
        expect(part("expected-rmse")).to_have_attribute("data-value", stated)
        measured = next(e for at, e in reversed(events) if at < seq and e.kind == "bearing_measured")
        expect(part("sweep-bearing")).to_have_attribute("data-value", str(measured.bearing_deg))

    with page.expect_request("**/api/scene/views/*") as asked:
        part("scene-switch").click()
    assert asked.value.post_data is not None
    assert json.loads(asked.value.post_data)["seq"] == settled[-1]
    with page.expect_request(
        lambda r: "/api/scene/views/" in r.url and json.loads(r.post_data or "{}").get("seq") == settled[0]
    ):
        screen.row("bearing_measured").first.click()
    part("scene-switch").click()

    at_first = page.locator("[data-testid=event-row][aria-current=true], li[aria-current=true] [data-testid=event-row]")
    part("jump").select_option("decision")
    expect(at_first).to_have_attribute("data-kind", "plan_chosen")
    part("jump").select_option("bearing")
    expect(at_first).to_have_attribute("data-kind", "bearing_measured")

    pace.select_option("50")
    part("play").click()
    expect(at_first).to_have_attribute("data-kind", "mission_ended")
    page.screenshot(path=tmp_path / "replay.png")


def test_the_page_opens_without_its_server_and_keeps_no_answer(server: Server, open_screen: OpenScreen) -> None:
    server.draft()
    screen = open_screen(server)
    page = screen.page
    manifest = page.evaluate("fetch(document.querySelector('link[rel=manifest]').href).then((a) => a.json())")
    assert manifest["display"] == "standalone"
    width = "async (src) => (await createImageBitmap(await (await fetch(src)).blob())).width"
    sizes = [page.evaluate(width, icon["src"]) for icon in manifest["icons"] if icon["type"] == "image/png"]
    assert sizes == [192, 512]
    page.evaluate("navigator.serviceWorker.ready.then(() => true)")
    expect(screen.part("mission-row").first).to_be_visible()
    held = page.evaluate(
        """async () => (await Promise.all((await caches.keys()).map(async (name) =>
            (await (await caches.open(name)).keys()).map((r) => new URL(r.url).pathname)))).flat()"""
    )
    assert "/index.html" in held
    assert not [path for path in held if path.startswith(("/api", "/scene", "/health", "/metrics"))]
    page.context.set_offline(True)
    page.reload()
    expect(screen.part("abort")).to_be_visible()
    screen.go("#/compare/none")
    expect(page.get_by_role("heading", name="Missions compared")).to_be_visible()
    assert page.evaluate("fetch('/api/missions').then(() => 'answered', () => 'refused')") == "refused"
    page.context.set_offline(False)
    page.reload()
    expect(screen.part("mission-row").or_(screen.part("compare")).first).to_be_visible()
