"""The simulated antenna: a small Yagi on a multicopter, as fields, with its own physics.

The element pattern is the array factor of four parallel elements; the airframe scatters part of the wave into it from a
few fixed points (motors, battery, legs), which makes the whole pattern unsymmetrical. The direction finder never sees
this module: it works with a pattern *measured* in the simulated world (see turntable.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Elevation = float | NDArray[np.float64]
"""rad, up positive: of all azimuths, or of each."""


class AntennaField(Protocol):
    """Complex far field of a receiving antenna, amplitude 1 in the direction of the front, at the horizon."""

    def field(self, azimuth_rad: NDArray[np.float64], elevation_rad: Elevation) -> NDArray[np.complex128]:
        """azimuth_rad: any shape, clockwise from the antenna's front."""
        ...


@dataclass(frozen=True, slots=True)
class Scatterer:
    """A point of the airframe. Place in wavelengths (forward, right of the driven element); complex coupling."""

    forward: float
    right: float
    coupling: complex


@dataclass(frozen=True, slots=True)
class YagiOnAirframe:
    """E(u) = sum_n a_n exp(j 2 pi x_n u_x) + sum_m c_m exp(j 2 pi r_m . u), u the unit vector towards the source.

    element_forward: places of the elements along the boom in wavelengths; element_current: complex currents.
    With the defaults: 3 dB beam about 65 degrees, largest backward lobe 12 dB down, strongest a little
    left of the front.
    """

    element_forward: tuple[float, ...] = (-0.2, 0.0, 0.2, 0.4)
    element_current: tuple[complex, ...] = (
        0.72 * np.exp(2.25j),
        1.0,
        0.72 * np.exp(-2.25j),
        0.5 * np.exp(-4.5j),
    )
    scatterers: tuple[Scatterer, ...] = (
        Scatterer(-0.75, 0.62, 0.10 * np.exp(0.7j)),
        Scatterer(-0.75, -0.62, 0.07 * np.exp(-1.9j)),
        Scatterer(-1.9, 0.75, 0.06 * np.exp(2.9j)),
        Scatterer(-1.3, -0.15, 0.11 * np.exp(1.4j)),
    )

    def field(self, azimuth_rad: NDArray[np.float64], elevation_rad: Elevation) -> NDArray[np.complex128]:
        """See AntennaField. Vertical elements: cos(elevation) besides the array factor."""
        azimuth = np.asarray(azimuth_rad, dtype=np.float64)
        return self._raw(azimuth, elevation_rad) / np.abs(self._raw(np.zeros(1), 0.0))[0]

    def _raw(self, azimuth: NDArray[np.float64], elevation: Elevation) -> NDArray[np.complex128]:
        forward, right = np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation)
        total = np.zeros(azimuth.shape, dtype=np.complex128)
        for place, current in zip(self.element_forward, self.element_current, strict=True):
            total += current * np.exp(2j * np.pi * place * forward)
        for point in self.scatterers:
            total += point.coupling * np.exp(2j * np.pi * (point.forward * forward + point.right * right))
        return total * np.cos(elevation)


@dataclass(frozen=True, slots=True)
class TabulatedAntenna:
    """An antenna given by a measured table: dB at degrees clockwise from its front. Its phase is taken as zero."""

    azimuth_deg: NDArray[np.float64]
    gain_db: NDArray[np.float64]

    def field(self, azimuth_rad: NDArray[np.float64], elevation_rad: Elevation) -> NDArray[np.complex128]:
        """See AntennaField; the table holds at every elevation."""
        wanted_deg: NDArray[np.float64] = np.rad2deg(azimuth_rad)
        relative_db: NDArray[np.float64] = self.gain_db - self.gain_db.max()
        gain = np.interp(wanted_deg, self.azimuth_deg, relative_db, period=360.0)
        return (10.0 ** (gain / 20.0)).astype(np.complex128)
