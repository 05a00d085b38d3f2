"""Recordings brought in on the page: through the antenna that took them, drawn as they were heard, IQ given back."""

from __future__ import annotations

import io
import math
import tarfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, expect
from recorded_turn import BESIDE, YAGI, turn_csv, turn_sigmf
from screen import OpenScreen, Screen
from served import Server

from hardware.direction_finding.pattern_file import pattern_json
from hardware.sdr.sigmf_names import DATA, META

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(240)]

PLACE = "50.6240, 7.2040"


def opened(server: Server, open_screen: OpenScreen, **options: object) -> Screen:
    screen = open_screen(server, f"#/mission/{server.draft()}", **options)
    screen.part("recording").locator("summary").first.click()
    return screen


def one_sweep_is_found(screen: Screen) -> None:
    """Below the sweeps stand remarks, a list of its own."""
    expect(screen.part("recording-found").locator("ul").first.locator("li")).to_have_count(1)


def test_a_turn_of_another_antenna_is_heard_through_its_own_pattern(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    turn, pattern, broken = tmp_path / "turn.csv", tmp_path / "whip.json", tmp_path / "milk.json"
    broken.write_text("buy milk")
    turn.write_text(turn_csv(BESIDE, 60.0))
    pattern.write_text(pattern_json(BESIDE))
    screen = opened(server, open_screen)
    part = screen.part
    part("recording-files").set_input_files(turn)
    part("recording-antenna").set_input_files(broken)
    part("recording-place").fill(PLACE)
    part("recording-send").click()
    expect(part("recording-problem")).to_contain_text("milk.json")
    part("recording-antenna").set_input_files(pattern)
    part("recording-send").click()
    one_sweep_is_found(screen)
    told = server.events(screen.mission_id)
    (imported,) = [e for e in told if e["kind"] == "recording_imported"]
    (measured,) = [e for e in told if e["kind"] == "bearing_measured"]
    assert imported["antenna"]["name"] == BESIDE.name
    assert measured["bearing_deg"] == pytest.approx(60.0, abs=2.0)
    expect(part("sweep-bearing")).to_have_attribute("data-value", str(measured["bearing_deg"]))


def picture(of: Locator) -> np.ndarray:
    """(height, width, 3)"""
    return np.asarray(Image.open(io.BytesIO(of.screenshot())).convert("RGB")).astype(int)


def test_a_pulsed_sweep_draws_every_power_that_was_heard_and_nothing_between(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    """A pulse in 12 degrees, each alone in its bin."""
    turn = tmp_path / "pulses.csv"
    turn.write_text(turn_csv(YAGI, 200.0, every_deg=12.0))
    screen = opened(server, open_screen, device_scale_factor=4)  # so that a dot and the gap beside it are many pixels
    part = screen.part
    part("recording-files").set_input_files(turn)
    part("recording-place").fill(PLACE)
    part("recording-send").click()
    expect(part("polar-power")).to_be_attached()
    (sweep,) = [e for e in server.events(screen.mission_id) if "binned_db" in e]
    heard = {number: level for number, level in enumerate(sweep["binned_db"]) if level is not None}
    assert len(heard) == 30
    plot = part("polar")
    plot.scroll_into_view_if_needed()
    screen.page.add_style_tag(content=".polar > :not(.polar-power) { visibility: hidden }")
    drawn = picture(plot)
    screen.page.add_style_tag(content=".polar-power { visibility: hidden }")
    inked = np.abs(drawn - picture(plot)).max(axis=2) > 60
    side = min(inked.shape)
    top, span = max(heard.values()), max(12.0, max(heard.values()) - min(heard.values()))

    def pixels(number: float, level: float) -> np.ndarray:
        """Around where this power belongs."""
        away = 0.12 + 0.88 * (1.0 - (top - level) / span)
        angle = math.radians(2.0 * number + 1.0)
        x, y = away * math.sin(angle), -away * math.cos(angle)
        column, row = (
            round(middle / 2 + side / 2.6 * at) for middle, at in zip(inked.shape[::-1], (x, y), strict=True)
        )
        return inked[row - 2 : row + 3, column - 2 : column + 3]

    assert [number for number, level in heard.items() if not pixels(number, level).any()] == []
    assert [number for number, level in heard.items() if level > top - 6 and pixels(number + 3, level).any()] == []


def test_iq_that_was_kept_is_offered_as_sigmf_and_nowhere_else(
    server: Server, open_screen: OpenScreen, tmp_path: Path
) -> None:
    meta = turn_sigmf(tmp_path)
    screen = opened(server, open_screen)
    part = screen.part
    part("recording-files").set_input_files([meta, meta.with_suffix(DATA)])
    part("recording-send").click()
    one_sweep_is_found(screen)
    mission_id = screen.mission_id
    screen.go("#/")
    row = screen.page.locator(f"[data-testid=mission-row][data-mission='{mission_id}']")
    row.locator("details.export summary").click()
    expect(part("export-sigmf")).to_have_count(1)
    with screen.page.expect_download() as taken:
        row.get_by_test_id("export-sigmf").click()
    with tarfile.open(taken.value.path()) as archive:
        assert {Path(one.name).suffix for one in archive.getmembers() if one.isfile()} == {META, DATA}
