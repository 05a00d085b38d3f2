"""Draw the icons of the installed page from `public/icon.svg`, with the installed Chromium.

python frontend/scripts/make_icons.py
"""

from __future__ import annotations

import shutil
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

PUBLIC = Path(__file__).resolve().parents[1] / "public"
PLAIN, PLAIN_PX = "icon-192.png", 192
MASKABLE, MASKABLE_PX = "icon-maskable.png", 512
SAFE = 0.72
"""Of the width: what lies outside the middle 80 % may be cut off by a launcher (W3C manifest, maskable icons)."""
GROUND = "#0047b3"
COLOURS = 32
"""Blue, white and what lies between at the edges: a palette of them is a third of the picture's bytes."""


def main() -> None:
    drawing = (PUBLIC / "icon.svg").read_text()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page()

        def draw(name: str, px: int, share: float, ground: str) -> None:
            page.set_viewport_size({"width": px, "height": px})
            style = f"margin:0;background:{ground};display:grid;place-items:center;height:100vh"
            sized = drawing.replace("<svg ", f'<svg width="{px * share}" height="{px * share}" ', 1)
            page.set_content(f'<body style="{style}">{sized}</body>')
            page.screenshot(path=PUBLIC / name, omit_background=ground == "transparent")
            drawn = Image.open(PUBLIC / name).convert("RGBA")
            few = drawn.quantize(COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
            few.save(PUBLIC / name, optimize=True)

        draw(PLAIN, PLAIN_PX, 1.0, "transparent")
        draw(MASKABLE, MASKABLE_PX, SAFE, GROUND)
        browser.close()


if __name__ == "__main__":
    main()
