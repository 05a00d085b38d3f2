"""Colours come out on the screen as they are wanted."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from backend.scene.colours import PALETTES, cividis
from backend.scene.display import bytes_for, light_for, linear_light, tone_mapped


def seen(light: np.ndarray) -> np.ndarray:
    """What the renderer shows of linear light, 0..255."""
    shown = tone_mapped(light)
    return 255 * np.where(shown <= 0.0031308, 12.92 * shown, 1.055 * shown ** (1 / 2.4) - 0.055)


@given(arrays(np.uint8, (7, 3), elements=st.integers(0, 250)))
def test_greys_and_mild_colours_are_seen_as_they_are(colours: np.ndarray) -> None:
    grey = np.repeat(colours[:, :1], 3, axis=1)
    assert np.abs(seen(light_for(grey)) - grey).max() <= 2.5


def test_every_colour_of_the_palettes_and_of_cividis_is_seen_as_it_is() -> None:
    wanted = [
        colour
        for palette in PALETTES.values()
        for name in palette.__slots__
        for colour in (palette.rounds if name == "rounds" else (getattr(palette, name),))
    ]
    colours = np.concatenate((np.array(wanted), np.rint(cividis(np.linspace(0, 1, 50))))).astype(np.uint8)
    assert np.abs(seen(light_for(colours)) - np.minimum(colours, 251)).max() <= 2


def test_bytes_are_the_light_cut_to_what_a_byte_holds() -> None:
    corners = np.array(np.meshgrid([0, 255], [0, 255], [0, 255])).reshape(3, -1).T.astype(np.uint8)
    assert np.isfinite(light_for(corners)).all()
    assert np.abs(bytes_for(corners) / 255 - np.clip(light_for(corners), 0, 1)).max() <= 0.5 / 255 + 1e-6


def test_linear_light_of_the_known_middle() -> None:
    assert linear_light(np.array(0.5)).item() == np.float64(0.21404114048223255)


def test_cividis_is_brightest_at_the_top_and_monotonous() -> None:
    luminance = cividis(np.linspace(0, 1, 100)) @ np.array([0.2126, 0.7152, 0.0722])
    assert (np.diff(luminance) > 0).all()
