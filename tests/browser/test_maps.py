"""Offline maps on the real page: drawn from this server's packages, labels included, with the network cut."""

from __future__ import annotations

import gzip
import io
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import mapbox_vector_tile
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, expect
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer
from relief import geotiff
from screen import OpenScreen, Screen
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.long]

GREEN = (30, 160, 60)
HOME_TILE = {zoom: (int((7.2046 + 180) / 360 * 2**zoom), int(0.336426 * 2**zoom)) for zoom in (13, 14, 15, 16)}
"""The tile of the simulated vehicle's home; its Mercator ordinate is 0.336426."""

PATIENCE_S = 60.0


def archive(contents: Callable[[int], bytes], zooms: tuple[int, ...], vector: bool) -> bytes:
    stream = io.BytesIO()
    writer = Writer(stream)
    for zoom in zooms:
        column, row = HOME_TILE[zoom]
        reach = 2 ** (zoom - 13) * 2
        tiles = [(x, y) for x in range(column - reach, column + reach) for y in range(row - reach, row + reach)]
        for tile_id in sorted(zxy_to_tileid(zoom, x, y) for x, y in tiles):
            writer.write_tile(tile_id, contents(zoom))
    header = {
        "tile_type": TileType.MVT if vector else TileType.PNG,
        "tile_compression": Compression.GZIP if vector else Compression.NONE,
        "min_lon_e7": 71_000_000,
        "min_lat_e7": 505_500_000,
        "max_lon_e7": 73_000_000,
        "max_lat_e7": 507_000_000,
    }
    fields = {"name": "String", "kind": "String"}
    layers = [{"id": name, "fields": fields} for name in ("earth", "landuse", "roads", "water", "places")]
    writer.finalize(header, {"name": "test", "attribution": "somebody", "vector_layers": layers if vector else []})
    return stream.getvalue()


@cache
def green_tile(_: int) -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", (256, 256), GREEN).save(stream, "PNG")
    return stream.getvalue()


@cache
def tile(names: bool) -> bytes:
    """Land everywhere, and sixteen places with a name."""
    square = {"geometry": "POLYGON ((0 0, 4096 0, 4096 4096, 0 4096, 0 0))", "properties": {"kind": "earth"}}
    places = [
        {"geometry": f"POINT ({x} {y})", "properties": {"name": "Mühlenwörth", "kind": "locality"}}
        for x in range(512, 4096, 1024)
        for y in range(512, 4096, 1024)
    ]
    layers = [{"name": "earth", "features": [square]}, {"name": "places", "features": places if names else []}]
    return gzip.compress(mapbox_vector_tile.encode(layers))


class MapTab:
    """The console with one offline map chosen; whatever is asked of another machine is refused and remembered."""

    def __init__(self, browser: Browser, server: Server, map_id: str) -> None:
        self.context = browser.new_context(viewport={"width": 1280, "height": 800})
        self.context.add_init_script(
            f"localStorage.setItem('crossfix.basemap', '{map_id}');"
            """localStorage.setItem('crossfix.settings', '{"theme": "outdoor", "tourSeen": true, "tones": false}')"""
        )
        self.foreign: list[str] = []
        self.asked: list[str] = []
        self.page: Page = self.context.new_page()
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.context.route(lambda url: urlsplit(url).hostname not in {"127.0.0.1", None, ""}, self._refuse)
        self.screen = Screen(self.page, server.url)

    def _refuse(self, route) -> None:
        self.foreign.append(route.request.url)
        route.abort()

    def picture(self) -> np.ndarray:
        """(height, width, 3) of the map."""
        shot = self.screen.part("map").screenshot()
        return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)

    def wait_for(self, condition: Callable[[], bool], what: str) -> None:
        until = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < until, f"{what} did not come"
            self.page.wait_for_timeout(250)


def upload(server: Server, content: bytes) -> str:
    answer = httpx.post(f"{server.url.rstrip('/')}/api/maps", params={"name": "test"}, content=content, timeout=60)
    answer.raise_for_status()
    return answer.json()["map_id"]


def near(picture: np.ndarray, colour: tuple[int, int, int], within: int = 12) -> float:
    """Share of the pixels that have about this colour."""
    return float((np.abs(picture - np.array(colour)).max(axis=2) < within).mean())


def middle(picture: np.ndarray) -> np.ndarray:
    """Inside the area, where nothing but the map and the belief is drawn before the start."""
    height, width, _ = picture.shape
    return picture[int(0.3 * height) : int(0.66 * height), int(0.32 * width) : int(0.72 * width)]


WORLD = {"outdoor": ((244, 243, 236), (207, 222, 230)), "indoor": ((29, 36, 42), (11, 18, 24))}
"""Colours of land and water on the small map that ships."""


def test_the_small_map_that_ships_is_seen_under_the_first_page(server: Server, open_screen: OpenScreen) -> None:
    """For who has uploaded none: the world around an empty library, then the land around its first mission."""
    foreign: list[str] = []

    def shares(screen: Screen, theme: str) -> list[float]:
        shot = screen.part("library-map").screenshot()
        picture = np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)
        return [near(picture, colour, 3) for colour in WORLD[theme]]

    def until(screen: Screen, condition: Callable[[], bool], what: str) -> None:
        late = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < late, f"{what} did not come"
            screen.page.wait_for_timeout(250)

    def first_page(theme: str, gives_map: bool) -> Screen:
        screen = open_screen(server, "#/health", {"theme": theme})
        screen.page.on("request", lambda request: foreign.append(request.url))
        if not gives_map:
            screen.page.route("**/api/basemap", lambda route: route.abort())
        screen.go("#/")
        screen.map_ready("library-map")
        return screen

    for theme in WORLD:
        plain = first_page(theme, gives_map=False)
        expect(plain.part("welcome")).to_be_visible()
        assert shares(plain, theme)[1] < 0.02, "what is seen below comes from the map that ships"
        plain.page.close()
        screen = first_page(theme, gives_map=True)
        until(screen, lambda screen=screen, theme=theme: min(shares(screen, theme)) > 0.05, "land and water")
    server.draft()
    screen = first_page("outdoor", gives_map=True)
    expect(screen.part("mission-row")).to_have_count(1)
    until(screen, lambda: shares(screen, "outdoor")[0] > 0.3, "the land around the mission")
    ours = urlsplit(server.url).netloc
    hosts = {urlsplit(url).netloc for url in foreign if urlsplit(url).scheme.startswith("http")}
    assert hosts == {ours}


