"""What an antenna receives along a way, all of its points at once: the same waves as `World.received_fields` has at one
place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pymap3d
from numpy.typing import NDArray

from hardware.readings import Place
from hardware.sim.propagation import SPEED_OF_LIGHT_M_S, two_ray_gain
from hardware.sim.world import Emitter, World, as_leaning

Floats = NDArray[np.float64]


def received_along(
    world: World,
    emitter: Emitter,
    lon_lat: Floats,
    height_m: float,
    heading_deg: Floats,
    lean: Floats,
    lost_db: Sequence[Floats],
) -> NDArray[np.complex128]:
    """(n,) complex amplitudes at the antenna's terminals without fading and noise; |.|^2 in milliwatt.

    lon_lat: (n, 2) degrees. heading_deg: (n,) reported. lean: (n, 2) rad, as of `Pose`. lost_db: (n,) by which the
    shadows weaken the emitter's wave, then each reflector's, there.
    """
    wavelength = SPEED_OF_LIGHT_M_S / emitter.frequency_hz
    east, north = _seen_from(lon_lat, emitter.place)
    up = emitter.height_m - height_m
    front = heading_deg + world.heading_error_deg + world.antenna_offset_deg

    def wave(path_m: Floats, to_east: Floats, to_north: Floats) -> NDArray[np.complex128]:
        gain = [
            two_ray_gain(float(path), emitter.height_m, height_m, wavelength, world.ground_reflection)
            for path in path_m
        ]
        x, y, z = as_leaning(to_east, to_north, np.full(to_east.size, up), (lean[:, 0], lean[:, 1]))
        elevation = np.arctan2(z, np.maximum(np.hypot(x, y), 0.1))
        return np.array(gain) * world.antenna.field(np.radians(np.degrees(np.arctan2(x, y)) - front), elevation)

    total = wave(np.hypot(east, north), east, north) * 10.0 ** (-lost_db[0] / 20.0)
    for reflector, lost in zip(world.reflectors, lost_db[1:], strict=True):
        wall_east, wall_north = _seen_from(lon_lat, reflector.place)
        path = np.hypot(wall_east - east, wall_north - north) + np.hypot(wall_east, wall_north)
        amplitude = 10.0 ** (-(reflector.loss_db + lost) / 20.0) * np.exp(1j * reflector.phase_rad)
        total = total + amplitude * wave(path, wall_east, wall_north)
    return total * 10.0 ** ((emitter.power_dbm - emitter.polarization_loss_db) / 20.0)


def _seen_from(lon_lat: Floats, place: Place) -> tuple[Floats, Floats]:
    """(n,) east and north, m, of a place in the local frame of each of the points."""
    lon, lat = lon_lat.T
    east, north, _ = pymap3d.geodetic2enu(place.lat, place.lon, 0.0, lat, lon, 0.0)
    return np.asarray(east), np.asarray(north)
