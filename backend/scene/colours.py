"""Colours of the 3D scene, the same as the map's. No red and no amber: they belong to alerts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Theme = Literal["dark", "light"]
Colour = tuple[int, int, int]


def rgb(code: str) -> Colour:
    """code: "#rrggbb"."""
    return int(code[1:3], 16), int(code[3:5], 16), int(code[5:7], 16)


@dataclass(frozen=True, slots=True)
class Palette:
    """rounds: dropped first .. survived, chosen."""

    sky: Colour
    ground: Colour
    grid: Colour
    grid_major: Colour
    ink: Colour
    faint: Colour
    area: Colour
    fence: Colour
    no_fly: Colour
    bearing_low: Colour
    bearing_high: Colour
    rose: Colour
    path: Colour
    accent: Colour
    rounds: tuple[Colour, ...]


PALETTES: dict[Theme, Palette] = {
    "dark": Palette(
        sky=rgb("#0e1215"),
        ground=rgb("#14181c"),
        grid=rgb("#22292f"),
        grid_major=rgb("#333c44"),
        ink=rgb("#f2f5f7"),
        faint=rgb("#7b8a95"),
        area=rgb("#f2f5f7"),
        fence=rgb("#9ccfa5"),
        no_fly=rgb("#b9a8f0"),
        bearing_low=rgb("#6d6478"),
        bearing_high=rgb("#f0a6ff"),
        rose=rgb("#5fd6d0"),
        path=rgb("#7db7ff"),
        accent=rgb("#7db7ff"),
        rounds=tuple(map(rgb, ("#39434b", "#55626c", "#7b8a95", "#a9b7c1", "#e2eaf0", "#7db7ff"))),
    ),
    "light": Palette(
        sky=rgb("#eef1f2"),
        ground=rgb("#fbfbf8"),
        grid=rgb("#e3e3dc"),
        grid_major=rgb("#c9c9c0"),
        ink=rgb("#111111"),
        faint=rgb("#808e99"),
        area=rgb("#111111"),
        fence=rgb("#3a5a40"),
        no_fly=rgb("#5b4b8a"),
        bearing_low=rgb("#9a8fa8"),
        bearing_high=rgb("#7a0f8a"),
        rose=rgb("#0b6e6e"),
        path=rgb("#0047b3"),
        accent=rgb("#0047b3"),
        rounds=tuple(map(rgb, ("#d5dade", "#aeb8c0", "#808e99", "#54636f", "#1d2c38", "#0047b3"))),
    ),
}

CIVIDIS = np.array(
    [
        (0, 34, 78),
        (0, 46, 106),
        (26, 56, 111),
        (50, 67, 109),
        (67, 78, 108),
        (83, 90, 109),
        (97, 101, 111),
        (111, 112, 115),
        (125, 124, 120),
        (140, 136, 120),
        (155, 148, 118),
        (171, 160, 114),
        (188, 174, 108),
        (205, 187, 99),
        (222, 201, 88),
        (240, 216, 70),
        (254, 232, 56),
    ],
    float,
)
"""Every sixteenth colour of cividis (Nunez, Anderton, Renslow 2018), linear in between."""


def cividis(share: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3) colours 0..255 of shares 0..1."""
    stops = np.linspace(0.0, 1.0, len(CIVIDIS))
    clipped = np.clip(share, 0.0, 1.0)
    return np.stack([np.interp(clipped, stops, CIVIDIS[:, channel]) for channel in range(3)], axis=-1)


def between(low: Colour, high: Colour, share: float) -> Colour:
    """Linear between two colours; share clipped to 0..1."""
    t = min(1.0, max(0.0, share))
    red, green, blue = (round(a + t * (b - a)) for a, b in zip(low, high, strict=True))
    return red, green, blue


def flat(colour: Colour, alpha: float, count: int) -> NDArray[np.uint8]:
    """(count, 4) of one colour; alpha 0..1."""
    return np.tile(np.array([*colour, round(255 * alpha)], np.uint8), (count, 1))


def fading(colour: Colour, alphas: NDArray[np.float64]) -> NDArray[np.uint8]:
    """(n, 4) of one colour with an alpha 0..1 a vertex."""
    return np.column_stack((np.tile(colour, (len(alphas), 1)), np.rint(255 * alphas))).astype(np.uint8)
