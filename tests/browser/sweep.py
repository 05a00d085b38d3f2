"""Every screen in both themes and four sizes as pictures, and what is clipped there: `make screens SCREENS=folder`."""

from __future__ import annotations

import argparse
import json
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
from PIL import Image
from playwright.sync_api import Browser, Page, expect, sync_playwright
from playwright.sync_api import Error as PlaywrightError

from tests.browser.conftest import CHROMIUM, SETTINGS, serving
from tests.browser.screen import AIM_MAP, Screen
from tests.browser.served import Server
from tests.browser.stock import TAGS, brought, search_of_tags, ways

SIZES = {"laptop": (1440, 900), "tablet": (820, 1180), "phone": (390, 844), "small": (1280, 720)}
THEMES = ("outdoor", "indoor")

CLIPPED = """() => [...document.querySelectorAll("body *")].filter((one) => {
  const { overflowX, visibility } = getComputedStyle(one);
  const isDrawn = one.closest("svg, .visually-hidden, .maplibregl-map") !== null;
  const isSeen = !isDrawn && visibility === "visible" && one.clientWidth > 1;
  return isSeen && ["hidden", "clip"].includes(overflowX) && one.scrollWidth > one.clientWidth + 1;
}).map((one) => `${one.tagName.toLowerCase()}.${one.className}: ${one.textContent.trim().slice(0, 60)}`)"""
"""What is cut off at its right edge: elements that hide what does not fit in them."""

TOO_WIDE = "() => document.documentElement.scrollWidth > innerWidth"


@dataclass(frozen=True)
class Shown:
    """Where the pictures are taken: a server with a library, a draft, and a flight that holds."""

    server: Server
    draft: str
    flown: str
    """Over, and kept with its bearings."""
    held: str
    tags: str
    """Of eight tags, with bearings from a hand antenna; nothing flies."""


def nothing(_: Screen) -> None:
    """What is there when the page has come to rest."""


def map_drawn(screen: Screen) -> None:
    screen.map_ready()


def editor_drawn(screen: Screen) -> None:
    screen.map_ready("edit-map")


def checked(screen: Screen) -> None:
    screen.map_ready()
    expect(screen.part("check").first).to_be_visible()


def ready_to_resume(screen: Screen) -> None:
    screen.map_ready()
    screen.offer_resume()


def proposing(screen: Screen) -> None:
    screen.map_ready()
    screen.page.mouse.click(*screen.map_point(0.55, 0.45))
    expect(screen.part("proposal")).to_be_visible()


def last_bearing(screen: Screen) -> None:
    if screen.part("scene-switch").get_attribute("aria-pressed") == "true":  # since an earlier picture
        screen.part("scene-switch").click()
    screen.map_ready()
    if screen.part("card-events").is_visible():
        screen.part("card-events").click()
    screen.row("bearing_measured").last.click()
    if screen.part("card-sweep").is_visible():
        screen.part("card-sweep").click()


def sensor_opened(screen: Screen) -> None:
    """What lies behind "more": the antenna's offset, the error that bearings share, what is heard on the way, and
    turning only where that told little."""
    suggested(screen)
    offset = screen.part("field-sensor-bearing_offset_deg")
    screen.page.locator("details.more").filter(has=offset).locator("summary").click()
    screen.part("field-sensor-listen_on_the_way").check()
    screen.part("field-sensor-swing_on_the_way").check()
    screen.part("field-sensor-never_stop").check()
    screen.part("field-sensor-never_stop").evaluate("(field) => field.scrollIntoView({ block: 'center' })")


def suggested(screen: Screen) -> None:
    """The form as it is at first, whatever an earlier picture typed."""
    screen.map_ready("edit-map")
    if screen.part("discard").is_visible():
        screen.part("discard").click()


def tags_typed(screen: Screen) -> None:
    """Two of them at one frequency, one before all others, heard by a narrow receiver."""
    suggested(screen)
    screen.part("field-emitters-0-kind").select_option("pulsed")
    screen.part("emitter-list").fill(f"{TAGS}\n150.1/1.05 the first one's cub !1")
    screen.part("emitter-list").blur()
    screen.part("field-receiver-band").select_option("25")


def moving(screen: Screen) -> None:
    suggested(screen)
    screen.part("field-emitters-0-movement").select_option("animal")
    screen.part("field-localization-follow").scroll_into_view_if_needed()


