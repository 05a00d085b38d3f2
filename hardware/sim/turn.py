"""One whole turn in the simulated world at once, without a vehicle: for studies of thousands of sweeps."""

from __future__ import annotations

import numpy as np

from hardware.readings import Place, Sweep
from hardware.sim.world import RadioLink


def turn_once(
    link: RadioLink,
    place: Place,
    height_m: float = 40.0,
    *,
    start_s: float = 0.0,
    start_deg: float = 0.0,
    turned_deg: float = 360.0,
    rate_deg_s: float = 30.0,
    rate_hz: float = 20.0,
) -> Sweep:
    """The sweep of a vehicle that turns clockwise from `start_deg` on one place; times must not decrease."""
    at_s = start_s + np.arange(0.0, turned_deg / rate_deg_s, 1.0 / rate_hz)
    heading_deg = (start_deg + rate_deg_s * (at_s - start_s)) % 360.0
    power_dbm, clipped = link.powers_dbm(at_s, place, height_m, heading_deg)
    return Sweep(
        at_s,
        heading_deg,
        power_dbm,
        link.frequency_hz,
        place,
        altitude_amsl_m=height_m,
        clipped_samples=int(clipped.sum()),
        noise_floor_db=link.world.front_end.noise_dbm,
    )