def test_pictures_of_a_package_lie_under_the_mission_and_its_belief(server: Server, browser: Browser) -> None:
    map_id = upload(server, archive(green_tile, (13, 14, 15, 16), vector=False))
    tab = MapTab(browser, server, map_id)
    try:
        tab.screen.open(server.draft())
        tab.screen.map_ready()
        tab.wait_for(lambda: near(tab.picture(), GREEN) > 0.3, "the picture tiles")
        tab.wait_for(lambda: near(middle(tab.picture()), GREEN) < 0.1, "the belief over them")
        assert tab.foreign == []
        assert any(url.endswith("/tiles.pmtiles") for url in tab.asked)
    finally:
        tab.context.close()


def dark_pixels(picture: np.ndarray) -> int:
    return int((middle(picture).max(axis=2) < 130).sum())


@pytest.mark.parametrize("names", [True, False])
def test_vector_tiles_are_drawn_with_their_names_and_no_glyphs_are_fetched(
    server: Server, browser: Browser, names: bool
) -> None:
    map_id = upload(server, archive(lambda _: tile(names), (13, 14, 15), vector=True))
    layers = server.get(f"/api/maps/{map_id}/layers?theme=light")["layers"]
    land = next(layer["paint"]["fill-color"] for layer in layers if layer["source-layer"] == "earth")
    tab = MapTab(browser, server, map_id)
    try:
        tab.screen.open(server.draft())
        tab.screen.map_ready()
        tab.wait_for(lambda: near(tab.picture(), rgb(land)) > 0.2, "the land")
        if names:
            tab.wait_for(lambda: dark_pixels(tab.picture()) > 50, "the names")
        else:
            assert dark_pixels(tab.picture()) == 0, "what is dark in the other package are its names"
        assert tab.foreign == []
        assert not any("glyph" in url or url.endswith(".pbf") for url in tab.asked)
    finally:
        tab.context.close()


def rgb(code: str) -> tuple[int, int, int]:
    return int(code[1:3], 16), int(code[3:5], 16), int(code[5:7], 16)


def test_a_package_is_uploaded_chosen_and_removed_on_the_page(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    screen = open_screen(server, "#/maps")
    broken, package = tmp_path / "notes.pmtiles", tmp_path / "meadow.pmtiles"
    broken.write_text("buy milk")
    package.write_bytes(archive(green_tile, (13,), vector=False))
    screen.part("upload-maps").set_input_files(broken)
    expect(screen.page.get_by_role("alert")).to_contain_text("What to do")
    screen.part("upload-maps").set_input_files(package)
    row = screen.part("map-package").filter(has_text="meadow")
    row.get_by_role("radio").check()
    chosen = screen.evaluate("localStorage.getItem('crossfix.basemap')")
    assert chosen in [one["map_id"] for one in server.get("/api/maps")["maps"]]
    row.get_by_role("button").click()
    expect(row).to_have_count(0)
    assert chosen not in [one["map_id"] for one in server.get("/api/maps")["maps"]]


def test_uploaded_terrain_is_shaded_and_lined_under_a_mission_and_can_be_hidden(
    server: Server, browser: Browser, tmp_path: Path
) -> None:
    """A ridge of 90 m beside the vehicle's home, seen in the corner of the map where nothing else is drawn."""
    step_deg, count = 1 / 3600, 300
    ridge = 120.0 + 90.0 * np.exp(-(((np.arange(count) - count / 2 + 8) / 12.0) ** 2))
    heights = np.broadcast_to(ridge, (count, count)).astype(np.float32)
    file = tmp_path / "ridge.tif"
    file.write_bytes(geotiff(heights, 50.6234 + count / 2 * step_deg, 7.2046 - count / 2 * step_deg, step_deg))
    tab = MapTab(browser, server, "")
    try:
        tab.screen.go("#/maps")
        tab.screen.part("upload-terrain").set_input_files(file)
        expect(tab.screen.part("terrain")).to_contain_text("ridge")
        tab.screen.open(server.draft())
        tab.screen.map_ready()
        tab.wait_for(lambda: any("/terrain/contours" in url for url in tab.asked), "the contours")
        tab.wait_for(lambda: any("/terrain/tiles/" in url for url in tab.asked), "the shading")
        tab.page.locator("summary", has_text="Layers").click()
        relief = tab.page.get_by_role("checkbox", name="Relief")
        expect(relief).to_be_checked()
        tab.page.wait_for_timeout(500)
        corner = (slice(-150, -60), slice(200, 500))
        with_relief = tab.picture()[corner]
        relief.uncheck()
        tab.wait_for(lambda: (np.abs(tab.picture()[corner] - with_relief).max(axis=2) > 4).mean() > 0.2, "the plain")
        assert tab.foreign == []
    finally:
        for one in server.get("/api/terrain")["terrains"]:
            httpx.delete(f"{server.url.rstrip('/')}/api/terrain/{one['terrain_id']}", timeout=20).raise_for_status()
        tab.context.close()