def advised(screen: Screen) -> None:
    """Somebody on foot says where they stand and asks where to go."""
    name = screen.part("report-name")
    if name.is_visible():
        name.fill("Ada")
    screen.part("report-mode-here").click()
    screen.page.locator(AIM_MAP).click(position={"x": 90, "y": 230})
    screen.part("advice-walking").click()
    expect(screen.part("advice-said")).to_be_visible()


def ways_opened(screen: Screen) -> None:
    screen.part("ways").locator("summary").click()
    if screen.part("ways").get_attribute("data-known") == "false":
        middle = httpx.get(f"{screen.url}/api/missions/{screen.page.url.split('/')[-2]}", timeout=60).json()
        ring = middle["spec"]["area"]["coordinates"][0]
        at = (sum(corner[0] for corner in ring[:4]) / 4, sum(corner[1] for corner in ring[:4]) / 4)
        screen.part("ways-upload").set_input_files(
            {"name": "valley.geojson", "mimeType": "application/geo+json", "buffer": ways(at)}
        )
        expect(screen.part("ways")).to_have_attribute("data-known", "true")
    screen.part("ways").scroll_into_view_if_needed()


def import_opened(screen: Screen) -> None:
    screen.map_ready()
    screen.part("recording").locator("summary").first.click()
    screen.part("recording").locator("details.more summary").click()
    screen.part("recording-send").scroll_into_view_if_needed()


def on_its_way(screen: Screen) -> None:
    """The example on the way to its second place."""
    screen.map_ready()
    screen.expect_belief(1)
    screen.expect_phase("flying")


def in_three_dimensions(screen: Screen) -> None:
    last_bearing(screen)
    screen.part("scene-switch").click()
    screen.page.wait_for_timeout(SCENE_MS)
    warning = screen.page.frame_locator("iframe").locator(".mantine-Notification-closeButton")
    if warning.count() > 0:  # of drawing by software, as on every machine without a graphics card
        warning.first.click()


def from_menu(name: str) -> Callable[[Screen], None]:
    def show(screen: Screen) -> None:
        screen.part("menu").click()
        if name != "menu":
            screen.part(f"menu-{name}").click()

    return show


def pressed(name: str) -> Callable[[Screen], None]:
    return lambda screen: screen.part(name).click()


def report_ready(screen: Screen) -> None:
    expect(screen.part("report")).to_have_attribute("data-ready", "true")


def compared(screen: Screen) -> None:
    expect(screen.part("compare-line").first).to_be_attached()


def missions_listed(screen: Screen) -> None:
    expect(screen.part("mission-row").first).to_be_visible()
    screen.map_ready("library-map")


Prepare = Callable[[Screen], None]


def screens(at: Shown) -> dict[str, tuple[str, Prepare]]:
    """Each screen by its name: its address, and what brings it to where it is looked at."""
    return {
        "missions": ("#/", missions_listed),
        "menu": ("#/", from_menu("menu")),
        "settings": ("#/", from_menu("settings")),
        "keys": ("#/", from_menu("keys")),
        "new": ("#/new", suggested),
        "sensor": ("#/new", sensor_opened),
        "tags": ("#/new", tags_typed),
        "moving": ("#/new", moving),
        "eight": (f"#/mission/{at.tags}", map_drawn),
        "preflight": (f"#/mission/{at.draft}", checked),
        "import": (f"#/mission/{at.draft}", import_opened),
        "held": (f"#/mission/{at.held}", map_drawn),
        "resume": (f"#/mission/{at.held}", ready_to_resume),
        "proposal": (f"#/mission/{at.held}", proposing),
        "instruments": (f"#/mission/{at.held}", pressed("indicators")),
        "alerts": (f"#/mission/{at.held}", pressed("alerts")),
        "area": (f"#/mission/{at.held}/area", editor_drawn),
        "bearings": (f"#/mission/{at.held}/bearings", nothing),
        "advised": (f"#/mission/{at.tags}/bearings", advised),
        "ways": (f"#/mission/{at.tags}/bearings", ways_opened),
        "example": ("#/mission/example", on_its_way),
        "scene": (f"#/mission/{at.flown}", in_three_dimensions),
        "review": (f"#/mission/{at.flown}", last_bearing),
        "report": (f"#/report/{at.flown}", report_ready),
        "compare": (f"#/compare/{at.flown}", compared),
        "calibration": ("#/calibration", nothing),
        "maps": ("#/maps", nothing),
        "people": ("#/people", nothing),
        "health": ("#/health", nothing),
    }


HELD = {"held", "resume", "proposal", "instruments", "alerts", "area", "bearings"}
"""What is looked at in a flight that holds: without one of these none is flown."""


