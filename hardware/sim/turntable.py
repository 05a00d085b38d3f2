"""A simulated turntable: measures the simulated antenna the way a real one is measured, noise included.

`python -m hardware.sim.turntable FILE` writes the pattern that ships as patterns/small_yagi.json.
"""

from __future__ import annotations

import argparse
import dataclasses
import math

import numpy as np

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern, make_pattern, save_pattern
from hardware.readings import Place
from hardware.sim.propagation import Fading
from hardware.sim.world import Emitter, Pose, RadioLink, World

OWN_POINTING_SIGMA_DEG = 0.5
"""The simulated antenna is mounted as it was measured; its pattern is interpolated between the turntable's steps."""


def simulated_antenna() -> AntennaPattern:
    """The pattern that ships, for the simulated vehicle, on whose antenna it was measured."""
    return dataclasses.replace(load_pattern(SMALL_YAGI), pointing_sigma_deg=OWN_POINTING_SIGMA_DEG)


def measure_pattern(world: World, step_deg: float = 5.0, turns: int = 10) -> AntennaPattern:
    """Turn the vehicle's model on the spot, 60 m from the world's first emitter at its own height, and average.

    Anechoic range: no reflectors, no ground, no fading; receiver noise and gain jitter stay.
    """
    emitter = dataclasses.replace(world.emitters[0], place=Place(0.0, 0.0), pulse_period_s=None)
    hall = dataclasses.replace(
        world,
        emitters=(emitter,),
        reflectors=(),
        ground_reflection=0.0,
        fading=Fading(math.inf),
        heading_error_deg=0.0,
        antenna_offset_deg=0.0,
    )
    link = RadioLink(hall, emitter.frequency_hz)
    south = Place(-60.0 / 110_574.0, 0.0)
    angle = np.arange(0.0, 360.0, step_deg)
    reading = np.zeros((turns, angle.size))
    for turn in range(turns):
        for k, relative in enumerate(angle):
            # the emitter is in the north, so a nose at -a sees it at relative bearing a
            reading[turn, k], _ = link.power_dbm(0.0, Pose(south, emitter.height_m, -relative % 360.0))
    gain = reading.mean(axis=0)
    return make_pattern(
        "small Yagi on a multicopter (simulated turntable)",
        angle,
        gain - gain.max(),
        world.antenna_offset_deg,
        emitter.frequency_hz,
        "vertical",
    )


def main() -> None:
    """Writes the measured pattern; the seed is the world's."""
    parser = argparse.ArgumentParser(description="Measure the simulated antenna on a simulated turntable.")
    parser.add_argument("file", nargs="?", default=str(SMALL_YAGI), help="where to write the pattern (JSON)")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    save_pattern(measure_pattern(World((Emitter(Place(0.0, 0.0)),), seed=arguments.seed)), arguments.file)


if __name__ == "__main__":
    main()
