"""How a wave travels in the simulated world: free space, ground reflection, fading."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field

import numpy as np

SPEED_OF_LIGHT_M_S = 299_792_458.0


def two_ray_gain(
    ground_distance_m: float,
    transmitter_height_m: float,
    receiver_height_m: float,
    wavelength_m: float,
    ground_reflection: float,
) -> complex:
    """Complex amplitude gain between isotropic antennas over flat ground (two-ray model).

    h = lambda / (4 pi) * ( exp(-j k d1) / d1 + Gamma exp(-j k d2) / d2 ), d1 direct, d2 by way of the ground.
    `ground_reflection` Gamma 0 is free space, -1 perfect grazing reflection.
    """
    ground = max(ground_distance_m, 0.1)
    direct = math.hypot(ground, receiver_height_m - transmitter_height_m)
    reflected = math.hypot(ground, receiver_height_m + transmitter_height_m)
    wave_number = 2.0 * math.pi / wavelength_m
    return (wavelength_m / (4.0 * math.pi)) * (
        cmath.exp(-1j * wave_number * direct) / direct
        + ground_reflection * cmath.exp(-1j * wave_number * reflected) / reflected
    )


@dataclass(frozen=True, slots=True)
class Fading:
    """Rician fading: a steady part and a scattered part that forgets itself within `coherence_s`.

    rician_k_db: steady over scattered power; math.inf: no fading.
    """

    rician_k_db: float = 9.0
    coherence_s: float = 0.35


@dataclass(slots=True)
class FadingProcess:
    """One realization in time: a first-order Gauss-Markov scattered part. Times must not decrease."""

    fading: Fading
    rng: np.random.Generator
    _scattered: complex | None = field(default=None, init=False)
    _at_s: float = field(default=0.0, init=False)

    def gain(self, at_s: float) -> complex:
        """Complex amplitude gain of mean power one."""
        if math.isinf(self.fading.rician_k_db):
            return 1.0 + 0.0j
        k = 10.0 ** (self.fading.rician_k_db / 10.0)
        scattered_sd = math.sqrt(0.5 / (k + 1.0))
        draw = complex(*self.rng.normal(0.0, scattered_sd, 2))
        if self._scattered is None:
            self._scattered = draw
        else:
            # x(t + dt) = rho x(t) + sqrt(1 - rho^2) w, rho = exp(-dt / tau)
            rho = math.exp(-max(at_s - self._at_s, 0.0) / self.fading.coherence_s)
            self._scattered = rho * self._scattered + math.sqrt(1.0 - rho * rho) * draw
        self._at_s = at_s
        return math.sqrt(k / (k + 1.0)) + self._scattered