def held_flight(server: Server, browser: Browser) -> str:
    """A flight that holds after its second bearing."""
    mission = server.draft(expected_rmse_m=0.1, maximum_bearings=200)
    with page_of(browser, server, SIZES["laptop"], {}) as screen:
        screen.fly(mission)
        expect(screen.row("bearing_measured")).to_have_count(2, timeout=180_000)
        screen.hold()
    return mission


@contextmanager
def page_of(browser: Browser, server: Server, size: tuple[int, int], settings: dict[str, Any]) -> Iterator[Screen]:
    """A device of its own with these settings of the page."""
    width, height = size
    handheld = width < 900
    context = browser.new_context(viewport={"width": width, "height": height}, has_touch=handheld, is_mobile=handheld)
    stored = json.dumps(SETTINGS | settings)
    context.add_init_script(f"localStorage.setItem('crossfix.settings', {stored!r})")
    page: Page = context.new_page()
    page.set_default_timeout(30_000)
    page.goto(server.url)
    yield Screen(page, server.url)
    context.close()


def faults(page: Page) -> list[str]:
    """What does not fit on the page that is shown."""
    wide = ["the page is wider than the screen"] if page.evaluate(TOO_WIDE) else []
    return wide + page.evaluate(CLIPPED)


SETTLED_MS = 700
SCENE_MS = 8000
"""Until software has drawn the first picture in 3D."""


def taken(screen: Screen, address: str, prepare: Prepare, picture: Path | None) -> list[str]:
    """One screen, its picture when one is wanted; what does not fit on it."""
    screen.go("#/health")
    screen.go(address)
    prepare(screen)
    screen.page.mouse.move(0, 0)
    screen.page.wait_for_timeout(SETTLED_MS)
    if picture is not None:
        picture.parent.mkdir(parents=True, exist_ok=True)
        screen.page.screenshot(path=picture)
    return faults(screen.page)


README = {
    "fly-outdoor": "laptop/example-outdoor",
    "fly-indoor": "laptop/example-indoor",
    "plan": "laptop/new-outdoor",
    "preflight": "laptop/preflight-outdoor",
    "area": "laptop/area-outdoor",
    "scene": "laptop/scene-outdoor",
    "review": "laptop/review-outdoor",
    "tablet": "tablet/example-outdoor",
}
"""What the README shows, by the name of its file: size, screen and theme."""


def keep_small(pictures: Path, folder: Path) -> None:
    """Those of README that were taken, in 256 colours."""
    for name, taken_as in README.items():
        picture = pictures / f"{taken_as}.png"
        if picture.exists():
            Image.open(picture).convert("RGB").quantize(256, kmeans=8, dither=Image.Dither.NONE).save(
                folder / f"{name}.png", optimize=True
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", help="names of screens, with commas between them")
    parser.add_argument("--sizes", default=",".join(SIZES))
    parser.add_argument("--themes", default=",".join(THEMES))
    parser.add_argument("--language", default="en")
    parser.add_argument("--scale", type=float, default=1.0, help="of the text: 1.3 is 130 percent")
    parser.add_argument("--readme", type=Path, help="folder for small copies of what the README shows")
    arguments = parser.parse_args()
    found = 0
    with (
        tempfile.TemporaryDirectory() as folder,
        serving(Path(folder)) as server,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=CHROMIUM)
        flown = brought(server)[0]
        draft = server.draft()
        wanted = arguments.only.split(",") if arguments.only else None
        held = held_flight(server, browser) if wanted is None or HELD & set(wanted) else draft
        shown = screens(Shown(server, draft, flown, held, search_of_tags(server)))
        for size in arguments.sizes.split(","):
            for theme in arguments.themes.split(","):
                worn = {"theme": theme, "language": arguments.language, "scale": arguments.scale}
                with page_of(browser, server, SIZES[size], worn) as screen:
                    for name in wanted or shown:
                        address, prepare = shown[name]
                        picture = arguments.out / size / f"{name}-{theme}.png"
                        try:
                            wrong = taken(screen, address, prepare, picture)
                        except (PlaywrightError, AssertionError) as fault:
                            wrong = [f"was not reached: {str(fault).splitlines()[0]}"]
                        for one in wrong:
                            print(f"{size} {theme} {name}: {one}")
                        found += len(wrong)
        browser.close()
    if arguments.readme:
        keep_small(arguments.out, arguments.readme)
    print(f"{found} faults")


if __name__ == "__main__":
    main()
