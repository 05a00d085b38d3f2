"""From the colours wanted on the screen to those that viser's renderer must be given.

The page renders with three.js: colours of vertices are linear light, and the filmic tone curve is applied to all of
them (three.js `ACESFilmicToneMapping`, after S. Hill's fit of the ACES reference transforms), then the sRGB curve.
Without the way back everything would look pale.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

ACES_INPUT = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
ACES_OUTPUT = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
EXPOSURE = 1 / 0.6

BRIGHTEST = 0.97
"""The tone curve reaches 1 only for endless light."""


def linear_light(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """The sRGB curve undone (IEC 61966-2-1); 0..1."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def tone_mapped(light: NDArray[np.float64]) -> NDArray[np.float64]:
    """What the renderer makes of (..., 3) linear light: v (v + a) - b over v (c v + d) + e, between two matrices."""
    v = (light * EXPOSURE) @ ACES_INPUT.T
    fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return np.clip(fitted @ ACES_OUTPUT.T, 0.0, 1.0)


def light_for(colours: NDArray[np.uint8]) -> NDArray[np.float32]:
    """(..., 3) linear light that is seen as the (..., 3) colours; very bright ones a little darker.

    The tone curve bleaches: a saturated colour needs negative light in a channel, which a shader takes as it is.
    """
    wanted = np.minimum(linear_light(colours.astype(float) / 255.0), BRIGHTEST)
    fitted = np.clip(wanted @ np.linalg.inv(ACES_OUTPUT).T, 0.0, 1.0)
    square, straight = 1.0 - 0.983729 * fitted, 0.0245786 - 0.4329510 * fitted
    rest = -0.000090537 - 0.238081 * fitted
    v = (-straight + np.sqrt(straight**2 - 4 * square * rest)) / (2 * square)
    return ((v @ np.linalg.inv(ACES_INPUT).T) / EXPOSURE).astype(np.float32)


def bytes_for(colours: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The same for what takes bytes only (lines): light below 0 and beyond 1 is cut."""
    return np.rint(255.0 * np.clip(light_for(colours), 0.0, 1.0)).astype(np.uint8)
