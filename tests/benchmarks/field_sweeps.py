"""Single sweeps of the field world: how often the finder's own sigma holds, by how strong the strongest echo is.

    python -m tests.benchmarks.field_sweeps --fields 60

Whole turns at four places in each field, 60 to 200 m from the emitter, the compass right, with the antenna's measured
pattern. Sigma is the finder's without what the vehicle states of its heading. An echo is compared with the direct wave
before the antenna, both shadowed as they are at the place.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import sys
from collections.abc import Sequence
from typing import get_args

import numpy as np

from backend.cli.field_missions import OUTLIER_DEG, FieldOptions, FieldStudy
from backend.events import BearingMeasured
from backend.search.sector import whole_turn
from backend.simulation.field_world import HEIGHT_M, Antenna, Field
from hardware.sim.antenna import TabulatedAntenna
from hardware.sim.world import Pose
from planner.shares import wilson
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write

PLACES = 4
AWAY_M = (60.0, 200.0)
LEVELS_DB = {
    "below -15": (-math.inf, -15.0),
    "-15 to -10": (-15.0, -10.0),
    "-10 to -6": (-10.0, -6.0),
    "-6 to -3": (-6.0, -3.0),
    "-3 and more": (-3.0, math.inf),
    "any": (-math.inf, math.inf),
}
WEAK_DB = -10.0
ROUND = TabulatedAntenna(np.array([0.0, 180.0]), np.zeros(2))
"""Hears all round alike."""
COLUMNS = (
    Column(name="antenna"),
    Column(name="strongest echo, dB"),
    Column(name="sweeps"),
    Column(name="within two sigma, %", decimals=0),
    Column(name="its 95 % interval"),
    Column(name="sigma (median), degrees", decimals=1),
    Column(name="RMS of errors cut at 30, degrees", decimals=1),
)


@dataclasses.dataclass(frozen=True, slots=True)
class Heard:
    """echo_db: the strongest echo's power over the direct wave's. off_deg: the bearing's error. sigma_deg: stated."""

    echo_db: float
    off_deg: float
    sigma_deg: float


def strongest_echo_db(field: Field, x: float, y: float) -> float:
    """Over the direct wave, at (x, y) m ENU."""
    world = dataclasses.replace(field.at(x, y), antenna=ROUND)
    emitter, pose = world.emitters[0], Pose(field.frame.to_geo(x, y), HEIGHT_M, 0.0)
    direct = dataclasses.replace(world, reflectors=()).received_field(emitter, pose)
    both = [dataclasses.replace(world, reflectors=(one,)).received_field(emitter, pose) for one in world.reflectors]
    return max(20.0 * math.log10(abs(field - direct) / abs(direct)) for field in both)


def sweeps(antenna: Antenna, fields: int, seed: int) -> list[Heard]:
    """Of the accepted turns. seed: of the first field."""
    study = FieldStudy.of(FieldOptions(compass_deg=0.0, antenna=antenna))
    rng, heard = np.random.default_rng(seed), list[Heard]()
    for number in range(fields):
        field = study.field(seed + number)
        for place in range(PLACES):
            towards, away = rng.uniform(-math.pi, math.pi), rng.uniform(*AWAY_M)
            here = (field.truth[0] + away * math.cos(towards), field.truth[1] + away * math.sin(towards))
            fact, _, _ = study.measured(field, here, place, whole_turn("first"))
            off = study.off_deg(field, fact) if isinstance(fact, BearingMeasured) else None
            if isinstance(fact, BearingMeasured) and off is not None:
                sigma = math.sqrt(fact.sigma_deg**2 - fact.heading_sigma_deg**2)
                heard.append(Heard(strongest_echo_db(field, *here), off, sigma))
        print(f"{antenna}: field {number + 1} of {fields}", file=sys.stderr, flush=True)
    return heard


def row(antenna: str, level: str, heard: Sequence[Heard]) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    off, sigma = np.abs([one.off_deg for one in heard]), np.array([one.sigma_deg for one in heard])
    held = int(np.sum(off < 2.0 * sigma))
    low, high = wilson(held, len(heard))
    return (
        *(antenna, level, len(heard), 100.0 * held / len(heard), f"{100 * low:.0f} to {100 * high:.0f}"),
        *(float(np.median(sigma)), float(np.sqrt(np.mean(np.minimum(off, OUTLIER_DEG) ** 2)))),
    )


def figure(name: str, heard: Sequence[Heard]) -> Figure:
    """How many are within two sigma."""
    held = 100.0 * float(np.mean([abs(one.off_deg) < 2.0 * one.sigma_deg for one in heard]))
    return plain(f"within two sigma, {name}", round(held, 1), "%", note=f"{len(heard)} sweeps")


def main() -> None:
    parser = argparse.ArgumentParser(description="What sweeps of the field world are worth, by their strongest echo.")
    parser.add_argument("--fields", type=int, default=60)
    parser.add_argument("--seed", type=int, default=95_000)
    add_out(parser)
    arguments = parser.parse_args()
    begun, cells, figures = begin(__file__), list[tuple[Cell, ...]](), list[Figure]()
    for antenna in get_args(Antenna):
        heard = sweeps(antenna, arguments.fields, arguments.seed)
        for level, (low, high) in LEVELS_DB.items():
            if within := [one for one in heard if low <= one.echo_db < high]:
                cells.append(row(antenna, level, within))
        weak = [one for one in heard if one.echo_db < WEAK_DB]
        figures += [figure(antenna, heard), figure(f"{antenna}, no echo above {WEAK_DB:g} dB", weak)]
    table = Table(name="echoes", columns=COLUMNS, rows=tuple(cells))
    print(markdown(table))
    page = "direction-finding.md#sweeps-of-the-field-world"
    write(arguments.out, "field_sweeps", "Sweeps of the field world", begun, figures, tables=[table], page=page)


if __name__ == "__main__":
    main()
