"""A bearing has the number of its place wherever it is named, and whoever ordered something is named once."""

from __future__ import annotations

import re
from typing import Any

import msgspec.msgpack
import pytest
import zstandard
from playwright.sync_api import WebSocket, expect
from screen import OpenScreen, Screen
from served import Server

from hardware.frame import LocalFrame
from hardware.readings import Place
from tests.browser.stock import stored

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(240)]

JOURNAL = "orders"
"""The operator refused its first place and moved its fourth: the bearings were taken at 2, 3, 5, 6 and 7."""

ON_THE_MAP = """
window.placesOnMap = [];
const post = Worker.prototype.postMessage;
Worker.prototype.postMessage = function (message, ...rest) {
  const given = message?.data;
  if (given?.source === "measured" && given.data?.features) {
    window.placesOnMap = given.data.features
      .filter(({ properties }) => properties.what === "place")
      .map(({ properties, geometry }) => [properties.label, ...geometry.coordinates]);
  }
  return post.call(this, message, ...rest);
};
"""
"""Remembers what the map is given to draw: its numbers are pixels."""


def drawn(screen: Screen, bearings: int) -> list[tuple[str, float, float]]:
    """Number, lon and lat of each place on the map, once there are as many as bearings."""
    screen.page.wait_for_function("(wanted) => placesOnMap.length === wanted", arg=bearings, timeout=60_000)
    return [(label, lon, lat) for label, lon, lat in screen.evaluate("placesOnMap")]


def test_a_bearing_has_the_number_of_its_place_on_map_lists_and_report(server: Server, open_screen: OpenScreen) -> None:
    mission = stored(server, JOURNAL)
    taken = [e for e in server.events(mission) if e["kind"] == "bearing_measured"]
    numbers = [str(one["place_number"]) for one in taken]
    towards = [f"{round(one['bearing_deg']) % 360:03d}°" for one in taken]
    assert numbers == ["2", "3", "5", "6", "7"]

    screen = open_screen(server)
    screen.page.add_init_script(ON_THE_MAP)
    screen.open(mission)
    screen.page.reload()
    screen.map_ready()
    assert drawn(screen, len(taken)) == [
        (number, one["place"]["lon"], one["place"]["lat"]) for number, one in zip(numbers, taken, strict=True)
    ]
    at_place = [re.compile(f"{deg} ± .* at place {n},") for n, deg in zip(numbers, towards, strict=True)]
    expect(screen.row("bearing_measured")).to_have_text(at_place)
    choices = screen.part("sweep").locator("select option")
    picked = [f"Place {n}, {deg}" for n, deg in zip(numbers, towards, strict=True)]
    expect(choices).to_have_text([re.compile("."), *reversed(picked)])

    screen.row("bearing_measured").last.click()
    screen.part("what-if").locator("summary").click()
    counted = [f"{n}: {deg}" for n, deg in zip(numbers[1:], towards[1:], strict=True)]
    expect(screen.part("what-if-without").locator("label")).to_have_text(counted)  # the first was left out in flight

    screen.go(f"#/report/{mission}")
    expect(screen.part("report")).to_have_attribute("data-ready", "true")
    lines = screen.part("report-emitter").locator("tbody tr")
    expect(lines.locator("td:nth-child(1)")).to_have_text(numbers)
    expect(lines.locator("td:nth-child(4)")).to_have_text([re.compile(f"^{deg}") for deg in towards])
    expect(screen.part("report-map").locator("g text")).to_have_text(numbers)


@pytest.mark.parametrize("language", ["en", "de"])
def test_whoever_ordered_something_is_named_once_in_a_sentence(
    server: Server, open_screen: OpenScreen, language: str
) -> None:
    mission = stored(server, JOURNAL)
    orderly = {e["by"] for e in server.events(mission) if e.get("by")}
    assert orderly == {"operator"}
    screen = open_screen(server, f"#/mission/{mission}", {"language": language})
    screen.page.locator(".timeline-controls input").check()
    expect(screen.row("command_accepted").first).to_be_visible()
    by = re.compile("operator|Bediener", re.IGNORECASE)
    told = [row.inner_text() for row in screen.part("event-row").all()]
    named = [len(by.findall(row)) for row in told]
    assert sum(named) > 8, "who ordered it is said"
    assert [row for row, times in zip(told, named, strict=True) if times > 1] == []


class SceneLabels:
    """The numbers of places in the 3D picture, with where they stand (m east and north of the home): what its viewer is
    sent, since a picture's digits are pixels."""

    def __init__(self, screen: Screen) -> None:
        self.shown: dict[str, str] = {}
        self.at: dict[str, tuple[float, float]] = {}
        screen.page.on("websocket", self._listen)

    def _listen(self, socket: WebSocket) -> None:
        if "/scene/" in socket.url:
            socket.on("framereceived", self._read)

    def _read(self, frame: str | bytes) -> None:
        if not isinstance(frame, bytes):
            return
        size = int.from_bytes(frame[8:16], "little")
        packed = zstandard.ZstdDecompressor().decompress(frame[16 : 16 + size])
        for message in msgspec.msgpack.decode(packed)["messages"]:
            self._note(message)

    def _note(self, message: dict[str, Any]) -> None:
        name = message.get("name", "")
        if "places/" not in name:
            return
        match message["type"]:
            case "LabelMessage":
                self.shown[name] = message["props"]["text"]
            case "SetPositionMessage":
                self.at[name] = (message["position"][0], message["position"][1])
            case "RemoveSceneNodeMessage":
                self.shown.pop(name, None)
            case _:
                pass

    def wait_for(self, screen: Screen, numbers: list[str]) -> None:
        for _ in range(600):
            if sorted(self.shown.values()) == numbers:
                return
            screen.page.wait_for_timeout(200)
        raise AssertionError(f"{self.shown} instead of {numbers}")


def test_a_bearing_has_the_number_of_its_place_in_the_3d_picture(server: Server, open_screen: OpenScreen) -> None:
    mission = stored(server, JOURNAL)
    told = server.events(mission)
    taken = [e for e in told if e["kind"] == "bearing_measured"]
    home = next(e["home"] for e in told if e["kind"] == "mission_started")
    frame = LocalFrame(Place(**home))
    screen = open_screen(server)
    labels = SceneLabels(screen)
    screen.open(mission)
    screen.row("bearing_measured").last.click()
    screen.part("scene-switch").click()
    labels.wait_for(screen, [str(one["place_number"]) for one in taken])
    stands = {text: labels.at[name] for name, text in labels.shown.items()}
    assert stands == {
        str(one["place_number"]): pytest.approx(frame.to_enu(Place(**one["place"])), abs=0.1) for one in taken
    }
    screen.row("bearing_measured").nth(1).click()
    labels.wait_for(screen, ["2", "3"])
